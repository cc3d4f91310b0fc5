//! The runs: options enter; for each time gap and braking the figures without and with the envelope leave, beside the leader's.

use std::path::Path;

use holdover::parameters::FEED_FORWARD;
use serde::Serialize;

use super::avoidable::{Known, Limits, is_avoidable};
use super::leader::{self, BRAKES_AT_S};
use super::options::BrakingOptions;
use crate::error::Error;
use crate::input::scenario::{MAX_VEHICLES, Overrides, Scenario};
use crate::measure::simulate::simulate;
use crate::parallel;
use crate::sim::world::Tick;

/// The bodies and the lags of the followers, each in turn.
const BODIES: [&str; 3] = ["car", "van", "bus"];
const LAGS_S: [f64; 5] = [0.1, 0.5, 0.3, 0.2, 0.4];

/// Time over which a jerk is taken.
const JERK_OVER_S: f64 = 0.1;
/// Speed below which it is not: the end of a stop is a jolt for everybody.
const MOVES_MPS: f64 = 0.5;

/// The figures of one time gap and braking.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Row {
    /// Time gap of the followers.
    pub time_gap_s: f64,
    /// The leader's braking.
    pub braking_mps2: f64,
    /// Number of runs without the envelope; there are as many with it.
    pub seeds: u64,
    /// The leader's comfort.
    pub leader: Comfort,
    /// Figures without the envelope.
    pub off: Side,
    /// Figures with the envelope.
    pub on: Side,
}

/// What those inside feel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Comfort {
    /// Hardest braking, as a magnitude.
    pub hardest_braking_mps2: f64,
    /// Largest change of acceleration within 0.1 s, as a rate.
    pub largest_jerk_mps3: f64,
}

/// The figures of all runs with one setting of the envelope.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Side {
    /// Pairs that met, in all runs together.
    pub collisions: usize,
    /// Of these, in how many the vehicle behind could have come to rest (`avoidable.rs`). A pair is left out if its vehicle ahead had run
    /// into another before: a collision stops nobody in the simulation.
    pub avoidable: usize,
    /// In how many it could have, had it known of the braking in the moment in which that began.
    pub avoidable_at_once: usize,
    /// Smallest bumper gap; `None`: vehicles met.
    pub min_gap_m: Option<f64>,
    /// The comfort of the followers, the worst of all.
    #[serde(flatten)]
    pub comfort: Comfort,
    /// Ticks at which a target was outside its bound, in all runs together.
    pub bound_violations: usize,
}

/// Number of runs.
#[must_use]
pub fn count(options: &BrakingOptions) -> u64 {
    (options.time_gaps_s.len() * options.braking_mps2.len()) as u64 * 2 * options.seeds
}

/// Runs everything on all cores. `done` is called after each run.
///
/// # Errors
/// An error that a unit finds in the configuration.
pub fn run(options: &BrakingOptions, done: impl Fn() + Sync) -> Result<Vec<Row>, Error> {
    let places: Vec<(f64, f64)> = options
        .time_gaps_s
        .iter()
        .flat_map(|gap| options.braking_mps2.iter().map(|braking| (*gap, *braking)))
        .collect();
    let runs = 2 * options.seeds;
    let jobs = 0..places.len() as u64 * runs;
    let one = |job: u64| {
        let (place, number) = (places[(job / runs) as usize], job % runs);
        let outcome = outcome(options, place, number / 2, !number.is_multiple_of(2));
        done();
        outcome
    };
    let outcomes: Vec<Outcome> = parallel::each(jobs, one).into_iter().collect::<Result<_, _>>()?;
    let row = |(&(time_gap_s, braking_mps2), outcomes): (&(f64, f64), &[Outcome])| {
        let side = |first: usize| Side::of(outcomes.iter().skip(first).step_by(2));
        let leader = outcomes.iter().map(|outcome| outcome.leader).fold(Comfort::default(), Comfort::worst);
        Row { time_gap_s, braking_mps2, seeds: options.seeds, leader, off: side(0), on: side(1) }
    };
    Ok(places.iter().zip(outcomes.chunks(runs as usize)).map(row).collect())
}

/// The figures of one run.
struct Outcome {
    leader: Comfort,
    side: Side,
}

/// The run of a seed, which is so many after the first.
fn outcome(options: &BrakingOptions, place: (f64, f64), number: u64, is_engaged: bool) -> Result<Outcome, Error> {
    let scenario = scenario(options, place, number, is_engaged)?;
    let (trace, summary) = simulate(&scenario, options.seed + number, None, |_| {})?;
    let comfort = |ticks: &Vec<Tick>| Comfort::of(ticks, scenario.period_s);
    let followers = trace.vehicles.iter().skip(1).map(comfort).fold(Comfort::default(), Comfort::worst);
    Ok(Outcome {
        leader: trace.vehicles.first().map(comfort).unwrap_or_default(),
        side: Side {
            collisions: summary.collisions,
            avoidable: avoidable(&scenario, &trace.vehicles, Known::Seen),
            avoidable_at_once: avoidable(&scenario, &trace.vehicles, Known::AtOnce),
            min_gap_m: summary.min_gap_m,
            comfort: followers,
            bound_violations: summary.bound.violations,
        },
    })
}

/// In how many pairs that met the vehicle behind could have come to rest.
fn avoidable(scenario: &Scenario, vehicles: &[Vec<Tick>], known: Known) -> usize {
    let from = (BRAKES_AT_S / scenario.period_s) as usize;
    let meets_at = |index: usize| {
        let (length_m, pair) = (scenario.vehicles[index].length_m, (&vehicles[index], &vehicles[index + 1]));
        pair.0.iter().zip(pair.1).position(|(ahead, behind)| ahead.position_m - length_m <= behind.position_m)
    };
    let could_stop = |index: usize| {
        let described = &scenario.vehicles[index + 1];
        let law = described.kind.limits();
        let limits = Limits {
            braking_mps2: law.braking.get().to_num(),
            jerk_mps3: law.jerk.get().to_num(),
            lag_s: described.plant_lag_s,
        };
        let (ahead, behind) = (&vehicles[index], &vehicles[index + 1]);
        is_avoidable(ahead, behind, scenario.vehicles[index].length_m, from, known, &limits, scenario.period_s)
    };
    let meetings: Vec<Option<usize>> = (0..vehicles.len().saturating_sub(1)).map(meets_at).collect();
    first_meetings(&meetings).filter(|index| could_stop(*index)).count()
}

/// The pairs that met before the vehicle ahead had run into another, of those with these ticks of meeting.
fn first_meetings(meetings: &[Option<usize>]) -> impl Iterator<Item = usize> {
    let is_first = |index: usize| {
        let ahead = index.checked_sub(1).and_then(|ahead| meetings[ahead]);
        meetings[index].is_some_and(|met| ahead.is_none_or(|ahead| met < ahead))
    };
    (0..meetings.len()).filter(move |index| is_first(*index))
}

/// The scenario of one run: every vehicle starts at its time gap and speed. The braking begins in the middle of one of as many equal parts
/// of the silence as there are seeds.
///
/// # Errors
/// None for values within the options' limits.
fn scenario(
    options: &BrakingOptions,
    (time_gap_s, braking_mps2): (f64, f64),
    number: u64,
    is_engaged: bool,
) -> Result<Scenario, Error> {
    let BrakingOptions { speed_mps, silence_s, delay_s, loss, range_sensors, .. } = options;
    let gap_m = 2.0 + speed_mps * time_gap_s;
    let common = format!("speed_mps = {speed_mps}\nposition_accuracy_m = 0.05\nspeed_accuracy_mps = 0.02\n");
    let turn = ((options.seed % 15) + number) as usize;
    let follower = |index: usize| {
        // As `Config::with_range_sensor` has it.
        let feed_forward: f64 = if range_sensors.has(index + 1) { FEED_FORWARD.get().to_num() } else { 0.0 };
        let (body, lag_s) = (BODIES[(index + turn) % BODIES.len()], LAGS_S[(index + turn) % LAGS_S.len()]);
        format!(
            "[[vehicle]]\nkind = \"{body}\"\nlag_s = {lag_s}\ngap_m = {gap_m}\ntime_gap_s = {time_gap_s}\n\
             feed_forward = {feed_forward}\n{common}"
        )
    };
    let followers: String = (0..MAX_VEHICLES - 1).map(follower).collect();
    let from_s = BRAKES_AT_S - silence_s * (number as f64 + 0.5) / options.seeds as f64;
    let text = format!(
        "duration_s = {}\nego = 1\n[leader]\ntarget_speed_mps = {speed_mps}\n[[vehicle]]\n{common}{followers}[channel]\n\
         applies_to = \"all\"\ndelay_mean_s = {delay_s}\ndelay_std_s = 0\nloss = {loss}\noutages = [[{from_s}, {}]]\n\
         [envelope]\nengaged = {is_engaged}\n",
        leader::duration_s(*speed_mps, braking_mps2),
        from_s + silence_s,
    );
    let overrides = Overrides { range_sensors: Some(*range_sensors), ..Overrides::default() };
    let mut scenario = Scenario::parse(Path::new("braking"), &text, &overrides)?;
    scenario.leader.motion = Some(leader::motion(*speed_mps, braking_mps2, scenario.period_s));
    Ok(scenario)
}

impl Comfort {
    fn of(ticks: &[Tick], period_s: f64) -> Self {
        let over = ((JERK_OVER_S / period_s).round() as usize).max(1);
        let jerk = |(before, after): (&Tick, &Tick)| {
            (after.acceleration_mps2 - before.acceleration_mps2).abs() / (over as f64 * period_s)
        };
        let pairs = ticks.iter().zip(ticks.iter().skip(over)).filter(|(_, after)| after.speed_mps >= MOVES_MPS);
        Self {
            hardest_braking_mps2: ticks.iter().map(|tick| -tick.acceleration_mps2).fold(0.0, f64::max),
            largest_jerk_mps3: pairs.map(jerk).fold(0.0, f64::max),
        }
    }

    fn worst(self, other: Self) -> Self {
        Self {
            hardest_braking_mps2: self.hardest_braking_mps2.max(other.hardest_braking_mps2),
            largest_jerk_mps3: self.largest_jerk_mps3.max(other.largest_jerk_mps3),
        }
    }
}

impl Side {
    fn of<'a>(outcomes: impl Iterator<Item = &'a Outcome> + Clone) -> Self {
        let sides = || outcomes.clone().map(|outcome| outcome.side);
        let collisions = sides().map(|side| side.collisions).sum();
        Self {
            collisions,
            avoidable: sides().map(|side| side.avoidable).sum(),
            avoidable_at_once: sides().map(|side| side.avoidable_at_once).sum(),
            min_gap_m: sides().filter_map(|side| side.min_gap_m).reduce(f64::min).filter(|_| collisions == 0),
            comfort: sides().map(|side| side.comfort).fold(Comfort::default(), Comfort::worst),
            bound_violations: sides().map(|side| side.bound_violations).sum(),
        }
    }
}

/// The reasons why the rows fail; empty if they pass.
#[must_use]
pub fn failures(rows: &[Row]) -> Vec<String> {
    let mut failures = Vec::new();
    for Row { time_gap_s, braking_mps2, off, on, .. } in rows {
        let place = format!("at a time gap of {time_gap_s} s behind {braking_mps2} m/s²");
        if on.collisions > 0 {
            failures.push(format!("{} collision(s) {place} with the envelope", on.collisions));
        }
        let violations = off.bound_violations + on.bound_violations;
        if violations > 0 {
            failures.push(format!("{violations} tick(s) {place} at which a target was outside its bound"));
        }
    }
    failures
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::world::Tick;
    use holdover::wire::command::ModeCode;

    #[test]
    fn a_pair_counts_that_met_before_its_vehicle_ahead_had_run_into_another() {
        let first = |meetings: &[Option<usize>]| first_meetings(meetings).collect::<Vec<_>>();
        assert_eq!(first(&[Some(5), Some(9), Some(7)]), [0, 2]);
        assert_eq!(first(&[None, Some(3), None]), [1]);
        assert_eq!(first(&[Some(5), Some(5)]), [0]);
        assert_eq!(first(&[]), [0usize; 0]);
    }

    fn tick(speed_mps: f64, acceleration_mps2: f64) -> Tick {
        Tick {
            position_m: 0.0,
            speed_mps,
            acceleration_mps2,
            command_mps2: 0.0,
            limited: false,
            mode: ModeCode::Standby,
            target: None,
        }
    }

    #[test]
    fn a_jerk_is_a_change_within_a_tenth_of_a_second_and_the_end_of_a_stop_is_none() {
        let ramp: Vec<Tick> = (0..30).map(|n| tick(10.0, -0.1 * f64::from(n.min(20)))).collect();
        let comfort = Comfort::of(&ramp, 0.01);
        assert!((comfort.largest_jerk_mps3 - 10.0).abs() < 1e-9 && (comfort.hardest_braking_mps2 - 2.0).abs() < 1e-9);
        let stop: Vec<Tick> = (0..30).map(|n| if n < 15 { tick(1.0, -2.0) } else { tick(0.0, 0.0) }).collect();
        assert_eq!(Comfort::of(&stop, 0.01).largest_jerk_mps3, 0.0);
    }

    #[test]
    fn where_vehicles_met_there_is_no_smallest_gap() {
        let side = |collisions, min_gap_m| Side {
            collisions,
            avoidable: 0,
            avoidable_at_once: 0,
            min_gap_m,
            comfort: Comfort::default(),
            bound_violations: 0,
        };
        let outcomes =
            [side(0, Some(1.5)), side(1, Some(-3.0))].map(|side| Outcome { leader: Comfort::default(), side });
        assert_eq!(Side::of(outcomes.iter()).min_gap_m, None);
        assert_eq!(Side::of(outcomes.iter().take(1)).min_gap_m, Some(1.5));
    }
}
