//! The identifiers of the catalogue as options, which several commands have: what is typed, and a file, enter; checked identifiers leave.

use std::fs;
use std::num::ParseIntError;
use std::path::{Path, PathBuf};

use clap::Args;
use holdover::wire::catalogue::{CATALOGUE, Content, Line, OnFd};
use holdover::wire::{BaseId, Identifier, Identifiers};

use crate::error::Error;

/// Where the messages lie on the bus.
#[derive(Clone, Debug, Default, Args)]
pub struct IdentifierArguments {
    /// First CAN identifier of the catalogue, such as 0x480 [default: 0x480]
    #[arg(long, value_name = "ID", value_parser = number)]
    pub base_id: Option<u32>,

    /// Place a message outside the block, such as MotionCommand=0x123, or MotionCommand=0x0CFF0210 with 29 bits, as each number
    /// above 0x7FF has and each that ends with an x; a peer's with the distance between slots, such as
    /// PeerMotionA=0x18FF4021/0x100. May be repeated
    #[arg(long, value_name = "NAME=ID")]
    pub place: Vec<String>,

    /// A file of such places, one a line; # begins a comment
    #[arg(long, value_name = "FILE")]
    pub identifiers: Option<PathBuf>,
}

impl IdentifierArguments {
    /// The block, then the file's places, then those that were typed.
    ///
    /// # Errors
    /// A base, a name or an identifier that does not exist, and two messages on one identifier.
    pub fn read(&self) -> Result<Identifiers, Error> {
        let mut identifiers = Identifiers::block(base(self.base_id)?);
        if let Some(file) = &self.identifiers {
            identifiers = of_file(file, identifiers)?;
        }
        for text in &self.place {
            identifiers = place(identifiers, text).map_err(|error| error.in_option("--place"))?;
        }
        identifiers.check().map_err(|cause| Error::new(cause.to_string(), "place one of them elsewhere"))?;
        Ok(identifiers)
    }
}

/// A number, decimal or hexadecimal as 0x480.
fn number(text: &str) -> Result<u32, ParseIntError> {
    match text.strip_prefix("0x").or_else(|| text.strip_prefix("0X")) {
        Some(digits) => u32::from_str_radix(digits, 16),
        None => text.parse(),
    }
}

/// The base with this identifier; the default one where none is given.
fn base(id: Option<u32>) -> Result<BaseId, Error> {
    let Some(id) = id else { return Ok(BaseId::DEFAULT) };
    u16::try_from(id).ok().and_then(BaseId::new).ok_or_else(|| {
        let remedy = format!("give one up to {:#x}, so that the messages fit into 11 bits", BaseId::MAX);
        Error::new(format!("the first identifier is {id:#x}"), remedy).in_option("--base-id")
    })
}

fn of_file(file: &Path, mut identifiers: Identifiers) -> Result<Identifiers, Error> {
    let text = fs::read_to_string(file).map_err(|error| Error::unreadable(file, &error))?;
    for (line, text) in (1..).zip(text.lines()) {
        let text = text.split('#').next().unwrap_or_default().trim();
        if !text.is_empty() {
            identifiers = place(identifiers, text).map_err(|error| error.in_file(file).at_line(line))?;
        }
    }
    Ok(identifiers)
}

/// These identifiers, but for the place that is written `NAME=ID`, or `NAME=ID/STRIDE` for a peer's.
fn place(identifiers: Identifiers, text: &str) -> Result<Identifiers, Error> {
    let form = "write NAME=ID, such as MotionCommand=0x123, or =0x0CFF0210 with 29 bits";
    let (name, at) = text.split_once('=').ok_or_else(|| Error::new(format!("`{text}` is no place"), form))?;
    let (name, at) = (name.trim(), at.trim());
    let line = CATALOGUE.iter().find(|line| is_called(line, name)).ok_or_else(|| {
        let names: Vec<String> = CATALOGUE.iter().map(plain).collect();
        Error::new(format!("there is no message `{name}`"), format!("give one of {}", names.join(", ")))
    })?;
    let (id, stride) = match at.split_once('/') {
        Some((id, stride)) => (id.trim_end(), Some(stride.trim_start())),
        None => (at, None),
    };
    let wrong =
        |text| Error::new(format!("`{text}` is no identifier"), "give 0 to 0x7FF, or up to 0x1FFFFFFF for 29 bits");
    let id = identifier(id).ok_or_else(|| wrong(id))?;
    match (line.content, stride) {
        (Content::Said(_, about), Some(stride)) if line.is_per_slot() => {
            let stride = number(stride).map_err(|_| {
                Error::new(
                    format!("`{stride}` is no distance between slots"),
                    "give a number of identifiers, such as 0x100",
                )
            })?;
            Ok(identifiers.place_peers(about, id, stride))
        }
        (_, None) if line.is_per_slot() => {
            let remedy = format!("add it, such as {name}={id}/0x100");
            Err(Error::new(format!("{name} has no distance between slots"), remedy))
        }
        (_, Some(_)) => {
            Err(Error::new(format!("{name} has no slots"), format!("leave the distance away: {name}={id}")))
        }
        (content, None) => {
            identifiers.place(content, id).ok_or_else(|| Error::new(format!("`{text}` is no place"), form))
        }
    }
}

/// The name of a line in a place: that of the DBC, without the slot's number.
fn plain(line: &Line) -> String {
    line.name.replace("{slot}", "")
}

/// Whether a line has this name, on classic CAN or on CAN FD.
fn is_called(line: &Line, name: &str) -> bool {
    plain(line) == name || matches!(line.on_fd, OnFd::Frame(of) if of.replace("{slot}", "") == name)
}

/// An identifier; one of 29 bits is above 0x7FF or ends with an x.
fn identifier(text: &str) -> Option<Identifier> {
    if let Some(extended) = text.strip_suffix(['x', 'X']) {
        return Identifier::extended(number(extended).ok()?);
    }
    let number = number(text).ok()?;
    u16::try_from(number).ok().and_then(Identifier::standard).or_else(|| Identifier::extended(number))
}

#[cfg(test)]
mod tests {
    use super::*;
    use holdover::wire::catalogue::{About, Speaker};

    fn read(places: &[&str]) -> Result<Identifiers, String> {
        let place = places.iter().map(|text| (*text).into()).collect();
        IdentifierArguments { place, ..IdentifierArguments::default() }.read().map_err(|error| error.to_string())
    }

    #[test]
    fn a_base_is_decimal_or_hexadecimal_and_leaves_room_for_all_messages() {
        for (text, id) in [("0", 0), ("1152", 0x480), ("0x480", 0x480), ("0X740", 0x740), ("1856", 0x740)] {
            assert_eq!(base(Some(number(text).unwrap())).unwrap().get(), id);
        }
        assert_eq!(base(None).unwrap(), BaseId::DEFAULT);
        for text in ["0x741", "1857", "65535", "65536"] {
            assert!(base(Some(number(text).unwrap())).is_err(), "{text}");
        }
        for text in ["", "x", "-1", "4294967296", "0x", "480h"] {
            assert!(number(text).is_err(), "{text}");
        }
    }

    #[test]
    fn a_place_has_11_or_29_bits_and_a_stride_where_there_are_slots() {
        let placed = read(&["MotionCommand=0x0CFF0210x", "TimeSync = 291", "PeerMotionB=0x18FF4021/0x100"]).unwrap();
        let id = Identifier::extended(0x0CFF_0210).unwrap();
        assert_eq!(placed.placement(Content::Command), Some((id, 0)));
        assert_eq!(placed.placement(Content::Sync), Some((Identifier::standard(0x123).unwrap(), 0)));
        let first = Identifier::extended(0x18FF_4021).unwrap();
        assert_eq!(placed.placement(Content::Said(Speaker::Peer, About::MotionB)), Some((first, 0x100)));
        assert_eq!(placed.placement(Content::FollowUp), None);
    }

    #[test]
    fn what_is_no_place_is_refused_with_its_remedy() {
        for (place, said) in [
            ("MotionCommand", "is no place; write NAME=ID"),
            ("Motion=5", "there is no message `Motion`; give one of TimeSync, "),
            ("TimeSync=0x20000000", "`0x20000000` is no identifier; give 0 to 0x7FF, or up to 0x1FFFFFFF"),
            ("TimeSync=0x20000000x", "is no identifier"),
            ("TimeSync=-1", "is no identifier"),
            ("PeerMotionA=0x18FF4021x", "has no distance between slots; add it, such as PeerMotionA=0x18FF4021x/0x100"),
            ("TimeSync=5/8", "TimeSync has no slots; leave the distance away: TimeSync=0x005"),
            ("PeerRoute=0x700/1000", "the identifiers of Peer0Route and of its other slots do not fit"),
            ("TimeSync=0x482", "MotionCommand and TimeSync have the same identifier; place one of them elsewhere"),
        ] {
            let error = read(&[place]).unwrap_err();
            assert!(error.contains(said), "{place}: {error}");
        }
    }
}
