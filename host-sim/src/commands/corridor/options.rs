//! The options of `run` for a corridor: typed values enter, checked options or an error leave.

use std::path::{Path, PathBuf};

use super::scale::VEHICLES;
use crate::commands::ending::Destination;
use crate::commands::run::arguments::RunSettings;
use crate::commands::run::candump::Candump;
use crate::error::Error;
use crate::input::scenario::{Overrides, Switch};
use crate::measure::trajectories::{self, Wanted};
use crate::places::can_be_file;
use crate::provenance::shell_word;
use crate::roads::description::Corridor;
use crate::roads::experiment::of_seed;
use crate::roads::read;
use crate::seeds;
use crate::sim::modem::PEERS;

/// The most vehicles at once. More would need gigabytes.
const MOST_VEHICLES: usize = 10_000;

/// A corridor, and where its results go.
#[derive(Clone, Debug, PartialEq)]
pub struct CorridorOptions {
    /// The corridor, with the values of the command line.
    pub corridor: Corridor,
    /// Its name in the report.
    pub name: String,
    /// Whether the excerpts and figures over time are with the envelope.
    pub excerpts_with_envelope: bool,
    /// The command line that repeats this run.
    pub command: String,
    /// The seeds, from the first on.
    pub seeds: Vec<u64>,
    /// Where its results go.
    pub destination: Destination,
    /// Numbers of vehicles at once for which the speed of the simulation is measured.
    pub vehicles: Vec<usize>,
    /// Traffic in vehicles a minute that is run instead of the scenario's; usually empty.
    pub demand: Vec<f64>,
    /// Numbers of slots for that traffic.
    pub slots: Vec<usize>,
    /// File for the one-page picture.
    pub picture: Option<PathBuf>,
    /// File for the trajectories of all vehicles, of the first seed.
    pub trajectories: Option<Wanted>,
    /// File of every vehicle's ticks, of the first seed.
    pub mcap: Option<PathBuf>,
    /// The bus to log, of the first seed; the vehicle is the index of its trip.
    pub candump: Option<Candump>,
}

impl CorridorOptions {
    /// Reads the corridor in the text of a file, which the user called `named`.
    ///
    /// # Errors
    /// An unusable scenario, options that are not for corridors, and output that cannot be written.
    pub fn read(named: &Path, file: &Path, text: &str, settings: RunSettings) -> Result<Self, Error> {
        let foreign = [
            ("--leader-motion", settings.leader_motion.is_some()),
            ("--channel-trace", settings.channel_trace.is_some()),
            ("--trace", settings.trace.is_some()),
        ];
        if let Some((option, _)) = foreign.iter().find(|(_, is_given)| *is_given) {
            return Err(
                Error::new("is for a string of vehicles, and this is a corridor", "leave it out").in_option(option)
            );
        }
        let overrides = Overrides {
            seed: settings.seed,
            step_s: settings.step,
            envelope: settings.envelope,
            range_sensors: settings.range_sensors,
            set: settings.set.clone(),
            ..Overrides::default()
        };
        let mut corridor = read::corridor(file, text, &overrides)?;
        let demand = settings.demand.clone().unwrap_or_default();
        let most = corridor.most_per_min();
        if let Some(beyond) = demand.iter().find(|per_min| !(**per_min > 0.0 && **per_min < most)) {
            let remedy = format!("give numbers above 0 and below {most:.0}");
            return Err(Error::new(format!("is {beyond}"), remedy).in_option("--demand"));
        }
        let slots = slots(settings.slots.clone(), &mut corridor, !demand.is_empty())?;
        let count = settings.seeds.unwrap_or(1);
        let seeds = seeds::checked(corridor.seed, count)?.collect();
        let candump = candump(&corridor, &settings)?;
        if settings.trajectories.is_some() && settings.demand.is_some() {
            return Err(of_other_traffic("--trajectories"));
        }
        if settings.mcap.is_some() && settings.demand.is_some() {
            return Err(of_other_traffic("--mcap"));
        }
        if !corridor.events.is_empty() && settings.demand.is_some() {
            let cause = "what [[event]] says befalls the scenario's own vehicles, and --demand runs other traffic";
            return Err(Error::new(cause, "leave one of the two out").in_option("--demand"));
        }
        let destination = settings.output.read()?.with_inputs([named])?;
        let mut taken = vec![named];
        let outputs = [("--picture", &settings.picture), ("--candump", &settings.candump), ("--mcap", &settings.mcap)];
        for (option, file) in outputs {
            if let Some(file) = file {
                can_be_file(option, file, &taken)?;
                taken.push(file);
            }
        }
        let trajectories = trajectories::wanted(settings.trajectories.as_deref(), settings.trajectories_every, &taken)?;
        let usual = if destination.report.is_some() { VEHICLES.to_vec() } else { Vec::new() };
        let is_given = settings.vehicles.is_some();
        let vehicles = settings.vehicles.unwrap_or(usual);
        if let Some(beyond) = vehicles.iter().find(|number| !(1..=MOST_VEHICLES).contains(*number)) {
            let remedy = format!("give numbers from 1 to {MOST_VEHICLES}");
            return Err(Error::new(format!("is {beyond}"), remedy).in_option("--vehicles"));
        }
        let mut command = format!("holdover-sim run {} --seed {}", named.display(), corridor.seed);
        if count > 1 {
            command += &format!(" --seeds {count}");
        }
        if let Some(step_s) = settings.step {
            command += &format!(" --step {step_s}");
        }
        if let Some(envelope) = settings.envelope {
            command += &format!(" --envelope={envelope}");
        }
        if let Some(sensors) = settings.range_sensors {
            command += &format!(" --range-sensors {sensors}");
        }
        command.extend(settings.set.iter().map(|set| format!(" --set {}", shell_word(set))));
        let listed = |numbers: Vec<String>| numbers.join(",");
        if !demand.is_empty() {
            command += &format!(" --demand {}", listed(demand.iter().map(f64::to_string).collect()));
        }
        if settings.slots.is_some() {
            command += &format!(" --slots {}", listed(slots.iter().map(usize::to_string).collect()));
        }
        if is_given {
            command += &format!(" --vehicles {}", listed(vehicles.iter().map(usize::to_string).collect()));
        }
        let name = named.file_stem().map_or("corridor".into(), |stem| stem.to_string_lossy().into_owned());
        Ok(Self {
            corridor,
            name,
            excerpts_with_envelope: settings.envelope.is_some_and(Switch::is_on),
            command,
            seeds,
            destination,
            vehicles,
            demand,
            slots,
            picture: settings.picture,
            trajectories,
            mcap: settings.mcap,
            candump,
        })
    }
}

/// The bus to log: that of the vehicle of the command line, or else the ego's.
fn candump(corridor: &Corridor, settings: &RunSettings) -> Result<Option<Candump>, Error> {
    let Some(file) = settings.candump.clone() else { return Ok(None) };
    if settings.demand.is_some() {
        return Err(of_other_traffic("--candump"));
    }
    let (trips, ego) = of_seed(corridor, corridor.seed);
    let Some(vehicle) = settings.candump_vehicle.or(ego) else {
        let error = Error::new("no vehicle of this seed is the ego", "name one by --candump-vehicle");
        return Err(error.in_option("--candump"));
    };
    exists("--candump-vehicle", vehicle, trips.len())?;
    Ok(Some(Candump { file, vehicle }))
}

fn of_other_traffic(option: &str) -> Error {
    let cause = "is for the scenario's own traffic, and --demand runs other traffic";
    Error::new(cause, "leave one of the two out").in_option(option)
}

/// Whether there is a vehicle of that index among so many.
///
/// # Errors
/// There is none.
pub fn exists(option: &str, vehicle: usize, vehicles: usize) -> Result<(), Error> {
    if vehicle < vehicles {
        return Ok(());
    }
    let remedy = match vehicles.checked_sub(1) {
        Some(last) => format!("give an index from 0 to {last}"),
        None => "let vehicles arrive".to_owned(),
    };
    Err(Error::new(format!("there is no vehicle {vehicle}"), remedy).in_option(option))
}

/// Numbers of slots: those of the command line, which then apply to the corridor; or else the corridor's.
fn slots(said: Option<Vec<usize>>, corridor: &mut Corridor, may_be_several: bool) -> Result<Vec<usize>, Error> {
    let slots = said.unwrap_or_else(|| vec![corridor.slots]);
    if let Some(beyond) = slots.iter().find(|slots| !(read::LEAST_SLOTS..=PEERS).contains(*slots)) {
        let remedy = format!("give from {} to {PEERS}", read::LEAST_SLOTS);
        return Err(Error::new(format!("is {beyond}"), remedy).in_option("--slots"));
    }
    if slots.len() > 1 && !may_be_several {
        return Err(Error::new("has several numbers", "give one, or `--demand` too").in_option("--slots"));
    }
    corridor.slots = slots.first().copied().unwrap_or(corridor.slots);
    Ok(slots)
}
