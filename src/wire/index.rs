//! The catalogue as a receiver and a sender need it: an identifier's offset, or a content, enters and its entry leaves. Made
//! of the catalogue at compile time, without names, units and texts, so that an ECU's image does not hold those; and of a
//! frame's fields only those that a frame can break.

use super::Slot;
use super::bits::Payload;
use super::catalogue::{ABOUTS, CATALOGUE, Content, LINES, Node, PEERS_OFFSET, SLOT_STRIDE, Speaker};
#[cfg(feature = "fd")]
use super::field::TAG;
use super::field::{Field, Place};
use crate::health::Cause;
use crate::time::Duration;

/// One line of the catalogue.
#[derive(Clone, Copy)]
pub(super) struct Entry {
    /// What it carries.
    pub(super) content: Content,
    /// Offset from the base; of slot 0 for a peer's.
    pub(super) offset: u16,
    /// Who sends it.
    pub(super) sender: Node,
    /// The parts of a message come within this.
    pub(super) within: Duration,
    /// First bit and bits of the field that tells the parts of the message apart; no bits where there is one part.
    selector: (u8, u8),
    /// From and to in [`RULES`].
    rules: (u8, u8),
}

/// The raw values that may stand in a field, where not all of its bit patterns may.
#[derive(Clone, Copy)]
struct Rule {
    start: u8,
    length: u8,
    signed: bool,
    /// [`EVERY`] if it stands in all of them.
    part: u8,
    min: i32,
    max: i32,
    /// The code for none, which is `max` where there is none.
    none: i32,
}

const EVERY: u8 = u8::MAX;
const NOWHERE: u8 = u8::MAX;

impl Rule {
    /// `None` for a field in which every bit pattern is a value.
    #[allow(clippy::cast_possible_truncation, clippy::arithmetic_side_effects)] // in const: a frame has 64 bits
    const fn of(field: &Field) -> Option<Self> {
        let none = match field.none {
            Some(none) => none,
            None => field.max,
        };
        let (ends, patterns) = (if none > field.max { none } else { field.max }, 1i64 << field.length);
        // All of them are values if they are as many as there are, and none is left out before the code for none.
        if ends <= field.max + 1 && ends - field.min + 1 == patterns {
            return None;
        }
        let fit = field.min >= i32::MIN as i64 && ends <= i32::MAX as i64;
        assert!(fit && none >= field.min, "limits fit 32 bits");
        let part = match field.place {
            Place::Part(part) => part,
            Place::Always | Place::Selector => EVERY,
        };
        let (start, length) = (field.start as u8, field.length as u8);
        Some(Self {
            start,
            length,
            signed: field.signed,
            part,
            min: field.min as i32,
            max: field.max as i32,
            none: none as i32,
        })
    }

    fn holds(&self, payload: Payload, part: u8) -> bool {
        if self.part != EVERY && self.part != part {
            return true;
        }
        let (start, length) = (u32::from(self.start), u32::from(self.length));
        #[allow(clippy::cast_possible_wrap)] // a field has at most 52 bits
        let raw = if self.signed { payload.signed(start, length) } else { payload.unsigned(start, length) as i64 };
        (i64::from(self.min) <= raw && raw <= i64::from(self.max)) || raw == i64::from(self.none)
    }
}

/// How many rules the catalogue has.
#[allow(clippy::indexing_slicing, clippy::arithmetic_side_effects)] // in const
const COUNT: usize = {
    let (mut count, mut line) = (0, 0);
    while line < LINES {
        let mut field = 0;
        while field < CATALOGUE[line].fields.len() {
            count += Rule::of(&CATALOGUE[line].fields[field]).is_some() as usize;
            field += 1;
        }
        line += 1;
    }
    count
};

const _: () = assert!(COUNT < 256 && LINES < NOWHERE as usize);

#[allow(clippy::indexing_slicing, clippy::arithmetic_side_effects, clippy::cast_possible_truncation)] // in const
const MADE: ([Entry; LINES], [Rule; COUNT]) = {
    let first = &CATALOGUE[0];
    let (content, sender, within) = (first.content, first.sender, Duration::ZERO);
    let entry = Entry { content, offset: 0, sender, within, selector: (0, 0), rules: (0, 0) };
    let mut entries = [entry; LINES];
    let mut rules = [Rule { start: 0, length: 0, signed: false, part: EVERY, min: 0, max: 0, none: 0 }; COUNT];
    let (mut count, mut line) = (0, 0);
    while line < LINES {
        let (from, of) = (count, &CATALOGUE[line]);
        let (mut field, mut selector) = (0, (0, 0));
        while field < of.fields.len() {
            let this = &of.fields[field];
            if matches!(this.place, Place::Selector) {
                selector = (this.start as u8, this.length as u8);
            }
            if let Some(rule) = Rule::of(this) {
                rules[count] = rule;
                count += 1;
            }
            field += 1;
        }
        let rules = (from as u8, count as u8);
        let within = Duration::from_millis(of.within_ms as i64);
        entries[line] = Entry { content: of.content, offset: of.offset, sender: of.sender, within, selector, rules };
        line += 1;
    }
    (entries, rules)
};

static ENTRIES: [Entry; LINES] = MADE.0;
static RULES: [Rule; COUNT] = MADE.1;

/// Offsets up to the end of slot 0.
const OFFSETS: usize = (PEERS_OFFSET + SLOT_STRIDE) as usize;

/// Places in the catalogue, by offset.
#[allow(clippy::indexing_slicing, clippy::arithmetic_side_effects, clippy::cast_possible_truncation)] // in const
static BY_OFFSET: [u8; OFFSETS] = {
    let (mut places, mut line) = ([NOWHERE; OFFSETS], 0);
    while line < LINES {
        places[CATALOGUE[line].offset as usize] = line as u8;
        line += 1;
    }
    places
};

/// What is not said of a vehicle.
const OTHERS: usize = 12;
const CONTENTS: usize = OTHERS + 3 * ABOUTS;

/// Places in the catalogue, by [`number`].
#[allow(clippy::indexing_slicing, clippy::arithmetic_side_effects, clippy::cast_possible_truncation)] // in const
static BY_CONTENT: [u8; CONTENTS] = {
    let (mut places, mut line) = ([NOWHERE; CONTENTS], 0);
    while line < LINES {
        let number = number(CATALOGUE[line].content);
        assert!(places[number] == NOWHERE, "each content has its own number, and `OTHERS` counts them");
        places[number] = line as u8;
        line += 1;
    }
    places
};

/// Contents, counted.
#[allow(clippy::arithmetic_side_effects)] // a few
const fn number(content: Content) -> usize {
    match content {
        Content::Sync => 0,
        Content::FollowUp => 1,
        Content::Command => 2,
        Content::DriverRequest => 3,
        Content::Range => 4,
        Content::EstimateA => 5,
        Content::EstimateB => 6,
        Content::Status => 7,
        Content::Unserved => 8,
        Content::Actuators => 9,
        Content::Pass(Speaker::Peer) => 10,
        Content::Pass(_) => 11,
        Content::Said(Speaker::Ego, about) => OTHERS + about as usize,
        Content::Said(Speaker::Own, about) => OTHERS + ABOUTS + about as usize,
        Content::Said(Speaker::Peer, about) => OTHERS + 2 * ABOUTS + about as usize,
    }
}

/// The offset of a place in the catalogue; of slot 0 for a peer's.
pub(super) fn offset_of(place: usize) -> Option<u16> {
    ENTRIES.get(place).map(|entry| entry.offset)
}

/// The place in the catalogue of an offset, and its slot (0 where there are none).
pub(super) fn place_of(offset: u16) -> Option<(usize, Slot)> {
    let (first, slot) = match offset.checked_sub(PEERS_OFFSET) {
        Some(beyond) => (PEERS_OFFSET.wrapping_add(beyond % SLOT_STRIDE), beyond / SLOT_STRIDE),
        None => (offset, 0),
    };
    let place = BY_OFFSET.get(usize::from(first)).copied().filter(|place| *place != NOWHERE)?;
    Some((usize::from(place), Slot(u8::try_from(slot).ok()?)))
}

/// The entry of an offset, its place in the catalogue, and its slot (0 where there are none).
pub(super) fn find(offset: u16) -> Option<(usize, &'static Entry, Slot)> {
    let (place, slot) = place_of(offset)?;
    Some((place, ENTRIES.get(place)?, slot))
}

/// The entry of a content, and its place in the catalogue; some contents have none (the vehicle does not tell its unit its
/// driving parameters this way).
pub(super) fn find_content(content: Content) -> Option<(usize, &'static Entry)> {
    let place = usize::from(*BY_CONTENT.get(number(content))?);
    Some((place, ENTRIES.get(place)?))
}

/// The entry at a place in the catalogue.
#[cfg(feature = "fd")]
pub(super) fn at(place: usize) -> Option<&'static Entry> {
    ENTRIES.get(place)
}

impl Entry {
    /// A payload that is empty but for the tag and for what says which part it is.
    #[cfg(feature = "fd")]
    pub(super) fn head(&self, part: u8, tag: u8) -> Payload {
        let (start, length) = self.selector;
        let tagged = Payload::EMPTY.with(TAG.start, TAG.length, tag.into());
        tagged.with(start.into(), length.into(), part.into())
    }

    /// Which part of its message a frame is.
    #[allow(clippy::cast_possible_truncation)] // a selector has at most 8 bits
    pub(super) fn part_of(&self, payload: Payload) -> u8 {
        let (start, length) = self.selector;
        payload.unsigned(u32::from(start), u32::from(length)) as u8
    }

    /// Whether every field of the frame holds a value that may stand in it.
    ///
    /// # Errors
    /// `Range` if one does not.
    pub(super) fn check(&self, payload: Payload) -> Result<(), Cause> {
        let part = self.part_of(payload);
        let (from, to) = self.rules;
        let rules = RULES.get(usize::from(from)..usize::from(to)).unwrap_or_default();
        if rules.iter().all(|rule| rule.holds(payload, part)) { Ok(()) } else { Err(Cause::Range) }
    }

    /// Its offset for this slot (slot 0 where there are none).
    pub(super) const fn offset_for(&self, slot: Slot) -> u16 {
        self.content.offset_for(self.offset, slot)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_entry_refuses_what_a_field_of_its_line_does_not_accept_and_nothing_else() {
        for (entry, line) in ENTRIES.iter().zip(&CATALOGUE) {
            let selector = line.fields.iter().find(|field| field.place == Place::Selector);
            for part in 0..selector.map_or(1, |selector| selector.max + 1) {
                let stands = |field: &&Field| !matches!(field.place, Place::Part(of) if i64::from(of) != part);
                let whole = selector.map_or(Payload::EMPTY, |field| field.with_raw(Payload::EMPTY, part));
                // Zero is not a value of every field; the nearest one to it is.
                let others = line.fields.iter().filter(|field| stands(field) && field.place != Place::Selector);
                let whole = others.fold(whole, |payload, field| field.with_raw(payload, 0));
                assert_eq!((entry.part_of(whole), entry.check(whole)), (part as u8, Ok(())), "{}", line.name);
                for field in line.fields.iter().filter(stands) {
                    let last = (1i64 << field.length) - 1;
                    let near = [0, 1, last / 2, last / 2 + 1, last - 1, last, field.min, field.max, field.max + 1];
                    for raw in near.into_iter().filter(|_| field.place != Place::Selector) {
                        let payload = whole.with(field.start, field.length, raw as u64);
                        let expected = field.accepts(field.raw(payload));
                        assert_eq!(entry.check(payload).is_ok(), expected, "{} {} {raw}", line.name, field.name);
                    }
                }
            }
            if let Some(selector) = selector.filter(|selector| selector.max + 1 < 1 << selector.length) {
                let beyond = Payload::EMPTY.with(selector.start, selector.length, selector.max as u64 + 1);
                assert_eq!(entry.check(beyond), Err(Cause::Range), "{}", line.name);
            }
        }
    }

    #[test]
    fn every_line_is_found_by_its_offset_and_by_its_content() {
        for (place, line) in CATALOGUE.iter().enumerate() {
            assert_eq!(find(line.offset).map(|(place, entry, _)| (place, entry.offset)), Some((place, line.offset)));
            assert_eq!(find_content(line.content).map(|(place, _)| place), Some(place));
        }
        assert!(find_content(Content::Said(Speaker::Ego, super::super::catalogue::About::DrivingParameters)).is_none());
        let is_free = |offset: &u16| CATALOGUE.iter().all(|line| line.offset != *offset);
        assert!((0..PEERS_OFFSET + SLOT_STRIDE).filter(is_free).all(|offset| place_of(offset).is_none()));
    }
}
