//! Messages in, frames of CAN FD out: one frame for each message.

use super::{Sender, Unsent};
use crate::wire::bits::Payload;
use crate::wire::catalogue::{self, About, Content, Speaker};
use crate::wire::fd::{State, e2e, layout};
use crate::wire::frame::{Data, Frame};
use crate::wire::{Said, Slot, Transport, index};

impl<const PEERS: usize> Sender<PEERS> {
    /// On a bus with these frames; before anything is sent.
    #[must_use]
    pub const fn over(mut self, transport: Transport) -> Self {
        self.transport = transport;
        self
    }

    pub(crate) fn set_transport(&mut self, transport: Transport) {
        self.transport = transport;
    }

    pub(super) const fn is_over_fd(&self) -> bool {
        matches!(self.transport, Transport::Fd)
    }

    /// Emits the frame that begins with this content.
    pub(super) fn emit_over_fd(
        &mut self,
        content: Content,
        slot: Slot,
        payloads: impl Iterator<Item = Option<Payload>>,
        emit: &mut impl FnMut(Frame),
    ) -> Result<(), Unsent> {
        let (place, entry) = index::find_content(content).ok_or(Unsent::NoLine)?;
        let layout = layout::of(place).ok_or(Unsent::NoLine)?;
        let offset = entry.offset_for(slot);
        let id = self.identifiers.at(offset);
        let counter = self.counter(place, entry, slot)?;
        let mut bits = layout.pack(payloads);
        let data = bits.bytes_mut(layout.bytes.into());
        e2e::protect(data, catalogue::data_id(offset), *counter);
        *counter = counter.wrapping_add(1);
        emit(Frame { id, data: Data::new(data).ok_or(Unsent::NoLine)? });
        Ok(())
    }

    /// Emits what a vehicle says of its motion and of what it will do: one frame of CAN FD, or those of its parts.
    pub(super) fn say_state(
        &mut self,
        speaker: Speaker,
        slot: Slot,
        state: &State,
        emit: &mut impl FnMut(Frame),
    ) -> Result<(), Unsent> {
        if matches!(speaker, Speaker::Ego) {
            return Err(Unsent::NoLine);
        }
        let State { motion, parameters, horizon } = *state;
        if self.is_over_fd() {
            let [a, b] = motion.encode().map(Some);
            let horizon = horizon.map_or([None; 5], |knots| knots.encode().map(Some));
            let parameters = parameters.map_or([None; 3], |parameters| parameters.encode(0).map(Some));
            let payloads = [a, b].into_iter().chain(horizon).chain(parameters);
            return self.emit_over_fd(Content::Said(speaker, About::MotionA), slot, payloads, emit);
        }
        let rest = [parameters.map(Said::DrivingParameters), horizon.map(Said::Horizon)];
        let said = [Some(Said::Motion(motion))].into_iter().chain(rest).flatten();
        said.into_iter().try_for_each(|said| self.say(speaker, slot, &said, emit))
    }
}
