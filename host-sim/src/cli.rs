//! The command line as it is typed: arguments enter, raw values leave. What they mean and whether they can be is
//! decided in [`crate::options`].

use crate::capture::{self, arguments::CaptureArguments};
use crate::ecu::{self, arguments::EcuArguments};
use crate::evaluate::{self, arguments::EvaluateArguments};
use crate::gains::{self, arguments::GainsArguments};
use crate::hil::{self, arguments::HilArguments};
use crate::motions::{self, arguments::MotionsArguments};
use crate::price::{self, arguments::PriceArguments};
use crate::replay::{self, arguments::ReplayArguments};
use crate::string::{self, arguments::StringArguments};
use crate::sweep::{self, arguments::SweepArguments};
use clap::{Args, Parser, Subcommand};
use std::path::PathBuf;

/// Drives simulated vehicles, each with the onboard unit's own code, over an impaired V2X channel.
///
/// Without a command it does `run`, and without a scenario that is the paper's: five vehicles, the third of them (the
/// ego) on a channel with delay, loss and a silence of four seconds. It prints how far from the truth the ego's
/// follower believes the ego to be, beside what the literal paper makes of the same messages, and writes a report with
/// plots.
#[derive(Clone, Debug, Parser)]
#[command(name = "holdover-sim", version, args_conflicts_with_subcommands = true, after_help = AFTER_HELP)]
pub struct Cli {
    /// What to do; `run` if nothing is said.
    #[command(subcommand)]
    pub command: Option<Command>,
    /// The settings of `run`, which may stand without the command.
    #[command(flatten)]
    pub run: RunSettings,
}

/// The commands.
#[derive(Clone, Debug, Subcommand)]
pub enum Command {
    /// Run a scenario and report on it
    #[command(after_help = AFTER_HELP)]
    Run(RunArguments),
    /// Measure the estimate of a recorded vehicle over a recorded link, or in silences
    #[command(after_help = evaluate::arguments::AFTER_HELP)]
    Evaluate(EvaluateArguments),
    /// Run a scenario at several prediction steps with many seeds, on all cores
    #[command(after_help = sweep::arguments::AFTER_HELP)]
    Sweep(SweepArguments),
    /// Measure what the envelope costs: runs without and with it over silences of several lengths, on all cores
    #[command(after_help = price::arguments::AFTER_HELP)]
    Price(PriceArguments),
    /// Make the table of gains that the core ships, eq. 6, and prove every cell of it
    #[command(after_help = gains::arguments::AFTER_HELP)]
    Gains(GainsArguments),
    /// Measure how a string of ten vehicles damps what its leader does, over delays and losses, on all cores
    #[command(after_help = string::arguments::AFTER_HELP)]
    String(StringArguments),
    /// Measure the estimate of a target in a silence over five motions, beside seven other methods, on all cores
    #[command(after_help = motions::arguments::AFTER_HELP)]
    Motions(MotionsArguments),
    /// Give a unit the traffic of a recorded CAN bus and print what it sends, or put that traffic on a bus
    #[command(after_help = replay::arguments::AFTER_HELP)]
    Replay(ReplayArguments),
    /// Record the traffic of a CAN interface
    #[command(after_help = capture::arguments::AFTER_HELP)]
    Record(CaptureArguments),
    /// Be an onboard unit on a CAN interface
    #[command(after_help = ecu::arguments::AFTER_HELP)]
    Ecu(EcuArguments),
    /// Drive an onboard unit on a CAN interface through a scenario, and judge it
    #[command(after_help = hil::arguments::AFTER_HELP)]
    Hil(HilArguments),
}

/// What can follow `run`.
#[derive(Clone, Debug, Default, Args)]
pub struct RunArguments {
    /// The scenario, a file or one of `--list`; the paper's if none is given (scenarios/paper.toml explains it)
    #[arg(value_name = "SCENARIO")]
    pub scenario: Option<PathBuf>,
    /// The rest.
    #[command(flatten)]
    pub settings: RunSettings,
}

/// The options of `run`.
#[derive(Clone, Debug, Default, Args)]
pub struct RunSettings {
    /// Seed of everything random, instead of the scenario's
    #[arg(long, value_name = "N")]
    pub seed: Option<u64>,

    /// So many seeds, from `--seed` on, on all cores; for a corridor
    #[arg(long, value_name = "N")]
    pub seeds: Option<u64>,

    /// List the scenarios that come with the program
    #[arg(long)]
    pub list: bool,

    /// Measure how fast so many vehicles at once are simulated, in corridors side by side; for a corridor. A report says it of
    /// 10,30,100,300
    #[arg(long, value_name = "N,…", value_delimiter = ',')]
    pub vehicles: Option<Vec<usize>>,

    /// More traffic: so many vehicles a minute in all, each with the envelope and without it, by the scenario's link and by a
    /// perfect one, instead of everything else; for a corridor
    #[arg(long, value_name = "N,…", value_delimiter = ',')]
    pub demand: Option<Vec<f64>>,

    /// How many peers every unit has slots for, instead of the scenario's; several numbers with `--demand`; for a corridor
    #[arg(long, value_name = "N,…", value_delimiter = ',')]
    pub slots: Option<Vec<usize>>,

    /// Draw a one-page picture, for a corridor: trajectories, errors, and ours beside seven other methods
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

    /// Engage the envelope, every unit's last gate: stay able to stop behind what is certain of the vehicle ahead.
    /// The sides of a corridor are without and with it in any case; its excerpts and figures are then with it
    #[arg(long)]
    pub envelope: bool,

    /// Print the results as one JSON value on stdout
    #[arg(long)]
    pub json: bool,

    /// Folder for the HTML report; it is created
    #[arg(long, value_name = "DIR", default_value = "holdover-report")]
    pub out: PathBuf,

    /// Write no report
    #[arg(long, conflicts_with = "out")]
    pub no_report: bool,

    /// Write every tick: time, truth, estimate and its bound, age, mode, command and whether the envelope changed it
    #[arg(long, value_name = "FILE.csv")]
    pub trace: Option<PathBuf>,

    /// Write the traffic on one vehicle's bus as a candump log
    #[arg(long, value_name = "FILE")]
    pub candump: Option<PathBuf>,

    /// Whose bus that is; the ego's unless given
    #[arg(long, value_name = "INDEX", requires = "candump")]
    pub candump_vehicle: Option<usize>,
}

const AFTER_HELP: &str = "\
Examples:
  holdover-sim                           the paper's scenario
  holdover-sim --seed 3 --json           with other random numbers, as JSON
  holdover-sim run city.toml --out city  your scenario, its report in city/
  holdover-sim run --list                the scenarios that come with it
  holdover-sim run corridor --seeds 10   four intersections, ten seeds
  holdover-sim --leader-motion drive.csv --channel-trace link.csv
                                         your recordings of a drive and a link
  holdover-sim --envelope                with every unit's last gate engaged
  holdover-sim evaluate --help           measure the estimate on recordings

Output:
  Results go to stdout, as a table or with --json as one JSON value; progress
  goes to stderr. The report is one HTML file in the folder of --out. Equal
  seeds give equal bytes, but for what stands under \"timing\".

Exit codes:
  0  the verdict is: passed
  1  the verdict is: failed
  2  bad input; one line on stderr names file, line, cause and remedy
  3  inconclusive: this program itself was late";
