//! The command line as it is meant: typed values enter; checked options leave, with every input file read, or an error.
//! After this only writing can fail.

use clap_complete::Shell;
use std::path::PathBuf;

use crate::commands::braking::options::BrakingOptions;
use crate::commands::check::CheckOptions;
use crate::commands::cli::{Cli, Command};
use crate::commands::corridor::options::CorridorOptions;
use crate::commands::dbc::DbcOptions;
use crate::commands::ecu::options::EcuOptions;
use crate::commands::ending::json;
use crate::commands::envelope_cost::options::EnvelopeCostOptions;
use crate::commands::evaluate::options::EvaluateOptions;
use crate::commands::gains::GainsOptions;
use crate::commands::hil::options::HilOptions;
use crate::commands::live::options::LiveOptions;
use crate::commands::motions::options::MotionsOptions;
use crate::commands::record::RecordOptions;
use crate::commands::replay::options::ReplayOptions;
use crate::commands::run::arguments::RunArguments;
use crate::commands::run::options::RunOptions;
use crate::commands::string::options::StringOptions;
use crate::commands::sweep::options::SweepOptions;
use crate::commands::{
    braking, check, corridor, dbc, ecu, envelope_cost, evaluate, gains, hil, live, manual, motions, record, replay,
    run, string, sweep,
};
use crate::error::Error;
use crate::input::library;
use crate::output;
use crate::verdict::Verdict;

/// A checked command.
#[derive(Clone, Debug)]
pub enum Options {
    /// Run a string of vehicles.
    Run(RunOptions),
    /// Run a corridor.
    Corridor(Box<CorridorOptions>),
    /// Show a string of vehicles in the browser.
    Live(Box<LiveOptions>),
    /// List the scenarios that come with the program, as JSON or not.
    List(bool),
    /// Print one of them.
    Show(&'static str),
    /// Measure the estimate of a recorded vehicle.
    Evaluate(EvaluateOptions),
    /// Check files.
    Check(CheckOptions),
    /// Run a scenario at several steps with many seeds.
    Sweep(SweepOptions),
    /// Measure the cost of the envelope.
    EnvelopeCost(EnvelopeCostOptions),
    /// Make and prove the tables of gains.
    Gains(GainsOptions),
    /// Measure string stability.
    String(StringOptions),
    /// Measure how a string brakes.
    Braking(BrakingOptions),
    /// Measure the estimate over target motions.
    Motions(MotionsOptions),
    /// Replay a log.
    Replay(ReplayOptions),
    /// Record a CAN interface.
    Record(RecordOptions),
    /// Print the catalogue.
    Dbc(DbcOptions),
    /// Run a unit on a CAN interface.
    Ecu(EcuOptions),
    /// Judge a unit on a CAN interface.
    Hil(Box<HilOptions>),
    /// Print the completions of a shell.
    Completions(Shell),
    /// Write the manual pages into a folder.
    Man(PathBuf),
}

impl Options {
    /// Reads and checks the command line.
    ///
    /// # Errors
    /// Unusable input, and output that cannot be written.
    pub fn read(cli: Cli) -> Result<Self, Error> {
        match cli.command {
            Some(Command::Run(arguments)) => Self::of_run(arguments),
            Some(Command::Live(arguments)) => LiveOptions::read(arguments).map(Box::new).map(Self::Live),
            Some(Command::Evaluate(arguments)) => EvaluateOptions::read(arguments).map(Self::Evaluate),
            Some(Command::Check(arguments)) => Ok(Self::Check(CheckOptions::read(arguments))),
            Some(Command::Sweep(arguments)) => SweepOptions::read(arguments).map(Self::Sweep),
            Some(Command::EnvelopeCost(arguments)) => EnvelopeCostOptions::read(arguments).map(Self::EnvelopeCost),
            Some(Command::Gains(arguments)) => GainsOptions::read(arguments).map(Self::Gains),
            Some(Command::String(arguments)) => StringOptions::read(arguments).map(Self::String),
            Some(Command::Braking(arguments)) => BrakingOptions::read(arguments).map(Self::Braking),
            Some(Command::Motions(arguments)) => MotionsOptions::read(arguments).map(Self::Motions),
            Some(Command::Replay(arguments)) => ReplayOptions::read(arguments).map(Self::Replay),
            Some(Command::Record(arguments)) => RecordOptions::read(arguments).map(Self::Record),
            Some(Command::Dbc(arguments)) => DbcOptions::read(&arguments).map(Self::Dbc),
            Some(Command::Ecu(arguments)) => EcuOptions::read(&arguments).map(Self::Ecu),
            Some(Command::Hil(arguments)) => HilOptions::read(arguments).map(Box::new).map(Self::Hil),
            Some(Command::Completions(arguments)) => Ok(Self::Completions(arguments.shell)),
            Some(Command::Man(arguments)) => Ok(Self::Man(arguments.folder)),
            None => Self::of_run(RunArguments { scenario: None, settings: cli.run }),
        }
    }

    fn of_run(arguments: RunArguments) -> Result<Self, Error> {
        if arguments.settings.list {
            return Ok(Self::List(arguments.settings.output.json));
        }
        if let Some(name) = &arguments.settings.show {
            return library::show(name).map(Self::Show);
        }
        let Some(named) = &arguments.scenario else { return RunOptions::read(arguments).map(Self::Run) };
        let (file, text) = library::text(named)?;
        match library::kind(&file, &text)? {
            library::Kind::String => RunOptions::read(arguments).map(Self::Run),
            library::Kind::Corridor => {
                CorridorOptions::read(named, &file, &text, arguments.settings).map(Box::new).map(Self::Corridor)
            }
        }
    }

    /// Executes the command.
    ///
    /// # Errors
    /// The errors of the command.
    pub fn run(&self) -> Result<Verdict, Error> {
        match self {
            Self::Run(options) => run::run(options),
            Self::Corridor(options) => corridor::run(options),
            Self::Live(options) => live::run(options),
            Self::List(true) => output::print(&format!("{}\n", json(&library::listed())?)).map(|()| Verdict::Pass),
            Self::List(false) => output::print(&library::list()).map(|()| Verdict::Pass),
            Self::Show(text) => output::print(text).map(|()| Verdict::Pass),
            Self::Evaluate(options) => evaluate::run(options),
            Self::Check(options) => check::run(options),
            Self::Sweep(options) => sweep::run(options),
            Self::Gains(options) => gains::run(options),
            Self::String(options) => string::run(options),
            Self::Braking(options) => braking::run(options),
            Self::Motions(options) => motions::run(options),
            Self::EnvelopeCost(options) => envelope_cost::run(options),
            Self::Replay(options) => replay::run(options),
            Self::Record(options) => record::run(options),
            Self::Dbc(options) => dbc::run(options),
            Self::Ecu(options) => ecu::run(options),
            Self::Hil(options) => hil::run(options),
            Self::Completions(shell) => manual::completions(*shell),
            Self::Man(folder) => manual::man(folder),
        }
    }
}
