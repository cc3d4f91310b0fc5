//! What is refused changes nothing: after any frame that any unit refuses, all that the unit holds is what it was before, but for
//! the count of the cause, the end-to-end state, the parts of messages under way, and the evidence of misbehaviour.

#[allow(dead_code)] // others use all of it
use crate::messages;
use crate::rig;
use std::collections::BTreeMap;

use crate::rig::junction::WAYS;
use crate::rig::random::Random;
use crate::rig::{EGO, Rig, Unit, instant, mps, mps2};
use holdover::health::Cause;
use holdover::wire::geo::GeoPosition;
use holdover::wire::motion::{Motion, WirePosition};
use holdover::wire::{Identifiers, Message, Predecessor, Said, Sender, Slot, StationHash};
use proptest::strategy::{Strategy, ValueTree};
use proptest::test_runner::TestRunner;

/// What a refusal may change: the receiver has the end-to-end state and the parts under way, a suspect is evidence, and so is
/// whose a slot may be, with what was said of a place that no motion has confirmed.
const MAY_CHANGE: [&str; 6] = ["receiver", "health", "suspects", "agreed", "is_disputed", "sender_clock"];

/// All that a unit holds, as text, without what a refusal may change.
fn snapshot(unit: &Unit, cause: Cause) -> String {
    let (mut kept, mut skipped, mut axes) = (String::new(), None, None);
    for line in format!("{unit:#?}").lines() {
        let depth = line.len() - line.trim_start().len();
        if let Some(until) = skipped {
            skipped = (depth > until).then_some(until);
            continue;
        }
        if axes.is_some_and(|from| depth <= from) {
            axes = None;
        }
        let name = line.trim_start().split(':').next().unwrap_or_default();
        if name == "axes" {
            axes = Some(depth);
        }
        // Of a synchronisation in two steps the first is used up by the second, and the doubt is the evidence.
        let is_doubt_of_time = cause.name().starts_with("sync_") && ["mark", "doubted"].contains(&name);
        // Who is too far away to be driven by is known to be there all the same.
        // By a sender's clock that is found to be ahead less is certain.
        let is_far =
            matches!(cause, Cause::TooFar | Cause::Future) && ["bound", "course", "is_carried"].contains(&name);
        let is_waiting = axes.is_some() && name == "tie";
        if MAY_CHANGE.contains(&name) || is_doubt_of_time || is_far || is_waiting {
            skipped = line.ends_with(['{', '(', '[']).then_some(depth);
            continue;
        }
        kept.push_str(line);
        kept.push('\n');
    }
    assert!(kept.len() > 10_000 && kept.contains("horizons") && kept.contains("choice"));
    kept
}

/// The first line in which two texts differ.
fn difference(before: &str, after: &str) -> Option<String> {
    let mut lines = before.lines().zip(after.lines()).enumerate();
    let (number, (old, new)) = lines.find(|(_, (old, new))| old != new)?;
    let context: Vec<_> = before.lines().skip(number.saturating_sub(12)).take(12).collect();
    Some(format!("{}\n-{old}\n+{new}", context.join("\n")))
}

struct World {
    rig: Rig,
    random: Random,
    runner: TestRunner,
    sensors: Sender<0>,
    modem: Sender<16>,
    now: i64,
    refused: BTreeMap<&'static str, u32>,
}

impl World {
    fn new(seed: u64, way: Option<usize>) -> Self {
        let mut rig = Rig::new(&rig::config());
        if let Some(way) = way {
            rig.unit.set_out(&WAYS[way]).unwrap();
        }
        Self {
            rig,
            random: Random::new(seed),
            runner: TestRunner::deterministic(),
            sensors: Sender::new(Identifiers::DEFAULT),
            modem: Sender::new(Identifiers::DEFAULT),
            now: 0,
            refused: BTreeMap::new(),
        }
    }

    fn any<S: Strategy>(&mut self, strategy: &S) -> S::Value {
        strategy.new_tree(&mut self.runner).unwrap().current()
    }

    /// Where a station is on its own lane; the ego is station 1.
    fn place(&self, station: StationHash) -> f64 {
        10.0 * self.now as f64 * 1e-6 + 40.0 * f64::from(station.0)
    }

    fn honest(&mut self, station: StationHash) -> Motion {
        let place = self.place(station);
        self.rig.motion(station, self.now, place, 10.0, 0.0, 0.0, Some((0.5, 0.2)))
    }

    /// A motion of which one thing or other is wrong.
    fn wrong(&mut self, station: StationHash) -> Motion {
        let off = [-3.0, 3.0, 60.0, -400.0, 2_000.0, 9_000.0][self.random.below(6) as usize];
        let (place, late) = (self.place(station), self.random.between(-1e6, 14e6) as i64);
        let honest = self.honest(station);
        let moved = WirePosition::from_mm(((place + off) * 1e3) as i64);
        match self.random.below(6) {
            0 => Motion { position: moved, ..honest },
            1 => Motion { speed: mps(self.random.between(0.0, 60.0)), ..honest },
            2 => Motion { acceleration: mps2(self.random.between(-20.0, 20.0)), ..honest },
            3 => Motion { stamp: rig::gnss(self.now - late, 0).stamp(), ..honest },
            4 => Motion { stamp: rig::gnss(self.now - late / 10, 0).stamp(), position: moved, ..honest },
            _ => self.any(&messages::motion()),
        }
    }

    /// A place north of the first junction, or anywhere.
    fn geo(&mut self, at: i64, along: f64) -> GeoPosition {
        let any = self.any(&messages::geo());
        if self.random.happens(0.3) {
            return any;
        }
        let latitude = ((200.0 - along) * 100.0) as i32;
        GeoPosition { latitude, longitude: 0, heading: 0, stamp: rig::gnss(at, 0).stamp(), ..any }
    }

    fn next(&mut self) -> Message {
        let station = StationHash([2, 2, 2, 3, 4, 66][self.random.below(6) as usize]);
        let home = Slot(station.0 % 4);
        let slot = if self.random.happens(0.15) { Slot(self.random.below(5) as u8) } else { home };
        match self.random.below(16) {
            0..5 => Message::Peer(slot, Said::Motion(self.honest(station))),
            5..9 => Message::Peer(slot, Said::Motion(self.wrong(station))),
            9 => Message::Ego(Said::Motion(self.wrong(EGO))),
            10 => Message::Peer(slot, self.any(&messages::said())),
            11 => {
                let along = self.place(station);
                Message::Peer(slot, Said::Geo(self.geo(self.now, along)))
            }
            12 => {
                let along = self.place(EGO);
                Message::Ego(Said::Geo(self.geo(self.now, along)))
            }
            13 => self.any(&messages::to_unit(4)),
            14 => Message::Range(self.any(&messages::range_sample())),
            _ => Message::Peer(slot, Said::DrivingParameters(rig::parameters(2.0, self.random.extreme(2.0, 9.0)))),
        }
    }

    fn put(&mut self, message: &Message) {
        let mut frames = Vec::new();
        match message {
            Message::Peer(..) => self.modem.send(message, &mut |frame| frames.push(frame)),
            _ => self.sensors.send(message, &mut |frame| frames.push(frame)),
        }
        .unwrap();
        for frame in &frames {
            let before = self.rig.unit.clone();
            if let Err(cause) = self.rig.unit.receive(instant(self.now), frame) {
                *self.refused.entry(cause.name()).or_default() += 1;
                let (before, after) = (snapshot(&before, cause), snapshot(&self.rig.unit, cause));
                if let Some(difference) = difference(&before, &after) {
                    panic!("{} changed this at {}:\n{difference}\n{message:?}", cause.name(), self.now);
                }
                assert_eq!(before.len(), after.len());
            }
        }
    }

    fn run(mut self, messages: u32) -> BTreeMap<&'static str, u32> {
        self.rig.power_up(true, 0);
        let _ = self.rig.request(-50_000, true, Predecessor::Station(StationHash(2)));
        let _ = self.rig.request(-40_000, true, Predecessor::Station(StationHash(2)));
        for _ in 0..messages {
            self.now += [1_000, 10_000, 10_000, 40_000][self.random.below(4) as usize];
            if self.random.happens(0.01) {
                self.now += 2_600_000; // others may take the slots
            }
            if self.random.happens(0.3) {
                self.rig.synchronise(self.now, 0);
            }
            let honest = self.honest(EGO);
            self.put(&Message::Ego(Said::Motion(honest)));
            let message = self.next();
            self.put(&message);
            if self.random.happens(0.5) {
                self.rig.tick(self.now);
            }
        }
        self.refused
    }
}

#[test]
fn whatever_is_refused_changes_nothing_else() {
    let mut refused: BTreeMap<_, u32> = BTreeMap::new();
    for seed in 0..12 {
        let way = [None, Some(0), Some(1)][seed as usize % 3];
        for (name, count) in World::new(seed, way).run(150) {
            *refused.entry(name).or_default() += count;
        }
    }
    let expected = ["jump", "implausible", "stale", "future", "duplicate", "too_far", "station_conflict", "torn"];
    for name in expected {
        assert!(refused.get(name).is_some_and(|count| *count >= 5), "{name}: {refused:?}");
    }
}
