//! Where each line of the catalogue lies on the bus: an identifier of the bus enters and its offset in the catalogue leaves,
//! and back.
//!
//! All lines lie in one block of standard identifiers, by offset, but for those that are placed one by one. A frame is found by two
//! comparisons in the block, and by one for each placed line before these.

use super::Transport;
use super::base_id::BaseId;
use super::catalogue::{ABOUTS, About, BLOCK, Content, LINES, Node, PEERS_OFFSET, SLOT_STRIDE, SLOTS, Speaker};
use super::identifier::Identifier;
use super::index;
use super::message_name::MessageName;

/// The identifiers of all lines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Identifiers {
    base: BaseId,
    is_any_placed: bool,
    /// By place in the catalogue; of slot 0 for a peer's.
    placed: [Identifier; LINES],
    /// Of the peers' lines: how far one slot is from the next.
    strides: [u32; ABOUTS],
}

/// Why identifiers were refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum IdentifierError {
    /// A slot of this line has no room in the 11 or 29 bits.
    Range(MessageName),
    /// These two have the same.
    Shared(MessageName, MessageName),
}

impl core::fmt::Display for IdentifierError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Range(name) => {
                write!(f, "the identifiers of {name} and of its other slots do not fit into 11 or 29 bits")
            }
            Self::Shared(one, other) => write!(f, "{one} and {other} have the same identifier"),
        }
    }
}

impl Identifiers {
    /// Those of a unit that is not started.
    pub(crate) const NONE: Self = Self::block(BaseId::NONE);
    /// The block from 0x480 to 0x53F.
    pub const DEFAULT: Self = Self::block(BaseId::DEFAULT);

    /// All lines in one block, from this base on.
    #[must_use]
    pub const fn block(base: BaseId) -> Self {
        Self { base, is_any_placed: false, placed: [Identifier::NONE; LINES], strides: [0; ABOUTS] }
    }

    /// These, but for a line that lies on this identifier; `None` for a content without a line, and for a peer's.
    #[must_use]
    pub fn place(mut self, content: Content, id: Identifier) -> Option<Self> {
        let (line, _) = index::find_content(content).filter(|_| !content.is_per_slot())?;
        *self.placed.get_mut(line)? = id;
        self.is_any_placed = true;
        Some(self)
    }

    /// These, but for a line of the peers, which lies on `first` for slot 0 and so many identifiers further for each slot.
    #[must_use]
    pub fn place_peers(mut self, about: About, first: Identifier, stride: u32) -> Self {
        let line = index::find_content(Content::Said(Speaker::Peer, about)).map(|(line, _)| line);
        if let Some(placed) = line.and_then(|line| self.placed.get_mut(line))
            && let Some(of_slots) = self.strides.get_mut(about as usize)
        {
            (*placed, *of_slots) = (first, stride);
            self.is_any_placed = true;
        }
        self
    }

    /// The first identifier of the block.
    #[must_use]
    pub const fn base(&self) -> BaseId {
        self.base
    }

    /// Where a line was placed, and its stride (0 where there are no slots); `None` if it lies in the block.
    #[must_use]
    pub fn placement(&self, content: Content) -> Option<(Identifier, u32)> {
        let (first, stride) = self.placed_at(index::find_content(content)?.0)?;
        Some((first, if content.is_per_slot() { stride } else { 0 }))
    }

    /// The stride of a line without slots is not used.
    fn placed_at(&self, line: usize) -> Option<(Identifier, u32)> {
        let first = self.placed.get(line).copied().filter(|id| *id != Identifier::NONE)?;
        let about = usize::from(index::offset_of(line)?.saturating_sub(PEERS_OFFSET));
        Some((first, self.strides.get(about).copied().unwrap_or(0)))
    }

    /// The identifier at this offset.
    #[must_use]
    pub fn at(&self, offset: u16) -> Identifier {
        if self.is_any_placed
            && let Some((line, slot)) = index::place_of(offset)
            && let Some((first, stride)) = self.placed_at(line)
        {
            return first.plus(stride.wrapping_mul(u32::from(slot.0)));
        }
        self.base.plus(offset)
    }

    /// All identifiers that a unit takes in, for the acceptance filter of its controller. Those of the peers are of all slots: a frame of
    /// a slot that a unit does not have is refused by name, and so has to reach it.
    pub fn heard_by_unit(&self) -> impl Iterator<Item = Identifier> + '_ {
        let is_heard = |offset: &u16| index::find(*offset).is_some_and(|(_, entry, _)| entry.sender != Node::Unit);
        (0..BLOCK).filter(is_heard).map(|offset| self.at(offset))
    }

    /// The offset of an identifier; `None` if no line lies there. Offsets of the block at which the catalogue has no line are told
    /// as long as nothing is placed.
    #[must_use]
    pub fn offset_of(&self, id: Identifier) -> Option<u16> {
        if !self.is_any_placed {
            return self.base.offset_of(id);
        }
        // On CAN FD a placed line may lie where the block has one without a frame of its own.
        self.placed_offset_of(id).or_else(|| self.base.offset_of(id).filter(|offset| self.is_in_block(*offset)))
    }

    fn is_in_block(&self, offset: u16) -> bool {
        index::place_of(offset).is_some_and(|(line, _)| self.placed_at(line).is_none())
    }

    #[inline(never)] // most buses have no placed line
    fn placed_offset_of(&self, id: Identifier) -> Option<u16> {
        self.placed.iter().enumerate().filter(|(_, first)| **first != Identifier::NONE).find_map(|(line, first)| {
            let (further, offset) = (id.since(*first), index::offset_of(line)?);
            let Some(about) = offset.checked_sub(PEERS_OFFSET) else { return (further == 0).then_some(offset) };
            let stride = self.strides.get(usize::from(about)).copied()?;
            let slot = if further == 0 { 0 } else { further.checked_div(stride)? };
            let is_one = slot < u32::from(SLOTS) && slot.wrapping_mul(stride) == further;
            let slot = u16::try_from(slot).ok().filter(|_| is_one)?;
            Some(offset.wrapping_add(SLOT_STRIDE.wrapping_mul(slot)))
        })
    }

    /// Whether every line that begins a frame of such a bus has identifiers of its own, with all slots that there are. Where another
    /// line of the block would be, is free.
    ///
    /// # Errors
    /// The first line that has not.
    pub fn check(&self, transport: Transport) -> Result<(), IdentifierError> {
        if !self.is_any_placed {
            return Ok(());
        }
        let lines = || {
            let framed = (0..LINES).filter(|line| begins_frame(*line, transport));
            framed.filter_map(|line| Some((line, index::offset_of(line)?)))
        };
        for (line, offset) in lines().filter(|(_, offset)| *offset >= PEERS_OFFSET) {
            let has_room = self.placed_at(line).is_none_or(|(first, stride)| {
                stride.checked_mul(u32::from(SLOTS - 1)).is_some_and(|further| first.has_room_for(further))
            });
            if !has_room {
                return Err(IdentifierError::Range(MessageName::at(offset)));
            }
        }
        // Of two that share one, at most one is found there.
        for (line, first) in lines() {
            let slots = if first >= PEERS_OFFSET { SLOTS } else { 1 };
            for offset in (0..slots).map(|slot| first.saturating_add(SLOT_STRIDE.saturating_mul(slot))) {
                let found = self.offset_of(self.at(offset)).unwrap_or(offset);
                if found != offset {
                    // The one that is in the block is named first.
                    let is_placed = self.placed_at(line).is_some();
                    let (one, other) = if is_placed { (found, offset) } else { (offset, found) };
                    return Err(IdentifierError::Shared(MessageName::at(one), MessageName::at(other)));
                }
            }
        }
        Ok(())
    }

    /// All identifiers of a line, by slot: so many slots where it has slots.
    pub fn of_line(&self, offset: u16, slots: u8) -> impl Iterator<Item = Identifier> {
        let slots = if offset >= PEERS_OFFSET { slots } else { 1 };
        (0..slots).map(move |slot| self.at(offset.saturating_add(SLOT_STRIDE.saturating_mul(u16::from(slot)))))
    }
}

/// Whether a frame of such a bus begins with the line at this place in the catalogue.
fn begins_frame(line: usize, transport: Transport) -> bool {
    match transport {
        #[cfg(feature = "fd")]
        Transport::Fd => super::fd::layout::of(line).is_some(),
        _ => line < LINES,
    }
}

#[cfg(all(test, feature = "fd"))]
mod tests {
    use super::*;

    fn id(number: u16) -> Identifier {
        Identifier::standard(number).unwrap()
    }

    #[test]
    fn where_a_line_of_the_block_has_no_frame_another_line_may_lie() {
        let ego = Content::Said(Speaker::Ego, About::MotionA);
        // EgoMotionB of the block, and Peer0MotionB: both follow in the frame of the line before.
        for (content, offset, free) in [(Content::Command, 0x02, 0x485), (ego, 0x04, 0x4C1)] {
            let placed = Identifiers::DEFAULT.place(content, id(free)).unwrap();
            assert_eq!(placed.check(Transport::Fd), Ok(()));
            assert!(matches!(placed.check(Transport::Classic), Err(IdentifierError::Shared(..))), "{free:#x}");
            assert_eq!((placed.offset_of(id(free)), placed.at(offset)), (Some(offset), id(free)));
        }
    }

    #[test]
    fn two_frames_of_can_fd_on_one_identifier_are_refused() {
        let shared = |one, other| Err(IdentifierError::Shared(MessageName::at(one), MessageName::at(other)));
        let command = Identifiers::DEFAULT.place(Content::Command, id(0x484)).unwrap();
        assert_eq!(command.check(Transport::Fd), shared(0x04, 0x02));
        let both = Identifiers::DEFAULT.place(Content::Command, id(0x123)).unwrap();
        let both = both.place(Content::Status, id(0x123)).unwrap();
        assert_eq!(both.check(Transport::Fd), shared(0x02, 0x18));
        let peers = Identifiers::DEFAULT.place_peers(About::MotionA, id(0x7F1), 1);
        assert_eq!(peers.check(Transport::Fd), Err(IdentifierError::Range(MessageName::at(0x40))));
    }
}
