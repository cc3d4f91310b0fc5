//! What a modem holds back. Messages that were late on the air may arrive many at once. On the bus the first frames of one would
//! overtake the last frames of another, so a modem sends the next message of a station when the one before has been on the bus.
//! Until then it holds the newest back, and drops those before it.

use std::collections::BTreeMap;

use holdover::wire::StationHash;

use crate::bus::Frame;
use crate::sim::modem::V2xMessage;

/// The messages that wait, by the station's number.
#[derive(Clone, Debug, Default)]
pub struct Backlog {
    /// The last frame of the message that was sent last.
    sent: BTreeMap<u8, Frame>,
    held: BTreeMap<u8, V2xMessage>,
}

impl Backlog {
    /// Notes that a message of this station is sent; this is its last frame.
    pub fn send(&mut self, station: StationHash, last: Frame) {
        self.sent.insert(station.0, last);
    }

    /// Whether a message of this station may be sent. `waits` says whether a frame still waits for the bus.
    pub fn has_room(&self, station: StationHash, mut waits: impl FnMut(&Frame) -> bool) -> bool {
        self.sent.get(&station.0).is_none_or(|frame| !waits(frame))
    }

    /// Holds a message back, in the place of an older one.
    pub fn hold(&mut self, message: V2xMessage) {
        self.held.insert(message.motion.station.0, message);
    }

    /// Takes the messages that may be sent now.
    pub fn released(&mut self, mut waits: impl FnMut(&Frame) -> bool) -> Vec<V2xMessage> {
        let sent = &self.sent;
        let may_go = |station: &u8, _: &mut V2xMessage| sent.get(station).is_none_or(|frame| !waits(frame));
        self.held.extract_if(.., may_go).map(|(_, message)| message).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_waits_for_the_one_of_its_station_before_it() {
        let mut backlog = Backlog::default();
        let frame = Frame::standard(7, &[]).unwrap();
        assert!(backlog.has_room(StationHash(1), |_| true));
        backlog.send(StationHash(1), frame);
        assert!(!backlog.has_room(StationHash(1), |waiting| *waiting == frame));
        assert!(backlog.has_room(StationHash(1), |_| false) && backlog.has_room(StationHash(2), |_| true));
    }
}
