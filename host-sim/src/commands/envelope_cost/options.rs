//! The options of `envelope-cost`: typed values enter, a checked scenario for each silence leaves.

use std::path::PathBuf;

use super::arguments::EnvelopeCostArguments;
use crate::commands::ending::Destination;
use crate::error::Error;
use crate::input::impairment::{Impairment, Window};
use crate::input::scenario::{Overrides, Scenario};
use crate::seeds;

/// Default silences, in seconds.
const SILENCES_S: [f64; 4] = [1.0, 2.0, 4.0, 8.0];

/// Beginning of the silence if the scenario has no outage, in seconds.
const BEGINS_S: f64 = 4.0;

/// Least time of a run after the longest silence, in seconds: time to catch up again.
const AFTERWARDS_S: f64 = 30.0;

/// The measurement, and where its results go.
#[derive(Clone, Debug, PartialEq)]
pub struct EnvelopeCostOptions {
    /// Each silence in seconds with its scenario; a recorded channel is one scenario without a length.
    pub scenarios: Vec<(Option<f64>, Scenario)>,
    /// The scenario file; `None`: the paper's scenario.
    pub scenario_file: Option<PathBuf>,
    /// The other arguments about the scenario, as they would be typed again.
    pub arguments: Vec<String>,
    /// The first seed.
    pub seed: u64,
    /// Number of seeds; at least 1.
    pub seeds: u64,
    /// The distance for which the travel time is measured, in metres.
    pub distance_m: f64,
    /// Where its results go.
    pub destination: Destination,
}

impl EnvelopeCostOptions {
    /// Reads and checks the arguments.
    ///
    /// # Errors
    /// Impossible values, an unusable scenario, and a folder that cannot be written.
    pub fn read(arguments: EnvelopeCostArguments) -> Result<Self, Error> {
        let words = typed(&arguments);
        let EnvelopeCostArguments { scenario: scenario_file, silences, seeds, seed, distance, strict, output, .. } =
            arguments;
        let overrides = Overrides {
            seed,
            leader_motion: arguments.leader_motion,
            channel_trace: arguments.channel_trace,
            range_sensors: arguments.range_sensors,
            ..Overrides::default()
        };
        let scenario = Scenario::read(scenario_file.as_deref(), &overrides)?;
        let scenarios = scenarios(&scenario, silences)?;
        seeds::checked(scenario.seed, seeds)?;
        if !(1.0..=1e6).contains(&distance) {
            let error = Error::new(format!("is {distance}"), "give metres from 1 to 1000000");
            return Err(error.in_option("--distance"));
        }
        let destination = output.read()?;
        let destination = destination.with_inputs(scenario_file.as_deref().into_iter().chain(scenario.recordings()))?;
        let destination = destination.with_findings(scenario.findings(), strict)?;
        Ok(Self {
            scenarios,
            scenario_file,
            arguments: words,
            seed: scenario.seed,
            seeds,
            distance_m: distance,
            destination,
        })
    }
}

fn scenarios(scenario: &Scenario, silences: Option<Vec<f64>>) -> Result<Vec<(Option<f64>, Scenario)>, Error> {
    let Impairment::Random { outages, .. } = &scenario.channel.impairment else {
        return match silences {
            None => Ok(vec![(None, scenario.clone())]),
            Some(_) => {
                let cause = "a recorded channel has the silences that it has";
                Err(Error::new(cause, "leave out --silences, or the recording").in_option("--silences"))
            }
        };
    };
    let begins_s = outages.iter().map(|outage| outage.from_s).reduce(f64::min).unwrap_or(BEGINS_S);
    let silences = silences.unwrap_or(SILENCES_S.to_vec());
    let longest_s = silences.iter().copied().filter(|length_s| length_s.is_finite()).fold(0.0, f64::max);
    let with = |length_s: f64| {
        if !(0.1..=600.0).contains(&length_s) {
            let error = Error::new(format!("has a length of {length_s} s"), "give seconds from 0.1 to 600");
            return Err(error.in_option("--silences"));
        }
        let outage = Window { from_s: begins_s, to_s: begins_s + length_s };
        // The same length for all silences, so that fractions of time can be compared.
        Ok((Some(length_s), silent(scenario, outage, begins_s + longest_s + AFTERWARDS_S)?))
    };
    silences.into_iter().map(with).collect()
}

/// The scenario with one outage instead of its own, at least until `end_s`.
fn silent(scenario: &Scenario, outage: Window, end_s: f64) -> Result<Scenario, Error> {
    let mut scenario = scenario.clone();
    match &scenario.leader.motion {
        None => scenario.duration_s = scenario.duration_s.max(end_s),
        Some(motion) if outage.to_s > motion.duration_s() => {
            let cause = format!("the silence ends at {} s, after the recorded motion", outage.to_s);
            return Err(Error::new(cause, "give shorter ones, or a longer recording").in_option("--silences"));
        }
        Some(_) => {}
    }
    if let Impairment::Random { outages, .. } = &mut scenario.channel.impairment {
        *outages = vec![outage];
    }
    Ok(scenario)
}

/// The options except the seeds, as they would be typed again.
fn typed(arguments: &EnvelopeCostArguments) -> Vec<String> {
    let file = |option: &str, file: &Option<PathBuf>| file.as_ref().map(|file| format!("{option} {}", file.display()));
    let silences = arguments.silences.as_ref().map(|lengths| {
        let lengths: Vec<String> = lengths.iter().map(f64::to_string).collect();
        format!("--silences {}", lengths.join(","))
    });
    let motion = file("--leader-motion", &arguments.leader_motion);
    let trace = file("--channel-trace", &arguments.channel_trace);
    let distance = Some(format!("--distance {}", arguments.distance));
    let sensors = arguments.range_sensors.map(|switch| format!("--range-sensors {switch}"));
    [silences, distance, motion, trace, sensors].into_iter().flatten().collect()
}
