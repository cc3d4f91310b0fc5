//! Where the catalogue's payloads lie in frames of CAN FD: made of the catalogue at compile time. A line's place in the catalogue
//! enters, and the layout of the frame that begins with it leaves.
//!
//! After the header of 24 bits the payloads of a frame's messages come one after the other, in the order of the catalogue and of
//! their parts: of each the bits from its first field to the end of its last, without tag and selector. A message that may be
//! missing has a bit before it that says whether it is there.

use super::Bits;
use super::e2e::{self, HEADER_BITS};
use crate::health::Cause;
use crate::wire::bits::Payload;
use crate::wire::catalogue::{CATALOGUE, LINES, OnFd};
use crate::wire::field::{Field, Place, TAG};
use crate::wire::index::{self, Entry};

/// The most payloads that a frame has: two of a motion, five of a horizon, three of driving parameters.
pub const MOST_PARTS: usize = 10;
/// The payloads of a frame; `None` where a message is not there.
pub type Parts = [Option<Payload>; MOST_PARTS];

/// A payload in a frame.
#[derive(Clone, Copy, Debug)]
pub struct Section {
    /// Its line's place in the catalogue.
    pub line: u8,
    /// Which part of the message it is.
    pub part: u8,
    /// Its first bit on classic CAN.
    pub first: u8,
    /// Bits.
    pub length: u8,
    /// Its first bit in the frame.
    pub at: u16,
    /// The bit that says whether it is there; 0: it always is.
    pub valid: u16,
}

/// The frame of one or several lines.
#[derive(Clone, Copy, Debug)]
pub struct Layout {
    /// Bytes of the frame.
    pub bytes: u8,
    /// From and to in [`SECTIONS`].
    sections: (u8, u8),
}

/// Lengths of a frame's data that are used: those of CAN FD above 8 bytes.
const LENGTHS: [u16; 7] = [12, 16, 20, 24, 32, 48, 64];
const NOWHERE: u8 = u8::MAX;

#[allow(clippy::indexing_slicing, clippy::arithmetic_side_effects)] // in const
const COUNTS: (usize, usize) = {
    let (mut frames, mut sections, mut line) = (0, 0, 0);
    while line < LINES {
        frames += matches!(CATALOGUE[line].on_fd, OnFd::Frame(_)) as usize;
        sections += CATALOGUE[line].frames as usize;
        line += 1;
    }
    (frames, sections)
};

/// First bit, and bits, of what a part of a message has beside tag and selector.
#[allow(clippy::indexing_slicing, clippy::arithmetic_side_effects)] // in const
const fn extent(fields: &[Field], parts: u8, is_tagged: bool, part: u8) -> (u32, u32) {
    let (mut first, mut end, mut place) = (64, 0, 0);
    while place < fields.len() {
        let field = &fields[place];
        let stands = match field.place {
            Place::Always => !(is_tagged && field.start == TAG.start),
            // Of what is one frame on classic CAN everything is moved, also what selects between its readings.
            Place::Selector => parts == 1,
            Place::Part(of) => parts == 1 || of == part,
        };
        if stands {
            first = if field.start < first { field.start } else { first };
            end = if field.start + field.length > end { field.start + field.length } else { end };
        }
        place += 1;
    }
    (first, end - first)
}

#[allow(clippy::indexing_slicing, clippy::arithmetic_side_effects, clippy::cast_possible_truncation)] // in const
const MADE: ([Layout; COUNTS.0], [Section; COUNTS.1], [u8; LINES]) = {
    let mut layouts = [Layout { bytes: 0, sections: (0, 0) }; COUNTS.0];
    let mut sections = [Section { line: 0, part: 0, first: 0, length: 0, at: 0, valid: 0 }; COUNTS.1];
    let mut by_line = [NOWHERE; LINES];
    let (mut frame, mut count, mut at, mut line) = (0, 0, 0, 0);
    while line < LINES {
        let of = &CATALOGUE[line];
        let mut valid = 0;
        match of.on_fd {
            OnFd::Frame(_) => {
                by_line[line] = frame as u8;
                layouts[frame].sections.0 = count as u8;
                frame += 1;
                at = HEADER_BITS;
            }
            OnFd::Follows => {}
            OnFd::MayFollow(_) => {
                valid = at;
                at += 1;
            }
        }
        let mut part = 0;
        while part < of.frames {
            let (first, length) = extent(of.fields, of.frames, of.within_ms > 0, part);
            sections[count] = Section { line: line as u8, part, first: first as u8, length: length as u8, at, valid };
            at += length as u16;
            count += 1;
            part += 1;
        }
        let mut length = 0;
        while LENGTHS[length] * 8 < at {
            length += 1;
        }
        layouts[frame - 1].bytes = LENGTHS[length] as u8;
        layouts[frame - 1].sections.1 = count as u8;
        assert!(count - layouts[frame - 1].sections.0 as usize <= MOST_PARTS);
        line += 1;
    }
    assert!(count < 256);
    (layouts, sections, by_line)
};

static LAYOUTS: [Layout; COUNTS.0] = MADE.0;
static SECTIONS: [Section; COUNTS.1] = MADE.1;
static BY_LINE: [u8; LINES] = MADE.2;

/// The frame that begins with the line at this place in the catalogue.
#[must_use]
pub fn of(line: usize) -> Option<&'static Layout> {
    let frame = BY_LINE.get(line).filter(|frame| **frame != NOWHERE)?;
    LAYOUTS.get(usize::from(*frame))
}

impl Layout {
    /// Its payloads, in order.
    #[must_use]
    pub fn sections(&self) -> &'static [Section] {
        let (from, to) = self.sections;
        SECTIONS.get(usize::from(from)..usize::from(to)).unwrap_or_default()
    }

    /// The payloads that stand in a frame, as on classic CAN, with this tag.
    ///
    /// # Errors
    /// `Range` if a field of one that is there holds a value that may not stand in it.
    pub(in crate::wire) fn unpack(&self, bits: &Bits, tag: u8) -> Result<Parts, Cause> {
        let mut parts = [None; MOST_PARTS];
        for (place, section) in parts.iter_mut().zip(self.sections()) {
            if section.valid == 0 || bits.get(section.valid, 1) == 1 {
                let entry = index::at(section.line.into()).ok_or(Cause::Range)?;
                let payload = section.payload(entry, bits, tag);
                entry.check(payload)?;
                *place = Some(payload);
            }
        }
        Ok(parts)
    }

    /// The payloads that stand in a frame's data, whatever its checksum.
    ///
    /// # Errors
    /// `Length`, and `Range` if a field holds a value that may not stand in it.
    pub fn read(&self, data: &[u8]) -> Result<Parts, Cause> {
        let is_whole = data.len() == usize::from(self.bytes);
        let tag = data.get(2).map_or(0, |counter| counter & 3);
        if is_whole { self.unpack(&Bits::of(data), tag) } else { Err(Cause::Length) }
    }

    /// The first payload of a frame with the right length and checksum.
    pub(crate) fn intact(&self, data_id: u16, data: &[u8]) -> Option<Payload> {
        let is_intact = data.len() == usize::from(self.bytes) && e2e::is_intact(data_id, data);
        let [first, ..] = self.unpack(&Bits::of(data), 0).ok().filter(|_| is_intact)?;
        first
    }

    /// The payloads one after the other; what comes after the last of them is not there.
    pub(in crate::wire) fn pack(&self, parts: impl IntoIterator<Item = Option<Payload>>) -> Bits {
        let mut bits = Bits::EMPTY;
        for (payload, section) in parts.into_iter().zip(self.sections()) {
            let Some(payload) = payload else { continue };
            if section.valid != 0 {
                bits.put(section.valid, 1, 1);
            }
            bits.put(section.at, section.length, payload.unsigned(section.first.into(), section.length.into()));
        }
        bits
    }
}

impl Section {
    fn payload(&self, entry: &Entry, bits: &Bits, tag: u8) -> Payload {
        let headed = entry.head(self.part, tag);
        headed.with(self.first.into(), self.length.into(), bits.get(self.at, self.length))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wire::catalogue::{About, Content, Speaker};

    fn frame(content: Content) -> &'static Layout {
        of(CATALOGUE.iter().position(|line| line.content == content).unwrap()).unwrap()
    }

    #[test]
    fn every_field_is_in_one_frame_once_and_no_two_overlap() {
        for (place, line) in CATALOGUE.iter().enumerate() {
            let Some(layout) = of(place) else {
                assert!(!matches!(line.on_fd, OnFd::Frame(_)));
                continue;
            };
            let mut taken = [false; 512];
            taken[..HEADER_BITS.into()].fill(true);
            let mut valid = 0;
            for section in layout.sections() {
                let bits = section.at..section.at + u16::from(section.length);
                let flag = (section.valid != 0 && section.valid != valid).then_some(section.valid);
                valid = section.valid;
                for bit in bits.chain(flag) {
                    assert!(!std::mem::replace(&mut taken[usize::from(bit)], true), "{} {bit}", line.name);
                }
            }
            let used = taken.iter().rposition(|taken| *taken).unwrap() + 1;
            assert!(taken[..used].iter().all(|taken| *taken), "{}", line.name);
            let shortest = LENGTHS.into_iter().find(|length| usize::from(*length) * 8 >= used);
            assert_eq!(shortest, Some(layout.bytes.into()), "{}", line.name);
        }
    }

    #[test]
    fn a_vehicles_state_fills_one_frame_of_sixty_four_bytes() {
        for speaker in [Speaker::Own, Speaker::Peer] {
            let state = frame(Content::Said(speaker, About::MotionA));
            let last = state.sections().last().unwrap();
            assert_eq!((state.bytes, last.at + u16::from(last.length), state.sections().len()), (64, 505, MOST_PARTS));
        }
        assert_eq!(frame(Content::Said(Speaker::Ego, About::MotionA)).bytes, 16);
        assert_eq!(
            [Content::Sync, Content::Command, Content::EstimateA].map(|content| frame(content).bytes),
            [12, 12, 16]
        );
    }
}
