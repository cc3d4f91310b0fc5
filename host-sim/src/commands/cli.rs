//! The command line as it is typed: arguments enter, raw values leave. [`crate::commands::options`] interprets and
//! checks them.

use crate::commands::braking::{self, arguments::BrakingArguments};
use crate::commands::check::{self, arguments::CheckArguments};
use crate::commands::dbc::{self, arguments::DbcArguments};
use crate::commands::ecu::{self, arguments::EcuArguments};
use crate::commands::envelope_cost::{self, arguments::EnvelopeCostArguments};
use crate::commands::evaluate::{self, arguments::EvaluateArguments};
use crate::commands::gains::{self, arguments::GainsArguments};
use crate::commands::hil::{self, arguments::HilArguments};
use crate::commands::live::{self, arguments::LiveArguments};
use crate::commands::manual::{self, CompletionsArguments, ManArguments};
use crate::commands::motions::{self, arguments::MotionsArguments};
use crate::commands::record::{self, arguments::RecordArguments};
use crate::commands::replay::{self, arguments::ReplayArguments};
use crate::commands::run::arguments::{AFTER_HELP, RunArguments, RunSettings};
use crate::commands::string::{self, arguments::StringArguments};
use crate::commands::sweep::{self, arguments::SweepArguments};
use crate::provenance::VERSION;
use clap::{Parser, Subcommand};

/// Drives simulated vehicles, each with the onboard unit's own code, over an impaired V2X channel.
///
/// Without a command, `run` is executed. Without a scenario, `run` takes that of the paper: five vehicles, the third of
/// them (the ego) on a channel with delay, loss and a silence of four seconds. It prints the error of the ego's
/// position as its follower's unit estimates it, beside that of the literal paper's method on the same messages. It
/// writes a report with plots.
#[derive(Clone, Debug, Parser)]
#[command(name = "holdover-sim", version = VERSION, args_conflicts_with_subcommands = true, after_help = AFTER_HELP)]
pub struct Cli {
    /// The command; `run` if none is given.
    #[command(subcommand)]
    pub command: Option<Command>,
    /// The settings of `run`, which may be given without the command.
    #[command(flatten)]
    pub run: RunSettings,
}

/// The commands.
#[derive(Clone, Debug, Subcommand)]
pub enum Command {
    /// Run a scenario and report on it
    #[command(after_help = AFTER_HELP)]
    Run(RunArguments),
    /// See a scenario in the browser and take part: drive, break the links, go back in time
    #[command(after_help = live::arguments::AFTER_HELP)]
    Live(LiveArguments),
    /// Measure the estimate of a recorded vehicle over a recorded link, or in silences
    #[command(after_help = evaluate::arguments::AFTER_HELP)]
    Evaluate(EvaluateArguments),
    /// Tell what recordings say that no vehicle and no link does
    #[command(after_help = check::arguments::AFTER_HELP)]
    Check(CheckArguments),
    /// Run a scenario at several prediction steps with many seeds, on all cores
    #[command(after_help = sweep::arguments::AFTER_HELP)]
    Sweep(SweepArguments),
    /// Measure the cost of the envelope: runs without and with it over silences of several lengths, on all cores
    #[command(alias = "price", after_help = envelope_cost::arguments::AFTER_HELP)]
    EnvelopeCost(EnvelopeCostArguments),
    /// Make the tables of gains that the core ships, eq. 6, and prove every cell of them
    #[command(after_help = gains::arguments::AFTER_HELP)]
    Gains(GainsArguments),
    /// Measure how a string of ten vehicles damps a disturbance by its leader, over delays and losses, on all cores
    #[command(after_help = string::arguments::AFTER_HELP)]
    String(StringArguments),
    /// Measure how a string of ten comes to rest behind a leader that brakes in a silence, on all cores
    #[command(after_help = braking::arguments::AFTER_HELP)]
    Braking(BrakingArguments),
    /// Measure the estimate of a target in a silence over five motions, beside seven other methods, on all cores
    #[command(after_help = motions::arguments::AFTER_HELP)]
    Motions(MotionsArguments),
    /// Give a unit the frames of a recorded CAN bus and print what it sends, or put these frames on a bus
    #[command(after_help = replay::arguments::AFTER_HELP)]
    Replay(ReplayArguments),
    /// Record the frames on a CAN interface
    #[command(after_help = record::arguments::AFTER_HELP)]
    Record(RecordArguments),
    /// Print the message catalogue as a DBC file
    #[command(after_help = dbc::arguments::AFTER_HELP)]
    Dbc(DbcArguments),
    /// Run an onboard unit on a CAN interface
    #[command(after_help = ecu::arguments::AFTER_HELP)]
    Ecu(EcuArguments),
    /// Run an onboard unit on a CAN interface through a scenario, and judge it
    #[command(after_help = hil::arguments::AFTER_HELP)]
    Hil(HilArguments),
    /// Print the completions of this command line for a shell
    #[command(after_help = manual::COMPLETIONS_AFTER_HELP)]
    Completions(CompletionsArguments),
    /// Write the manual pages
    #[command(after_help = manual::MAN_AFTER_HELP)]
    Man(ManArguments),
}
