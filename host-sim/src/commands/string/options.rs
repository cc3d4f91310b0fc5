//! The options of `string`: typed values enter, checked ones leave.

use holdover::parameters;

use super::arguments::StringArguments;
use super::disturbance::Disturbance;
use super::mixture::Mixture;
use crate::commands::ending::Destination;
use crate::error::Error;
use crate::input::kind::Kind;
use crate::input::scenario::SensorShare;
use crate::seeds;

/// Default number of seeds of a step, whose result depends on chance.
const STEP_SEEDS: u64 = 40;
/// Default number of seeds of a sine; over whole periods chance averages out.
const SINE_SEEDS: u64 = 1;

/// The measurement, and where its results go.
#[derive(Clone, Debug, PartialEq)]
pub struct StringOptions {
    /// Time gaps, in seconds; at least one.
    pub time_gaps_s: Vec<f64>,
    /// Delays of every message, in seconds; at least one.
    pub delays_s: Vec<f64>,
    /// Fractions of messages lost; at least one.
    pub losses: Vec<f64>,
    /// The disturbances by the leader.
    pub disturbances: Vec<Disturbance>,
    /// The share of the followers that have a range sensor.
    pub range_sensors: SensorShare,
    /// The kinds of the followers, each in turn; at least one.
    pub kinds: Vec<Kind>,
    /// Who drives the followers.
    pub mixture: Mixture,
    /// The first seed of the losses.
    pub seed: u64,
    /// Number of seeds, if it is given: from 1 to [`seeds::MOST`].
    pub seeds: Option<u64>,
    /// Where its results go.
    pub destination: Destination,
}

impl StringOptions {
    /// Checks the arguments.
    ///
    /// # Errors
    /// Impossible values, and a folder that cannot be written.
    pub fn read(arguments: StringArguments) -> Result<Self, Error> {
        let StringArguments {
            time_gaps,
            delays,
            losses,
            frequencies,
            step_only,
            range_sensors,
            kinds,
            people,
            unequipped,
            seed,
            seeds,
            output,
        } = arguments;
        let time_gaps = if time_gaps.is_empty() { vec![shipped_time_gap_s(range_sensors)] } else { time_gaps };
        within("--time-gaps", &time_gaps, "seconds", (0.1, 3.995))?;
        within("--delays", &delays, "seconds", (0.0, 1.0))?;
        within("--losses", &losses, "shares", (0.0, 0.9))?;
        within("--frequencies", &frequencies, "Hz", (0.02, 2.0))?;
        let mixture = Mixture::checked(people, unequipped, range_sensors)?;
        seeds::checked(seed, seeds.unwrap_or(STEP_SEEDS))?;
        let destination = output.read()?;
        let sines = frequencies.into_iter().filter(|_| !step_only).map(Disturbance::Sine);
        let disturbances = std::iter::once(Disturbance::Step).chain(sines).collect();
        Ok(Self {
            time_gaps_s: time_gaps,
            delays_s: delays,
            losses,
            disturbances,
            range_sensors,
            kinds,
            mixture,
            seed,
            seeds,
            destination,
        })
    }

    /// Number of seeds of a disturbance at a loss. Only losses are random, so without a loss one seed is enough.
    #[must_use]
    pub fn seeds_of(&self, disturbance: Disturbance, loss: f64) -> u64 {
        let usual = if disturbance == Disturbance::Step { STEP_SEEDS } else { SINE_SEEDS };
        if loss > 0.0 { self.seeds.unwrap_or(usual) } else { 1 }
    }

    /// Whether every follower is a car.
    #[must_use]
    pub fn has_cars_alone(&self) -> bool {
        self.kinds.iter().all(|kind| *kind == Kind::Car)
    }

    /// The command that repeats this.
    #[must_use]
    pub fn command(&self) -> String {
        let list = |values: &[f64]| values.iter().map(f64::to_string).collect::<Vec<_>>().join(",");
        let frequencies: Vec<f64> =
            self.disturbances.iter().filter_map(|disturbance| disturbance.frequency_hz()).collect();
        let sines =
            if frequencies.is_empty() { "--step-only".into() } else { format!("--frequencies {}", list(&frequencies)) };
        let kinds: Vec<&str> = self.kinds.iter().map(|kind| kind.name()).collect();
        let kinds = if self.has_cars_alone() { String::new() } else { format!(" --kinds {}", kinds.join(",")) };
        let seeds = self.seeds.map_or(String::new(), |seeds| format!(" --seeds {seeds}"));
        format!(
            "holdover-sim string --time-gaps {} --delays {} --losses {} {sines} --range-sensors {}{kinds}{} --seed {}{seeds}",
            list(&self.time_gaps_s),
            list(&self.delays_s),
            list(&self.losses),
            self.range_sensors,
            self.mixture.command(),
            self.seed
        )
    }
}

/// The time gap that is shipped where every vehicle has a range sensor, and where some have none.
#[must_use]
pub fn shipped_time_gap_s(sensors: SensorShare) -> f64 {
    let time_gap = if sensors.is_all() { parameters::TIME_GAP_WITH_SENSOR } else { parameters::TIME_GAP };
    f64::from(time_gap.to_millis()) / 1e3
}

/// Refuses the first value outside the limits.
///
/// # Errors
/// That value, with the limits.
pub fn within(option: &str, values: &[f64], unit: &str, (low, high): (f64, f64)) -> Result<(), Error> {
    let remedy = format!("give {unit} from {low} to {high}");
    match values.iter().find(|value| !(low..=high).contains(*value)) {
        Some(value) => Err(Error::new(format!("is {value}"), remedy).in_option(option)),
        None => Ok(()),
    }
}
