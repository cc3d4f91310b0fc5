//! Frames of CAN FD in, whole messages out: judged like those of classic CAN, but that nothing is put together of parts. A tag, where
//! a message has one, is the low bits of its frame's counter.

use embedded_can::Frame;

use super::{Received, Receiver, decode_single};
use crate::health::Cause;
use crate::wire::bits::Payload;
use crate::wire::catalogue::{self, ABOUTS, About, Content, LINES, PEERS_OFFSET, Speaker};
use crate::wire::driving_parameters::DrivingParameters;
use crate::wire::estimate::TargetEstimate;
use crate::wire::fd::e2e::Check;
use crate::wire::fd::layout::{self, Parts};
use crate::wire::fd::{Bits, State};
use crate::wire::geo::GeoPosition;
use crate::wire::horizon::Knots;
use crate::wire::index::Entry;
use crate::wire::motion::Motion;
use crate::wire::route::Route;
use crate::wire::{Message, Said, Slot, Transport};

/// What a receiver keeps beside, for CAN FD.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct OverFd<const PEERS: usize> {
    transport: Transport,
    /// By place in the catalogue; those of the peers' lines are not used.
    checks: [Check; LINES],
    peers: [[Check; ABOUTS]; PEERS],
}

impl<const PEERS: usize> OverFd<PEERS> {
    pub(super) const NEW: Self = Self {
        transport: Transport::Classic,
        checks: [Check::new(); LINES],
        peers: [const { [Check::new(); ABOUTS] }; PEERS],
    };

    #[inline(always)]
    pub(super) const fn is_used(&self) -> bool {
        matches!(self.transport, Transport::Fd)
    }

    fn check_of(&mut self, place: usize, entry: &Entry, slot: Slot) -> Option<&mut Check> {
        if entry.content.is_per_slot() {
            let about = usize::from(entry.offset.saturating_sub(PEERS_OFFSET));
            self.peers.get_mut(usize::from(slot.0)).and_then(|checks| checks.get_mut(about))
        } else {
            self.checks.get_mut(place)
        }
    }
}

impl<const PEERS: usize> Receiver<PEERS> {
    /// On a bus with these frames; before anything is received.
    #[must_use]
    pub const fn over(mut self, transport: Transport) -> Self {
        self.fd.transport = transport;
        self
    }

    pub(crate) fn set_transport(&mut self, transport: Transport) {
        self.fd.transport = transport;
    }

    /// Of a frame that this side hears.
    #[inline(never)] // apart from the other bus's stack
    pub(super) fn receive_over_fd<const UNIT: bool>(
        &mut self,
        place: usize,
        entry: &Entry,
        slot: Slot,
        offset: u16,
        frame: &impl Frame,
    ) -> Result<Received, Cause> {
        let Some(layout) = layout::of(place) else { return Ok(Received::Foreign) };
        let check = self.fd.check_of(place, entry, slot).ok_or(Cause::UnknownSlot)?;
        let data = frame.data();
        if frame.is_remote_frame() || data.len() != usize::from(layout.bytes) {
            return Err(Cause::Length);
        }
        let counter = check.receive(catalogue::data_id(offset), data)?;
        let parts = layout.unpack(&Bits::of(data), counter & 3)?;
        Ok(decode::<UNIT>(entry.content, slot, &parts)?.map_or(Received::Foreign, Received::Whole))
    }
}

/// The message that begins with this content. What only the other side sends does not get here.
fn decode<const UNIT: bool>(content: Content, slot: Slot, parts: &Parts) -> Result<Option<Message>, Cause> {
    let [first, second, ..] = *parts;
    let pair = [first.unwrap_or_default(), second.unwrap_or_default()];
    Ok(match content {
        Content::EstimateA | Content::Said(Speaker::Own, _) if UNIT => None,
        Content::Pass(speaker) => {
            let [a, b, c, d, ..] = parts.map(Option::unwrap_or_default);
            super::pass::<UNIT>(speaker, &[a, b, c, d])
        }
        Content::EstimateA => Some(Message::Estimate(TargetEstimate::decode(&pair)?)),
        Content::Said(speaker, about) => said(speaker, about, &pair, parts).map(|said| match speaker {
            Speaker::Ego => Message::Ego(said),
            Speaker::Own => Message::Own(said),
            Speaker::Peer => Message::Peer(slot, said),
        }),
        single => {
            let [first, _] = pair;
            decode_single::<UNIT>(single, first)?
        }
    })
}

fn said(speaker: Speaker, about: About, pair: &[Payload; 2], parts: &Parts) -> Option<Said> {
    Some(match about {
        About::MotionA if matches!(speaker, Speaker::Ego) => Said::Motion(Motion::decode(pair)),
        About::MotionA => Said::State(state(pair, parts)),
        About::Geo => Said::Geo(GeoPosition::decode(pair)),
        About::Route => Said::Route(Route::decode(pair)),
        About::MotionB | About::Horizon | About::DrivingParameters => return None,
    })
}

fn state(pair: &[Payload; 2], parts: &Parts) -> State {
    let [_, _, a, b, c, d, e, f, g, h] = *parts;
    let horizon = match (a, b, c, d, e) {
        (Some(a), Some(b), Some(c), Some(d), Some(e)) => Some(Knots::decode(&[a, b, c, d, e])),
        _ => None,
    };
    let parameters = match (f, g, h) {
        (Some(f), Some(g), Some(h)) => Some(DrivingParameters::decode(&[f, g, h])),
        _ => None,
    };
    State { motion: Motion::decode(pair), parameters, horizon }
}
