//! When a run on the roads is given up: the speeds of every tick enter; whether nobody will move any more leaves.
//!
//! A vehicle whose radio is dead may hold up others for good, and a run would last until its time is over without anything happening.

use super::Traffic;
use crate::measure::metrics::STANDING_BELOW_MPS;

/// After the last arrival a run is given up when nobody has moved for so long, in seconds, beyond the longest silence and emergency stop.
/// It is four times the time after which a unit forgets a station, which is the longest that it waits for anything.
const STUCK_S: f64 = 120.0;

impl Traffic<'_> {
    /// Notes whether anybody moves.
    pub(super) fn note_motion(&mut self, at_s: f64) {
        if self.travellers.values().any(|one| one.vehicle.plant.speed_mps >= STANDING_BELOW_MPS) {
            self.moved_s = at_s;
        }
    }

    /// Whether nobody will move any more. With events of the scenario that is not told.
    pub(super) fn is_stuck(&self) -> bool {
        let patience_s = STUCK_S + self.conditions.radio.dark_s + self.conditions.emergencies.stands_s;
        let nobody_comes = self.next == self.trips.len() && self.corridor.events.is_empty();
        nobody_comes && self.at_s() - self.moved_s > patience_s
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::scenario::{Change, Event};
    use crate::roads::conditions::Conditions;
    use crate::roads::description::Corridor;
    use crate::roads::example;
    use crate::roads::experiment::Experiment;
    use crate::roads::trips::Trip;

    #[test]
    fn a_run_is_given_up_when_nobody_has_moved_for_120_s_and_the_longest_silence_and_stop_since_the_last_arrival() {
        let experiment = Experiment::new(example::corridor());
        let Experiment { corridor, network, itineraries } = &experiment;
        let conditions = Conditions::of(corridor);
        let longest_s = conditions.radio.dark_s + conditions.emergencies.stands_s;
        let trips = [example::trip(2), Trip { at_s: 50.0, ..example::trip(2) }];
        let mut traffic = Traffic::new(corridor, network, itineraries, &trips, conditions, 1);
        traffic.advance(10.0, &mut []).unwrap();
        assert!((9.9..10.0).contains(&traffic.moved_s), "{}", traffic.moved_s);
        let is_stuck_after = |traffic: &mut Traffic, still_s: f64| {
            traffic.ticks = ((traffic.moved_s + still_s) / corridor.period_s).round() as u64;
            traffic.is_stuck()
        };
        assert!(!is_stuck_after(&mut traffic, longest_s + 1_000.0));
        traffic.next = trips.len();
        assert!(!is_stuck_after(&mut traffic, longest_s + 119.9));
        assert!(is_stuck_after(&mut traffic, longest_s + 120.1));
        let release = Event { at_s: 900.0, vehicle: None, change: Change::Release };
        let with_events = Corridor { events: vec![release], ..corridor.clone() };
        traffic.corridor = &with_events;
        assert!(!is_stuck_after(&mut traffic, longest_s + 120.1));
    }
}
