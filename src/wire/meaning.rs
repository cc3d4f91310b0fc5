//! What every signal means, once: the documentation of the messages' fields and the comments of the DBC are both made of it. A name
//! enters, its text leaves. An engineer with the DBC alone has to be able to build a node that is right.

use super::catalogue::{About, Content, Speaker};

/// The text of a meaning, as a literal, so that `#[doc = meaning!(…)]` can have it.
macro_rules! meaning {
    (tag) => { "Ties the frames of one message: all of them carry the same tag, which counts modulo 4 from message to message." };
    (position) => { "Front bumper along the lane, in the direction of travel, modulo 33554.432 m. Take the position nearest to your own." };
    (ego_position) => { "Own front bumper along the lane: it increases in the direction of travel, from the origin that the peers use (on a route each vehicle may have its own), modulo 33554.432 m." };
    (stamp) => { "GNSS time (seconds since 1980-01-06, without leap seconds) at which all of this message was true, modulo 13.1072 s." };
    (station) => { "Low 8 bits of the identity of the station whose state it is: the name by which PredecessorStation refers to it. Two stations may have the same one; each is known by its slot." };
    (ego_station) => { "The own station, as the unit is configured. Another value is counted (ego_station in Health), and the motion is used." };
    (speed) => { "Speed along the lane; a vehicle that rolls back says 0." };
    (acceleration) => { "Acceleration along the lane; braking is negative." };
    (demand) => { "The acceleration that was demanded last of the actuators, in force up to the stamp: from it the receiver foresees what the lag still brings. Without a command in force, the same as Acceleration." };
    (position_accuracy) => { "95 % of the errors of Position are below this. The receiver takes three times as much for certain. Not published: 5 m is taken for the largest error." };
    (speed_accuracy) => { "95 % of the errors of Speed are below this. The receiver takes three times as much for certain. Not published: 1.5 m/s is taken for the largest error." };
    (part) => { "Which frame of the message this is." };
    (displacement) => { "Way from Position of the motion of the same Tag to where the front bumper will be at this knot." };
    (displacement_fd) => { "Way from Position to where the front bumper will be at this knot." };
    (horizon_valid) => { "Whether a horizon is in this frame; where it is absent its signals are ignored." };
    (parameters_valid) => { "Whether driving parameters are in this frame: send them every 500 ms, and twice at once when they change. Where they are absent their signals are ignored, and the last ones hold." };
    (knot_speed) => { "Speed at this knot." };
    (knot_acceleration) => { "Acceleration at this knot. At Speed 0 it is that with which the vehicle came to rest since the knot before, and tells when (see the message)." };
    (bow) => { "How far the vehicle, midway in time since the knot before, is ahead of the quintic curve through the two knots." };
    (length) => { "Length of the vehicle, bumper to bumper, with what it tows." };
    (standstill) => { "Distance that it keeps at standstill to the rear bumper ahead." };
    (predecessor_kind) => { "Whether the vehicle follows a station (PredecessorStation), follows nobody and drives by TargetSpeed, or does not say (it drives by no law that it publishes; in DriverRequest: the order at the intersections decides)." };
    (predecessor_station) => { "Station of the vehicle that it follows, the nearest ahead of it with that name. Ignored unless PredecessorKind is station; 0 then." };
    (target_speed) => { "Speed wanted on a free road: a cap, which only CatchUp lets it exceed." };
    (catch_up) => { "Share of TargetSpeed by which it exceeds that speed, at most, to catch up with the vehicle that it follows." };
    (time_gap) => { "Time gap that it keeps to the rear bumper ahead, beside Standstill. Less than 0.1 s is reserved: 0 is not a value." };
    (gain) => { "Gain k of the law u = -k (gap error + Damping times the speed difference)." };
    (feed_forward) => { "Share of the predecessor's acceleration that the law adds to what gap and speeds ask for." };
    (damping) => { "Weight of the speed difference in the law, in seconds." };
    (lag) => { "Time constant of its actuators: how its acceleration follows the demand." };
    (acceleration_limit) => { "Largest acceleration that it demands; also the hardest that it is capable of, which others' safety rests on. Publish a harder one 10 s before it is used." };
    (braking_limit) => { "Hardest braking that it demands in normal driving, as a magnitude." };
    (jerk_limit) => { "Fastest change of its demand in normal driving." };
    (emergency_braking) => { "Hardest braking that it is capable of, as a magnitude. Others' safety rests on its never being more. Publish a harder one 10 s before it is used." };
    (horizon_length) => { "How far ahead in time the horizon reaches that it sends; 0: it sends none." };
    (latitude) => { "Degrees north of the front bumper's middle, WGS 84." };
    (longitude) => { "Degrees east of the front bumper's middle, WGS 84." };
    (heading) => { "Degrees clockwise from true north into which the vehicle points. A vehicle that is turned away from a street by more than 60 degrees is not on that street." };
    (route_distance) => { "Way of the front bumper to the crossing point of its leg at Stamp; negative beyond it." };
    (leg) => { "Leg of the intersection by which it comes, by the numbers of the route data." };
    (turn) => { "Its exit there: the number of the exit less that of the leg, modulo 8; 0 is straight on." };
    (intersection) => { "Number of the intersection in the route data." };
    (arrival) => { "GNSS time since which it comes to the intersection, modulo 10485.76 s; later where it has yielded. It decides the order: earlier goes first." };
    (claim_kind) => { "Whether it takes a station (PredecessorStation) to be just ahead of it in the order, of those whose ways conflict with its own or that are ahead on its leg, takes itself for the first, or does not say." };
    (claim_station) => { "Station that it takes to be just ahead of it in that order. Ignored unless PredecessorKind is station; 0 then." };
    (engaged) => { "Whether the unit shall drive. Send 0 as soon as the driver takes over. 300 ms without a DriverRequest and the unit hands back (Detail request lost)." };
    (request_target_speed) => { "Set speed: a cap. The unit exceeds it only by the share that is configured to catch up, 0 by default." };
    (request_time_gap) => { "Time gap to keep to the rear bumper ahead, beside the configured distance at standstill. Less than 0.1 s is reserved: 0 is refused. So is more than 3.995 s but for the code." };
    (range_distance) => { "Own front bumper to the rear bumper of the nearest vehicle on the own path; with Nobody, as far as the sensor sees that none is there." };
    (speed_difference) => { "Speed of that vehicle less the own speed: negative where the own vehicle closes in." };
    (distance_accuracy) => { "95 % of the errors of Distance are below this. Do not send a view that is worse than can be said." };
    (range_speed_accuracy) => { "95 % of the errors of SpeedDifference are below this. Do not send a view that is worse than can be said." };
    (range_age) => { "How old the measurement was when the frame was handed to the CAN controller, rounded up. Do not send a measurement older than 63 ms. The frame has to have ended on the bus 3 ms after that." };
    (range_nobody) => { "Whether no vehicle is nearer than Distance on the own path, the next conflict area included. Send it only for an instant since which several views have shown none, and not while the sensor may be blind." };
    (legs) => { "Legs by which the next vehicle into the conflict area, or one that is in it, has no slot: bit n is leg n." };
    (unserved_ahead) => { "Way of the rear bumper of the nearest vehicle without a slot ahead on the own leg to the crossing point of that leg at Intersection, which is the next one on the own way: any other is ignored. Negative beyond the crossing point." };
    (stations) => { "How many stations that come to the same intersection have no slot, 63 for more." };
    (station_id) => { "The whole identity of the station, of which Station is the low 8 bits." };
    (left) => { "Number of the intersection that the vehicle left last; none if it has left none on its way." };
    (zone) => { "Where the vehicle is, by the zone of Intersection. Before the zone it claims nothing, whatever the windows say, and its claims in the zone are those of a newcomer." };
    (by_hand) => { "Whether a person drives, or has handed the vehicle back too near to an area to stop before it. It then claims nothing more. What it has claimed is honoured until it is over, but nobody who can still stop relies on it." };
    (pass_stamp) => { "GNSS time up to which the vehicle says all that it claims: no window that it claims later counts from before that. Modulo 655.36 s." };
    (claimed) => { "GNSS time from which the window counts. Of two windows that conflict, that with the earlier one has priority, then that of the smaller StationId. Modulo 655.36 s." };
    (entry) => { "GNSS time before which the vehicle's front does not enter the conflict area. Modulo 655.36 s." };
    (pass_length) => { "Time from then to when the vehicle's rear has left the conflict area. 0: no window." };
    (sequence) => { "Ties TimeSync and TimeFollowUp: the same in both, and counts modulo 16." };
    (seconds) => { "Whole seconds of GNSS time (since 1980-01-06, without leap seconds) of the sending of this frame, as far as known beforehand." };
    (micros) => { "What to add to TimeSync.Seconds to get the GNSS time at which the TimeSync with this Sequence was on the bus." };
    (command_acceleration) => { "Demanded acceleration; braking is negative. Not to be used in Mode standby." };
    (hold) => { "Asks the brakes to hold the vehicle: it stands and is to go on standing. 0 in standby: the driver holds the vehicle." };
    (time) => { "Time from the unit's first period to this one by its own clock, modulo 1.024 s: frames that waited on their way are as far apart by it as they were made." };
    (control) => { "Whether the actuators take the unit's commands. Off and failed make the unit stand by (Detail actuators not ready)." };
    (accelerator) => { "Whether the driver presses the accelerator pedal: the unit stands by for as long (Detail driver accelerates)." };
    (brake) => { "Whether the driver presses the brake pedal: the unit stands by at once (Detail driver brakes), and until DriverRequest.Engaged was 0 once." };
    (holding) => { "Whether the brakes hold the vehicle at standstill, as MotionCommand.Hold asks." };
    (acknowledged) => { "Tick of the newest MotionCommand that is in force." };
    (effort) => { "Whether Force or BrakeTorque stands in the frame." };
    (force) => { "Net engine force that brings the acceleration about, by the configured vehicle model. The largest value means that force or more." };
    (brake_torque) => { "Brake torque that brings the acceleration about, by the configured vehicle model. The largest value means that torque or more." };
    (mode) => { "How the unit drives: standby (not at all), cooperative, holdover (by the estimate), fallback (by what is certain), fault (it brakes)." };
    (limited) => { "Whether the envelope, the last gate, changed the command." };
    (tick) => { "Counts the unit's periods modulo 64: a command that does not count on is an old one." };
    (estimate_position) => { "Where the front bumper of the target is now, as estimated; modulo 33554.432 m. Take the position nearest to your own." };
    (estimate_speed) => { "Speed of the target now, as estimated." };
    (age) => { "Age of the newest sample that the estimate rests on, rounded up." };
    (behind) => { "How far behind Position the target may be, at most." };
    (ahead) => { "How far ahead of Position the target may be, at most." };
    (slower) => { "How much slower than Speed the target may be, at most." };
    (faster) => { "How much faster than Speed the target may be, at most." };
    (cause) => { "The cause that this page counts; the message's comment says what each means." };
    (count) => { "How often the cause was met since start; it stops at its largest value." };
    (detail) => { "Why the unit is in fallback or fault; in standby, why a unit that is asked to drive does not (8 to 10); otherwise none. Other numbers are reserved." };
    (synchronised) => { "Whether the unit knows GNSS time." };
    (links_on) => { "Number of peers whose messages come in time." };
    (interface) => { "Version of the interface that the unit speaks. A node built for another one than the InterfaceVersion of its DBC file may misread signals." };
}

pub(super) use meaning;

/// Of the end-to-end checksum and counter, which every frame has.
pub(super) const fn header(is_over_fd: bool) -> [&'static str; 2] {
    if is_over_fd { [CRC_FD, COUNTER_FD] } else { [CRC, COUNTER] }
}

const CRC: &str = "End-to-end checksum, AUTOSAR Profile 1A: CRC-8 (polynomial 0x1D, start and final xor 0) over E2EDataId, low byte first, and bytes 1 to 7.";
const COUNTER: &str = "End-to-end counter: counts 0 to 14 and begins again, over all frames of this identifier.";
const CRC_FD: &str = "End-to-end checksum, AUTOSAR Profile 5: CRC-16 (polynomial 0x1021, start 0xFFFF, final xor 0) over all bytes after it and then E2EDataId, low byte first.";
const COUNTER_FD: &str = "End-to-end counter: counts 0 to 255 and begins again, over all frames of this identifier.";

/// What a signal of a message means; empty for a signal that there is not.
#[must_use]
pub fn signal(content: Content, name: &str, is_over_fd: bool) -> &'static str {
    match (content, name) {
        (_, "HorizonValid") => meaning!(horizon_valid),
        (_, "ParametersValid") => meaning!(parameters_valid),
        (Content::Said(_, About::Horizon), "Displacement") if is_over_fd => meaning!(displacement_fd),
        _ => field(content, name),
    }
}

fn field(content: Content, name: &str) -> &'static str {
    match content {
        Content::Sync | Content::FollowUp => match name {
            "Sequence" => meaning!(sequence),
            "Seconds" => meaning!(seconds),
            "Micros" => meaning!(micros),
            _ => "",
        },
        Content::Command => match name {
            "Acceleration" => meaning!(command_acceleration),
            "Mode" => meaning!(mode),
            "Limited" => meaning!(limited),
            "Tick" => meaning!(tick),
            "Hold" => meaning!(hold),
            "Time" => meaning!(time),
            "Effort" => meaning!(effort),
            "Force" => meaning!(force),
            "BrakeTorque" => meaning!(brake_torque),
            _ => "",
        },
        Content::Actuators => match name {
            "Control" => meaning!(control),
            "Accelerator" => meaning!(accelerator),
            "Brake" => meaning!(brake),
            "Holding" => meaning!(holding),
            "Tick" => meaning!(acknowledged),
            _ => "",
        },
        Content::DriverRequest => match name {
            "Engaged" => meaning!(engaged),
            "PredecessorKind" => meaning!(predecessor_kind),
            "PredecessorStation" => meaning!(predecessor_station),
            "TargetSpeed" => meaning!(request_target_speed),
            "TimeGap" => meaning!(request_time_gap),
            _ => "",
        },
        Content::Range => match name {
            "Distance" => meaning!(range_distance),
            "SpeedDifference" => meaning!(speed_difference),
            "DistanceAccuracy" => meaning!(distance_accuracy),
            "SpeedAccuracy" => meaning!(range_speed_accuracy),
            "Age" => meaning!(range_age),
            "Nobody" => meaning!(range_nobody),
            _ => "",
        },
        Content::Unserved => match name {
            "Stations" => meaning!(stations),
            "Ahead" => meaning!(unserved_ahead),
            "Legs" => meaning!(legs),
            "Intersection" => meaning!(intersection),
            _ => "",
        },
        Content::Pass(_) => match name {
            "Tag" => meaning!(tag),
            "Part" => meaning!(part),
            "StationId" => meaning!(station_id),
            "Arrival" => meaning!(arrival),
            "Intersection" => meaning!(intersection),
            "Leg" => meaning!(leg),
            "Turn" => meaning!(turn),
            "Left" => meaning!(left),
            "Zone" => meaning!(zone),
            "ByHand" => meaning!(by_hand),
            "PassStamp" => meaning!(pass_stamp),
            "Claimed1" | "Claimed2" => meaning!(claimed),
            "Entry1" | "Entry2" => meaning!(entry),
            "Length1" | "Length2" => meaning!(pass_length),
            _ => "",
        },
        Content::EstimateA | Content::EstimateB => match name {
            "Tag" => meaning!(tag),
            "Position" => meaning!(estimate_position),
            "Speed" => meaning!(estimate_speed),
            "Age" => meaning!(age),
            "Behind" => meaning!(behind),
            "Ahead" => meaning!(ahead),
            "Slower" => meaning!(slower),
            "Faster" => meaning!(faster),
            _ => "",
        },
        Content::Status => match name {
            "Cause" => meaning!(cause),
            "Count" => meaning!(count),
            "Mode" => meaning!(mode),
            "Detail" => meaning!(detail),
            "Synchronised" => meaning!(synchronised),
            "LinksOn" => meaning!(links_on),
            "InterfaceVersion" => meaning!(interface),
            _ => "",
        },
        Content::Said(speaker, about) => said(speaker, about, name),
    }
}

fn said(speaker: Speaker, about: About, name: &str) -> &'static str {
    match (about, name) {
        (_, "Tag") => meaning!(tag),
        (_, "Part") => meaning!(part),
        (_, "Stamp") => meaning!(stamp),
        (About::MotionA, "Position") if matches!(speaker, Speaker::Ego) => meaning!(ego_position),
        (About::MotionA, "Position") => meaning!(position),
        (About::MotionA, "Station") if matches!(speaker, Speaker::Ego) => meaning!(ego_station),
        (About::MotionA, "Station") => meaning!(station),
        (About::MotionB, "Speed") => meaning!(speed),
        (About::MotionB, "Acceleration") => meaning!(acceleration),
        (About::MotionB, "Demand") => meaning!(demand),
        (About::MotionB, "PositionAccuracy") => meaning!(position_accuracy),
        (About::MotionB, "SpeedAccuracy") => meaning!(speed_accuracy),
        (About::Horizon, "Displacement") => meaning!(displacement),
        (About::Horizon, "Speed") => meaning!(knot_speed),
        (About::Horizon, "Acceleration") => meaning!(knot_acceleration),
        (About::Horizon, "Bow") => meaning!(bow),
        (About::Geo, "Latitude") => meaning!(latitude),
        (About::Geo, "Longitude") => meaning!(longitude),
        (About::Geo, "Heading") => meaning!(heading),
        (About::Route, "Distance") => meaning!(route_distance),
        (About::Route, "Leg") => meaning!(leg),
        (About::Route, "Turn") => meaning!(turn),
        (About::Route, "Intersection") => meaning!(intersection),
        (About::Route, "Arrival") => meaning!(arrival),
        (About::Route, "PredecessorKind") => meaning!(claim_kind),
        (About::Route, "PredecessorStation") => meaning!(claim_station),
        (About::DrivingParameters, name) => parameters(name),
        _ => "",
    }
}

fn parameters(name: &str) -> &'static str {
    match name {
        "Length" => meaning!(length),
        "Standstill" => meaning!(standstill),
        "PredecessorKind" => meaning!(predecessor_kind),
        "PredecessorStation" => meaning!(predecessor_station),
        "TargetSpeed" => meaning!(target_speed),
        "TimeGap" => meaning!(time_gap),
        "Gain" => meaning!(gain),
        "Damping" => meaning!(damping),
        "FeedForward" => meaning!(feed_forward),
        "Lag" => meaning!(lag),
        "CatchUp" => meaning!(catch_up),
        "AccelerationLimit" => meaning!(acceleration_limit),
        "BrakingLimit" => meaning!(braking_limit),
        "JerkLimit" => meaning!(jerk_limit),
        "EmergencyBraking" => meaning!(emergency_braking),
        "HorizonLength" => meaning!(horizon_length),
        _ => "",
    }
}
