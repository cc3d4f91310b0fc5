//! The catalogue as a DBC file for everyone else's tools: its identifiers, a number of slots and a kind of bus enter, text leaves
//! ([`core::fmt::Display`]). `holdover.dbc` and `holdover-fd.dbc` at the root of the package are this for base 0x480 and 8 slots.

use core::fmt::{Display, Formatter, Result};

use super::catalogue::{CATALOGUE, Content, Line, Node, OnFd, SLOTS};
use super::identifier::Identifier;
use super::identifiers::Identifiers;
use super::message_name::Name;
use super::{Slot, Transport, meaning};
use crate::health::Cause;
use signal::Signal;

mod attributes;
mod signal;
mod texts;

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

    /// When it is sent, and rules for readers: of each line of the frame those that the line before it does not have.
    fn write_comment(&self, f: &mut Formatter<'_>) -> Result {
        let Line { only, tied, comment, .. } = self.line;
        if self.line.is_sent() && !only.is_empty() {
            write!(f, "Sent only {only}. ")?;
        }
        if self.line.is_sent() && !self.is_over_fd && !tied.is_empty() {
            write!(f, "{tied} ")?;
        }
        f.write_str(comment)?;
        if let Content::Status = self.line.content {
            for cause in Cause::ALL {
                write!(f, " {}: {}", cause.name(), cause.meaning())?;
            }
        }
        if !self.is_over_fd {
            return Ok(());
        }
        let mut before = *comment;
        let followers = CATALOGUE.iter().skip(self.place.saturating_add(1)).take_while(|line| !line.begins(true));
        for Line { only, comment, on_fd, .. } in followers {
            if let OnFd::MayFollow(flag) = on_fd {
                write!(f, " {flag} is present only {only}.")?;
            }
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
        attributes::define(f, is_over_fd)?;
        for message in self.messages() {
            let id = message.id.in_dbc();
            for (name, value) in message.attributes() {
                writeln!(f, "BA_ \"{name}\" BO_ {id} {value};")?;
            }
            for name in ["Crc", "Counter"] {
                writeln!(f, "BA_ \"GenSigStartValue\" SG_ {id} {name} 0;")?;
            }
            for signal in message.signals() {
                writeln!(f, "BA_ \"GenSigStartValue\" SG_ {id} {} {};", signal.name(), signal.start())?;
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
    use crate::parameters::{UNPUBLISHED_POSITION_ACCURACY, UNPUBLISHED_SPEED_ACCURACY};
    use crate::wire::catalogue::{About, Speaker};

    /// The comments of the messages and of their signals.
    fn comments(dbc: Dbc) -> Vec<(String, String)> {
        struct Comment<'a>(&'a Described);
        impl Display for Comment<'_> {
            fn fmt(&self, f: &mut Formatter<'_>) -> Result {
                self.0.write_comment(f)
            }
        }
        let of = |message: Described| {
            let signals = message.signals();
            let signal = |signal: Signal| signal.meaning(message.is_over_fd).to_string();
            let texts: Vec<_> = std::iter::once(Comment(&message).to_string()).chain(signals.map(signal)).collect();
            texts.into_iter().map(move |text| (message.name().to_string(), text)).collect::<Vec<_>>()
        };
        dbc.messages().flat_map(of).collect()
    }

    /// Whatever looks like the name of a message or signal is one, or begins one: a file speaks of nothing that is not in it.
    fn comments_name_only_what_is_there(dbc: Dbc) {
        let signals =
            dbc.messages().flat_map(|message| message.signals().map(|s| s.name().to_string()).collect::<Vec<_>>());
        let names: Vec<_> = dbc.messages().map(|message| message.name().to_string()).chain(signals).collect();
        for (message, comment) in comments(dbc) {
            assert!(comment.ends_with('.') && !comment.contains('"'), "{message}: {comment}");
            for word in comment.split(|c: char| !c.is_ascii_alphanumeric()) {
                let humps = word
                    .chars()
                    .zip(word.chars().skip(1))
                    .filter(|(a, b)| a.is_ascii_lowercase() && b.is_ascii_uppercase());
                let is_known = names.iter().any(|name| name.starts_with(word));
                assert!(humps.count() == 0 || is_known, "{message}: {word} is not in the file: {comment}");
                let is_of_classic = ["FollowUp", "Sync", "Motion", "MotionA", "MotionB", "Tag"].contains(&word);
                assert!(!is_of_classic || names.iter().any(|name| name == word), "{message}: {word}: {comment}");
            }
        }
    }

    #[test]
    fn every_message_has_a_comment_and_comments_name_only_what_is_there() {
        comments_name_only_what_is_there(Dbc::new(Identifiers::DEFAULT, 1));
        #[cfg(feature = "fd")]
        comments_name_only_what_is_there(Dbc::new(Identifiers::DEFAULT, 1).over_fd());
    }

    #[test]
    fn comments_tell_what_is_taken_for_an_accuracy_that_is_not_published() {
        for (name, taken) in [
            ("PositionAccuracy", format!("not published: {} m is", UNPUBLISHED_POSITION_ACCURACY.get())),
            ("SpeedAccuracy", format!("not published: {} m/s is", UNPUBLISHED_SPEED_ACCURACY.get())),
        ] {
            let text = meaning::signal(Content::Said(Speaker::Peer, About::MotionB), name, false);
            assert!(text.to_lowercase().contains(&taken), "{text}: {taken}");
        }
    }

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
