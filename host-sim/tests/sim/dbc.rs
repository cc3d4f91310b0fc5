//! `holdover.dbc` and `holdover-fd.dbc` against the frames: random messages are encoded by the core's sender, their raw frames are decoded
//! by what an independent parser reads in the file, and every signal of every message is compared with the message.

#[allow(dead_code)] // shared with the core's own tests
#[path = "../../../tests/core/messages/mod.rs"]
mod messages;

use std::collections::BTreeMap;
use std::sync::LazyLock;

use can_dbc::{ByteOrder, Dbc, MessageId, MultiplexIndicator, Signal, ValueDescription, ValueType};
use embedded_can::Id;
use holdover::wire::command::Effort;
use holdover::wire::fd::State;
use holdover::wire::{Frame, Identifiers, Message, Predecessor, Said, Sender, Slot, Transport};
use messages::{from_unit, knots, motion, parameters, to_unit};
use proptest::option;
use proptest::prelude::*;

/// What a signal says: a physical value, or the name that the file gives to the raw value.
#[derive(Clone, Debug, PartialEq)]
enum Reading {
    Value(f64),
    Name(String),
}

fn read(name: &str) -> Dbc {
    let text = std::fs::read_to_string(format!("{}/../{name}", env!("CARGO_MANIFEST_DIR"))).unwrap();
    Dbc::try_from(text.as_str()).unwrap()
}

fn file() -> &'static Dbc {
    static FILE: LazyLock<Dbc> = LazyLock::new(|| read("holdover.dbc"));
    &FILE
}

fn file_fd() -> &'static Dbc {
    static FILE: LazyLock<Dbc> = LazyLock::new(|| read("holdover-fd.dbc"));
    &FILE
}

fn raw(signal: &Signal, data: &[u8]) -> i64 {
    assert_eq!(signal.byte_order, ByteOrder::LittleEndian);
    let bit = |place: u64| i64::from(data[(place / 8) as usize] >> (place % 8) & 1);
    let bits = (0..signal.size).fold(0, |sum, place| sum | bit(signal.start_bit + place) << place);
    let negative = signal.value_type == ValueType::Signed && bits >> (signal.size - 1) & 1 == 1;
    if negative { bits - (1 << signal.size) } else { bits }
}

fn id_of(frame: &Frame) -> MessageId {
    match frame.id.into() {
        Id::Standard(id) => MessageId::Standard(id.as_raw()),
        Id::Extended(id) => MessageId::Extended(id.as_raw()),
    }
}

fn name_of(file: &Dbc, id: MessageId, signal: &str, raw: i64) -> Option<String> {
    file.value_descriptions.iter().find_map(|described| match described {
        ValueDescription::Signal { message_id, name, value_descriptions } if *message_id == id && name == signal => {
            value_descriptions.iter().find(|value| value.id == raw).map(|value| value.description.clone())
        }
        _ => None,
    })
}

/// Message name, and the readings of all its frames' signals; the E2E header and the part are left out.
fn decoded(file: &Dbc, frames: &[Frame]) -> (Vec<String>, BTreeMap<String, Reading>) {
    let (mut names, mut readings) = (Vec::new(), BTreeMap::new());
    for frame in frames {
        let id = id_of(frame);
        let message = file.messages.iter().find(|message| message.id == id).unwrap();
        assert_eq!(message.size, frame.data.len() as u64, "{}", message.name);
        if !names.contains(&message.name) {
            names.push(message.name.clone());
        }
        let selector = message.signals.iter().find(|s| s.multiplexer_indicator == MultiplexIndicator::Multiplexor);
        let part = selector.map(|selector| raw(selector, &frame.data));
        for signal in &message.signals {
            let here = match signal.multiplexer_indicator {
                MultiplexIndicator::MultiplexedSignal(of) => part == Some(of as i64),
                _ => true,
            };
            if !here || ["Crc", "Counter", "Part"].contains(&signal.name.as_str()) {
                continue;
            }
            let raw = raw(signal, &frame.data);
            let reading = match name_of(file, id, &signal.name, raw) {
                Some(name) => Reading::Name(name),
                None => Reading::Value(raw as f64 * signal.factor + signal.offset),
            };
            let before = readings.insert(signal.name.clone(), reading.clone());
            assert!(before.is_none_or(|before| before == reading), "{} differs between frames", signal.name);
        }
    }
    (names, readings)
}

/// The readings that a message must give.
#[derive(Default)]
struct Expected(BTreeMap<String, Reading>);

impl Expected {
    fn value(mut self, name: &str, value: impl Into<f64>) -> Self {
        self.0.insert(name.into(), Reading::Value(value.into()));
        self
    }

    fn name(mut self, signal: &str, name: impl Into<String>) -> Self {
        self.0.insert(signal.into(), Reading::Name(name.into()));
        self
    }

    fn either(self, signal: &str, value: Option<f64>, none: &str) -> Self {
        match value {
            Some(value) => self.value(signal, value),
            None => self.name(signal, none),
        }
    }

    fn predecessor(self, predecessor: Predecessor) -> Self {
        let (kind, station) = match predecessor {
            Predecessor::Unknown => ("unknown", 0),
            Predecessor::None => ("nobody", 0),
            Predecessor::Station(hash) => ("station", hash.0),
        };
        self.name("PredecessorKind", kind).value("PredecessorStation", station)
    }
}

/// A quantity as a float.
macro_rules! si {
    ($quantity:expr) => {
        $quantity.get().to_num::<f64>()
    };
}

fn expected_of_said(said: &Said) -> Expected {
    let e = Expected::default();
    match said {
        Said::Motion(m) => e
            .value("Tag", m.tag)
            .value("Position", f64::from(m.position.mm()) / 1e3)
            .value("Stamp", f64::from(m.stamp.raw()) / 1e4)
            .value("Station", m.station.0)
            .value("Speed", si!(m.speed))
            .value("Acceleration", si!(m.acceleration))
            .value("Demand", si!(m.demand))
            .either("PositionAccuracy", m.position_accuracy.map(|d| si!(d)), "not published")
            .either("SpeedAccuracy", m.speed_accuracy.map(|v| si!(v)), "not published"),
        Said::DrivingParameters(i) => e
            .value("Tag", 1)
            .value("Length", si!(i.length))
            .value("Standstill", si!(i.standstill))
            .predecessor(i.predecessor)
            .value("TargetSpeed", si!(i.target_speed))
            .value("TimeGap", si!(i.time_gap))
            .value("Gain", si!(i.gain))
            .value("Damping", si!(i.damping))
            .value("FeedForward", si!(i.feed_forward))
            .value("Lag", si!(i.lag))
            .value("CatchUp", si!(i.catch_up))
            .value("AccelerationLimit", si!(i.limits.acceleration))
            .value("BrakingLimit", si!(i.limits.braking))
            .value("JerkLimit", si!(i.limits.jerk))
            .value("EmergencyBraking", si!(i.limits.emergency_braking))
            .value("HorizonLength", f64::from(i.horizon_tenths) / 10.0),
        Said::Horizon(h) => h.knots.iter().enumerate().fold(e.value("Tag", h.tag), |e, (n, knot)| {
            e.value(&format!("Displacement{n}"), si!(knot.displacement))
                .value(&format!("Speed{n}"), si!(knot.speed))
                .value(&format!("Acceleration{n}"), si!(knot.acceleration))
                .value(&format!("Bow{n}"), si!(knot.bow))
        }),
        Said::State(state) => {
            let present = |there: bool| if there { "present" } else { "absent" };
            let parts = [
                Some(Said::Motion(state.motion)),
                state.parameters.map(Said::DrivingParameters),
                state.horizon.map(Said::Horizon),
            ];
            let readings = parts.iter().flatten().flat_map(|part| expected_of_said(part).0);
            Expected(readings.collect())
                .name("HorizonValid", present(state.horizon.is_some()))
                .name("ParametersValid", present(state.parameters.is_some()))
        }
        Said::Geo(g) => e
            .value("Tag", g.tag)
            .value("Latitude", f64::from(g.latitude) / 1e7)
            .value("Longitude", f64::from(g.longitude) / 1e7)
            .value("Heading", f64::from(g.heading) * 0.0125)
            .value("Stamp", f64::from(g.stamp.raw()) / 1e4),
        Said::Route(r) => e
            .value("Tag", r.tag)
            .value("Distance", si!(r.distance))
            .value("Stamp", f64::from(r.stamp.raw()) / 1e4)
            .value("Leg", r.movement.leg)
            .value("Turn", (8 + r.movement.exit - r.movement.leg) % 8)
            .value("Intersection", r.intersection)
            .value("Arrival", f64::from(r.arrival) / 100.0)
            .predecessor(r.predecessor),
    }
}

fn expected_of(message: &Message) -> Expected {
    let e = Expected::default();
    let mode = |mode| format!("{mode:?}").to_lowercase();
    match message {
        Message::Ego(said) | Message::Own(said) | Message::Peer(_, said) => expected_of_said(said),
        Message::Sync(s) => e.value("Sequence", s.sequence).value("Seconds", s.seconds),
        Message::FollowUp(f) => e.value("Sequence", f.sequence).value("Micros", f.micros),
        Message::Actuators(a) => e
            .name("Control", ["off", "ready", "driving", "failed"][a.control as usize])
            .name("Accelerator", if a.accelerator { "pressed" } else { "released" })
            .name("Brake", if a.brake { "pressed" } else { "released" })
            .name("Holding", if a.holding { "held at standstill" } else { "not held" })
            .value("Tick", a.tick),
        Message::DriverRequest(i) => e
            .name("Engaged", if i.engaged { "drive" } else { "off" })
            .predecessor(i.predecessor)
            .value("TargetSpeed", si!(i.target_speed))
            .either("TimeGap", i.time_gap.map(|t| si!(t)), "as configured"),
        Message::Range(r) => e
            .value("Distance", si!(r.distance))
            .value("SpeedDifference", si!(r.speed_difference))
            .value("DistanceAccuracy", si!(r.distance_accuracy))
            .value("SpeedAccuracy", si!(r.speed_accuracy))
            .value("Age", r.age.as_micros() as f64 / 1e6)
            .name("Nobody", if r.nobody { "no vehicle nearer than Distance" } else { "vehicle at Distance" }),
        Message::Unserved(u) => e
            .value("Intersection", u.intersection)
            .value("Legs", u.legs)
            .either("Ahead", u.ahead.map(|way| si!(way)), "nobody")
            .value("Stations", u.stations),
        Message::OwnPass(p) | Message::PeerPass(p) => {
            let e = e
                .value("Tag", p.tag)
                .value("StationId", p.station_id)
                .value("Intersection", p.intersection)
                .value("Leg", p.movement.leg)
                .value("Turn", (8 + p.movement.exit - p.movement.leg) % 8)
                .either("Left", p.left.map(f64::from), "none")
                .name("Zone", if p.is_before_zone { "before the zone" } else { "in the zone" })
                .name("ByHand", if p.is_by_hand { "yes" } else { "no" })
                .value("PassStamp", f64::from(p.stamp.0) / 100.0)
                .value("Arrival", f64::from(p.arrival) / 100.0);
            p.claims.iter().enumerate().fold(e, |e, (piece, claimed)| {
                let name = |signal: &str| format!("{signal}{}", piece + 1);
                let time = |time: Option<u16>| f64::from(time.unwrap_or(0)) / 100.0;
                e.value(&name("Claimed"), time(claimed.map(|claimed| claimed.at.0)))
                    .value(&name("Entry"), time(claimed.map(|claimed| claimed.entry.0)))
                    .either(&name("Length"), claimed.map(|claimed| time(Some(claimed.length))), "no window")
            })
        }
        Message::Command(c) => {
            let e = e
                .value("Acceleration", si!(c.acceleration))
                .name("Mode", mode(c.mode))
                .name("Limited", if c.limited { "changed by the envelope" } else { "as computed" })
                .value("Tick", c.tick)
                .name("Hold", if c.hold { "hold at standstill" } else { "no hold" })
                .value("Time", f64::from(c.time_ms) / 1e3);
            match c.effort {
                Effort::Force(newtons) => e.name("Effort", "force").value("Force", newtons),
                Effort::BrakeTorque(torque) => e.name("Effort", "brake torque").value("BrakeTorque", torque),
            }
        }
        Message::Estimate(t) => {
            let end = |of: fn(&holdover::wire::estimate::Ends) -> f64| t.ends.as_ref().map(of);
            e.value("Tag", t.tag)
                .value("Position", f64::from(t.position.mm()) / 1e3)
                .value("Speed", si!(t.speed))
                .value("Age", t.age.as_micros() as f64 / 1e6)
                .either("Behind", end(|ends| si!(ends.behind)), "no bound")
                .either("Ahead", end(|ends| si!(ends.ahead)), "no bound")
                .either("Slower", end(|ends| si!(ends.slower)), "no bound")
                .either("Faster", end(|ends| si!(ends.faster)), "no bound")
        }
        Message::Status(s) => e
            .name("Cause", s.cause.name())
            .value("Count", s.count)
            .name("Mode", mode(s.mode))
            .either("Detail", detail(s.detail).is_none().then_some(s.detail.into()), detail(s.detail).unwrap_or(""))
            .name("Synchronised", if s.synchronised { "GNSS time known" } else { "no GNSS time" })
            .value("LinksOn", s.links_on)
            .value("InterfaceVersion", s.interface),
    }
}

/// What the file calls the cause of a fallback or a fault.
fn detail(number: u8) -> Option<&'static str> {
    Some(match number {
        0 => "none",
        1 => "not associated",
        2 => "never heard",
        3 => "silent",
        4 => "range disagrees",
        5 => "request lost",
        8 => "driver brakes",
        9 => "driver accelerates",
        10 => "actuators not ready",
        16 => "ego missing",
        17 => "ego stale",
        _ => return None,
    })
}

/// The messages of the file that carry it.
fn names_of(message: &Message) -> Vec<String> {
    let two = |name: &str| vec![format!("{name}A"), format!("{name}B")];
    let of_said = |speaker: String, said: &Said| match said {
        Said::Motion(_) => two(&format!("{speaker}Motion")),
        Said::DrivingParameters(_) => vec![format!("{speaker}DrivingParameters")],
        Said::Horizon(_) => vec![format!("{speaker}Horizon")],
        Said::Geo(_) => vec![format!("{speaker}Position")],
        Said::Route(_) => vec![format!("{speaker}Route")],
        Said::State(_) => vec![format!("{speaker}State")],
    };
    match message {
        Message::Ego(said) => of_said("Ego".into(), said),
        Message::Own(said) => of_said("Own".into(), said),
        Message::Peer(Slot(slot), said) => of_said(format!("Peer{slot}"), said),
        Message::Sync(_) => vec!["TimeSync".into()],
        Message::FollowUp(_) => vec!["TimeFollowUp".into()],
        Message::DriverRequest(_) => vec!["DriverRequest".into()],
        Message::Actuators(_) => vec!["ActuatorState".into()],
        Message::Range(_) => vec!["RangeSensor".into()],
        Message::Unserved(_) => vec!["PeersUnserved".into()],
        Message::OwnPass(_) => vec!["OwnPass".into()],
        Message::PeerPass(_) => vec!["PeerPass".into()],
        Message::Command(_) => vec!["MotionCommand".into()],
        Message::Estimate(_) => two("TargetEstimate"),
        Message::Status(_) => vec!["Health".into()],
    }
}

fn are_as_meant(readings: &BTreeMap<String, Reading>, expected: &BTreeMap<String, Reading>) -> bool {
    assert_eq!(readings.keys().collect::<Vec<_>>(), expected.keys().collect::<Vec<_>>());
    readings.iter().all(|(name, reading)| match (reading, &expected[name]) {
        // a quantity is within half a word of its format of the decimal that it stands for
        (Reading::Value(read), Reading::Value(meant)) => (read - meant).abs() < 1e-6,
        (read, meant) => read == meant,
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]
    #[test]
    fn every_signal_of_every_message_reads_in_the_file_as_it_was_meant(message in prop_oneof![to_unit(8), from_unit()]) {
        let mut frames = Vec::new();
        Sender::<8>::new(Identifiers::DEFAULT).send(&message, &mut |frame| frames.push(frame)).unwrap();
        let (names, readings) = decoded(file(), &frames);
        let expected = expected_of(&message).0;
        prop_assert_eq!(names, names_of(&message));
        prop_assert!(are_as_meant(&readings, &expected));
    }

    #[test]
    fn every_signal_of_every_message_over_can_fd_reads_in_its_file_as_it_was_meant(
        message in prop_oneof![to_unit(8), from_unit()], motion in motion(), parameters in option::of(parameters()), horizon in option::of(knots()),
    ) {
        let state = |said: Said| match said {
            Said::Motion(_) | Said::DrivingParameters(_) | Said::Horizon(_) => Said::State(State { motion, parameters, horizon }),
            other => other,
        };
        let message = match message {
            Message::Peer(slot, said) => Message::Peer(slot, state(said)),
            Message::Own(said) => Message::Own(state(said)),
            other => other,
        };
        let mut frames = Vec::new();
        Sender::<8>::new(Identifiers::DEFAULT).over(Transport::Fd).send(&message, &mut |frame| frames.push(frame)).unwrap();
        let (names, mut readings) = decoded(file_fd(), &frames);
        let mut expected = expected_of(&message).0;
        expected.remove("Tag");
        // What is not there is not read.
        if readings.contains_key("HorizonValid") {
            readings.retain(|name, _| expected.contains_key(name));
        }
        let whole = |name: String| name.replace("EgoMotionA", "EgoMotion").replace("TargetEstimateA", "TargetEstimate");
        let meant: Vec<_> = names_of(&message).into_iter().map(whole).filter(|name| !name.ends_with('B')).collect();
        prop_assert_eq!(names, meant);
        prop_assert!(are_as_meant(&readings, &expected));
    }
}
