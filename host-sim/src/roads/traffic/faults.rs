//! The faults of a corridor: a seed enters; vehicles leave whose receiver, sender or range sensor dies on its way, or
//! whose clock is off.
//!
//! A fault is of one part, and it lasts. The unit is not told of it: it learns of it, if at all, by what comes in and
//! what does not.

use super::Traffic;
use crate::roads::lane::Lane;
use crate::roads::trips::{HEARD_S, moment_s};
use crate::streams::{Purpose, stream, unit};

/// By how much a clock is off, in seconds, to either side.
const CLOCK_OFF_S: f64 = 0.05;

/// The fault of a vehicle. Times are of the run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Fault {
    /// From this time on its modem hears nothing over the air.
    DeafFrom(f64),
    /// From this time on nothing that it broadcasts goes out.
    MuteFrom(f64),
    /// On its whole way, what it takes for GNSS time is ahead of it by so many seconds, or behind it.
    TimeAheadBy(f64),
    /// From this time on its range sensor shows nothing.
    BlindFrom(f64),
}

impl Traffic<'_> {
    /// The fault of the vehicle with this index that appears now, if it has one. `sees`: whether there is a range
    /// sensor that may die. A vehicle that has one at a share has the same at every larger share. The radio works for
    /// [`HEARD_S`], as before a silence: a real vehicle would have been heard on the road before, and would have
    /// heard the others.
    pub(super) fn fault_of(&self, at_s: f64, index: usize, lane: &Lane, sees: bool) -> Option<Fault> {
        let mut generator = stream(self.seed, Purpose::Fault(u32::try_from(index).unwrap_or(u32::MAX)));
        let [draw, which, when] = [(); 3].map(|()| unit(&mut generator));
        let from_s = |first_s| at_s + moment_s(self.corridor, lane, first_s, when);
        let fault = match (4.0 * which) as u8 {
            0 => Fault::DeafFrom(from_s(HEARD_S)),
            1 => Fault::MuteFrom(from_s(HEARD_S)),
            2 => Fault::TimeAheadBy(if when < 0.5 { CLOCK_OFF_S } else { -CLOCK_OFF_S }),
            _ => Fault::BlindFrom(from_s(0.0)),
        };
        (draw < self.conditions.emergencies.faults && (sees || !matches!(fault, Fault::BlindFrom(_)))).then_some(fault)
    }
}

#[cfg(test)]
mod tests {
    use holdover::wire::{Message, Received, Receiver, Role};

    use super::*;
    use crate::bus::Frame;
    use crate::roads::conditions::Conditions;
    use crate::roads::description::Emergencies;
    use crate::roads::example;
    use crate::roads::experiment::Experiment;
    use crate::roads::trips::Trip;
    use crate::sim::modem::PEERS;
    use crate::sim::time::gnss;

    /// Two cars on 2nd Street, the second one 4 s behind the first.
    fn two() -> [Trip; 2] {
        [example::trip(0), Trip { at_s: 4.0, ..example::trip(0) }]
    }

    /// The world of these trips under a seed, in which this share of the vehicles has a fault. Messages are neither
    /// late nor lost.
    fn world<'a>(experiment: &'a Experiment, trips: &'a [Trip], seed: u64, faults: f64) -> Traffic<'a> {
        let Experiment { corridor, network, itineraries } = experiment;
        let emergencies = Emergencies { faults, ..Emergencies::NONE };
        let radio = corridor.radio.perfect();
        let conditions = Conditions { emergencies, radio, ..Conditions::of(corridor) };
        Traffic::new(corridor, network, itineraries, trips, conditions, seed)
    }

    /// The age at 13 s of what the first vehicle knows of the second, and of what the second knows of the first, if
    /// this vehicle has this fault from 10 s on.
    fn ages_s(of: usize, fault: Option<Fault>) -> [f64; 2] {
        let experiment = Experiment::new(example::corridor());
        let trips = two();
        let mut traffic = world(&experiment, &trips, 1, 0.0);
        traffic.advance(10.0, &mut []).unwrap();
        traffic.travellers.get_mut(&of).unwrap().fault = fault;
        traffic.advance(13.0, &mut []).unwrap();
        [0, 1].map(|index| {
            let vehicle = &traffic.travellers[&index].vehicle;
            let sample = vehicle.unit.peers().iter().find_map(|peer| peer.newest()).unwrap();
            13.0 - vehicle.time_of(sample.at)
        })
    }

    /// Whether what a vehicle knows of the other one is of just now, and not of 3 s ago.
    fn is_up_to_date(age_s: f64) -> bool {
        assert!((0.0..0.15).contains(&age_s) || (3.0..3.15).contains(&age_s), "{age_s}");
        age_s < 1.0
    }

    #[test]
    fn one_in_so_many_has_one_of_four_drawn_evenly() {
        let experiment = Experiment::new(example::corridor());
        let (lane, trips) = (&experiment.network.lanes[0], two());
        let of = |faults: f64, sees: bool| {
            let traffic = world(&experiment, &trips, 1, faults);
            (0..4_000).filter_map(|index| traffic.fault_of(5.0, index, lane, sees)).collect::<Vec<_>>()
        };
        let (few, all) = (of(0.02, true), of(1.0, true));
        assert!((50..=110).contains(&few.len()), "{}", few.len());
        assert!(few.iter().all(|one| all.contains(one)) && all.len() == 4_000 && of(0.0, true).is_empty());
        let count = |is: fn(&Fault) -> bool| all.iter().filter(|fault| is(fault)).count();
        let counts = [
            count(|fault| matches!(fault, Fault::DeafFrom(_))),
            count(|fault| matches!(fault, Fault::MuteFrom(_))),
            count(|fault| *fault == Fault::TimeAheadBy(0.05)),
            count(|fault| *fault == Fault::TimeAheadBy(-0.05)),
            count(|fault| matches!(fault, Fault::BlindFrom(_))),
        ];
        for (count, wanted) in counts.into_iter().zip([1_000, 1_000, 500, 500, 1_000_usize]) {
            assert!(count.abs_diff(wanted) <= 110, "{counts:?}");
        }
        // Without a range sensor none dies.
        assert_eq!(of(1.0, false).len(), 4_000 - counts[4]);
    }

    #[test]
    fn it_begins_at_any_moment_of_the_way_and_that_of_a_radio_once_the_radio_was_heard() {
        let experiment = Experiment::new(example::corridor());
        let (lane, trips) = (&experiment.network.lanes[0], two());
        let traffic = world(&experiment, &trips, 1, 1.0);
        let over_s = (lane.exit_m - lane.entry_m) / experiment.corridor.traffic.target_speed_mps;
        let (mut radios_s, mut sensors_s) = (Vec::new(), Vec::new());
        for index in 0..4_000 {
            match traffic.fault_of(5.0, index, lane, true) {
                Some(Fault::DeafFrom(from_s) | Fault::MuteFrom(from_s)) => radios_s.push(from_s - 5.0),
                Some(Fault::BlindFrom(from_s)) => sensors_s.push(from_s - 5.0),
                _ => {}
            }
        }
        for (from_s, first_s) in [(radios_s, HEARD_S), (sensors_s, 0.0)] {
            assert!(from_s.iter().all(|from_s| (first_s..over_s).contains(from_s)));
            let mean_s = from_s.iter().sum::<f64>() / from_s.len() as f64;
            assert!((mean_s - (first_s + over_s) / 2.0).abs() < 0.03 * (over_s - first_s), "{mean_s}");
        }
    }

    #[test]
    fn a_dead_receiver_hears_nothing_and_is_heard() {
        let deaf = Some(Fault::DeafFrom(10.0));
        assert_eq!(ages_s(0, None).map(is_up_to_date), [true, true]);
        assert_eq!(ages_s(0, deaf).map(is_up_to_date), [false, true]);
        assert_eq!(ages_s(1, deaf).map(is_up_to_date), [true, false]);
    }

    #[test]
    fn a_dead_sender_is_not_heard_and_hears() {
        let mute = Some(Fault::MuteFrom(10.0));
        assert_eq!(ages_s(0, mute).map(is_up_to_date), [true, false]);
        assert_eq!(ages_s(1, mute).map(is_up_to_date), [false, true]);
        assert_eq!(ages_s(0, Some(Fault::MuteFrom(13.0))).map(is_up_to_date), [true, true]);
    }

    #[test]
    fn a_clock_that_is_off_stamps_what_it_sends_by_its_own_time() {
        let experiment = Experiment::new(example::corridor());
        let (lane, trips) = (&experiment.network.lanes[0], [example::trip(0)]);
        let (mut ahead, mut behind) = (0, 0);
        for seed in 1..=20 {
            let mut traffic = world(&experiment, &trips, seed, 1.0);
            let Some(Fault::TimeAheadBy(ahead_s)) = traffic.fault_of(0.0, 0, lane, true) else { continue };
            traffic.advance(0.5, &mut []).unwrap();
            assert!(traffic.aired.len() > 3 && traffic.remains.faults == 1);
            for (sent_s, .., message) in &traffic.aired {
                let now = gnss(*sent_s);
                let age_us = now.as_micros() as i64 - message.motion.stamp.unwrap_near(now).as_micros() as i64;
                let age_s = age_us as f64 * 1e-6 + ahead_s;
                assert!((0.0..0.02).contains(&age_s), "{age_s}");
            }
            *if ahead_s > 0.0 { &mut ahead } else { &mut behind } += 1;
        }
        assert!(ahead > 0 && behind > 0);
    }

    /// Number of views on the bus of the second vehicle from 10 s to 15 s, with this fault.
    fn views(fault: Option<Fault>) -> usize {
        let experiment = Experiment::new(example::corridor());
        let trips = two();
        let mut traffic = world(&experiment, &trips, 1, 0.0);
        traffic.advance(10.0, &mut []).unwrap();
        let second = traffic.travellers.get_mut(&1).unwrap();
        (second.fault, second.log) = (fault, Some(second.vehicle.listen()));
        traffic.advance(15.0, &mut []).unwrap();
        let mut frames: Vec<(f64, Frame)> = Vec::new();
        let second = traffic.travellers.get_mut(&1).unwrap();
        second.hand_in(&mut frames).unwrap();
        let vehicle = &second.vehicle;
        let mut receiver = Receiver::<PEERS>::new(vehicle.unit.config().identifiers, Role::Unit);
        let mut is_view = |(at_s, frame): &(f64, Frame)| {
            matches!(receiver.receive(vehicle.instant(*at_s), frame), Ok(Received::Whole(Message::Range(_))))
        };
        frames.iter().filter(|one| is_view(one)).count()
    }

    #[test]
    fn a_dead_range_sensor_shows_nothing() {
        let all = views(None);
        assert!((200..=250).contains(&all), "{all}");
        let half = views(Some(Fault::BlindFrom(12.5)));
        assert!((80..=126).contains(&half), "{half}");
    }

    #[test]
    fn nobody_appears_near_behind_one_whose_sender_is_dead() {
        let experiment = Experiment::new(example::corridor());
        let trips = two();
        let mut traffic = world(&experiment, &trips, 1, 0.0);
        traffic.advance(3.0, &mut []).unwrap();
        traffic.travellers.get_mut(&0).unwrap().fault = Some(Fault::MuteFrom(2.0));
        traffic.advance(9.0, &mut []).unwrap();
        assert_eq!(traffic.travellers.len(), 1);
        traffic.advance(12.0, &mut []).unwrap();
        assert_eq!(traffic.travellers.len(), 2);
    }

    #[test]
    fn who_has_left_does_not_wait_for_a_dead_radio_to_hear_of_it() {
        let experiment = Experiment::new(example::corridor());
        let trips = two();
        let mut traffic = world(&experiment, &trips, 1, 0.0);
        traffic.advance(10.0, &mut []).unwrap();
        traffic.travellers.get_mut(&0).unwrap().left_s = Some(10.0);
        let mut is_heard_of = |of: usize, fault| {
            traffic.travellers.get_mut(&of).unwrap().fault = fault;
            let heard = traffic.is_heard_of(10.5, &traffic.travellers[&0]);
            traffic.travellers.get_mut(&of).unwrap().fault = None;
            heard
        };
        assert!(!is_heard_of(0, None));
        assert!(is_heard_of(0, Some(Fault::MuteFrom(9.0))) && is_heard_of(1, Some(Fault::DeafFrom(9.0))));
        assert!(!is_heard_of(0, Some(Fault::DeafFrom(9.0))) && !is_heard_of(1, Some(Fault::MuteFrom(9.0))));
    }

    #[test]
    fn a_run_with_faults_is_the_same_again() {
        let text = example::TEXT.replacen("duration_s = 600.0", "duration_s = 20.0", 1);
        let experiment = Experiment::new(example::of(&text));
        let emergencies = Emergencies { faults: 1.0, ..experiment.corridor.emergencies };
        let conditions = Conditions { emergencies, ..Conditions::of(&experiment.corridor) };
        let [one, again] = [(); 2].map(|()| experiment.run(1, conditions, None).unwrap());
        assert_eq!(one, again);
        assert_eq!(one.remains.faults as usize, experiment.trips(1).0.len());
    }
}
