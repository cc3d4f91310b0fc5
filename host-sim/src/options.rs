//! The command line as it is meant: raw values enter; options that have been checked, with every input file read, or
//! an error leave. After this only writing can fail.

use crate::capture::CaptureOptions;
use crate::cli::{Cli, Command, RunArguments};
use crate::corridor::options::CorridorOptions;
use crate::ecu::options::EcuOptions;
use crate::error::{Error, quoted};
use crate::evaluate::options::EvaluateOptions;
use crate::gains::GainsOptions;
use crate::hil::options::HilOptions;
use crate::library;
use crate::motions::options::MotionsOptions;
use crate::price::options::PriceOptions;
use crate::replay::options::ReplayOptions;
use crate::scenario::{Overrides, Scenario};
use crate::string::options::StringOptions;
use crate::sweep::options::SweepOptions;
use std::path::{Path, PathBuf};

/// What to do.
#[derive(Clone, Debug)]
pub enum Options {
    /// Run a string of vehicles.
    Run(RunOptions),
    /// Run a corridor.
    Corridor(CorridorOptions),
    /// List the scenarios that come with the program.
    List,
    /// Measure the estimate of a recorded vehicle.
    Evaluate(EvaluateOptions),
    /// Run a scenario at several steps with many seeds.
    Sweep(SweepOptions),
    /// Measure what the envelope costs.
    Price(PriceOptions),
    /// Make and prove the table of gains.
    Gains(GainsOptions),
    /// Measure string stability.
    String(StringOptions),
    /// Measure the estimate over target motions.
    Motions(MotionsOptions),
    /// Replay a log.
    Replay(ReplayOptions),
    /// Record an interface.
    Record(CaptureOptions),
    /// Be a unit.
    Ecu(EcuOptions),
    /// Judge one.
    Hil(Box<HilOptions>),
}

/// A run and what becomes of its results.
#[derive(Clone, Debug, PartialEq)]
pub struct RunOptions {
    /// The scenario, with what the command line says instead of its file.
    pub scenario: Scenario,
    /// The file that it came from; `None`: it is the paper's.
    pub scenario_file: Option<PathBuf>,
    /// What else the command line says of the scenario, as it would have to be typed again.
    pub arguments: Vec<String>,
    /// Results as JSON.
    pub json: bool,
    /// Folder of the report; `None`: no report.
    pub report: Option<PathBuf>,
    /// Where to write every tick.
    pub trace: Option<PathBuf>,
    /// Which bus to record.
    pub candump: Option<Candump>,
}

/// A bus to be recorded.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Candump {
    /// The log.
    pub file: PathBuf,
    /// Index of the vehicle whose bus it is.
    pub vehicle: usize,
}

impl Options {
    /// Reads what the command line names and checks it.
    ///
    /// # Errors
    /// Whatever makes the input unusable, and places for output that cannot be written.
    pub fn read(cli: Cli) -> Result<Self, Error> {
        match cli.command {
            Some(Command::Run(arguments)) => Self::of_run(arguments),
            Some(Command::Evaluate(arguments)) => EvaluateOptions::read(arguments).map(Self::Evaluate),
            Some(Command::Sweep(arguments)) => SweepOptions::read(arguments).map(Self::Sweep),
            Some(Command::Price(arguments)) => PriceOptions::read(arguments).map(Self::Price),
            Some(Command::Gains(arguments)) => GainsOptions::read(arguments).map(Self::Gains),
            Some(Command::String(arguments)) => StringOptions::read(arguments).map(Self::String),
            Some(Command::Motions(arguments)) => MotionsOptions::read(arguments).map(Self::Motions),
            Some(Command::Replay(arguments)) => ReplayOptions::read(arguments).map(Self::Replay),
            Some(Command::Record(arguments)) => CaptureOptions::read(arguments).map(Self::Record),
            Some(Command::Ecu(arguments)) => EcuOptions::read(&arguments).map(Self::Ecu),
            Some(Command::Hil(arguments)) => HilOptions::read(arguments).map(Box::new).map(Self::Hil),
            None => Self::of_run(RunArguments { scenario: None, settings: cli.run }),
        }
    }

    fn of_run(arguments: RunArguments) -> Result<Self, Error> {
        if arguments.settings.list {
            return Ok(Self::List);
        }
        let Some(named) = &arguments.scenario else { return RunOptions::read(arguments).map(Self::Run) };
        let (file, text) = library::text(named)?;
        match library::kind(&file, &text)? {
            library::Kind::String => RunOptions::read(arguments).map(Self::Run),
            library::Kind::Corridor => {
                CorridorOptions::read(named, &file, &text, arguments.settings).map(Self::Corridor)
            }
        }
    }
}

impl RunOptions {
    fn read(RunArguments { scenario: scenario_file, settings }: RunArguments) -> Result<Self, Error> {
        let foreign = [
            ("--seeds", settings.seeds.is_some()),
            ("--vehicles", settings.vehicles.is_some()),
            ("--demand", settings.demand.is_some()),
            ("--slots", settings.slots.is_some()),
            ("--picture", settings.picture.is_some()),
        ];
        if let Some((option, _)) = foreign.iter().find(|(_, is_given)| *is_given) {
            let remedy = "leave it out; `sweep` runs a string with many seeds";
            return Err(Error::new("is for a corridor, and this is a string of vehicles", remedy).in_option(option));
        }
        let overrides = Overrides {
            seed: settings.seed,
            step_s: settings.step,
            leader_motion: settings.leader_motion.clone(),
            channel_trace: settings.channel_trace.clone(),
            envelope: settings.envelope,
        };
        let arguments = typed(&overrides);
        let scenario = Scenario::read(scenario_file.as_deref(), &overrides)?;
        let vehicle = settings.candump_vehicle.unwrap_or(scenario.ego);
        let last = scenario.vehicles.len() - 1;
        if vehicle > last {
            let error = Error::new(format!("there is no vehicle {vehicle}"), format!("give an index from 0 to {last}"));
            return Err(error.in_option("--candump-vehicle"));
        }
        let report = (!settings.no_report).then_some(settings.out);
        if let Some(folder) = &report {
            can_be_folder(folder)?;
        }
        let inputs = [scenario_file.as_ref(), settings.leader_motion.as_ref(), settings.channel_trace.as_ref()];
        let outputs = [("--trace", settings.trace.as_deref()), ("--candump", settings.candump.as_deref())];
        let mut taken: Vec<&Path> = inputs.into_iter().flatten().map(PathBuf::as_path).collect();
        for (option, file) in outputs {
            if let Some(file) = file {
                can_be_file(option, file, &taken)?;
                taken.push(file);
            }
        }
        let candump = settings.candump.map(|file| Candump { file, vehicle });
        Ok(Self { scenario, scenario_file, arguments, json: settings.json, report, trace: settings.trace, candump })
    }
}

/// The options that change the scenario, but for the seed.
fn typed(overrides: &Overrides) -> Vec<String> {
    let file = |option: &str, file: &Option<PathBuf>| file.as_ref().map(|file| format!("{option} {}", file.display()));
    let step = overrides.step_s.map(|step_s| format!("--step {step_s}"));
    let motion = file("--leader-motion", &overrides.leader_motion);
    let trace = file("--channel-trace", &overrides.channel_trace);
    let envelope = overrides.envelope.then(|| "--envelope".to_owned());
    [step, motion, trace, envelope].into_iter().flatten().collect()
}

/// That the report's folder is not a file; missing folders are created when it is written.
///
/// # Errors
/// It is a file, or has no name.
pub fn can_be_folder(folder: &Path) -> Result<(), Error> {
    let cause = if folder.as_os_str().is_empty() {
        "is an empty name".to_owned()
    } else if folder.exists() && !folder.is_dir() {
        format!("{} is a file", quoted(&folder.to_string_lossy()))
    } else {
        return Ok(());
    };
    Err(Error::new(cause, "name a folder for the report, or give --no-report").in_option("--out"))
}

/// That a file can be written there, without losing an input or another output.
///
/// # Errors
/// It is a folder or in none, is taken, or has no name.
pub fn can_be_file(option: &str, file: &Path, taken: &[&Path]) -> Result<(), Error> {
    let name = quoted(&file.to_string_lossy());
    let (cause, remedy) = if file.as_os_str().is_empty() {
        ("is an empty name".to_owned(), "name a file")
    } else if file.is_dir() {
        (format!("{name} is a folder"), "name a file in it")
    } else {
        match resolved(file) {
            None => (format!("{name} is in a folder that does not exist"), "create the folder first"),
            Some(path) if taken.iter().any(|other| resolved(other).as_ref() == Some(&path)) => {
                (format!("{name} is also another file of this command"), "give each a name of its own")
            }
            Some(_) => return Ok(()),
        }
    };
    Err(Error::new(cause, remedy).in_option(option))
}

/// One path for all names of a file, which need not exist yet; `None` if its folder does not exist.
fn resolved(file: &Path) -> Option<PathBuf> {
    if let Ok(path) = file.canonicalize() {
        return Some(path);
    }
    let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    Some(folder.canonicalize().ok()?.join(file.file_name()?))
}
