//! The arguments of `braking`, as they are typed.

use clap::Args;

use crate::commands::ending::OutputArguments;
use crate::input::scenario::SensorShare;

/// The arguments of `braking`.
#[derive(Clone, Debug, Args)]
#[command(mut_arg("out", |out| out.default_value("holdover-report/braking")))]
pub struct BrakingArguments {
    /// The leader's braking, in m/s² from 0.5 to 12
    #[arg(long, value_name = "M/S2,…", value_delimiter = ',', default_value = "2,5,8", allow_negative_numbers = true)]
    pub braking: Vec<f64>,

    /// Time gaps of the ten followers, in seconds from 0.1 to 3.995; by default the shipped one
    #[arg(long, value_name = "SECONDS,…", value_delimiter = ',', allow_negative_numbers = true)]
    pub time_gaps: Vec<f64>,

    /// Speed from which the leader brakes, in m/s from 1 to 40
    #[arg(long, value_name = "M/S", default_value = "15", allow_negative_numbers = true)]
    pub speed: f64,

    /// Length of the silence in which it begins to brake, in seconds from 0.1 to 20
    #[arg(long, value_name = "SECONDS", default_value = "4", allow_negative_numbers = true)]
    pub silence: f64,

    /// Delay of every message, in seconds from 0 to 1
    #[arg(long, value_name = "SECONDS", default_value = "0.1", allow_negative_numbers = true)]
    pub delay: f64,

    /// Fraction of messages lost outside the silence, from 0 to 0.9
    #[arg(long, value_name = "SHARE", default_value = "0.1", allow_negative_numbers = true)]
    pub loss: f64,

    /// Whether every follower has a range sensor, or a share of them, from 0 to 1
    #[arg(long, value_name = "on|off|SHARE", allow_negative_numbers = true, default_value = "on")]
    pub range_sensors: SensorShare,

    /// Seed of losses and views, and of the order of the bodies
    #[arg(long, value_name = "N", default_value = "1", allow_negative_numbers = true)]
    pub seed: u64,

    /// Number of seeds, each with one run without the envelope and one with it; the braking begins in as many places of the silence
    #[arg(long, value_name = "N", default_value = "10", allow_negative_numbers = true)]
    pub seeds: u64,

    /// Where its results go.
    #[command(flatten)]
    pub output: OutputArguments,
}

/// The end of `braking --help`.
pub const AFTER_HELP: &str = "\
Examples:
  holdover-sim braking                           the shipped time gap, with range sensors
  holdover-sim braking --time-gaps 0.6,0.8,1 --seeds 20 --json
  holdover-sim braking --range-sensors off       by messages alone
  holdover-sim braking --speed 25 --braking 8 --silence 8

Runs:
  Ten vehicles at their time gap behind a leader that says where it is, but not
  how it will drive. All links fall silent, and in the silence the leader brakes
  to a stop; its braking sets in at 25 m/s³. Cars, vans and buses take turns, and
  lags of 0.1 to 0.5 s; each seed begins with another of them. The silence is as
  long in each run, but the braking begins in another part of it.

Figures:
  gap         smallest bumper gap of any vehicle in any run; none where vehicles
              collided
  braking     hardest braking of a follower, as reached
  jerk        largest change of acceleration within 0.1 s, while a vehicle moves
              at 0.5 m/s or faster
  collisions  pairs that met; without the envelope they are reported, with it
              they fail the verdict
  avoidable   of these, pairs in which the vehicle behind could have come to rest
              by the limits of its law and with its lag, had it begun to brake
              0.1 s after the one ahead had lost 0.1 m/s, the largest error of
              the sensor's speed; without pairs whose vehicle ahead had run into
              another before: a collision stops nobody in the simulation
  known at once
              the same, had it begun to brake in the moment in which the one
              ahead did; nobody can know that moment

Output:
  Results go to stdout, as a table or with --json as one JSON value; progress
  goes to stderr. Equal input gives equal bytes, whatever the number of threads.

Exit codes:
  0  with the envelope nobody collided, and no target ever left its bound
  1  somebody did, or one did
  2  bad input; one line on stderr names option, cause and remedy";
