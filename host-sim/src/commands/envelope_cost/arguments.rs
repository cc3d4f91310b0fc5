//! The arguments of `envelope-cost`, as they are typed.

use clap::Args;
use std::path::PathBuf;

use crate::commands::ending::OutputArguments;
use crate::input::scenario::SensorShare;

/// The arguments of `envelope-cost`.
#[derive(Clone, Debug, Args)]
#[command(mut_arg("out", |out| out.default_value("holdover-report/envelope-cost")))]
pub struct EnvelopeCostArguments {
    /// The scenario; the paper's if none is given
    #[arg(value_name = "SCENARIO.toml")]
    pub scenario: Option<PathBuf>,

    /// Lengths of the silence, in seconds, each instead of the scenario's outages [default: 1,2,4,8]
    #[arg(long, value_name = "SECONDS,…", value_delimiter = ',', allow_negative_numbers = true)]
    pub silences: Option<Vec<f64>>,

    /// Number of seeds, each with one run with the envelope and one without
    #[arg(long, value_name = "N", default_value = "20", allow_negative_numbers = true)]
    pub seeds: u64,

    /// The first seed, instead of the scenario's
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub seed: Option<u64>,

    /// The distance for which the travel time is measured
    #[arg(long, value_name = "METRES", default_value = "200", allow_negative_numbers = true)]
    pub distance: f64,

    /// Let the leader drive this recording: `t_s,position_m,speed_mps[,acceleration_mps2]`
    #[arg(long, value_name = "FILE.csv")]
    pub leader_motion: Option<PathBuf>,

    /// Replace the random channel by this recording: `t_s,delay_s`; its silences replace --silences
    #[arg(long, value_name = "FILE.csv")]
    pub channel_trace: Option<PathBuf>,

    /// Whether every vehicle that follows another has a range sensor, or none, or a share from 0 to 1, instead of what the scenario
    /// says
    #[arg(long, value_name = "on|off|SHARE", allow_negative_numbers = true)]
    pub range_sensors: Option<SensorShare>,

    /// Refuse recordings that say what no vehicle and no link does, instead of warning of them
    #[arg(long)]
    pub strict: bool,

    /// Where its results go.
    #[command(flatten)]
    pub output: OutputArguments,
}

/// The end of `envelope-cost --help`.
pub const AFTER_HELP: &str = "\
Examples:
  holdover-sim envelope-cost                silences of 1, 2, 4 and 8 s
  holdover-sim envelope-cost --silences 0.5,1 --seeds 100 --json
  holdover-sim envelope-cost --range-sensors off
                                            what it costs by messages alone
  holdover-sim envelope-cost --leader-motion drive.csv --channel-trace link.csv
                                            your recordings, as they are

Runs:
  Each seed is run twice, without the envelope and with it. The silence begins
  when the scenario's first outage does (at 4 s if it has none), and takes the
  place of all its outages. All runs last as long as the scenario, and for at
  least 30 s after the longest silence; with a recorded leader as long as that.

Figures:
  limited       share of time in which the envelope changes a command, of the
                vehicles whose link to the one ahead is impaired
  travel time   mean of the same vehicles for the first --distance metres; none
                if one of them does not come that far
  stops         full stops of vehicles that a unit drives: below 0.1 m/s for
                0.5 s or more
  gap           smallest bumper gap of any vehicle in any run
  braking       hardest braking of any vehicle that a unit drives, as reached
  collisions    episodes of a bumper gap below 0; without the envelope they are
                reported, with it they fail the verdict

Output:
  Results go to stdout, as a table or with --json as one JSON value; progress
  goes to stderr. Equal input gives equal bytes, whatever the number of threads.

Exit codes:
  0  with the envelope nobody collided, and no target ever left its bound
  1  somebody did, or one did
  2  bad input; one line on stderr names file, line, cause and remedy";
