//! Passes that are repeated (F9): those that the modem hears enter, and those that it broadcasts again leave, with the stamps that they
//! were said with. So a station that cannot hear another one learns of its claims, and that it has heard a message since then.
//!
//! What a station said is repeated as it was, by whoever heard it. A unit takes a repeated pass as if it had heard it from its station.

use std::collections::BTreeMap;

use holdover::wire::pass::Pass;
use holdover::wire::{Frame, Message};

use super::{Relay, V2xMessage};

/// So many passes fit into a broadcast.
pub const REPEATED: usize = 4;

/// What was heard longer ago than this is not repeated any more, in seconds: the longest silence that two stations may begin with.
const NEWS_S: f64 = 4.5;

/// What was heard last of a station.
#[derive(Clone, Copy, Debug)]
struct Heard {
    pass: Pass,
    at_s: f64,
    repeated_s: f64,
}

/// The passes that a modem knows.
#[derive(Clone, Debug, Default)]
pub(super) struct Repeater {
    /// Time between two repeats of a station's pass; `None`: nothing is repeated.
    every_s: Option<f64>,
    /// The own station.
    own: Option<u32>,
    heard: BTreeMap<u32, Heard>,
}

impl Repeater {
    /// Repeats each pass so often; 0: not at all.
    pub fn set(&mut self, hz: f64) {
        self.every_s = (hz > 0.0).then(|| 1.0 / hz);
    }

    /// Takes in what the own unit says.
    pub fn take_own(&mut self, pass: &Pass) {
        self.own = Some(pass.station_id);
    }

    /// Takes in a pass from the air. Whether it is news: another station's, and said later than what was heard of that station before.
    pub fn take(&mut self, at_s: f64, pass: &Pass) -> bool {
        if self.every_s.is_none() || self.own == Some(pass.station_id) {
            return false;
        }
        let held = self.heard.get(&pass.station_id);
        // Times come round; the later is the one from which the other lies less than half a round behind.
        let is_later = |held: &Heard| (pass.stamp.0.wrapping_sub(held.pass.stamp.0) as i16) > 0;
        if held.is_some_and(|held| at_s - held.at_s < NEWS_S && !is_later(held)) {
            return false;
        }
        let repeated_s = held.map_or(at_s, |held| held.repeated_s);
        self.heard.insert(pass.station_id, Heard { pass: *pass, at_s, repeated_s });
        true
    }

    /// What is to be repeated now: what waits for longest first.
    pub fn due(&mut self, at_s: f64) -> [Option<Pass>; REPEATED] {
        let Some(every_s) = self.every_s else { return [None; REPEATED] };
        self.heard.retain(|_, heard| at_s - heard.at_s < NEWS_S);
        let mut due: Vec<&mut Heard> =
            self.heard.values_mut().filter(|heard| at_s - heard.repeated_s >= every_s - 1e-9).collect();
        due.sort_by(|a, b| a.repeated_s.total_cmp(&b.repeated_s));
        let mut due = due.into_iter().map(|heard| {
            heard.repeated_s = at_s;
            heard.pass
        });
        [(); REPEATED].map(|()| due.next())
    }
}

impl Relay {
    /// Repeats the passes that are heard so often; 0: not at all.
    pub fn repeat_passes(&mut self, hz: f64) {
        self.repeater.set(hz);
    }

    /// Takes in what the unit says of its passes.
    pub fn take_pass(&mut self, pass: &Pass) {
        self.repeater.take_own(pass);
    }

    /// The passes of others to broadcast now.
    pub fn repeats(&mut self, at_s: f64) -> [Option<Pass>; REPEATED] {
        self.repeater.due(at_s)
    }

    /// Relays what a station says of its passes, and what it repeats of others' if that is news.
    pub(super) fn relay_passes(&mut self, at_s: f64, message: &V2xMessage, frames: &mut Vec<Frame>) {
        if let Some(pass) = &message.pass {
            self.repeater.take(at_s, pass);
            self.relay_pass(pass, frames);
        }
        for pass in message.repeated.iter().flatten() {
            if self.repeater.take(at_s, pass) {
                self.relay_pass(pass, frames);
            }
        }
    }

    /// Relays a pass if its station comes to the unit's next intersection or has just left it. The station needs no slot.
    fn relay_pass(&mut self, pass: &Pass, frames: &mut Vec<Frame>) {
        let Some(next) = self.course.next() else { return };
        if pass.intersection == next.intersection.id || pass.left == Some(next.intersection.id) {
            let sent = self.sender.send(&Message::PeerPass(*pass), &mut |frame| frames.push(frame));
            sent.expect("the catalogue has a line for passes");
        }
    }
}

#[cfg(test)]
mod tests {
    use holdover::coordination::Movement;
    use holdover::wire::pass::PassTime;

    use super::*;

    fn pass(station_id: u32, stamp: u16) -> Pass {
        let movement = Movement::straight(0);
        let (stamp, claims) = (PassTime(stamp), [None; 2]);
        Pass {
            tag: 0,
            station_id,
            intersection: 5,
            movement,
            left: None,
            is_before_zone: false,
            is_by_hand: false,
            stamp,
            arrival: 0,
            claims,
        }
    }

    fn due(repeater: &mut Repeater, at_s: f64) -> Vec<(u32, u16)> {
        repeater.due(at_s).into_iter().flatten().map(|pass| (pass.station_id, pass.stamp.0)).collect()
    }

    #[test]
    fn the_newest_pass_of_each_other_station_is_repeated_at_the_rate_while_it_is_news() {
        let mut repeater = Repeater::default();
        repeater.set(1.0);
        repeater.take_own(&pass(1, 0));
        assert!(!repeater.take(0.0, &pass(1, 10)), "the own one comes back");
        for (station, stamp, is_news) in
            [(2, 65_530, true), (2, 4, true), (2, 4, false), (2, 65_531, false), (3, 7, true)]
        {
            assert_eq!(repeater.take(0.0, &pass(station, stamp)), is_news, "{station} {stamp}");
        }
        assert_eq!(due(&mut repeater, 0.9), []);
        assert_eq!(due(&mut repeater, 1.0), [(2, 4), (3, 7)]);
        assert_eq!(due(&mut repeater, 1.5), []);
        assert!(repeater.take(1.5, &pass(3, 150)));
        assert_eq!(due(&mut repeater, 4.4), [(2, 4), (3, 150)]);
        assert_eq!(due(&mut repeater, 5.9), [(3, 150)]);
        assert_eq!(due(&mut repeater, 7.0), []);
    }

    #[test]
    fn what_waits_for_longest_is_repeated_first_and_nothing_at_a_rate_of_0() {
        let mut repeater = Repeater::default();
        assert!(!repeater.take(0.0, &pass(2, 1)));
        repeater.set(2.0);
        for station in 2..8 {
            repeater.take(0.0, &pass(station, 1));
        }
        let stations = |due: Vec<(u32, u16)>| due.into_iter().map(|(station, _)| station).collect::<Vec<_>>();
        assert_eq!(stations(due(&mut repeater, 1.0)), [2, 3, 4, 5]);
        assert_eq!(stations(due(&mut repeater, 1.1)), [6, 7]);
        repeater.set(0.0);
        assert_eq!(due(&mut repeater, 4.0), []);
    }
}
