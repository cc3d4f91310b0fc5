//! The arguments of `string`, as they are typed.

use clap::Args;

use crate::commands::ending::OutputArguments;
use crate::input::kind::Kind;
use crate::input::scenario::SensorShare;

/// The arguments of `string`.
#[derive(Clone, Debug, Args)]
#[command(mut_arg("out", |out| out.default_value("holdover-report/string")))]
pub struct StringArguments {
    /// Time gaps of the ten followers, in seconds from 0.1 to 3.995; by default the shipped one
    #[arg(long, value_name = "SECONDS,…", value_delimiter = ',', allow_negative_numbers = true)]
    pub time_gaps: Vec<f64>,

    /// Delays of every message, in seconds from 0 to 1
    #[arg(
        long,
        value_name = "SECONDS,…",
        value_delimiter = ',',
        default_value = "0,0.1,0.2",
        allow_negative_numbers = true
    )]
    pub delays: Vec<f64>,

    /// Fractions of messages lost, from 0 to 0.9
    #[arg(
        long,
        value_name = "SHARE,…",
        value_delimiter = ',',
        default_value = "0,0.2,0.4",
        allow_negative_numbers = true
    )]
    pub losses: Vec<f64>,

    /// Frequencies of the leader's sines, in Hz from 0.02 to 2; a step is run as well
    #[arg(
        long,
        value_name = "HZ,…",
        value_delimiter = ',',
        default_value = "0.05,0.1,0.2,0.3,0.5,0.7,1",
        allow_negative_numbers = true
    )]
    pub frequencies: Vec<f64>,

    /// Run the step alone, without sines
    #[arg(long, conflicts_with = "frequencies")]
    pub step_only: bool,

    /// Whether every follower has a range sensor, or a share of them, from 0 to 1
    #[arg(long, value_name = "on|off|SHARE", allow_negative_numbers = true, default_value = "off")]
    pub range_sensors: SensorShare,

    /// Kinds of the ten followers, which take turns
    #[arg(long, value_name = "KIND,…", value_delimiter = ',', default_value = "car")]
    pub kinds: Vec<Kind>,

    /// Followers, from 1 to 10, that a person drives and that tell their states alone
    #[arg(long, value_name = "VEHICLE,…", value_delimiter = ',', allow_negative_numbers = true)]
    pub people: Vec<usize>,

    /// Followers without a unit, that a person drives and nobody hears; with range sensors
    #[arg(long, value_name = "VEHICLE,…", value_delimiter = ',', allow_negative_numbers = true)]
    pub unequipped: Vec<usize>,

    /// Seed of the losses
    #[arg(long, value_name = "N", default_value = "1", allow_negative_numbers = true)]
    pub seed: u64,

    /// Number of seeds of step and sines, from `--seed` on, instead of 40 and 1; the largest ratio of all counts
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub seeds: Option<u64>,

    /// Where its results go.
    #[command(flatten)]
    pub output: OutputArguments,
}

/// The end of `string --help`.
pub const AFTER_HELP: &str = "\
Examples:
  holdover-sim string                            the shipped gains and time gap
  holdover-sim string --time-gaps 1,1.2,1.4,1.6 --step-only --json
  holdover-sim string --delays 0,0.025,0.05 --losses 0,0.1 --seeds 5
  holdover-sim string --delays 0.05 --losses 0.1 --frequencies 0.1,0.2
  holdover-sim string --range-sensors on --people 2,7 --unequipped 4
  holdover-sim string --range-sensors on --kinds car,van,bus --time-gaps 1,1.2,1.4

Runs:
  Ten vehicles behind a leader at 15 m/s that says where it is, but not how it
  will drive. It slows down by 2 m/s, or its speed goes up and down at one
  frequency, by 2 m/s or as much as 1 m/s² makes of it. Every message takes the
  delay, and the share is lost at random.

  The followers are cars with a lag of 0.3 s. Vans have one of 0.4 s and buses
  one of 0.5 s. Each follower drives by the limits of its kind, and with a range
  sensor all but buses feed half of the acceleration ahead forward. The time gap
  by default is that of a car.

Mixed strings:
  A person drives by the Intelligent Driver Model, 1.5 s behind what is really
  there. Ratios are those of the vehicles that a unit drives. A unit behind a
  vehicle that nobody hears sees it, and keeps 1.8 s, or the time gap if that is
  more. The other methods are not run.

Range sensors on a share of the followers are spread evenly, the first follower
has one, and the time gap by default is that of a unit without one.

Chance:
  Which messages are lost decides what a step passes on, so it is run with 40
  seeds; over the whole periods of a sine that averages out, and one does.
  Without a loss nothing is drawn: every seed is the same run, and there is one.
  The verdict says of how many runs it is, and for no others: a run of losses
  that is long enough goes beyond the limit whatever the time gap. More of them:
  holdover-sim string --delays 0.2 --losses 0.4 --step-only --seeds 200

Figures:
  The largest ratio of a vehicle's speed amplitude to its predecessor's: at the
  driven frequency, over whole periods from 60 s on; for a step, of the farthest
  from the speed before. Predecessors below 0.02 m/s do not count.

  holdover         the units, with all that they do
  as it stands     the same law on the newest message as it stands
  age times speed  the same law on the newest message, moved on by its age
  CACC             the controller of Ploeg et al. (IEEE T-ITS 16, 2015): an ideal
                   sensor for gap and speed, and the predecessor's demand by the
                   newest message
  degraded         the same without messages: it estimates that acceleration

Exit codes:
  0  with holdover no ratio is above 1.01, and everybody follows all the time
  1  that is not so; the results say where
  2  bad input; one line on stderr names option, cause and remedy";
