//! Shrinking: a drive with a fault enters, a smaller drive with the same fault leaves.

use crate::scenario::{Error, Scenario};
use crate::verdict::Fault;
use crate::world;

/// Largest number of runs for one drive.
const RUNS: usize = 400;

/// Makes the scenario smaller while the fault is still found.
pub fn shrink(scenario: &Scenario, fault: Fault) -> Scenario {
    let mut best = scenario.clone();
    let mut runs = 0;
    let mut try_it = |best: &mut Scenario, change: &dyn Fn(&mut Scenario)| -> bool {
        let mut smaller = best.clone();
        change(&mut smaller);
        runs += 1;
        let is_smaller = smaller != *best && runs < RUNS;
        if is_smaller && world::run(&smaller).of(fault).is_some() {
            *best = smaller;
            return true;
        }
        false
    };
    if let Some(finding) = world::run(scenario).of(fault) {
        let end = (finding.at * 10.0).ceil() / 10.0 + 0.1;
        try_it(&mut best, &|s| s.length = s.length.min(end));
        try_it(&mut best, &|s| {
            s.length = s.length.min(end);
            let length = s.length;
            s.event.retain(|event| event.at < length);
        });
    }
    // Groups of events are removed first, then single events.
    let mut size = best.event.len().div_ceil(2);
    while size > 0 {
        let mut from = 0;
        while from < best.event.len() {
            let end = (from + size).min(best.event.len());
            if !try_it(&mut best, &|s| drop(s.event.drain(from..end))) {
                from += size;
            }
        }
        size /= 2;
    }
    for place in (0..best.crossing.len()).rev() {
        try_it(&mut best, &|s| {
            s.crossing.remove(place);
        });
    }
    for place in 0..best.crossing.len() {
        try_it(&mut best, &|s| s.crossing[place].deaf_until = s.crossing[place].deaf_from);
        try_it(&mut best, &|s| s.crossing[place].rests = 0.0);
        try_it(&mut best, &|s| s.crossing[place].at = s.crossing[place].at.round());
        try_it(&mut best, &|s| s.crossing[place].speed = s.crossing[place].speed.round());
    }
    for change in SIMPLER {
        try_it(&mut best, change);
    }
    for place in 0..best.event.len() {
        try_it(&mut best, &|s| s.event[place].at = s.event[place].at.round());
        try_it(&mut best, &|s| s.event[place].at = (s.event[place].at * 10.0).round() / 10.0);
    }
    best
}

/// The simplifications, which are applied one by one.
const SIMPLER: &[&dyn Fn(&mut Scenario)] = &[
    &|s| (s.radio.loss, s.radio.burst) = (0.0, 1.0),
    &|s| (s.radio.tails, s.radio.tail) = (0.0, 0.0),
    &|s| s.radio.jitter = 0.0,
    &|s| s.radio.delay = 0.02,
    &|s| s.bus.loss = 0.0,
    &|s| s.bus.twice = 0.0,
    &|s| s.bus.jitter = 0.0,
    // A vehicle without V2X has to be visible to the range sensor.
    &|s| s.range.fitted &= s.peer.iter().any(|p| p.station == 0),
    &|s| s.range.misses = 0.0,
    &|s| s.ego.drift = 0.0,
    &|s| s.ego.lag_factor = 1.0,
    &|s| s.ego.lag = 0.3,
    &|s| s.ego.acceleration_off = 0.0,
    &|s| s.ego.road = 8.0,
    &|s| s.ego.long = false,
    &|s| s.ego.position = 0.0,
    &|s| s.ego.clock = 1_000_000,
    &|s| s.ego.speed = s.ego.speed.round(),
    &|s| s.ego.wanted = s.ego.wanted.round(),
    &|s| s.ego.gap = 1.6,
    &|s| s.epoch = 1_465_000_000_000_000,
    &|s| (s.ego.sensor.error, s.ego.sensor.speed_error) = (Error::None, Error::None),
    &|s| (s.ego.sensor.position, s.ego.sensor.speed) = (0.05, 0.02),
    &|s| s.peer.iter_mut().for_each(|p| (p.sensor.error, p.sensor.speed_error) = (Error::None, Error::None)),
    &|s| s.peer.iter_mut().for_each(|p| (p.sensor.position, p.sensor.speed) = (0.05, 0.02)),
    &|s| s.peer.iter_mut().for_each(|p| p.clock = 0.0),
    &|s| s.peer.iter_mut().for_each(|p| p.phase = 0.05),
    &|s| s.peer.iter_mut().for_each(|p| p.ahead = p.ahead.round()),
    &|s| s.peer.iter_mut().for_each(|p| p.speed = p.speed.round()),
    &|s| s.peer.iter_mut().for_each(|p| p.braking = p.braking.round()),
    &|s| s.peer.iter_mut().for_each(|p| p.pulling = p.pulling.round().max(1.0)),
    &|s| s.peer.iter_mut().for_each(|p| p.length = 4.8),
    &|s| s.seed = 1,
];
