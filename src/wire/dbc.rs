//! The catalogue as a DBC file for everyone else's tools: its identifiers, a number of slots and a kind of bus enter, text leaves
//! ([`core::fmt::Display`]). `holdover.dbc` and `holdover-fd.dbc` at the root of the package are this for base 0x480 and 8 slots.

use core::fmt::{Display, Formatter, Result};

use super::catalogue::{CATALOGUE, Line, Node, OnFd, SLOTS, data_id};
use super::identifier::Identifier;
use super::identifiers::Identifiers;
use super::message_name::Name;
use super::{Slot, Transport, meaning};
use signal::Signal;

mod signal;
mod texts;

/// The number of `ExtendedCAN_FD` among the values of `VFrameFormat`.
const EXTENDED_CAN_FD: u16 = 15;

/// The DBC of a bus.
#[derive(Clone, Copy, Debug)]
pub struct Dbc {
    identifiers: Identifiers,
    slots: u8,
    transport: Transport,
}

/// A message of the file.
struct Described {
    /// The line that its frame begins with, and that one's place in the catalogue.
    line: &'static Line,
    #[cfg_attr(not(feature = "fd"), allow(dead_code))] // on classic CAN a frame is of one line
    place: usize,
    slot: Slot,
    id: Identifier,
    is_over_fd: bool,
}

impl Dbc {
    /// Of classic CAN, with these identifiers and so many slots (at most those that there are identifiers for).
    #[must_use]
    pub fn new(identifiers: Identifiers, slots: u8) -> Self {
        Self { identifiers, slots: slots.min(u8::try_from(SLOTS).unwrap_or(u8::MAX)), transport: Transport::Classic }
    }

    /// Of CAN FD.
    #[cfg(feature = "fd")]
    #[must_use]
    pub fn over_fd(self) -> Self {
        Self { transport: Transport::Fd, ..self }
    }

    /// Every message.
    fn messages(&self) -> impl Iterator<Item = Described> {
        let Self { identifiers, slots, transport } = *self;
        let is_over_fd = transport == Transport::Fd;
        let lines = move || CATALOGUE.iter().enumerate().filter(move |(_, line)| line.begins(is_over_fd));
        let single = lines().filter(|(_, line)| !line.is_per_slot()).map(|of| (of, Slot(0)));
        let peers = (0..slots)
            .flat_map(move |slot| lines().filter(|(_, line)| line.is_per_slot()).map(move |of| (of, Slot(slot))));
        single.chain(peers).map(move |((place, line), slot)| {
            let id = identifiers.at(line.offset_for(slot));
            Described { line, place, slot, id, is_over_fd }
        })
    }
}

impl Line {
    /// Whether it begins a frame on this kind of bus.
    fn begins(&self, is_over_fd: bool) -> bool {
        !is_over_fd || matches!(self.on_fd, OnFd::Frame(_))
    }
}

impl Described {
    #[cfg(not(feature = "fd"))]
    fn signals(&self) -> impl Iterator<Item = Signal> {
        signal::classic(self.line)
    }

    #[cfg(feature = "fd")]
    fn signals(&self) -> impl Iterator<Item = Signal> {
        let classic = (!self.is_over_fd).then(|| signal::classic(self.line));
        let over_fd = self.is_over_fd.then(|| signal::over_fd(self.place));
        classic.into_iter().flatten().chain(over_fd.into_iter().flatten())
    }

    /// Bytes of its frame.
    fn bytes(&self) -> u8 {
        #[cfg(feature = "fd")]
        if self.is_over_fd {
            return super::fd::layout::of(self.place).map_or(0, |layout| layout.bytes);
        }
        8
    }

    fn name(&self) -> Name {
        match self.line.on_fd {
            OnFd::Frame(name) if self.is_over_fd => Name(name, self.slot),
            _ => Name(self.line.name, self.slot),
        }
    }

    fn attributes(&self) -> impl Iterator<Item = (&'static str, u16)> {
        let (line, limits, is_over_fd) = (self.line, self.line.limits(), self.is_over_fd);
        let classic = |name, value| (!is_over_fd).then_some((name, value));
        let most_lost = u16::from(limits.max_delta_counter_init);
        [
            Some(("GenMsgCycleTime", line.cycle_ms)),
            Some(("GenMsgTimeout", line.timeout_ms)),
            classic("FramesPerCycle", line.frames.into()),
            Some(("E2EDataId", data_id(line.offset_for(self.slot)))),
            classic("E2EMaxDeltaCounterInit", most_lost),
            classic("E2EMaxNoNewOrRepeatedData", limits.max_no_new_or_repeated.into()),
            classic("E2ESyncCounterInit", limits.sync_counter_init.into()),
            (is_over_fd && self.id.is_extended()).then_some(("VFrameFormat", EXTENDED_CAN_FD)),
            is_over_fd.then_some(("E2EMaxDeltaCounter", most_lost.saturating_add(1))),
        ]
        .into_iter()
        .flatten()
    }

    /// Rules for readers: of each line of the frame those that the line before it does not have.
    fn write_comment(&self, f: &mut Formatter<'_>) -> Result {
        let Line { tied, comment, .. } = self.line;
        if !self.is_over_fd {
            let gap = if tied.is_empty() || comment.is_empty() { "" } else { " " };
            return write!(f, "{tied}{gap}{comment}");
        }
        f.write_str(comment)?;
        let mut before = *comment;
        let followers = CATALOGUE.iter().skip(self.place.saturating_add(1)).take_while(|line| !line.begins(true));
        for Line { comment, .. } in followers {
            if *comment != before {
                write!(f, " {comment}")?;
            }
            before = comment;
        }
        Ok(())
    }
}

impl Display for Dbc {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let is_over_fd = self.transport == Transport::Fd;
        let [crc, counter] = meaning::header(is_over_fd);
        let [crc_place, counter_place] = if is_over_fd {
            ["0|16@1+ (1,0) [0|65535]", "16|8@1+ (1,0) [0|255]"]
        } else {
            ["0|8@1+ (1,0) [0|255]", "8|4@1+ (1,0) [0|14]"]
        };
        f.write_str(texts::HEAD)?;
        for message in self.messages() {
            let (line, id) = (message.line, message.id.in_dbc());
            writeln!(f, "BO_ {id} {}: {} {}", message.name(), message.bytes(), node(line.sender))?;
            let receivers = if matches!(line.sender, Node::Unit) { "Modem,Vehicle" } else { "Unit" };
            writeln!(f, " SG_ Crc : {crc_place} \"\" {receivers}")?;
            writeln!(f, " SG_ Counter : {counter_place} \"\" {receivers}")?;
            for signal in message.signals() {
                writeln!(f, " SG_ {signal} {receivers}")?;
            }
            writeln!(f)?;
        }
        f.write_str(texts::notes(is_over_fd))?;
        f.write_str(texts::NODES)?;
        for message in self.messages() {
            let id = message.id.in_dbc();
            write!(f, "CM_ BO_ {id} \"")?;
            message.write_comment(f)?;
            writeln!(f, "\";")?;
            writeln!(f, "CM_ SG_ {id} Crc \"{crc}\";")?;
            writeln!(f, "CM_ SG_ {id} Counter \"{counter}\";")?;
            for signal in message.signals() {
                writeln!(f, "CM_ SG_ {id} {} \"{}\";", signal.name(), signal.meaning(is_over_fd))?;
            }
        }
        f.write_str(texts::attributes(is_over_fd))?;
        for message in self.messages() {
            let id = message.id.in_dbc();
            for (name, value) in message.attributes() {
                writeln!(f, "BA_ \"{name}\" BO_ {id} {value};")?;
            }
            for signal in message.signals() {
                let (name, start) = (signal.name(), signal.start());
                if start != 0 {
                    writeln!(f, "BA_ \"GenSigStartValue\" SG_ {id} {name} {start};")?;
                }
            }
        }
        for message in self.messages() {
            for signal in message.signals().filter(|signal| !signal.field.values.is_empty()) {
                write!(f, "VAL_ {} {}", message.id.in_dbc(), signal.name())?;
                for (raw, name) in signal.field.values {
                    write!(f, " {raw} \"{name}\"")?;
                }
                writeln!(f, " ;")?;
            }
        }
        Ok(())
    }
}

const fn node(node: Node) -> &'static str {
    match node {
        Node::Unit => "Unit",
        Node::Modem => "Modem",
        Node::Vehicle => "Vehicle",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn every_signal_says_what_it_means(dbc: Dbc) {
        for message in dbc.messages() {
            for signal in message.signals() {
                let meaning = signal.meaning(message.is_over_fd);
                assert!(
                    meaning.ends_with('.') && !meaning.contains('"'),
                    "{} {}: {meaning}",
                    message.name(),
                    signal.name()
                );
                assert!(!message.is_over_fd || !meaning.contains("Tag"), "{meaning}");
                let others = message.signals().filter(|other| other.name().to_string() == signal.name().to_string());
                assert_eq!(others.count(), 1, "{} {}", message.name(), signal.name());
            }
        }
    }

    #[test]
    fn every_signal_says_what_it_means_and_has_a_name_of_its_own() {
        every_signal_says_what_it_means(Dbc::new(Identifiers::DEFAULT, 1));
        #[cfg(feature = "fd")]
        every_signal_says_what_it_means(Dbc::new(Identifiers::DEFAULT, 1).over_fd());
    }

    #[test]
    fn every_factor_of_the_catalogue_is_a_decimal() {
        for field in CATALOGUE.iter().flat_map(|line| line.fields) {
            assert_eq!(1_000_000_000 % field.per_unit, 0, "{}", field.name);
        }
    }
}
