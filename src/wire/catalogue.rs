//! The message catalogue: every identifier of the unit's bus with its sender, times, E2E parameters and fields. An
//! identifier enters and its line leaves; receiver, sender, DBC and bus load all read the one table.
//!
//! Identifiers are `base + offset`, unless [`super::Identifiers`] places them elsewhere; the low ones win the bus. Peers have [`SLOT_STRIDE`] identifiers a slot. The E2E
//! data id is [`DATA_ID_BASE`] `+ offset`, whatever the base: within the block all data ids differ in the low byte, over
//! which the CRC is one to one, so a frame that strays to another identifier of the block never passes.

use super::e2e::Limits;
use super::field::{Field, Place};
use super::index;
use super::{
    Slot, actuators, command, driver_request, driving_parameters, estimate, geo, horizon, motion, range_sensor, route,
    status, sync, unserved,
};

/// Identifiers that the catalogue takes up, from the base on.
pub const BLOCK: u16 = 0xC0;
/// Offset of slot 0's first identifier.
pub const PEERS_OFFSET: u16 = 0x40;
/// Identifiers per slot.
pub const SLOT_STRIDE: u16 = 8;
/// Slots that there are identifiers for.
pub const SLOTS: u16 = 16;
/// E2E data id of offset 0.
pub const DATA_ID_BASE: u16 = 0x4800;

const _: () = assert!(PEERS_OFFSET + SLOTS * SLOT_STRIDE == BLOCK);
const _: () = assert!(DATA_ID_BASE & 0xFF == 0 && BLOCK <= 0x100, "data ids differ in the low byte");

/// What every identifier tolerates: two frames lost in a row; three repetitions; one good frame after a gap. Fewer than
/// four may be missing, because tags count modulo 4.
pub const LIMITS: Limits = Limits { max_delta_counter_init: 2, max_no_new_or_repeated: 3, sync_counter_init: 1 };

const _: () = assert!(LIMITS.max_delta_counter_init + 1 < 4, "a tag must not come round within a tolerated gap");

/// Who sends a message on the bus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Node {
    /// This unit.
    Unit,
    /// The V2X modem.
    Modem,
    /// The vehicle's own sensors, driver's desk and planner.
    Vehicle,
}

/// Who is spoken of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Speaker {
    /// The vehicle, to its unit.
    Ego,
    /// The vehicle, through its unit, to the others.
    Own,
    /// Another vehicle, through the modem.
    Peer,
}

/// Which frame of what a vehicle says of itself; the number is the place in a slot's block of identifiers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum About {
    /// First frame of its motion.
    MotionA = 0,
    /// Second frame of its motion.
    MotionB = 1,
    /// Its horizon.
    Horizon = 2,
    /// Its driving parameters.
    DrivingParameters = 3,
    /// Its place on the globe.
    Geo = 4,
    /// Its place on its route.
    Route = 5,
}

/// Frames about a vehicle.
pub const ABOUTS: usize = 6;

/// What stands on an identifier.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Content {
    /// [`sync::Sync`].
    Sync,
    /// [`sync::FollowUp`].
    FollowUp,
    /// [`command::Command`].
    Command,
    /// [`driver_request::DriverRequest`].
    DriverRequest,
    /// [`actuators::ActuatorState`].
    Actuators,
    /// [`range_sensor::RangeSample`].
    Range,
    /// [`unserved::Unserved`].
    Unserved,
    /// First frame of [`estimate::TargetEstimate`].
    EstimateA,
    /// Its second frame.
    EstimateB,
    /// [`status::Status`].
    Status,
    /// Something about a vehicle.
    Said(Speaker, About),
}

impl Content {
    /// Whether every slot has one.
    #[must_use]
    pub const fn is_per_slot(self) -> bool {
        matches!(self, Self::Said(Speaker::Peer, _))
    }

    /// The offset for this slot, from that of slot 0.
    pub(super) const fn offset_for(self, first: u16, slot: Slot) -> u16 {
        first.wrapping_add(if self.is_per_slot() { SLOT_STRIDE.wrapping_mul(slot.0 as u16) } else { 0 })
    }
}

/// One line of the catalogue.
#[derive(Clone, Copy, Debug)]
pub struct Line {
    /// Its name; a peer's has `{slot}` where the slot's number goes in the DBC.
    pub name: &'static str,
    /// What it carries.
    pub content: Content,
    /// Offset from the base; of slot 0 for a peer's.
    pub offset: u16,
    /// Who sends it.
    pub sender: Node,
    /// How often the message is sent.
    pub cycle_ms: u16,
    /// Without it for this long, it counts as missing; 0: what it said last holds.
    pub timeout_ms: u16,
    /// Frames on this identifier in every cycle.
    pub frames: u8,
    /// All frames of one message come within this; 0 where it has but one.
    pub within_ms: u16,
    /// The fields of all its frames.
    pub fields: &'static [Field],
    /// Rules for readers of the DBC.
    pub comment: &'static str,
}

impl Line {
    /// Whether every slot has one.
    #[must_use]
    pub const fn is_per_slot(&self) -> bool {
        self.content.is_per_slot()
    }

    /// What its receiver tolerates.
    #[must_use]
    pub const fn limits(&self) -> &'static Limits {
        &LIMITS
    }

    /// The field that tells the parts apart.
    #[must_use]
    pub fn selector(&self) -> Option<&'static Field> {
        self.fields.iter().find(|field| field.place == Place::Selector)
    }

    /// Its offset for this slot (slot 0 where there are none).
    #[must_use]
    pub const fn offset_for(&self, slot: Slot) -> u16 {
        self.content.offset_for(self.offset, slot)
    }
}

/// The E2E data id of an offset.
#[must_use]
pub const fn data_id(offset: u16) -> u16 {
    DATA_ID_BASE.wrapping_add(offset)
}

const fn line(name: &'static str, offset: u16, content: Content, sender: Node, fields: &'static [Field]) -> Line {
    let (cycle_ms, timeout_ms, frames) = timing(content);
    let (within_ms, comment) = (within(content), comment(content));
    Line { name, content, offset, sender, cycle_ms, timeout_ms, frames, within_ms, fields, comment }
}

/// Cycle, timeout and frames per cycle. The timeout of what the unit receives is that after which it reacts, by the default
/// configuration, and 0 where no loss of that message alone has a reaction of its own: what was said last holds. The timeout of
/// what it sends is 5 cycles of what comes every 10 ms, else 3.
#[allow(clippy::cast_possible_truncation)] // 5 knots
const fn timing(content: Content) -> (u16, u16, u8) {
    match content {
        Content::Sync | Content::FollowUp => (500, 5000, 1),
        Content::Command | Content::EstimateA | Content::EstimateB => (10, 50, 1),
        Content::Said(Speaker::Ego, About::MotionA | About::MotionB) => (10, 50, 1),
        Content::Range => (20, 200, 1),
        Content::Unserved => (200, 600, 1),
        Content::Actuators => (20, 0, 1),
        Content::DriverRequest | Content::Status => (100, 300, 1),
        Content::Said(Speaker::Peer, About::MotionA | About::MotionB) => (100, 250, 1),
        Content::Said(_, About::MotionA | About::MotionB) => (100, 300, 1),
        Content::Said(speaker, About::Horizon) => (100, held(speaker, 300), horizon::KNOTS as u8),
        Content::Said(speaker, About::Geo) => (100, held(speaker, 300), 2),
        Content::Said(speaker, About::DrivingParameters) => (500, held(speaker, 1500), 3),
        Content::Said(speaker, About::Route) => (200, held(speaker, 600), 2),
    }
}

/// No timeout of what the unit receives.
const fn held(speaker: Speaker, timeout_ms: u16) -> u16 {
    if matches!(speaker, Speaker::Own) { timeout_ms } else { 0 }
}

/// How far apart the frames of one message may come: half of what a tag takes to come round, four cycles, where the cycle is
/// 10 ms, and half a cycle, which is more than a bus ever holds them back, where it is longer.
const fn within(content: Content) -> u16 {
    match content {
        Content::Sync
        | Content::FollowUp
        | Content::Command
        | Content::DriverRequest
        | Content::Actuators
        | Content::Range
        | Content::Unserved
        | Content::Status => 0,
        Content::EstimateA | Content::EstimateB => 20,
        Content::Said(Speaker::Ego, About::MotionA | About::MotionB) => 20,
        Content::Said(..) => 50,
    }
}

const fn comment(content: Content) -> &'static str {
    match content {
        Content::Sync => "First step of the time synchronisation: its reception is the instant that FollowUp dates.",
        Content::FollowUp => {
            "Second step: the Sync with the same Sequence was on the bus at Sync.Seconds plus Micros of GNSS time."
        }
        Content::Command => "Effort selects Force (driving) or BrakeTorque (braking). Not to be used in Mode standby.",
        Content::DriverRequest => "What the driver or the planner wants.",
        Content::Actuators => {
            "What the actuators make of MotionCommand. Not needed: a unit that never hears it takes the actuators to be ready. Once heard, \
             what it said last holds."
        }
        Content::Range => "Not sent while nothing is measured ahead, or worse than the accuracies can say.",
        Content::Unserved => {
            "Sent on a route only. Legs by which the next vehicle into the conflict area, or one that is in it, has no slot; Ahead is the way of \
             the rear bumper of the nearest one ahead that has none to the crossing point; Stations counts all without one that could be met."
        }
        Content::EstimateA | Content::EstimateB => {
            "TargetEstimateA and B make one message: use both only if their Tag is the same and they come within 20 ms. The bound has all four ends \
             or none; ends are distances from the estimate, rounded up."
        }
        Content::Status => "A page per cause of refusal, one after the other.",
        Content::Said(Speaker::Ego, About::MotionA | About::MotionB) => {
            "MotionA and MotionB make one message: use both only if their Tag is the same and they come within 20 ms. \
             Position is modulo 2^25 mm: take the one nearest to your own. Stamp is GNSS time modulo 2^17 of 0.1 ms."
        }
        Content::Said(_, About::MotionA | About::MotionB) => {
            "MotionA and MotionB make one message: use both only if their Tag is the same and they come within 50 ms. \
             Position is modulo 2^25 mm: take the one nearest to your own. Stamp is GNSS time modulo 2^17 of 0.1 ms."
        }
        Content::Said(_, About::Horizon) => {
            "5 frames of one Tag within 50 ms make one message; Tag is that of the Motion it starts from. Part n is the state after \
             0.175, 0.375, 0.6, 0.8, 1 of HorizonLength (see DrivingParameters) after that Motion's Stamp; between them the way is a \
             quintic through position, speed and acceleration, plus Bow midway (64*Bow*s^3*(1-s)^3). At Speed 0 \
             Acceleration b tells when the vehicle came to rest: t = 12*D / (3*v + sqrt(9*v^2 + 12*(a-b)*D)) after part \
             n-1, whose speed and acceleration are v and a, on the way D between the two."
        }
        Content::Said(_, About::DrivingParameters) => {
            "3 frames of one Tag within 50 ms make one message. All limits are magnitudes."
        }
        Content::Said(_, About::Geo) => "2 frames of one Tag within 50 ms make one message.",
        Content::Said(_, About::Route) => {
            "2 frames of one Tag within 50 ms make one message. Arrival is GNSS time modulo 2^20 of 10 ms."
        }
    }
}

use About::{DrivingParameters, Geo, Horizon, MotionA, MotionB, Route};
use Node::{Modem, Unit, Vehicle};
use Speaker::{Ego, Own, Peer};

/// Lines of the catalogue.
pub const LINES: usize = 25;

/// The catalogue, by offset.
pub static CATALOGUE: [Line; LINES] = [
    line("TimeSync", 0x00, Content::Sync, Modem, sync::SYNC_FIELDS),
    line("TimeFollowUp", 0x01, Content::FollowUp, Modem, sync::FOLLOW_UP_FIELDS),
    line("MotionCommand", 0x02, Content::Command, Unit, command::FIELDS),
    line("ActuatorState", 0x03, Content::Actuators, Vehicle, actuators::FIELDS),
    line("EgoMotionA", 0x04, Content::Said(Ego, MotionA), Vehicle, motion::FIELDS_A),
    line("EgoMotionB", 0x05, Content::Said(Ego, MotionB), Vehicle, motion::FIELDS_B),
    line("DriverRequest", 0x06, Content::DriverRequest, Vehicle, driver_request::FIELDS),
    line("EgoPosition", 0x07, Content::Said(Ego, Geo), Vehicle, geo::FIELDS),
    line("RangeSensor", 0x08, Content::Range, Vehicle, range_sensor::FIELDS),
    line("PeersUnserved", 0x09, Content::Unserved, Modem, unserved::FIELDS),
    line("TargetEstimateA", 0x0A, Content::EstimateA, Unit, estimate::FIELDS_A),
    line("TargetEstimateB", 0x0B, Content::EstimateB, Unit, estimate::FIELDS_B),
    line("OwnMotionA", 0x10, Content::Said(Own, MotionA), Unit, motion::FIELDS_A),
    line("OwnMotionB", 0x11, Content::Said(Own, MotionB), Unit, motion::FIELDS_B),
    line("OwnHorizon", 0x12, Content::Said(Own, Horizon), Unit, horizon::FIELDS),
    line("OwnDrivingParameters", 0x13, Content::Said(Own, DrivingParameters), Unit, driving_parameters::FIELDS),
    line("OwnPosition", 0x14, Content::Said(Own, Geo), Unit, geo::FIELDS),
    line("OwnRoute", 0x15, Content::Said(Own, Route), Unit, route::FIELDS),
    line("Health", 0x18, Content::Status, Unit, status::FIELDS),
    line("Peer{slot}MotionA", 0x40, Content::Said(Peer, MotionA), Modem, motion::FIELDS_A),
    line("Peer{slot}MotionB", 0x41, Content::Said(Peer, MotionB), Modem, motion::FIELDS_B),
    line("Peer{slot}Horizon", 0x42, Content::Said(Peer, Horizon), Modem, horizon::FIELDS),
    line(
        "Peer{slot}DrivingParameters",
        0x43,
        Content::Said(Peer, DrivingParameters),
        Modem,
        driving_parameters::FIELDS,
    ),
    line("Peer{slot}Position", 0x44, Content::Said(Peer, Geo), Modem, geo::FIELDS),
    line("Peer{slot}Route", 0x45, Content::Said(Peer, Route), Modem, route::FIELDS),
];

/// The line of an offset, its place in the catalogue, and its slot (0 where there are none).
#[must_use]
pub fn find(offset: u16) -> Option<(usize, &'static Line, Slot)> {
    let (place, slot) = index::place_of(offset)?;
    Some((place, CATALOGUE.get(place)?, slot))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wire::BaseId;
    use crate::wire::bits::{FIRST_BIT, Payload};

    #[test]
    fn offsets_ascend_and_stay_inside_the_block() {
        assert!(CATALOGUE.is_sorted_by(|a, b| a.offset < b.offset));
        for line in &CATALOGUE {
            assert_eq!(line.is_per_slot(), line.offset >= PEERS_OFFSET);
            assert!(line.offset_for(Slot(15)) < BLOCK);
            assert_eq!(find(line.offset).map(|(_, found, _)| found.name), Some(line.name));
        }
        assert_eq!(find(0x40 + 15 * 8 + 5).map(|(_, line, slot)| (line.offset, slot)), Some((0x45, Slot(15))));
        assert_eq!((BaseId::new(0x740).map(BaseId::get), BaseId::new(0x741)), (Some(0x740), None));
    }

    #[test]
    fn the_parts_of_a_message_come_together_well_before_its_tag_comes_round() {
        for line in &CATALOGUE {
            let has_parts = line.frames > 1 || line.fields.iter().any(|field| field.name == "Tag");
            assert_eq!(line.within_ms > 0, has_parts, "{}", line.name);
            assert!(2 * line.within_ms <= 4 * line.cycle_ms, "{}", line.name);
        }
    }

    #[test]
    fn fields_neither_overlap_nor_leave_the_payload_and_their_values_fit() {
        for line in &CATALOGUE {
            let parts = line.selector().map_or(1, |selector| selector.max as u8 + 1);
            for part in 0..parts {
                let mut taken = 0u64;
                for field in line.fields.iter().filter(|f| !matches!(f.place, Place::Part(of) if of != part)) {
                    let what = format!("{} {}", line.name, field.name);
                    assert!(field.start >= FIRST_BIT && field.start + field.length <= 64, "{what}");
                    let bits = ((1u64 << field.length) - 1) << field.start;
                    assert_eq!(taken & bits, 0, "{what}");
                    taken |= bits;
                }
            }
            for field in line.fields {
                let what = format!("{} {}", line.name, field.name);
                let same = line.fields.iter().filter(|other| other.name == field.name).count();
                assert!(same == 1 || line.content == Content::Said(Ego, DrivingParameters), "{what}");
                for raw in [Some(field.min), Some(field.max), field.none].into_iter().flatten() {
                    assert_eq!(field.raw(field.with_raw(Payload::EMPTY, raw)), raw, "{what}");
                }
                assert!(field.values.iter().all(|(raw, _)| field.accepts(*raw)), "{what}");
            }
        }
    }
}
