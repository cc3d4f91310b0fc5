//! The arguments of `run`, as they are typed.

use crate::commands::ending::OutputArguments;
use crate::input::scenario::{SensorShare, Switch};
use clap::Args;
use std::path::PathBuf;

/// The arguments of `run`.
#[derive(Clone, Debug, Default, Args)]
pub struct RunArguments {
    /// The scenario, a file or a name from `--list`; by default the paper's (scenarios/paper.toml explains it)
    #[arg(value_name = "SCENARIO")]
    pub scenario: Option<PathBuf>,
    /// The options.
    #[command(flatten)]
    pub settings: RunSettings,
}

/// The options of `run`.
#[derive(Clone, Debug, Default, Args)]
pub struct RunSettings {
    /// Seed of everything random, instead of the scenario's
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub seed: Option<u64>,

    /// Number of seeds, from `--seed` on; they run on all cores. Corridors only
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub seeds: Option<u64>,

    /// List the scenarios that come with the program
    #[arg(long)]
    pub list: bool,

    /// Print a scenario that comes with the program, with a comment for each key
    #[arg(long, value_name = "NAME", conflicts_with_all = ["list", "json"])]
    pub show: Option<String>,

    /// Set a key of the scenario, as often as needed: `channel.loss=0.3`, `vehicle.1.gap_m=20` (counted from 0),
    /// `leader.program=[[0,13],[12,9]]`. It is checked like the file
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,

    /// Measure how fast the program simulates these numbers of vehicles at once, in corridors side by side [with a
    /// report: 10,30,100,300]. Corridors only
    #[arg(long, value_name = "N,…", value_delimiter = ',', allow_negative_numbers = true)]
    pub vehicles: Option<Vec<usize>>,

    /// Run these amounts of traffic, in vehicles per minute, and nothing else. Each is run with and without the
    /// envelope, over the scenario's links and over perfect ones; with vehicles that drive alone while a link is lost;
    /// without passes; and with silences of 0 to 12 s. This can take hours; after each run stderr shows what is done
    /// and what is left. Corridors only
    #[arg(long, value_name = "N,…", value_delimiter = ',', allow_negative_numbers = true)]
    pub demand: Option<Vec<f64>>,

    /// Number of peer slots of every unit, instead of the scenario's; several with `--demand`. Corridors only
    #[arg(long, value_name = "N,…", value_delimiter = ',', allow_negative_numbers = true)]
    pub slots: Option<Vec<usize>>,

    /// Draw a picture of one page: trajectories, errors, and this unit's method beside seven others. Corridors only
    #[arg(long, value_name = "FILE.svg")]
    pub picture: Option<PathBuf>,

    /// Prediction step of the core, instead of the scenario's
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true)]
    pub step: Option<f64>,

    /// Let the leader drive this recording: `t_s,position_m,speed_mps[,acceleration_mps2]`
    #[arg(long, value_name = "FILE.csv")]
    pub leader_motion: Option<PathBuf>,

    /// Replace the random channel by this recording: `t_s,delay_s` (an empty delay is a lost message)
    #[arg(long, value_name = "FILE.csv")]
    pub channel_trace: Option<PathBuf>,

    /// Whether the envelope is engaged, instead of what the scenario says. It is the last stage of every unit: stay able to
    /// stop behind the bound of the vehicle ahead. A corridor is always run without and with it; with this option its
    /// excerpts and figures are those with it
    #[arg(
        long,
        value_name = "on|off",
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = "on",
        hide_possible_values = true
    )]
    pub envelope: Option<Switch>,

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

    /// Write every tick: time, truth, estimate and its bound, age, mode, command, and whether the envelope changed the
    /// command
    #[arg(long, value_name = "FILE.csv")]
    pub trace: Option<PathBuf>,

    /// Write the trajectories of all vehicles: truth, estimate and bound, age, mode, as a table (.csv) or as the FCD of SUMO (.xml). Of
    /// a corridor, those of the first seed as the scenario says
    #[arg(long, value_name = "FILE")]
    pub trajectories: Option<PathBuf>,

    /// Time from one row of a vehicle to the next
    #[arg(
        long,
        value_name = "SECONDS",
        requires = "trajectories",
        default_value = "0.1",
        allow_negative_numbers = true
    )]
    pub trajectories_every: f64,
    /// Write every tick of every vehicle for Foxglove and other readers of MCAP, as JSON channels. Of a corridor, those of the first seed
    /// as the scenario says
    #[arg(long, value_name = "FILE.mcap")]
    pub mcap: Option<PathBuf>,

    /// Write the frames on one vehicle's bus as a candump log. Of a corridor, that of the first seed as the scenario says
    #[arg(long, value_name = "FILE")]
    pub candump: Option<PathBuf>,

    /// The vehicle of that bus; by default the ego. In a corridor vehicles are counted from 0 by their arrival
    #[arg(long, value_name = "INDEX", requires = "candump", allow_negative_numbers = true)]
    pub candump_vehicle: Option<usize>,
}

/// Examples and further notes.
pub const AFTER_HELP: &str = "\
Examples:
  holdover-sim                           the paper's scenario
  holdover-sim --seed 3 --json           with other random numbers, as JSON
  holdover-sim run city.toml --out city  your scenario, its report in city/
  holdover-sim run --list                the scenarios that come with it
  holdover-sim run --show paper >my.toml one of them, to be changed
  holdover-sim run city.toml --set channel.loss=0.4 --set ego=2
                                         yours with two other values
  holdover-sim run corridor --seeds 10   four intersections, ten seeds
  holdover-sim --leader-motion drive.csv --channel-trace link.csv
                                         your recordings of a drive and a link
  holdover-sim --envelope=off --range-sensors off
                                         by messages alone, as in the paper
  holdover-sim run corridor --no-report --candump ego.log
                                         the frames on the ego's bus
  holdover-sim evaluate --help           measure the estimate on recordings

Output:
  Results go to stdout, as a table or with --json as one JSON value; progress
  goes to stderr. The report is one HTML file in the folder of --out. Equal
  seeds give equal bytes, but for what stands under \"timing\". Files are written
  whole or not at all. Of a run of more than 60,000 ticks figures over time and
  percentiles are of evenly chosen ones, and all other figures of every tick.

Exit codes:
  0  the verdict is: passed
  1  the verdict is: failed
  2  bad input; one line on stderr names file, line, cause and remedy
  3  inconclusive: this program itself was late";
