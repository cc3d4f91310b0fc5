//! The modem between the air and the bus. Messages from the channel enter, and frames on the unit's bus leave; what the unit has told
//! of itself leaves to be broadcast.

use std::io;

use crate::bus::Bus;
use crate::sim::modem::V2xMessage;
use crate::sim::vehicle::Vehicle;

impl Vehicle {
    /// Receives a message from the channel.
    ///
    /// # Errors
    /// Errors of the bus.
    pub fn hear(&mut self, at_s: f64, message: &V2xMessage) -> io::Result<()> {
        self.forward_held(at_s)?;
        self.note_ahead(at_s, message);
        let (at, message) = (self.instant(at_s), self.alias.of_message(message));
        let harness = &self.harness;
        if self.backlog.has_room(message.motion.station, |frame| harness.waits(at, frame)) {
            return self.forward(at_s, &message);
        }
        self.backlog.hold(message);
        Ok(())
    }

    /// Forwards the messages that were held back, if there is room on the bus now.
    pub(super) fn forward_held(&mut self, at_s: f64) -> io::Result<()> {
        let (at, harness) = (self.instant(at_s), &self.harness);
        let released = self.backlog.released(|frame| harness.waits(at, frame));
        released.iter().try_for_each(|message| self.forward(at_s, message))
    }

    /// Puts a message on the unit's bus.
    fn forward(&mut self, at_s: f64, message: &V2xMessage) -> io::Result<()> {
        let (at, mut frames) = (self.instant(at_s), Vec::new());
        self.relay.hear(at_s, message, &mut frames);
        if let Some(last) = frames.last() {
            self.backlog.send(message.motion.station, last.into());
        }
        frames.iter().try_for_each(|frame| self.harness.send(at, frame.into()))
    }

    /// Forgets what the modem has broadcast up to now, because no other vehicle was within radio range.
    ///
    /// # Errors
    /// Errors of the bus.
    pub fn appear(&mut self, at_s: f64) -> io::Result<()> {
        self.take_in(at_s)?;
        self.broadcasts.clear();
        Ok(())
    }

    /// What the modem has broadcast, and when, since this was asked for the last time.
    pub fn broadcasts(&mut self) -> Vec<(f64, V2xMessage)> {
        std::mem::take(&mut self.broadcasts)
    }
}
