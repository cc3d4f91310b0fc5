//! The runs on a corridor: a description and seeds enter; the runs of every seed under every condition leave. The runs
//! are parallel, and their order does not depend on the number of threads.

use std::io;

use holdover::coordination::Itinerary;

use super::beliefs::Beliefs;
use super::conditions::{Conditions, Heeds, WhenLost};
use super::description::{Corridor, Wrong};
use super::entries::Entries;
use super::figures::{Outcome, Side, StepRow, WrongRow};
use super::journal::Journal;
use super::map::itineraries;
use super::network::Network;
use super::referee::Referee;
use super::traffic::Traffic;
use super::trips::{Trip, trips};
use super::watch::Watch;
use crate::error::Error;
use crate::input::scenario::Envelope;
use crate::parallel;
use crate::sim::sensors::faults::is_fitted;

/// The prediction steps of the study over `δt`.
pub const STEPS_S: [f64; 7] = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0];

/// The studies over `δt` and over the differences use this many seconds of arrivals, of the first seed.
pub const EXCERPT_S: f64 = 180.0;

/// The figures of all seeds, beside the references. Each side keeps its meaning, whether or not the scenario engages
/// the envelope.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Sides {
    /// The scenario, without the envelope.
    pub holdover: Side,
    /// The same with links without delay, loss and silence.
    pub perfect_link: Side,
    /// The same with vehicles that drive alone while the link to the vehicle just ahead is lost.
    pub alone: Side,
    /// The scenario, with the envelope.
    pub envelope: Side,
    /// The same with links without delay, loss and silence.
    pub envelope_perfect_link: Side,
    /// The scenario, with the envelope and with vehicles that make emergency stops or have a fault.
    pub emergencies: Side,
}

impl Sides {
    /// Number of sides.
    pub const COUNT: usize = 6;

    /// All of them, in their order.
    #[must_use]
    pub fn all(&self) -> [&Side; Self::COUNT] {
        [
            &self.holdover,
            &self.perfect_link,
            &self.alone,
            &self.envelope,
            &self.envelope_perfect_link,
            &self.emergencies,
        ]
    }
}

/// A corridor with its map.
pub struct Experiment {
    /// The description.
    pub corridor: Corridor,
    /// Its roads.
    pub network: Network,
    /// For each road, the way through its intersections, as the units have it.
    pub itineraries: Vec<&'static Itinerary>,
}

impl Experiment {
    /// The experiment on a checked description.
    #[must_use]
    pub fn new(corridor: Corridor) -> Self {
        let network = Network::of(&corridor);
        let itineraries = itineraries(&network);
        Self { corridor, network, itineraries }
    }

    /// The trips of a seed, and the index of the ego's trip.
    #[must_use]
    pub fn trips(&self, seed: u64) -> (Vec<Trip>, Option<usize>) {
        with_ego(&self.corridor, &self.network, seed)
    }

    /// Number of vehicles of a seed that have a range sensor.
    #[must_use]
    pub fn fitted(&self, seed: u64) -> usize {
        let is_fitted = |trip: &usize| is_fitted(self.corridor.sensors.share, seed, *trip as u32);
        (0..self.trips(seed).0.len()).filter(is_fitted).count()
    }

    /// One run.
    ///
    /// # Errors
    /// A scenario that the units refuse.
    pub fn run(&self, seed: u64, conditions: Conditions, journal: Option<&mut Journal>) -> Result<Outcome, Error> {
        self.run_before(seed, conditions, journal, &mut [])
    }

    /// The same before the eyes of further observers.
    ///
    /// # Errors
    /// As for [`run`](Self::run).
    pub fn run_before(
        &self,
        seed: u64,
        conditions: Conditions,
        journal: Option<&mut Journal>,
        others: &mut [&mut dyn Watch],
    ) -> Result<Outcome, Error> {
        let (trips, _) = self.trips(seed);
        let logged = journal.as_ref().and_then(|journal| journal.ego);
        let (mut referee, mut beliefs) = (Referee::new(&self.network, &trips), Beliefs::new(&self.network, logged));
        let mut entries = Entries::new(&self.network);
        let mut traffic = Traffic::new(&self.corridor, &self.network, &self.itineraries, &trips, conditions, seed);
        traffic.log(logged);
        let mut watches: Vec<&mut dyn Watch> = vec![&mut referee, &mut beliefs, &mut entries];
        for other in others {
            watches.push(&mut **other);
        }
        let mut log = Vec::new();
        let remains = match journal {
            Some(journal) => {
                watches.push(journal);
                let remains = traffic.run(&mut watches, &mut log).map_err(refused)?;
                journal.log = log;
                journal.errors.clone_from(&beliefs.watched);
                remains
            }
            None => traffic.run(&mut watches, &mut log).map_err(refused)?,
        };
        Ok(Outcome::of(seed, &referee, &beliefs, entries.errors, remains))
    }

    /// The runs of all seeds, beside the references. `done` is called after each run.
    ///
    /// # Errors
    /// As for [`run`](Self::run).
    pub fn sides(&self, seeds: &[u64], done: impl Fn() + Sync) -> Result<Sides, Error> {
        let conditions = of_sides(&self.corridor);
        let jobs: Vec<(u64, Conditions)> =
            seeds.iter().flat_map(|seed| conditions.map(|conditions| (*seed, conditions))).collect();
        let outcomes = self.all(&jobs, done)?;
        let side = |which: usize| Side::of(&outcomes.iter().skip(which).step_by(conditions.len()).collect::<Vec<_>>());
        let [holdover, perfect_link, alone, envelope, envelope_perfect_link, emergencies] =
            [0, 1, 2, 3, 4, 5].map(side);
        Ok(Sides { holdover, perfect_link, alone, envelope, envelope_perfect_link, emergencies })
    }

    /// The errors under each difference between a vehicle and what its unit assumes.
    ///
    /// # Errors
    /// As for [`run`](Self::run).
    pub fn wrong(&self, seed: u64, done: impl Fn() + Sync) -> Result<Vec<WrongRow>, Error> {
        let true_ = Wrong::NOTHING;
        let wrongs = [
            ("nothing", true_),
            ("mass +30 %", Wrong { mass_scale: 1.3, ..true_ }),
            ("grade 4 %", Wrong { grade: 0.04, ..true_ }),
            ("head wind 10 m/s", Wrong { headwind_mps: 10.0, ..true_ }),
            ("lag +50 %", Wrong { lag_scale: 1.5, ..true_ }),
            ("all of these", Wrong { mass_scale: 1.3, grade: 0.04, headwind_mps: 10.0, lag_scale: 1.5 }),
        ];
        let base = Conditions::of(&self.corridor);
        let jobs: Vec<(u64, Conditions)> =
            wrongs.iter().map(|(_, wrong)| (seed, Conditions { wrong: *wrong, ..base })).collect();
        let outcomes = self.excerpt().all(&jobs, done)?;
        let row = |((what, _), outcome): (&(&str, Wrong), &Outcome)| WrongRow {
            what: (*what).to_owned(),
            side: Side::of(&[outcome]),
        };
        Ok(wrongs.iter().zip(&outcomes).map(row).collect())
    }

    /// The errors at each prediction step, with the ego's journal.
    ///
    /// # Errors
    /// As for [`run`](Self::run).
    pub fn steps(&self, seed: u64, done: impl Fn() + Sync) -> Result<Vec<(StepRow, Journal)>, Error> {
        let excerpt = self.excerpt();
        let (_, ego) = excerpt.trips(seed);
        let one = |step_s: &f64| {
            let conditions = Conditions { step_s: *step_s, ..Conditions::of(&self.corridor) };
            let mut journal = Journal::new(ego);
            let outcome = excerpt.run(seed, conditions, Some(&mut journal))?;
            done();
            Ok((StepRow { step_s: *step_s, side: Side::of(&[&outcome]) }, journal))
        };
        parallel::each(&STEPS_S, one).into_iter().collect()
    }

    /// The configuration and the way of the ego's unit, to measure its computing time.
    #[must_use]
    pub fn ego_unit(&self, seed: u64, step_s: f64) -> Option<(holdover::Config, &'static Itinerary)> {
        let (trips, ego) = self.excerpt().trips(seed);
        let trip = trips.get(ego?)?;
        let conditions = Conditions { step_s, ..Conditions::of(&self.corridor) };
        let identity = super::conditions::Identity::of(&self.corridor, &conditions, seed, ego?, ego?);
        let config = super::conditions::config(&self.corridor, &conditions, identity, trip.kind);
        Some((config, self.itineraries[trip.road]))
    }

    /// The same roads with other traffic.
    #[must_use]
    pub fn of(&self, corridor: Corridor) -> Self {
        Self { corridor, network: self.network.clone(), itineraries: self.itineraries.clone() }
    }

    /// The same experiment with no more arrivals than an excerpt has.
    pub(super) fn excerpt(&self) -> Self {
        let duration_s = self.corridor.duration_s.min(EXCERPT_S);
        self.of(Corridor { duration_s, ..self.corridor.clone() })
    }

    pub(super) fn all(&self, jobs: &[(u64, Conditions)], done: impl Fn() + Sync) -> Result<Vec<Outcome>, Error> {
        let one = |(seed, conditions): &(u64, Conditions)| {
            let outcome = self.run(*seed, *conditions, None);
            done();
            outcome
        };
        parallel::each(jobs, one).into_iter().collect()
    }
}

/// The trips of a seed in a corridor, and the index of the ego's trip.
#[must_use]
pub fn of_seed(corridor: &Corridor, seed: u64) -> (Vec<Trip>, Option<usize>) {
    with_ego(corridor, &Network::of(corridor), seed)
}

fn with_ego(corridor: &Corridor, network: &Network, seed: u64) -> (Vec<Trip>, Option<usize>) {
    let trips = trips(corridor, network, seed);
    let is_ego = |trip: &Trip| trip.road == corridor.ego_road && trip.at_s >= corridor.ego_after_s;
    let ego = trips.iter().position(is_ego);
    (trips, ego)
}

/// The conditions of the sides, in the order of [`Sides`].
#[must_use]
pub fn of_sides(corridor: &Corridor) -> [Conditions; Sides::COUNT] {
    // A side is without or with the envelope, and its links are perfect or not, whatever is switched on the way.
    let heeds = Heeds { links: true, envelope: false };
    let scenario = Conditions { heeds, ..Conditions::of(corridor) };
    let [without, with] =
        [false, true].map(|engaged| Conditions { envelope: Envelope { engaged, ..scenario.envelope }, ..scenario });
    let unheeding = Heeds { links: false, ..heeds };
    let perfect_link = Conditions { radio: without.radio.perfect(), heeds: unheeding, ..without };
    let alone = Conditions { when_lost: WhenLost::Alone, ..without };
    let with_perfect_link = Conditions { radio: with.radio.perfect(), heeds: unheeding, ..with };
    [without, perfect_link, alone, with, with_perfect_link, Conditions { emergencies: corridor.emergencies, ..with }]
}

/// The error for a configuration that the units refuse. It does not occur as long as the units accept every value that
/// a file may have.
pub fn refused(error: io::Error) -> Error {
    Error::new(error.to_string(), "report this with the scenario")
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::input::scenario::{Overrides, Switch};
    use crate::roads::example::TEXT;
    use crate::roads::read::corridor;

    #[test]
    fn a_side_is_what_it_is_called_whatever_the_scenario_does_with_the_envelope() {
        let off = TEXT.replacen("engaged = true ", "engaged = false", 1);
        let asked = Overrides { envelope: Some(Switch::Off), ..Overrides::default() };
        for (text, overrides) in [(TEXT, Overrides::default()), (TEXT, asked), (&off, Overrides::default())] {
            let corridor = corridor(Path::new("corridor.toml"), text, &overrides).unwrap();
            let sides = of_sides(&corridor);
            assert_eq!(sides.map(|conditions| conditions.envelope.engaged), [false, false, false, true, true, true]);
            let is_perfect = sides.map(|conditions| conditions.radio == corridor.radio.perfect());
            assert_eq!(is_perfect, [false, true, false, false, true, false]);
            let is_alone = sides.map(|conditions| conditions.when_lost == WhenLost::Alone);
            assert_eq!(is_alone, [false, false, true, false, false, false]);
            assert_eq!(sides.map(|conditions| conditions.emergencies.share), [0.0, 0.0, 0.0, 0.0, 0.0, 0.05]);
            assert_eq!(sides.map(|conditions| conditions.emergencies.faults), [0.0, 0.0, 0.0, 0.0, 0.0, 0.02]);
        }
    }
}
