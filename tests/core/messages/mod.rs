//! Random messages whose values all stand on the wire exactly; the ranges are written out here once more on purpose,
//! apart from the catalogue.

use holdover::health::Cause;
use holdover::time::{Duration, Stamp};
use holdover::units::{Acceleration, Distance, FineSeconds, Fraction, Gain, Jerk, Seconds, Speed};
use holdover::wire::actuators::{ActuatorState, Control};
use holdover::wire::command::{Command, Effort, ModeCode};
use holdover::wire::driver_request::DriverRequest;
use holdover::wire::driving_parameters::{DrivingParameters, Limits};
use holdover::wire::estimate::{Ends, TargetEstimate};
use holdover::wire::geo::GeoPosition;
use holdover::wire::horizon::{KNOTS, Knot, Knots};
use holdover::wire::motion::{Motion, WirePosition};
use holdover::wire::pass::{Claimed, Pass, PassTime};
use holdover::wire::quantity::Quantity;
use holdover::wire::range_sensor::RangeSample;
use holdover::wire::route::Route;
use holdover::wire::status::Status;
use holdover::wire::sync::{FollowUp, Sync};
use holdover::wire::unserved::Unserved;
use holdover::wire::{Message, Movement, Predecessor, Said, Slot, StationHash};
use proptest::option;
use proptest::prelude::*;

fn steps<Q: Quantity + std::fmt::Debug>(raw: std::ops::RangeInclusive<i64>, per_unit: i64) -> BoxedStrategy<Q> {
    let (low, high) = (*raw.start(), *raw.end());
    prop_oneof![8 => raw, 1 => Just(low), 1 => Just(high)].prop_map(move |raw| Q::from_steps(raw, per_unit)).boxed()
}

fn position() -> impl Strategy<Value = WirePosition> {
    (-(1i64 << 24)..1 << 24).prop_map(WirePosition::from_mm)
}

fn speed() -> BoxedStrategy<Speed> {
    steps(0..=32_767, 500)
}

fn acceleration() -> BoxedStrategy<Acceleration> {
    steps(-1023..=1023, 50)
}

fn stamp() -> impl Strategy<Value = Stamp> {
    (0u32..1 << 17).prop_map(Stamp::from_raw)
}

fn predecessor() -> impl Strategy<Value = Predecessor> {
    prop_oneof![
        Just(Predecessor::Unknown),
        Just(Predecessor::None),
        any::<u8>().prop_map(|hash| Predecessor::Station(StationHash(hash))),
    ]
}

fn mode() -> impl Strategy<Value = ModeCode> {
    use ModeCode::{Cooperative, Fallback, Fault, Holdover, Standby};
    proptest::sample::select(vec![Standby, Cooperative, Holdover, Fallback, Fault])
}

prop_compose! {
    pub fn motion()(
        tag in 0u8..4, position in position(), speed in speed(), acceleration in acceleration(), demand in acceleration(),
        stamp in stamp(), position_accuracy in option::of(steps(0..=126, 20)),
        speed_accuracy in option::of(steps(0..=62, 50)), station: u8,
    ) -> Motion {
        let station = StationHash(station);
        Motion { tag, position, speed, acceleration, demand, stamp, position_accuracy, speed_accuracy, station }
    }
}

prop_compose! {
    fn limits()(
        acceleration in steps(5..=1023, 50), braking in steps(0..=1023, 50), jerk in steps::<Jerk>(1..=1023, 20),
        emergency_braking in steps(5..=1023, 50),
    ) -> Limits {
        Limits { acceleration, braking, jerk, emergency_braking }
    }
}

prop_compose! {
    pub fn parameters()(
        length in steps(50..=4095, 100), standstill in steps(0..=1023, 100), predecessor in predecessor(),
        target_speed in speed(), catch_up in steps::<Fraction>(0..=15, 20),
        time_gap in steps(20..=799, 200), gain in steps::<Gain>(0..=3999, 1000),
        damping in steps(0..=3999, 1000), feed_forward in steps::<Fraction>(0..=1, 2), lag in steps::<FineSeconds>(0..=999, 500), limits in limits(),
        horizon_tenths: u8,
    ) -> DrivingParameters {
        DrivingParameters {
            length, standstill, predecessor, target_speed, catch_up, time_gap, gain, damping, feed_forward, lag, limits, horizon_tenths,
        }
    }
}

prop_compose! {
    fn knot()(
        displacement in steps(0..=262_143, 1000), speed in speed(), acceleration in acceleration(),
        bow in steps::<Distance>(-4..=3, 200),
    ) -> Knot {
        Knot { displacement, speed, acceleration, bow }
    }
}

pub fn knots() -> impl Strategy<Value = Knots> {
    (0u8..4, proptest::array::uniform::<_, KNOTS>(knot())).prop_map(|(tag, knots)| Knots { tag, knots })
}

prop_compose! {
    pub fn geo()(
        tag in 0u8..4, latitude in -900_000_000i32..=900_000_000, longitude in -1_800_000_000i32..=1_800_000_000,
        heading in 0u16..28_800, stamp in stamp(),
    ) -> GeoPosition {
        GeoPosition { tag, latitude, longitude, heading, stamp }
    }
}

prop_compose! {
    pub fn route()(
        tag in 0u8..4, intersection: u8, leg in 0u8..8, exit in 0u8..8, distance in steps(-1_048_575..=1_048_575, 1000),
        stamp in stamp(), arrival in 0u32..1 << 20, predecessor in predecessor(),
    ) -> Route {
        Route { tag, intersection, movement: Movement { leg, exit }, distance, stamp, arrival, predecessor }
    }
}

prop_compose! {
    pub fn driver_request()(
        engaged: bool, predecessor in predecessor(), target_speed in speed(),
        time_gap in option::of(steps::<Seconds>(20..=799, 200)),
    ) -> DriverRequest {
        DriverRequest { engaged, predecessor, target_speed, time_gap }
    }
}

prop_compose! {
    pub fn range_sample()(
        distance in steps(0..=262_143, 1000), speed_difference in steps(-32_767..=32_767, 500),
        distance_accuracy in steps(0..=31, 20), speed_accuracy in steps(0..=15, 10), age in 0i64..64,
        nobody: bool,
    ) -> RangeSample {
        RangeSample { distance, speed_difference, distance_accuracy, speed_accuracy, age: Duration::from_millis(age), nobody }
    }
}

prop_compose! {
    pub fn actuators()(
        control in proptest::sample::select(&[Control::Off, Control::Ready, Control::Driving, Control::Failed][..]),
        accelerator: bool, brake: bool, holding: bool, tick in 0u8..64,
    ) -> ActuatorState {
        ActuatorState { control, accelerator, brake, holding, tick }
    }
}

prop_compose! {
    pub fn command()(
        acceleration in steps(-8191..=8191, 500),
        effort in prop_oneof![
            (0u16..=65_534).prop_map(Effort::Force), (0u16..=65_534).prop_map(Effort::BrakeTorque),
        ],
        mode in mode(), limited: bool, tick in 0u8..64, hold: bool, time_ms in 0u16..1024,
    ) -> Command {
        Command { acceleration, effort, mode, limited, tick, hold, time_ms }
    }
}

prop_compose! {
    fn ends()(
        behind in steps(0..=16_382, 50), ahead in steps(0..=16_382, 50), slower in steps(0..=510, 5),
        faster in steps(0..=510, 5),
    ) -> Ends {
        Ends { behind, ahead, slower, faster }
    }
}

prop_compose! {
    pub fn estimate()(
        tag in 0u8..4, position in position(), speed in speed(), age in 0i64..=8190, ends in option::of(ends()),
    ) -> TargetEstimate {
        TargetEstimate { tag, position, speed, age: Duration::from_millis(2 * age), ends }
    }
}

prop_compose! {
    pub fn status()(
        cause in proptest::sample::select(&Cause::ALL[..]), count in 0u32..1 << 24, mode in mode(), detail in 0u8..32,
        synchronised: bool, links_on: u8, interface in 0u8..8,
    ) -> Status {
        Status { cause, count, mode, detail, synchronised, links_on, interface }
    }
}

prop_compose! {
    /// Every one that can be said.
    pub fn unserved()(
        intersection: u8, legs: u8, ahead in proptest::option::of(steps(-1_048_574..=1_048_574, 1000)), stations in 0u8..64,
    ) -> Unserved {
        Unserved { intersection, legs, ahead, stations }
    }
}

prop_compose! {
    fn claimed()(at: u16, entry: u16, length in 1u16..4096) -> Claimed {
        Claimed { at: PassTime(at), entry: PassTime(entry), length }
    }
}

prop_compose! {
    pub fn pass()(
        tag in 0u8..4, station_id: u32, intersection: u8, leg in 0u8..8, exit in 0u8..8, left in proptest::option::of(any::<u8>()),
        is_before_zone: bool, is_by_hand: bool, stamp: u16, arrival in 0u32..1 << 20, one in proptest::option::of(claimed()), other in proptest::option::of(claimed()),
    ) -> Pass {
        let movement = Movement { leg, exit };
        let stamp = PassTime(stamp);
        Pass { tag, station_id, intersection, movement, left, is_before_zone, is_by_hand, stamp, arrival, claims: [one, other] }
    }
}

/// What a vehicle says of itself.
pub fn said() -> impl Strategy<Value = Said> {
    prop_oneof![
        motion().prop_map(Said::Motion),
        parameters().prop_map(Said::DrivingParameters),
        knots().prop_map(Said::Horizon),
        geo().prop_map(Said::Geo),
        route().prop_map(Said::Route),
    ]
}

/// What the unit hears.
pub fn to_unit(slots: u8) -> impl Strategy<Value = Message> {
    prop_oneof![
        1 => (0u8..16, any::<u32>()).prop_map(|(sequence, seconds)| Message::Sync(Sync { sequence, seconds })),
        1 => (0u8..16, any::<u32>()).prop_map(|(sequence, micros)| Message::FollowUp(FollowUp { sequence, micros })),
        1 => motion().prop_map(|motion| Message::Ego(Said::Motion(motion))),
        1 => geo().prop_map(|position| Message::Ego(Said::Geo(position))),
        1 => driver_request().prop_map(Message::DriverRequest),
        1 => actuators().prop_map(Message::Actuators),
        1 => range_sample().prop_map(Message::Range),
        1 => unserved().prop_map(Message::Unserved),
        1 => pass().prop_map(Message::PeerPass),
        5 => (0..slots, said()).prop_map(|(slot, said)| Message::Peer(Slot(slot), said)),
    ]
}

/// What the unit says.
pub fn from_unit() -> impl Strategy<Value = Message> {
    prop_oneof![
        2 => said().prop_map(Message::Own),
        1 => pass().prop_map(Message::OwnPass),
        1 => command().prop_map(Message::Command),
        1 => estimate().prop_map(Message::Estimate),
        1 => status().prop_map(Message::Status),
    ]
}
