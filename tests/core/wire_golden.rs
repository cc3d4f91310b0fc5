//! One of each message as literal bytes: the layout cannot drift unnoticed. Who changes one of these changes what every
//! other node on the bus has to read.

use holdover::health::Cause;
use holdover::time::{Duration, Stamp};
use holdover::units::{Acceleration, Distance, FineSeconds, Fraction, Gain, Jerk, Seconds, Speed};
use holdover::wire::actuators::{ActuatorState, Control};
use holdover::wire::command::{Command, Effort, ModeCode};
use holdover::wire::driver_request::DriverRequest;
use holdover::wire::driving_parameters::{DrivingParameters, Limits};
use holdover::wire::estimate::{Ends, TargetEstimate};
use holdover::wire::geo::GeoPosition;
use holdover::wire::horizon::{Knot, Knots};
use holdover::wire::motion::{Motion, WirePosition};
use holdover::wire::pass::{Claimed, Pass, PassTime};
use holdover::wire::range_sensor::RangeSample;
use holdover::wire::route::Route;
use holdover::wire::status::Status;
use holdover::wire::sync::{FollowUp, Sync};
use holdover::wire::unserved::Unserved;
use holdover::wire::{Identifiers, Message, Movement, Predecessor, Said, Sender, Slot, StationHash};

fn m(mm: i32) -> Distance {
    Distance::from_mm(mm)
}

fn v(mm_per_s: i32) -> Speed {
    Speed::from_mm_per_s(mm_per_s)
}

fn a(mm_per_s2: i32) -> Acceleration {
    Acceleration::from_mm_per_s2(mm_per_s2)
}

fn motion() -> Said {
    Said::Motion(Motion {
        tag: 2,
        position: WirePosition::from_mm(-1_234_567),
        speed: v(13_400),
        acceleration: a(-1_500),
        demand: a(740),
        stamp: Stamp::from_raw(98_765),
        position_accuracy: Some(m(450)),
        speed_accuracy: None,
        station: StationHash(0xA7),
    })
}

fn parameters() -> Said {
    Said::DrivingParameters(DrivingParameters {
        length: m(4_800),
        standstill: m(2_000),
        predecessor: Predecessor::Station(StationHash(0x5C)),
        target_speed: v(11_000),
        catch_up: Fraction::from_milli(200),
        time_gap: Seconds::from_millis(1_000),
        gain: Gain::from_milli(450),
        damping: Seconds::from_millis(1_250),
        feed_forward: Fraction::from_milli(500),
        lag: FineSeconds::from_millis(300),
        limits: Limits {
            acceleration: a(2_500),
            braking: a(4_000),
            jerk: Jerk::from_mm_per_s3(5_000),
            emergency_braking: a(8_000),
        },
        horizon_tenths: 40,
    })
}

fn horizon() -> Said {
    let knot = |n: i32| Knot {
        displacement: m(9_000 * n),
        speed: v(12_000 - 500 * n),
        acceleration: a(-20 * n),
        bow: m(5 * n - 20),
    };
    Said::Horizon(Knots { tag: 2, knots: [knot(1), knot(2), knot(3), knot(4), knot(5)] })
}

fn geo() -> Said {
    Said::Geo(GeoPosition {
        tag: 3,
        latitude: 377_890_123,
        longitude: -1_223_945_678,
        heading: 10_807,
        stamp: Stamp::from_raw(54_321),
    })
}

fn route() -> Said {
    Said::Route(Route {
        tag: 1,
        intersection: 2,
        movement: Movement::straight(3),
        distance: m(-4_321),
        stamp: Stamp::from_raw(12_345),
        arrival: 987_654,
        predecessor: Predecessor::None,
    })
}

fn pass() -> Pass {
    let claimed = |at, entry, length| Some(Claimed { at: PassTime(at), entry: PassTime(entry), length });
    Pass {
        tag: 3,
        station_id: 0x1234_56C8,
        intersection: 201,
        movement: Movement::straight(5),
        left: Some(77),
        is_before_zone: true,
        is_by_hand: true,
        stamp: PassTime(12_345),
        arrival: 654_321,
        claims: [claimed(12_300, 13_000, 321), claimed(12_340, 13_321, 40)],
    }
}

#[test]
fn every_message_has_these_bytes() {
    let driver_request = DriverRequest {
        engaged: true,
        predecessor: Predecessor::Station(StationHash(0x5C)),
        target_speed: v(11_000),
        time_gap: None,
    };
    let range = RangeSample {
        distance: m(23_456),
        speed_difference: v(-1_250),
        distance_accuracy: m(250),
        speed_accuracy: v(300),
        age: Duration::from_millis(17),
        nobody: true,
    };
    let command = |effort| {
        Message::Command(Command {
            acceleration: a(-1_234),
            effort,
            mode: ModeCode::Holdover,
            limited: true,
            tick: 42,
            hold: true,
            time_ms: 777,
        })
    };
    let ends = Ends { behind: m(1_240), ahead: m(860), slower: v(1_400), faster: v(600) };
    let estimate = TargetEstimate {
        tag: 1,
        position: WirePosition::from_mm(7_654_321),
        speed: v(12_346),
        age: Duration::from_millis(1_234),
        ends: Some(ends),
    };
    let status = Status {
        cause: Cause::Torn,
        count: 1_234_567,
        mode: ModeCode::Cooperative,
        detail: 21,
        synchronised: true,
        links_on: 5,
        interface: 2,
    };
    let actuators =
        ActuatorState { control: Control::Driving, accelerator: true, brake: false, holding: true, tick: 42 };
    let messages = [
        Message::Sync(Sync { sequence: 11, seconds: 1_400_000_000 }),
        Message::FollowUp(FollowUp { sequence: 11, micros: 123_456 }),
        command(Effort::Force(3_456)),
        command(Effort::BrakeTorque(765)),
        Message::Ego(motion()),
        Message::DriverRequest(driver_request),
        Message::Actuators(actuators),
        Message::Ego(geo()),
        Message::Range(range),
        Message::Unserved(Unserved { intersection: 201, legs: 0b1000_0110, ahead: Some(m(-31_416)), stations: 17 }),
        Message::Estimate(estimate),
        Message::Own(motion()),
        Message::Own(horizon()),
        Message::Own(parameters()),
        Message::Own(geo()),
        Message::Own(route()),
        Message::Status(status),
        Message::Peer(Slot(7), motion()),
        Message::Peer(Slot(7), horizon()),
        Message::Peer(Slot(7), parameters()),
        Message::Peer(Slot(7), geo()),
        Message::Peer(Slot(7), route()),
        Message::OwnPass(pass()),
        Message::PeerPass(pass()),
    ];
    let mut sender = Sender::<8>::new(Identifiers::DEFAULT);
    let mut lines = Vec::new();
    for message in &messages {
        sender
            .send(message, &mut |frame| {
                let bytes: String = frame.data.iter().map(|byte| format!("{byte:02X}")).collect();
                lines.push(format!("{:03X}#{bytes}", frame.id.number()));
            })
            .unwrap();
    }
    let lines: Vec<_> = lines.iter().map(String::as_str).collect();
    assert_eq!(lines, GOLDEN);
}

/// In candump's notation.
#[rustfmt::skip]
const GOLDEN: &[&str] = &[
    "480#4AB0004E72530000",
    "481#EAB040E201000000",
    "482#5270D9AB0AB061C2",
    "482#0F71D9ABBA5F60C2",
    "484#F3605E4AFBE6C0A7",
    "485#B1208BA6F62548FC",
    "486#1D502EBECAFF0000",
    "483#8560550000000000",
    "487#A6B0A512434B0C35",
    "487#5071190986DB1B15",
    "488#4400BAC5637F9928",
    "489#5A0020422AFC86C9",
    "48A#1050EC329D0ECC00",
    "48B#F4509AF001568003",
    "490#64605E4AFBE6C0A7",
    "491#26208BA6F62548FC",
    "492#E1205046B0B3FCBF",
    "492#AD61A08CE0ABF8DF",
    "492#AEA2F0D210A4F4FF",
    "492#53E34019419CF01F",
    "492#D924915F7194EC3F",
    "493#4E10E0818C5C7C95",
    "493#1E51C80887385942",
    "493#9D927D2043066428",
    "494#17B0A512434B0C35",
    "494#E171190986DB1B15",
    "495#0E908FF79F036302",
    "495#C85103890F000000",
    "498#4B7070682D91BA40",
    "4F8#2F605E4AFBE6C0A7",
    "4F9#6D208BA6F62548FC",
    "4FA#AA205046B0B3FCBF",
    "4FA#E661A08CE0ABF8DF",
    "4FA#E5A2F0D210A4F4FF",
    "4FA#18E34019419CF01F",
    "4FA#9224915F7194EC3F",
    "4FB#0510E0818C5C7C95",
    "4FB#5551C80887385942",
    "4FB#D6927D2043066428",
    "4FC#5CB0A512434B0C35",
    "4FC#AA71190986DB1B15",
    "4FD#45908FF79F036302",
    "4FD#835103890F000000",
    "496#9B30C8563412C905",
    "496#F1713930F1FBD964",
    "496#81B20C30C8324101",
    "496#99F3343009342800",
    "497#FE30C8563412C905",
    "497#94713930F1FBD964",
    "497#E4B20C30C8324101",
    "497#FCF3343009342800",
];
