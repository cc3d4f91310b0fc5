//! The message catalogue: every identifier of the unit's bus with its sender, times, E2E parameters and fields. An
//! identifier enters and its line leaves; receiver, sender, DBC and bus load all read the one table.
//!
//! Identifiers are `base + offset` unless [`super::Identifiers`] places them elsewhere; the low ones win the bus. Peers have
//! [`SLOT_STRIDE`] offsets a slot. The E2E data id is [`DATA_ID_BASE`] `+ offset`, wherever a line lies. All data ids differ in the
//! low byte, over which the CRC of classic CAN is one to one, so a frame that strays to another line's identifier never passes.

use super::Slot;
use super::e2e::Limits;
use super::field::{Field, Place};
use super::index;

mod lines;

pub use lines::{CATALOGUE, LINES};

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
    /// [`super::sync::Sync`].
    Sync,
    /// [`super::sync::FollowUp`].
    FollowUp,
    /// [`super::command::Command`].
    Command,
    /// [`super::driver_request::DriverRequest`].
    DriverRequest,
    /// [`super::actuators::ActuatorState`].
    Actuators,
    /// [`super::range_sensor::RangeSample`].
    Range,
    /// [`super::unserved::Unserved`].
    Unserved,
    /// [`super::pass::Pass`], of the own vehicle or of another one.
    Pass(Speaker),
    /// First frame of [`super::estimate::TargetEstimate`].
    EstimateA,
    /// Its second frame.
    EstimateB,
    /// [`super::status::Status`].
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
    /// How often the message is sent; 0: never, its identifier is reserved.
    pub cycle_ms: u16,
    /// The condition without which it is not sent, for readers of the DBC: what follows "only" in a sentence. Empty: it is always sent.
    pub only: &'static str,
    /// Without it for this long, it counts as missing; 0: what it said last holds.
    pub timeout_ms: u16,
    /// Frames on this identifier in every cycle.
    pub frames: u8,
    /// All frames of one message come within this; 0 where it has but one.
    pub within_ms: u16,
    /// The fields of all its frames.
    pub fields: &'static [Field],
    /// What ties its frames, where it needs several of classic CAN: the first of the rules for readers of the DBC.
    pub tied: &'static str,
    /// The other rules.
    pub comment: &'static str,
    /// Where it stands on a bus of CAN FD.
    pub on_fd: OnFd,
}

/// Where a message of the catalogue stands on a bus of CAN FD, whose frames have room for all parts of a message, and for
/// several messages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OnFd {
    /// It begins a frame, which has this name.
    Frame(&'static str),
    /// It follows the line before it, in the same frame.
    Follows,
    /// The same, and a signal of this name says whether it does.
    MayFollow(&'static str),
}

impl Line {
    /// Whether every slot has one.
    #[must_use]
    pub const fn is_per_slot(&self) -> bool {
        self.content.is_per_slot()
    }

    /// Whether anybody sends it.
    #[must_use]
    pub const fn is_sent(&self) -> bool {
        self.cycle_ms > 0
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

impl Line {
    /// In one frame of either bus, never sent and never missing, with nothing to say; what follows says otherwise.
    const fn new(name: &'static str, offset: u16, content: Content, sender: Node, fields: &'static [Field]) -> Self {
        Self {
            name,
            content,
            offset,
            sender,
            cycle_ms: 0,
            only: "",
            timeout_ms: 0,
            frames: 1,
            within_ms: 0,
            fields,
            tied: "",
            comment: "",
            on_fd: OnFd::Frame(name),
        }
    }

    /// Sent so often, and missing after this. The timeout of what the unit receives is that after which it reacts, by the default
    /// configuration, and 0 where no loss of that message alone has a reaction of its own: what was said last holds. The timeout of
    /// what it sends is 5 cycles of what comes every 10 ms, else 3.
    const fn every(self, cycle_ms: u16, timeout_ms: u16) -> Self {
        Self { cycle_ms, timeout_ms, ..self }
    }

    /// Sent on this condition.
    const fn only(self, only: &'static str) -> Self {
        Self { only, ..self }
    }

    /// In so many frames.
    const fn of(self, frames: u8) -> Self {
        Self { frames, ..self }
    }

    /// All frames of one message come within this: half of what a tag takes to come round, four cycles, where the cycle is
    /// 10 ms, and half a cycle, which is more than a bus ever holds them back, where it is longer. The text tells readers of the
    /// DBC.
    const fn within(self, within_ms: u16, tied: &'static str) -> Self {
        Self { within_ms, tied, ..self }
    }

    /// With these rules for readers of the DBC.
    const fn says(self, comment: &'static str) -> Self {
        Self { comment, ..self }
    }

    /// With this place on a bus of CAN FD.
    const fn fd(self, on_fd: OnFd) -> Self {
        Self { on_fd, ..self }
    }
}

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
            assert!(!line.is_sent() || 2 * line.within_ms <= 4 * line.cycle_ms, "{}", line.name);
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
                assert!(same == 1 || line.content == Content::Said(Speaker::Ego, About::DrivingParameters), "{what}");
                for raw in [Some(field.min), Some(field.max), field.none].into_iter().flatten() {
                    assert_eq!(field.raw(field.with_raw(Payload::EMPTY, raw)), raw, "{what}");
                }
                assert!(field.values.iter().all(|(raw, _)| field.accepts(*raw)), "{what}");
            }
        }
    }
}
