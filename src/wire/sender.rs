//! Messages in, protected frames out: the sending side of the bus, for the unit (`Own*`, command, estimate, status) as
//! for the modem, the vehicle's sensors and the harness (the rest).
//!
//! A tag that stands in a message is its producer's: a horizon has to carry the tag of its motion. [`DrivingParameters`] has none,
//! so the sender counts one for it.
//!
//! [`DrivingParameters`]: super::driving_parameters::DrivingParameters

use super::bits::Payload;
use super::catalogue::{self, ABOUTS, About, Content, LINES, PEERS_OFFSET, Speaker};
use super::identifiers::Identifiers;
use super::index::{self, Entry};
use super::{Frame, Message, Said, Slot, e2e};

#[cfg(feature = "fd")]
mod over_fd;

/// Why a message was not sent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Unsent {
    /// The catalogue has no line for it: of the ego there are only motion and position.
    NoLine,
    /// A slot beyond the sender's.
    UnknownSlot,
}

/// The E2E counters of all identifiers, and the tags of driving parameters; with so many slots (0 for the unit).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Sender<const PEERS: usize> {
    identifiers: Identifiers,
    /// By place in the catalogue; those of the peers' lines are not used.
    counters: [u8; LINES],
    parameters_tag: u8,
    peers: [Peer; PEERS],
    #[cfg(feature = "fd")]
    transport: super::Transport,
}

#[derive(Clone, Debug, PartialEq, Eq)]
struct Peer {
    counters: [u8; ABOUTS],
    parameters_tag: u8,
}

impl Peer {
    const NEW: Self = Self { counters: [0; ABOUTS], parameters_tag: 0 };
}

impl<const PEERS: usize> Sender<PEERS> {
    /// Nothing sent yet: every counter starts at 0.
    #[must_use]
    pub const fn new(identifiers: Identifiers) -> Self {
        Self {
            identifiers,
            counters: [0; LINES],
            parameters_tag: 0,
            peers: [const { Peer::NEW }; PEERS],
            #[cfg(feature = "fd")]
            transport: super::Transport::Classic,
        }
    }

    pub(crate) fn set_identifiers(&mut self, identifiers: &Identifiers) {
        self.identifiers = *identifiers;
    }

    /// Emits the message's frames, in order.
    ///
    /// # Errors
    /// [`Unsent`]; nothing was emitted then.
    pub fn send(&mut self, message: &Message, emit: &mut impl FnMut(Frame)) -> Result<(), Unsent> {
        let none = Slot(0);
        match message {
            Message::Sync(sync) => self.emit(Content::Sync, none, &sync.encode(), emit),
            Message::FollowUp(follow_up) => self.emit(Content::FollowUp, none, &follow_up.encode(), emit),
            Message::Actuators(state) => self.emit(Content::Actuators, none, &state.encode(), emit),
            Message::DriverRequest(parameters) => self.emit(Content::DriverRequest, none, &parameters.encode(), emit),
            Message::Range(sample) => self.emit(Content::Range, none, &sample.encode(), emit),
            Message::Unserved(unserved) => self.emit(Content::Unserved, none, &unserved.encode(), emit),
            Message::PeerPass(pass) => self.emit(Content::Pass(Speaker::Peer), none, &pass.encode(), emit),
            Message::Ego(said) => self.say(Speaker::Ego, none, said, emit),
            Message::Peer(slot, said) => self.say(Speaker::Peer, *slot, said, emit),
            Message::Command(_) | Message::Status(_) | Message::Estimate(_) | Message::Own(_) | Message::OwnPass(_) => {
                self.send_as_unit(message, emit)
            }
        }
    }

    /// Emits the frames of a message that the unit sends: an image with this alone holds the encoders of the unit's messages alone.
    ///
    /// # Errors
    /// [`Unsent`], also for what the unit does not send; nothing was emitted then.
    pub fn send_as_unit(&mut self, message: &Message, emit: &mut impl FnMut(Frame)) -> Result<(), Unsent> {
        let none = Slot(0);
        match message {
            Message::Command(command) => self.emit(Content::Command, none, &command.encode(), emit),
            Message::Status(status) => self.emit(Content::Status, none, &status.encode(), emit),
            Message::Estimate(estimate) => {
                self.emit_pair([Content::EstimateA, Content::EstimateB], none, &estimate.encode(), emit)
            }
            Message::Own(said) => self.say(Speaker::Own, none, said, emit),
            Message::OwnPass(pass) => self.emit(Content::Pass(Speaker::Own), none, &pass.encode(), emit),
            _ => Err(Unsent::NoLine),
        }
    }

    fn say(&mut self, speaker: Speaker, slot: Slot, said: &Said, emit: &mut impl FnMut(Frame)) -> Result<(), Unsent> {
        match said {
            Said::Motion(motion) => {
                let halves = [About::MotionA, About::MotionB].map(|about| Content::Said(speaker, about));
                self.emit_pair(halves, slot, &motion.encode(), emit)
            }
            Said::Horizon(knots) => self.emit(Content::Said(speaker, About::Horizon), slot, &knots.encode(), emit),
            Said::Geo(position) => self.emit(Content::Said(speaker, About::Geo), slot, &position.encode(), emit),
            Said::Route(route) => self.emit(Content::Said(speaker, About::Route), slot, &route.encode(), emit),
            Said::DrivingParameters(parameters) => {
                let tag = self.parameters_tag(speaker, slot)?;
                self.emit(Content::Said(speaker, About::DrivingParameters), slot, &parameters.encode(tag), emit)
            }
            #[cfg(feature = "fd")]
            Said::State(state) => self.say_state(speaker, slot, state, emit),
        }
    }

    /// Emits a message of two halves, which have identifiers of their own on classic CAN and share one frame of CAN FD.
    fn emit_pair(
        &mut self,
        [first, second]: [Content; 2],
        slot: Slot,
        halves: &[Payload; 2],
        emit: &mut impl FnMut(Frame),
    ) -> Result<(), Unsent> {
        #[cfg(feature = "fd")]
        if self.is_over_fd() {
            return self.emit(first, slot, halves, emit);
        }
        let [a, b] = *halves;
        self.emit(first, slot, &[a], emit)?;
        self.emit(second, slot, &[b], emit)
    }

    fn parameters_tag(&mut self, speaker: Speaker, slot: Slot) -> Result<u8, Unsent> {
        let tag = match speaker {
            Speaker::Peer => &mut self.peers.get_mut(usize::from(slot.0)).ok_or(Unsent::UnknownSlot)?.parameters_tag,
            Speaker::Own | Speaker::Ego => &mut self.parameters_tag,
        };
        *tag = tag.wrapping_add(1) & 3;
        Ok(*tag)
    }

    fn emit(
        &mut self,
        content: Content,
        slot: Slot,
        payloads: &[Payload],
        emit: &mut impl FnMut(Frame),
    ) -> Result<(), Unsent> {
        #[cfg(feature = "fd")]
        if self.is_over_fd() {
            return self.emit_over_fd(content, slot, payloads.iter().map(|payload| Some(*payload)), emit);
        }
        let (place, entry) = index::find_content(content).ok_or(Unsent::NoLine)?;
        let offset = entry.offset_for(slot);
        let id = self.identifiers.at(offset);
        let counter = self.counter(place, entry, slot)?;
        for payload in payloads {
            emit(Frame { id, data: e2e::protect(payload.to_bytes(), catalogue::data_id(offset), *counter).into() });
            *counter = e2e::next(*counter);
        }
        Ok(())
    }

    fn counter(&mut self, place: usize, entry: &Entry, slot: Slot) -> Result<&mut u8, Unsent> {
        if entry.content.is_per_slot() {
            if u16::from(slot.0) >= catalogue::SLOTS {
                return Err(Unsent::UnknownSlot);
            }
            let about = usize::from(entry.offset.saturating_sub(PEERS_OFFSET));
            let peer = self.peers.get_mut(usize::from(slot.0)).ok_or(Unsent::UnknownSlot)?;
            peer.counters.get_mut(about).ok_or(Unsent::NoLine)
        } else {
            self.counters.get_mut(place).ok_or(Unsent::NoLine)
        }
    }
}
