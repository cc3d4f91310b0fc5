//! A listener on a vehicle's bus: the `Peer*` frames that its unit receives enter, the decoded messages in float64, as the
//! baselines read them, leave. So they get what the unit gets, neither more nor less.

use std::collections::BTreeMap;

use holdover::time::Instant;
use holdover::units::Position;
use holdover::wire::{BaseId, Message, Predecessor, Received, Receiver, Role, Said};

use crate::bus::Frame;
use crate::heard::{Heard, HeardParameters};
use crate::modem::PEERS;
use crate::vehicle::{EPOCH_US, gnss, index_of};

/// The listener.
pub struct Observer {
    receiver: Receiver<PEERS>,
    parameter_messages: BTreeMap<u8, HeardParameters>,
}

impl Observer {
    /// On a bus whose catalogue starts at `base`.
    #[must_use]
    pub fn new(base: BaseId) -> Self {
        Self { receiver: Receiver::new(base, Role::Unit), parameter_messages: BTreeMap::new() }
    }

    /// Takes in a frame that was on the bus at `at_s`; a motion that it completes, with the latest driving parameters from the same slot. `near` is a position to
    /// unwrap positions near.
    pub fn observe(&mut self, at_s: f64, frame: &Frame, near: Position) -> Option<Heard> {
        let at = Instant::from_micros(gnss(at_s).as_micros()); // which has no times before its start
        match self.receiver.receive(at, frame) {
            Ok(Received::Whole(Message::Peer(slot, Said::DrivingParameters(parameters)))) => {
                let predecessor = match parameters.predecessor {
                    Predecessor::Station(station) => index_of(station),
                    Predecessor::None | Predecessor::Unknown => None,
                };
                self.parameter_messages.insert(slot.0, HeardParameters::from_parameters(&parameters, predecessor));
                None
            }
            Ok(Received::Whole(Message::Peer(slot, Said::Motion(motion)))) => {
                let time = motion.stamp.unwrap_near(gnss(at_s)).as_micros();
                let stamp_s = (time as i64 - EPOCH_US as i64) as f64 * 1e-6;
                let vehicle = index_of(motion.station)?;
                let position = motion.position.nearest_to(near);
                let heard = Heard::from_motion(at_s, stamp_s, vehicle, position, &motion);
                Some(match self.parameter_messages.get(&slot.0) {
                    Some(parameters) => heard.with_parameters(*parameters),
                    None => heard,
                })
            }
            _ => None,
        }
    }
}
