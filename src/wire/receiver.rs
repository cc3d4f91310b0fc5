//! Frames in, whole messages out: identifier, length, E2E, ranges and the parts of a message are judged here, in this
//! order, and each failure is a named [`Cause`].
//!
//! A refused frame changes the E2E state of its identifier and, if it is `Torn`, begins a new message; nothing else. A
//! frame of another identifier costs two comparisons, and one more for each line that is placed outside the block.

use embedded_can::Frame;

use super::actuators::ActuatorState;
use super::assembly::{Assembly, Piece};
use super::bits::Payload;
use super::catalogue::{self, ABOUTS, About, Content, LIMITS, LINES, Node, PEERS_OFFSET, Speaker};
use super::command::Command;
use super::driver_request::DriverRequest;
use super::driving_parameters::DrivingParameters;
use super::e2e::{self, Check};
use super::estimate::TargetEstimate;
use super::geo::GeoPosition;
use super::horizon::{KNOTS, Knots};
use super::identifiers::Identifiers;
use super::index::{self, Entry};
use super::motion::Motion;
use super::pass::Pass;
use super::range_sensor::RangeSample;
use super::route::Route;
use super::status::Status;
use super::sync::{FollowUp, Sync};
use super::unserved::Unserved;
use super::{Message, Said, Slot};
use crate::health::Cause;
use crate::time::Instant;

#[cfg(feature = "fd")]
mod over_fd;

/// On which side of the bus the receiver stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Role {
    /// The unit: hears the vehicle and the modem.
    Unit,
    /// The modem, the harness or a tool: hears the unit. Needs no peers.
    Modem,
}

impl Role {
    const fn hears(self, sender: Node) -> bool {
        match self {
            Self::Unit => !matches!(sender, Node::Unit),
            Self::Modem => matches!(sender, Node::Unit),
        }
    }
}

/// What a frame brought.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[allow(clippy::large_enum_variant)] // lives for one call; boxing needs an allocator
pub enum Received {
    /// Not for this receiver.
    Foreign,
    /// A good part of a message that is not whole yet.
    Pending,
    /// The whole message.
    Whole(Message),
}

/// What one vehicle's frames have brought so far.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Parts {
    motion: Assembly<2, 0>,
    horizon: Assembly<KNOTS, 1>,
    parameters: Assembly<3, 1>,
    geo: Assembly<2, 1>,
    route: Assembly<2, 1>,
}

impl Parts {
    const NEW: Self = Self {
        motion: Assembly::NEW,
        horizon: Assembly::NEW,
        parameters: Assembly::NEW,
        geo: Assembly::NEW,
        route: Assembly::NEW,
    };

    /// Takes one part. Returns whether the message is whole.
    fn add(&mut self, about: About, piece: &Piece) -> Result<bool, Cause> {
        match about {
            About::MotionA => self.motion.add(&piece.of(0)),
            About::MotionB => self.motion.add(&piece.of(1)),
            About::Horizon => self.horizon.add(piece),
            About::DrivingParameters => self.parameters.add(piece),
            About::Geo => self.geo.add(piece),
            About::Route => self.route.add(piece),
        }
    }

    /// The message that is whole.
    #[inline(always)] // made where it is wanted
    fn said(&self, about: About) -> Said {
        match about {
            About::MotionA | About::MotionB => Said::Motion(Motion::decode(self.motion.parts())),
            About::Horizon => Said::Horizon(Knots::decode(self.horizon.parts())),
            About::DrivingParameters => Said::DrivingParameters(DrivingParameters::decode(self.parameters.parts())),
            About::Geo => Said::Geo(GeoPosition::decode(self.geo.parts())),
            About::Route => Said::Route(Route::decode(self.route.parts())),
        }
    }
}

/// One slot's state.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Peer {
    checks: [Check; ABOUTS],
    parts: Parts,
}

impl Peer {
    const NEW: Self = Self { checks: [Check::new(); ABOUTS], parts: Parts::NEW };
}

/// The receiving side of the bus, with so many slots.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Receiver<const PEERS: usize> {
    identifiers: Identifiers,
    role: Role,
    /// By place in the catalogue; those of the peers' lines are not used.
    checks: [Check; LINES],
    /// Of the one vehicle that is not a peer: the ego for the unit, the unit's own for the modem.
    own: Parts,
    estimate: Assembly<2, 0>,
    /// Of the other vehicles for the unit, of the unit's own for the modem.
    pass: Assembly<4, 1>,
    peers: [Peer; PEERS],
    #[cfg(feature = "fd")]
    fd: over_fd::OverFd<PEERS>,
}

impl<const PEERS: usize> Receiver<PEERS> {
    /// Nothing received yet.
    #[must_use]
    pub const fn new(identifiers: Identifiers, role: Role) -> Self {
        Self {
            identifiers,
            role,
            checks: [Check::new(); LINES],
            own: Parts::NEW,
            estimate: Assembly::NEW,
            pass: Assembly::NEW,
            peers: [const { Peer::NEW }; PEERS],
            #[cfg(feature = "fd")]
            fd: over_fd::OverFd::NEW,
        }
    }

    pub(crate) fn set_identifiers(&mut self, identifiers: &Identifiers) {
        self.identifiers = *identifiers;
    }

    /// Takes one frame received at `at`.
    ///
    /// # Errors
    /// `UnknownSlot`, `Length` (also for a remote frame, and for one of the other kind of bus), the E2E refusals (`Checksum`,
    /// `CounterRange`, `Repeated`, `CounterGap`, `NotYetTrusted`), `Range`, `Torn`, tested in this order.
    pub fn receive(&mut self, at: Instant, frame: &impl Frame) -> Result<Received, Cause> {
        match self.role {
            Role::Unit => self.receive_as::<true>(at, frame),
            Role::Modem => self.receive_as::<false>(at, frame),
        }
    }

    /// As [`receive`](Self::receive) of a unit's receiver, without what the other side's takes: an image for an ECU need not
    /// hold that.
    pub(crate) fn receive_as_unit(&mut self, at: Instant, frame: &impl Frame) -> Result<Received, Cause> {
        self.receive_as::<true>(at, frame)
    }

    #[inline(always)]
    fn receive_as<const UNIT: bool>(&mut self, at: Instant, frame: &impl Frame) -> Result<Received, Cause> {
        let role = if UNIT { Role::Unit } else { Role::Modem };
        let Some(offset) = self.identifiers.offset_of(frame.id().into()) else { return Ok(Received::Foreign) };
        let Some((place, entry, slot)) = index::find(offset) else { return Ok(Received::Foreign) };
        if !role.hears(entry.sender) {
            return Ok(Received::Foreign);
        }
        #[cfg(feature = "fd")]
        if self.fd.is_used() {
            return self.receive_over_fd::<UNIT>(place, entry, slot, offset, frame);
        }
        if entry.content.is_per_slot() && usize::from(slot.0) >= PEERS {
            return Err(Cause::UnknownSlot);
        }
        let data: &[u8; 8] = match (frame.is_remote_frame(), frame.data().try_into()) {
            (false, Ok(data)) => data,
            _ => return Err(Cause::Length),
        };
        let data_id = catalogue::data_id(offset);
        self.check_of(place, entry, slot)?.receive(&LIMITS, data_id, data)?;
        let payload = Payload::from_bytes(*data);
        entry.check(payload)?;
        self.assemble::<UNIT>(at, entry, slot, e2e::counter_of(data), payload)
    }

    fn check_of(&mut self, place: usize, entry: &Entry, slot: Slot) -> Result<&mut Check, Cause> {
        let check = if entry.content.is_per_slot() {
            let about = usize::from(entry.offset.saturating_sub(PEERS_OFFSET));
            self.peers.get_mut(usize::from(slot.0)).and_then(|peer| peer.checks.get_mut(about))
        } else {
            self.checks.get_mut(place)
        };
        check.ok_or(Cause::UnknownSlot)
    }

    /// What only the other side sends does not get here.
    #[inline(always)] // a message is made where it is wanted
    fn assemble<const UNIT: bool>(
        &mut self,
        at: Instant,
        entry: &Entry,
        slot: Slot,
        counter: u8,
        payload: Payload,
    ) -> Result<Received, Cause> {
        let (part, tag) = (entry.part_of(payload), super::field::TAG.byte(payload));
        let piece = Piece { at, within: entry.within, part, tag, counter, payload };
        let message = match entry.content {
            Content::EstimateA | Content::EstimateB if UNIT => None,
            Content::Said(Speaker::Own, _) if UNIT => None,
            Content::Said(speaker, about) => {
                let parts = match speaker {
                    Speaker::Ego | Speaker::Own => &mut self.own,
                    Speaker::Peer => &mut self.peers.get_mut(usize::from(slot.0)).ok_or(Cause::UnknownSlot)?.parts,
                };
                if !parts.add(about, &piece)? {
                    return Ok(Received::Pending);
                }
                return Ok(Received::Whole(match speaker {
                    Speaker::Ego => Message::Ego(parts.said(about)),
                    Speaker::Own => Message::Own(parts.said(about)),
                    Speaker::Peer => Message::Peer(slot, parts.said(about)),
                }));
            }
            Content::Pass(_) if !self.pass.add(&piece)? => None,
            Content::Pass(speaker) => pass::<UNIT>(speaker, self.pass.parts()),
            Content::EstimateA => self.add_estimate(&piece.of(0))?,
            Content::EstimateB => self.add_estimate(&piece.of(1))?,
            single => decode_single::<UNIT>(single, payload)?,
        };
        Ok(message.map_or(Received::Pending, Received::Whole))
    }

    fn add_estimate(&mut self, piece: &Piece) -> Result<Option<Message>, Cause> {
        if !self.estimate.add(piece)? {
            return Ok(None);
        }
        Ok(Some(Message::Estimate(TargetEstimate::decode(self.estimate.parts())?)))
    }
}

/// What is said of passes.
fn pass<const UNIT: bool>(speaker: Speaker, parts: &[Payload; 4]) -> Option<Message> {
    let pass = Pass::decode(parts);
    match speaker {
        Speaker::Peer => Some(Message::PeerPass(pass)),
        _ if UNIT => None,
        _ => Some(Message::OwnPass(pass)),
    }
}

/// The message of a content that one frame of classic CAN has room for; `None` for every other.
#[inline(always)] // into the one place of each bus
fn decode_single<const UNIT: bool>(content: Content, payload: Payload) -> Result<Option<Message>, Cause> {
    let whole = [payload];
    Ok(match content {
        Content::Sync => Some(Message::Sync(Sync::decode(&whole))),
        Content::FollowUp => Some(Message::FollowUp(FollowUp::decode(&whole))),
        Content::Command | Content::Status if UNIT => None,
        Content::Command => Some(Message::Command(Command::decode(&whole))),
        Content::DriverRequest => Some(Message::DriverRequest(DriverRequest::decode(&whole))),
        Content::Actuators => Some(Message::Actuators(ActuatorState::decode(&whole))),
        Content::Range => Some(Message::Range(RangeSample::decode(&whole))),
        Content::Unserved => Some(Message::Unserved(Unserved::decode(&whole))),
        Content::Status => Some(Message::Status(Status::decode(&whole)?)),
        Content::EstimateA | Content::EstimateB | Content::Pass(_) | Content::Said(..) => None,
    })
}

#[cfg(all(test, not(feature = "fd")))]
mod tests {
    use super::*;

    #[test]
    fn a_receiver_for_eight_peers_takes_less_than_two_and_three_quarters_of_a_kilobyte() {
        let size = size_of::<Receiver<8>>();
        assert!(size <= 2816, "{size} bytes");
    }
}
