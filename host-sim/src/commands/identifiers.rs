//! The identifiers of the catalogue as options, which several commands have: what is typed, and a file, enter; checked identifiers leave.

use std::fs;
use std::path::{Path, PathBuf};

use clap::Args;
use holdover::wire::catalogue::{CATALOGUE, Content, Line, OnFd, SLOTS};
use holdover::wire::{BaseId, Identifier, IdentifierError, Identifiers, MessageName, Slot, Transport};

use crate::error::Error;

/// Where the messages lie on the bus.
#[derive(Clone, Debug, Default, Args)]
pub struct IdentifierArguments {
    /// First CAN identifier of the catalogue, such as 0x480 [default: 0x480]
    #[arg(long, value_name = "ID", allow_negative_numbers = true)]
    pub base_id: Option<String>,

    /// Place a message outside the block, such as MotionCommand=0x123, or MotionCommand=0x0CFF0210 with 29 bits, as each number
    /// above 0x7FF has and each that ends with an x; a peer's with the distance between slots, such as
    /// PeerMotionA=0x18FF4021/0x100. May be repeated
    #[arg(long, value_name = "NAME=ID")]
    pub place: Vec<String>,

    /// A file of such places, one a line; # begins a comment. What --place says of a message goes before
    #[arg(long, value_name = "FILE")]
    pub identifiers: Option<PathBuf>,
}

impl IdentifierArguments {
    /// The block, then the file's places, then those that were typed; on this kind of bus, with so many slots in use.
    ///
    /// # Errors
    /// A base, a name or an identifier that does not exist, a message that is placed twice, and two messages on one identifier.
    pub fn read(&self, transport: Transport, slots: u8) -> Result<Identifiers, Error> {
        let mut identifiers = Identifiers::block(base(self.base_id.as_deref())?);
        if let Some(file) = &self.identifiers {
            identifiers = of_file(file, identifiers, transport)?;
        }
        let mut placed = Vec::new();
        for text in &self.place {
            let place = Place::read(text, transport).map_err(|error| error.in_option("--place"))?;
            if placed.contains(&place.name) {
                return Err(Error::new(format!("{} is placed twice", place.name), "delete one").in_option("--place"));
            }
            identifiers = place.put(identifiers);
            placed.push(place.name);
        }
        identifiers.check(transport).map_err(|cause| refusal(cause, &identifiers, transport, slots))?;
        Ok(identifiers)
    }
}

/// A number, decimal or hexadecimal as 0x480.
fn number(text: &str) -> Option<u32> {
    let hexadecimal = text.strip_prefix("0x").or_else(|| text.strip_prefix("0X"));
    let (digits, radix) = hexadecimal.map_or((text, 10), |digits| (digits, 16));
    // Rust's own reading takes a sign too.
    digits.chars().all(|c| c.is_digit(radix)).then(|| u32::from_str_radix(digits, radix).ok())?
}

/// The base with this identifier; the default one where none is given.
fn base(text: Option<&str>) -> Result<BaseId, Error> {
    let Some(text) = text else { return Ok(BaseId::DEFAULT) };
    let id = number(text)
        .ok_or_else(|| Error::new(format!("`{text}` is no number"), "give one such as 0x480").in_option("--base-id"))?;
    u16::try_from(id).ok().and_then(BaseId::new).ok_or_else(|| {
        let remedy = format!("give one up to {:#x}, so that the messages fit into 11 bits", BaseId::MAX);
        Error::new(format!("the first identifier is {id:#x}"), remedy).in_option("--base-id")
    })
}

fn of_file(file: &Path, mut identifiers: Identifiers, transport: Transport) -> Result<Identifiers, Error> {
    let text = fs::read_to_string(file).map_err(|error| Error::unreadable(file, &error))?;
    let mut placed: Vec<(String, u64)> = Vec::new();
    // Editors of Windows write a mark in front.
    for (line, text) in (1..).zip(text.trim_start_matches('\u{feff}').lines()) {
        let text = text.split('#').next().unwrap_or_default().trim();
        if text.is_empty() {
            continue;
        }
        let here = |error: Error| error.in_file(file).at_line(line);
        let place = Place::read(text, transport).map_err(here)?;
        if let Some((name, before)) = placed.iter().find(|(name, _)| *name == place.name) {
            return Err(here(Error::new(format!("{name} is placed in line {before} already"), "delete one")));
        }
        identifiers = place.put(identifiers);
        placed.push((place.name, line));
    }
    Ok(identifiers)
}

/// A place as it is written: `NAME=ID`, or `NAME=ID/STRIDE` for a peer's.
struct Place {
    /// The message's name on the bus.
    name: String,
    content: Content,
    id: Identifier,
    /// From one slot to the next; 0 where there are no slots.
    stride: u32,
}

impl Place {
    fn read(text: &str, transport: Transport) -> Result<Self, Error> {
        let form = "write NAME=ID, such as MotionCommand=0x123, or =0x0CFF0210 with 29 bits";
        let (name, at) = text.split_once('=').ok_or_else(|| Error::new(format!("`{text}` is no place"), form))?;
        let (name, at) = (name.trim(), at.trim());
        let content = content(name, transport)?;
        let (id, stride) = match at.split_once('/') {
            Some((id, stride)) => (id.trim_end(), Some(stride.trim_start())),
            None => (at, None),
        };
        let wrong =
            |text| Error::new(format!("`{text}` is no identifier"), "give 0 to 0x7FF, or up to 0x1FFFFFFF for 29 bits");
        let id = identifier(id).ok_or_else(|| wrong(id))?;
        let stride = match (content.is_per_slot(), stride) {
            (true, Some(stride)) => distance(name, id, stride)?,
            (false, None) => 0,
            (true, None) => {
                let example = if id.is_extended() { "0x100" } else { "8" };
                let remedy = format!("add it, such as {name}={id}/{example}");
                return Err(Error::new(format!("{name} has no distance between slots"), remedy));
            }
            (false, Some(_)) => {
                return Err(Error::new(
                    format!("{name} has no slots"),
                    format!("leave the distance away: {name}={id}"),
                ));
            }
        };
        Ok(Self { name: name.into(), content, id, stride })
    }

    /// These identifiers, but for this place.
    fn put(&self, identifiers: Identifiers) -> Identifiers {
        match self.content {
            Content::Said(_, about) if self.content.is_per_slot() => {
                identifiers.place_peers(about, self.id, self.stride)
            }
            content => identifiers.place(content, self.id).expect("the catalogue has a line for what it names"),
        }
    }
}

/// The distance from one slot to the next, for the message of this name whose slot 0 is on `first`.
fn distance(name: &str, first: Identifier, text: &str) -> Result<u32, Error> {
    let distance = number(text).ok_or_else(|| {
        Error::new(format!("`{text}` is no distance between slots"), "give a number of identifiers, such as 0x100")
    })?;
    if distance == 0 {
        return Err(Error::new("the distance between slots is 0", "give at least 1"));
    }
    let last = u64::from(first.number()) + u64::from(distance) * u64::from(SLOTS - 1);
    let (bits, or) = if first.is_extended() { (29, "") } else { (11, ", or an x after the number for 29 bits") };
    if last < 1 << bits {
        return Ok(distance);
    }
    let remedy = format!("give a lower number or a smaller distance{or} (all {SLOTS} slots count)");
    Err(Error::new(format!("the identifiers of {name} do not fit into {bits} bits"), remedy))
}

/// The content of the message with this name on the bus.
fn content(name: &str, transport: Transport) -> Result<Content, Error> {
    let named = |line: &'static Line| Some((name_on(line, transport)?.replace("{slot}", ""), line.content));
    let named: Vec<(String, Content)> = CATALOGUE.iter().filter_map(named).collect();
    named.iter().find(|(of, _)| of == name).map(|(_, content)| *content).ok_or_else(|| {
        let bus = if transport == Transport::Fd { "CAN FD" } else { "classic CAN" };
        let names: Vec<&str> = named.iter().map(|(name, _)| name.as_str()).collect();
        Error::new(format!("there is no message `{name}` on {bus}"), format!("give one of {}", names.join(", ")))
    })
}

/// The name of a line in the DBC of such a bus; `None` if it has no frame of its own there.
fn name_on(line: &Line, transport: Transport) -> Option<&'static str> {
    match (transport, line.on_fd) {
        (Transport::Classic, _) => Some(line.name),
        (Transport::Fd, OnFd::Frame(name)) => Some(name),
        (Transport::Fd, _) => None,
    }
}

/// An identifier; one of 29 bits is above 0x7FF or ends with an x.
fn identifier(text: &str) -> Option<Identifier> {
    if let Some(extended) = text.strip_suffix(['x', 'X']).filter(|_| !text.eq_ignore_ascii_case("0x")) {
        return Identifier::extended(number(extended)?);
    }
    let number = number(text)?;
    u16::try_from(number).ok().and_then(Identifier::standard).or_else(|| Identifier::extended(number))
}

/// The error of identifiers that do not fit together.
fn refusal(cause: IdentifierError, identifiers: &Identifiers, transport: Transport, slots: u8) -> Error {
    let IdentifierError::Shared(one, other) = cause else {
        return Error::new(cause.to_string(), "give a lower number, or a smaller distance between slots");
    };
    let [one, other] = [one, other].map(message);
    let name = |(line, slot): (&Line, Slot)| {
        name_on(line, transport).unwrap_or(line.name).replace("{slot}", &slot.0.to_string())
    };
    let id = identifiers.at(one.0.offset_for(one.1));
    let is_in_use = [one, other].iter().all(|(line, slot)| !line.is_per_slot() || slot.0 < slots);
    let all = if is_in_use { String::new() } else { format!(" (all {SLOTS} slots count)") };
    Error::new(format!("{} and {} are both on {id}{all}", name(one), name(other)), "place one of them elsewhere")
}

/// The line and the slot of a message.
fn message(name: MessageName) -> (&'static Line, Slot) {
    let slots = (0..=u8::MAX).take(usize::from(SLOTS)).map(Slot);
    let mut messages = slots.flat_map(|slot| CATALOGUE.iter().map(move |line| (line, slot)));
    messages
        .find(|(line, slot)| MessageName::of(line, *slot) == name)
        .expect("the catalogue has a line for each message")
}

#[cfg(test)]
mod tests {
    use super::*;
    use holdover::wire::catalogue::{About, Speaker};

    fn read_over(transport: Transport, places: &[&str]) -> Result<Identifiers, String> {
        let place = places.iter().map(|text| (*text).into()).collect();
        let arguments = IdentifierArguments { place, ..IdentifierArguments::default() };
        arguments.read(transport, 8).map_err(|error| error.to_string())
    }

    fn read(places: &[&str]) -> Result<Identifiers, String> {
        read_over(Transport::Classic, places)
    }

    /// The same of a file with this text, and what was typed beside it.
    fn read_file(text: &str, places: &[&str]) -> Result<Identifiers, String> {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("identifiers");
        fs::write(&file, text).unwrap();
        let place = places.iter().map(|text| (*text).into()).collect();
        let arguments = IdentifierArguments { place, identifiers: Some(file), ..IdentifierArguments::default() };
        let path = format!("{}/", folder.path().display());
        arguments.read(Transport::Classic, 8).map_err(|error| error.to_string().replace(&path, ""))
    }

    fn standard(number: u16) -> Identifier {
        Identifier::standard(number).unwrap()
    }

    #[test]
    fn a_base_is_decimal_or_hexadecimal_and_leaves_room_for_all_messages() {
        for (text, id) in [("0", 0), ("1152", 0x480), ("0x480", 0x480), ("0X740", 0x740), ("1856", 0x740)] {
            assert_eq!(base(Some(text)).unwrap().get(), id);
        }
        assert_eq!(base(None).unwrap(), BaseId::DEFAULT);
        for text in ["0x741", "1857", "65535", "65536"] {
            assert!(base(Some(text)).unwrap_err().to_string().contains("; give one up to 0x740"), "{text}");
        }
        for text in ["", "foo", "-1", "+1", "4294967296", "0x", "0x+1", "480h"] {
            let refused = format!("--base-id: `{text}` is no number; give one such as 0x480");
            assert_eq!(base(Some(text)).unwrap_err().to_string(), refused);
        }
    }

    #[test]
    fn a_place_has_11_or_29_bits_and_a_stride_where_there_are_slots() {
        let placed = read(&["MotionCommand=0x0CFF0210x", "TimeSync = 291", "PeerMotionB=0x18FF4021/0x100"]).unwrap();
        let id = Identifier::extended(0x0CFF_0210).unwrap();
        assert_eq!(placed.placement(Content::Command), Some((id, 0)));
        assert_eq!(placed.placement(Content::Sync), Some((standard(0x123), 0)));
        let first = Identifier::extended(0x18FF_4021).unwrap();
        assert_eq!(placed.placement(Content::Said(Speaker::Peer, About::MotionB)), Some((first, 0x100)));
        assert_eq!(placed.placement(Content::FollowUp), None);
    }

    #[test]
    fn what_is_no_place_is_refused_with_its_remedy() {
        for (place, said) in [
            ("MotionCommand", "is no place; write NAME=ID"),
            ("Motion=5", "there is no message `Motion` on classic CAN; give one of TimeSync, "),
            ("TimeSync=0x20000000", "`0x20000000` is no identifier; give 0 to 0x7FF, or up to 0x1FFFFFFF"),
            ("TimeSync=0x20000000x", "is no identifier"),
            ("TimeSync=-1", "is no identifier"),
            ("PeerMotionA=0x18FF4021x", "has no distance between slots; add it, such as PeerMotionA=0x18FF4021x/0x100"),
            ("TimeSync=5/8", "TimeSync has no slots; leave the distance away: TimeSync=0x005"),
            ("TimeSync=0x", "`0x` is no identifier"),
            ("TimeSync=0X", "`0X` is no identifier"),
            ("TimeSync=x", "`x` is no identifier"),
            ("TimeSync=0x+5", "is no identifier"),
            ("PeerMotionA=0x100", "has no distance between slots; add it, such as PeerMotionA=0x100/8"),
            ("PeerMotionA=0x100/0", "the distance between slots is 0; give at least 1"),
            (
                "PeerMotionA=0x7F8/1",
                "the identifiers of PeerMotionA do not fit into 11 bits; give a lower number or a smaller distance, or an x \
                 after the number for 29 bits (all 16 slots count)",
            ),
            (
                "PeerRoute=0x1FFFFFF1/1",
                "of PeerRoute do not fit into 29 bits; give a lower number or a smaller distance (all 16 slots count)",
            ),
            ("PeerRoute=0x100/4294967295", "of PeerRoute do not fit into 11 bits"),
            ("TimeSync=0x482", "MotionCommand and TimeSync are both on 0x482; place one of them elsewhere"),
            ("TimeSync=0x4F9", "Peer7MotionB and TimeSync are both on 0x4F9; place"),
            ("TimeSync=0x501", "Peer8MotionB and TimeSync are both on 0x501 (all 16 slots count); place"),
        ] {
            let error = read(&[place]).unwrap_err();
            assert!(error.starts_with("--place: ") || error.contains("are both on"), "{error}");
            assert!(error.contains(said), "{place}: {error}");
        }
        assert!(read(&["PeerMotionA=0x7F8x/1", "TimeSync=0x0x"]).is_ok());
        let both = read(&["TimeSync=0x123", "MotionCommand=0x123"]).unwrap_err();
        assert!(both.starts_with("TimeSync and MotionCommand are both on 0x123; "), "{both}");
    }

    #[test]
    fn a_name_is_that_of_the_bus() {
        for (transport, place, said) in [
            (Transport::Fd, "EgoMotionB=0x123", "there is no message `EgoMotionB` on CAN FD; give one of TimeSync, "),
            (Transport::Fd, "EgoMotionA=0x123", "there is no message `EgoMotionA` on CAN FD; "),
            (Transport::Fd, "PeerHorizon=0x100/1", "there is no message `PeerHorizon` on CAN FD; "),
            (Transport::Classic, "EgoMotion=0x123", "there is no message `EgoMotion` on classic CAN; "),
            (Transport::Classic, "PeerState=0x100/1", "there is no message `PeerState` on classic CAN; "),
        ] {
            let error = read_over(transport, &[place]).unwrap_err();
            assert!(error.contains(said), "{place}: {error}");
            let (_, listed) = error.split_once("give one of ").unwrap();
            assert_eq!(listed.contains("EgoMotionB"), transport == Transport::Classic, "{error}");
            assert_eq!(listed.contains("PeerState"), transport == Transport::Fd, "{error}");
        }
        let placed = read_over(Transport::Fd, &["EgoMotion=0x123", "PeerState=0x100/1"]).unwrap();
        assert_eq!(placed.placement(Content::Said(Speaker::Ego, About::MotionA)), Some((standard(0x123), 0)));
        assert_eq!(placed.placement(Content::Said(Speaker::Peer, About::MotionA)), Some((standard(0x100), 1)));
    }

    #[test]
    fn two_messages_are_on_one_identifier_only_if_both_are_frames_of_the_bus() {
        assert!(read_over(Transport::Fd, &["MotionCommand=0x485"]).is_ok());
        let classic = read(&["MotionCommand=0x485"]).unwrap_err();
        assert!(classic.starts_with("EgoMotionB and MotionCommand are both on 0x485; "), "{classic}");
        let fd = read_over(Transport::Fd, &["MotionCommand=0x484"]).unwrap_err();
        assert!(fd.starts_with("EgoMotion and MotionCommand are both on 0x484; "), "{fd}");
    }

    #[test]
    fn a_message_is_placed_once_in_a_file_and_once_by_the_option_which_goes_before() {
        let twice = read_file("MotionCommand=0x123\n\nMotionCommand=0x124\n", &[]).unwrap_err();
        assert_eq!(twice, "identifiers:3: MotionCommand is placed in line 1 already; delete one");
        let twice = read(&["TimeSync=0x123", "TimeSync=0x123"]).unwrap_err();
        assert_eq!(twice, "--place: TimeSync is placed twice; delete one");
        let placed = read_file("MotionCommand=0x123 # as the bus has it\n", &["MotionCommand=0x124"]).unwrap();
        assert_eq!(placed.placement(Content::Command), Some((standard(0x124), 0)));
    }

    #[test]
    fn a_file_may_begin_with_a_mark_of_its_encoding() {
        let placed = read_file("\u{feff}MotionCommand=0x123\r\n", &[]).unwrap();
        assert_eq!(placed.placement(Content::Command), Some((standard(0x123), 0)));
    }
}
