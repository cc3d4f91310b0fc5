//! The lines of the catalogue: each message's facts, once. The horizon, the motion and so on of the ego, the own vehicle and a peer
//! are lines of their own, which share their texts.

use super::About::{DrivingParameters, Geo, Horizon, MotionA, MotionB, Route};
use super::Content::Said;
use super::Node::{Modem, Unit, Vehicle};
use super::OnFd::{Follows, Frame, MayFollow};
use super::Speaker::{Ego, Own, Peer};
use super::{Content, Line};
use crate::wire::{
    actuators, command, driver_request, driving_parameters, estimate, geo, horizon, motion, pass, range_sensor, route,
    status, sync, unserved,
};

/// Lines of the catalogue.
pub const LINES: usize = 27;

#[allow(clippy::cast_possible_truncation)] // 5
const KNOTS: u8 = horizon::KNOTS as u8;

/// The catalogue, by offset.
pub static CATALOGUE: [Line; LINES] = [
    Line::new("TimeSync", 0x00, Content::Sync, Modem, sync::SYNC_FIELDS)
        .every(500, 5000)
        .says("First step of the time synchronisation: its reception is the instant that TimeFollowUp dates."),
    Line::new("TimeFollowUp", 0x01, Content::FollowUp, Modem, sync::FOLLOW_UP_FIELDS)
        .every(500, 5000)
        .says("Second step: the TimeSync with the same Sequence was on the bus at its Seconds plus Micros of GNSS time."),
    Line::new("MotionCommand", 0x02, Content::Command, Unit, command::FIELDS)
        .every(10, 50)
        .says("Effort selects Force (driving) or BrakeTorque (braking). Not to be used in Mode standby."),
    Line::new("ActuatorState", 0x03, Content::Actuators, Vehicle, actuators::FIELDS).every(20, 0).says(
        "What the actuators make of MotionCommand. Not needed: a unit that never hears it takes the actuators to be ready. Once heard, \
         what it said last holds; a pedal until DriverRequest.Engaged is off later than 200 ms after the last frame.",
    ),
    Line::new("EgoMotionA", 0x04, Said(Ego, MotionA), Vehicle, motion::FIELDS_A)
        .every(10, 50)
        .within(20, MOTION_10_MS)
        .says(EGO_MOTION)
        .fd(Frame("EgoMotion")),
    Line::new("EgoMotionB", 0x05, Said(Ego, MotionB), Vehicle, motion::FIELDS_B)
        .every(10, 50)
        .within(20, MOTION_10_MS)
        .says(EGO_MOTION)
        .fd(Follows),
    Line::new("DriverRequest", 0x06, Content::DriverRequest, Vehicle, driver_request::FIELDS)
        .every(100, 300)
        .says("What the driver or the planner wants."),
    Line::new("EgoPosition", 0x07, Said(Ego, Geo), Vehicle, geo::FIELDS)
        .every(100, 0)
        .only("on a route; without an itinerary the unit ignores it")
        .of(2)
        .within(50, TWO_FRAMES)
        .says("Its Stamp has to be within 50 ms of that of the newest EgoMotion: else it is refused (stale)."),
    Line::new("RangeSensor", 0x08, Content::Range, Vehicle, range_sensor::FIELDS)
        .every(20, 200)
        .only("while a sensor sees, no worse than the accuracies can say")
        .says("What a sensor on board sees of the nearest vehicle ahead, or how far it sees that none is there."),
    Line::new("PeersUnserved", 0x09, Content::Unserved, Modem, unserved::FIELDS)
        .every(200, 600)
        .only("on a route; without an itinerary the unit ignores it")
        .says(
            "Legs by which the next vehicle into the conflict area, or one that is in it, has no slot; Ahead is the way of the rear bumper \
             of the nearest one ahead that has none to the crossing point of the own leg; Stations counts all that come there and have none.",
        ),
    Line::new("TargetEstimateA", 0x0A, Content::EstimateA, Unit, estimate::FIELDS_A)
        .every(10, 50)
        .only(ESTIMATED)
        .within(20, ESTIMATE_FRAMES)
        .says(ESTIMATE)
        .fd(Frame("TargetEstimate")),
    Line::new("TargetEstimateB", 0x0B, Content::EstimateB, Unit, estimate::FIELDS_B)
        .every(10, 50)
        .only(ESTIMATED)
        .within(20, ESTIMATE_FRAMES)
        .says(ESTIMATE)
        .fd(Follows),
    Line::new("OwnMotionA", 0x10, Said(Own, MotionA), Unit, motion::FIELDS_A)
        .every(100, 300)
        .only(FRESH)
        .within(50, MOTION_100_MS)
        .says(MOTION)
        .fd(Frame("OwnState")),
    Line::new("OwnMotionB", 0x11, Said(Own, MotionB), Unit, motion::FIELDS_B)
        .every(100, 300)
        .only(FRESH)
        .within(50, MOTION_100_MS)
        .says(MOTION)
        .fd(Follows),
    Line::new("OwnHorizon", 0x12, Said(Own, Horizon), Unit, horizon::FIELDS)
        .every(100, 300)
        .only("in Mode cooperative and holdover, while EgoMotion comes in time")
        .of(KNOTS)
        .within(50, HORIZON_FRAMES)
        .says(HORIZON)
        .fd(MayFollow("HorizonValid")),
    Line::new("OwnDrivingParameters", 0x13, Said(Own, DrivingParameters), Unit, driving_parameters::FIELDS)
        .every(500, 1500)
        .only("while Mode is not standby and EgoMotion comes in time")
        .of(3)
        .within(50, THREE_FRAMES)
        .says(PARAMETERS)
        .fd(MayFollow("ParametersValid")),
    Line::new("OwnPosition", 0x14, Said(Own, Geo), Unit, geo::FIELDS)
        .of(2)
        .within(50, TWO_FRAMES)
        .says("Reserved: no unit of this version sends it."),
    Line::new("OwnRoute", 0x15, Said(Own, Route), Unit, route::FIELDS)
        .every(200, 600)
        .only(
            "on a route, as soon as the unit knows its place there and GNSS time, while EgoMotion comes in time",
        )
        .of(2)
        .within(50, TWO_FRAMES)
        .says(ROUTE),
    Line::new("OwnPass", 0x16, Content::Pass(Own), Unit, pass::FIELDS)
        .every(200, 600)
        .only("on a route, with the envelope engaged, as soon as the unit knows its place there and GNSS time, while EgoMotion comes in time")
        .of(4)
        .within(50, FOUR_FRAMES)
        .says(PASS),
    Line::new("PeerPass", 0x17, Content::Pass(Peer), Modem, pass::FIELDS)
        .every(25, 0)
        .only(
            "on a route; one message for each that was heard of a station that comes to the same intersection or has just left it, whether it \
             has a slot or not",
        )
        .of(4)
        .within(50, FOUR_FRAMES)
        .says(PASS),
    Line::new("Health", 0x18, Content::Status, Unit, status::FIELDS)
        .every(100, 300)
        .says("A page per cause, one after the other; Count stops at its largest value. Several causes are no refusals."),
    Line::new("Peer{slot}MotionA", 0x40, Said(Peer, MotionA), Modem, motion::FIELDS_A)
        .every(100, 250)
        .only(HEARD)
        .within(50, MOTION_100_MS)
        .says(MOTION)
        .fd(Frame("Peer{slot}State")),
    Line::new("Peer{slot}MotionB", 0x41, Said(Peer, MotionB), Modem, motion::FIELDS_B)
        .every(100, 250)
        .only(HEARD)
        .within(50, MOTION_100_MS)
        .says(MOTION)
        .fd(Follows),
    Line::new("Peer{slot}Horizon", 0x42, Said(Peer, Horizon), Modem, horizon::FIELDS)
        .every(100, 0)
        .only("while the station in this slot tells its horizon")
        .of(KNOTS)
        .within(50, HORIZON_FRAMES)
        .says(HORIZON)
        .fd(MayFollow("HorizonValid")),
    Line::new("Peer{slot}DrivingParameters", 0x43, Said(Peer, DrivingParameters), Modem, driving_parameters::FIELDS)
        .every(500, 0)
        .only("while the station in this slot is heard and tells them")
        .of(3)
        .within(50, THREE_FRAMES)
        .says(PARAMETERS)
        .fd(MayFollow("ParametersValid")),
    Line::new("Peer{slot}Position", 0x44, Said(Peer, Geo), Modem, geo::FIELDS)
        .every(100, 0)
        .only("on a route, while the station in this slot tells its position")
        .of(2)
        .within(50, TWO_FRAMES)
        .says("The unit ignores it without an itinerary, and for 2 s after a route of the same slot."),
    Line::new("Peer{slot}Route", 0x45, Said(Peer, Route), Modem, route::FIELDS)
        .every(200, 0)
        .only("while the station in this slot tells its route")
        .of(2)
        .within(50, TWO_FRAMES)
        .says(PEER_ROUTE),
];

const MOTION_10_MS: &str =
    "Frames A and B of the motion make one message: use both only if their Tag is the same and they come within 20 ms.";
const MOTION_100_MS: &str =
    "Frames A and B of the motion make one message: use both only if their Tag is the same and they come within 50 ms.";
const ESTIMATE_FRAMES: &str = "Frames A and B of the estimate make one message: use both only if their Tag is the same and they come within 20 ms.";
const HORIZON_FRAMES: &str =
    "5 frames of one Tag within 50 ms make one message; Tag is that of the motion it starts from.";
const THREE_FRAMES: &str = "3 frames of one Tag within 50 ms make one message.";
const FOUR_FRAMES: &str = "4 frames of one Tag within 50 ms make one message.";
const TWO_FRAMES: &str = "2 frames of one Tag within 50 ms make one message.";

const FRESH: &str = "while EgoMotion comes in time";
const HEARD: &str = "while the station in this slot is heard";
const ESTIMATED: &str = "with a target whose place is estimated";

const EGO_MOTION: &str =
    "The own vehicle's motion. Position is modulo 2^25 mm. Stamp is GNSS time modulo 2^17 of 0.1 ms.";
const MOTION: &str =
    "Position is modulo 2^25 mm: take the one nearest to your own. Stamp is GNSS time modulo 2^17 of 0.1 ms.";
const ESTIMATE: &str = "The bound has all four ends or none; ends are distances from the estimate, rounded up.";
const HORIZON: &str = "Part n is the state after \
    0.175, 0.375, 0.6, 0.8, 1 of HorizonLength of the driving parameters, from Stamp of the motion on; between them the way is a \
    quintic through position, speed and acceleration, plus Bow midway (64*Bow*s^3*(1-s)^3). At Speed 0 \
    Acceleration b tells when the vehicle came to rest: t = 12*D / (3*v + sqrt(9*v^2 + 12*(a-b)*D)) after part \
    n-1, whose speed and acceleration are v and a, on the way D between the two.";
const PARAMETERS: &str = "All limits are magnitudes.";
const ROUTE: &str = "Arrival is GNSS time modulo 2^20 of 10 ms.";
const PASS: &str = "Times are GNSS time modulo 655.36 s. A window is from Entry to Entry plus Length.";
const PEER_ROUTE: &str = "Arrival is GNSS time modulo 2^20 of 10 ms. Without an itinerary the unit ignores it.";
