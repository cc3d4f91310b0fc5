//! When a run on the roads is given up: the vehicles of every tick enter; whether nobody will move any more leaves.
//!
//! A vehicle whose radio is dead may hold up others for good, and a run would last until its time is over without anything happening.

use super::{Traffic, Traveller};
use crate::measure::metrics::STANDING_BELOW_MPS;

/// A run is given up when nothing has happened for so long, in seconds, after the last driver could have taken over. It is four times the
/// longest time that a unit measures, which is that after which it forgets a station.
const STUCK_S: f64 = 120.0;

impl Traffic<'_> {
    /// Notes whether something happens, or is still to happen: somebody moves or is to come, a vehicle makes an emergency stop, or its
    /// silence or its fault has not begun, or a silence is not over.
    pub(super) fn note_life(&mut self, at_s: f64) {
        let is_alive = |one: &Traveller| {
            let is_on_way = !one.has_left();
            let moves = one.vehicle.plant.speed_mps >= STANDING_BELOW_MPS;
            moves || is_on_way && (at_s < one.dark.to_s || one.stops_by_itself() || one.fault_is_to_come(at_s))
        };
        if self.next < self.trips.len() || self.travellers.values().any(is_alive) {
            self.alive_s = at_s;
        }
    }

    /// Whether nobody will move any more. Where events are to happen that is not told.
    pub(super) fn is_stuck(&self) -> bool {
        let longest_s = STUCK_S + self.conditions.emergencies.driver_after_s;
        self.happenings.is_empty() && self.at_s() - self.alive_s > longest_s
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

    /// Whether a run with these trips and events is given up after so many seconds, of which nothing has happened in the last `still_s`.
    fn is_stuck(trips: &[Trip], events: Vec<Event>, after_s: f64, still_s: f64) -> bool {
        let experiment = Experiment::new(Corridor { events, ..example::corridor() });
        let Experiment { corridor, network, itineraries } = &experiment;
        let mut traffic = Traffic::new(corridor, network, itineraries, trips, Conditions::of(corridor), 1);
        traffic.advance(after_s, &mut []).unwrap();
        traffic.ticks = ((traffic.alive_s + still_s) / corridor.period_s).round() as u64;
        traffic.is_stuck()
    }

    #[test]
    fn a_run_is_given_up_when_nothing_has_happened_for_120_s() {
        let trips = [Trip { dark_after_s: 0.0, ..example::trip(2) }];
        assert!(!is_stuck(&trips, Vec::new(), 10.0, 119.9));
        assert!(is_stuck(&trips, Vec::new(), 10.0, 120.1));
        let release = Event { at_s: 900.0, vehicle: None, change: Change::Release };
        assert!(!is_stuck(&trips, vec![release], 10.0, 120.1));
    }

    #[test]
    fn something_happens_as_long_as_somebody_moves_is_to_come_or_is_to_be_silent() {
        let alive_s = |trips: &[Trip], halt: bool| {
            let experiment = Experiment::new(example::corridor());
            let Experiment { corridor, network, itineraries } = &experiment;
            let mut traffic = Traffic::new(corridor, network, itineraries, trips, Conditions::of(corridor), 1);
            traffic.advance(5.0, &mut []).unwrap();
            for _ in 0..if halt { 500 } else { 0 } {
                traffic.travellers.values_mut().for_each(|one| one.vehicle.plant.speed_mps = 0.0);
                traffic.step(&mut [], &mut Vec::new()).unwrap();
            }
            (traffic.at_s(), traffic.alive_s)
        };
        let silent_before = Trip { dark_after_s: 0.0, ..example::trip(2) };
        let is_now = |(at_s, alive_s): (f64, f64)| at_s - alive_s < 0.1;
        assert!(is_now(alive_s(&[silent_before], false)));
        let (at_s, then_s) = alive_s(&[silent_before], true);
        assert!(at_s - then_s > 4.0, "{then_s}");
        assert!(is_now(alive_s(&[silent_before, Trip { at_s: 50.0, ..silent_before }], true)));
        assert!(is_now(alive_s(&[Trip { dark_after_s: 60.0, ..silent_before }], true)));
    }
}
