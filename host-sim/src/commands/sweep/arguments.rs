//! The arguments of `sweep`, as they are typed.

use clap::Args;
use std::path::PathBuf;

use crate::commands::ending::OutputArguments;
use crate::input::scenario::{SensorShare, Switch};

/// The arguments of `sweep`.
#[derive(Clone, Debug, Args)]
#[command(mut_arg("out", |out| out.default_value("holdover-report/sweep")))]
pub struct SweepArguments {
    /// The scenario; by default the paper's
    #[arg(value_name = "SCENARIO.toml")]
    pub scenario: Option<PathBuf>,

    /// The prediction steps, in seconds from 0.001 to 1
    #[arg(
        long,
        value_name = "SECONDS,…",
        value_delimiter = ',',
        allow_negative_numbers = true,
        default_value = "0.01,0.02,0.05,0.1,0.2,0.5,1"
    )]
    pub steps: Vec<f64>,

    /// Number of seeds, each with one run per step
    #[arg(long, value_name = "N", default_value = "100", allow_negative_numbers = true)]
    pub seeds: u64,

    /// The first seed, instead of the scenario's
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub seed: Option<u64>,

    /// Whether the envelope is engaged. Nobody can foresee the commands that it changes
    #[arg(
        long,
        value_name = "on|off",
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = "on",
        default_value = "off",
        hide_possible_values = true
    )]
    pub envelope: Switch,

    /// Whether every vehicle that follows another has a range sensor, or a share of them, from 0 to 1
    #[arg(long, value_name = "on|off|SHARE", allow_negative_numbers = true, default_value = "off")]
    pub range_sensors: SensorShare,

    /// Refuse recordings that say what no vehicle and no link does, instead of warning of them
    #[arg(long)]
    pub strict: bool,

    /// Where its results go.
    #[command(flatten)]
    pub output: OutputArguments,
}

/// The end of `sweep --help`.
pub const AFTER_HELP: &str = "\
Examples:
  holdover-sim sweep                           the paper's steps, 100 seeds each
  holdover-sim sweep --seeds 10 --steps 0.01,0.1,1 --json
  holdover-sim sweep city.toml --out city-sweep
  holdover-sim sweep --envelope --range-sensors on
                                               as the units are shipped
  RAYON_NUM_THREADS=2 holdover-sim sweep       on two cores instead of all

Figures:
  The position error of the ego as its follower estimates it, from 1 s on, ours
  and the literal paper's on the same messages. The maximum is the worst of all
  seeds; the 99th percentile is the nearest rank of all seeds' errors together.
  The units tick at the scenario's period whatever the step. The estimate is by
  messages alone and no envelope limits a command, whatever the scenario says,
  unless the two options say otherwise.

Cost (\"timing\"):
  After the runs of a step, alone on its thread, the follower's unit is given
  the traffic of the first seed's run (of at most 20 s) again, five times; the
  cost is the mean over all ticks, of each the fastest of the five. All else is
  the same bytes whatever the number of threads.

Exit codes:
  0  every run passed
  1  at least one run failed: a collision, a full stop, or no estimate
  2  bad input; one line on stderr names file, line, cause and remedy";
