//! The radio channel between the vehicles. A broadcast enters, with the vehicles that are to hear it. Its copies leave
//! at the receivers in the order of arrival.

use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;
use std::rc::Rc;

use crate::input::impairment::{ChannelModel, Link};
use crate::input::scenario::Radio;
use crate::sim::channel::Channel;
use crate::sim::channel::changes::Changes;
use crate::sim::modem::V2xMessage;
use crate::sim::time::micros;

/// The most messages in the record of a link: half an hour at ten a second.
const MOST_MESSAGES: usize = 18_000;

/// A message on its way.
#[derive(Clone)]
struct Flight {
    arrives_us: i64,
    number: u64,
    to: usize,
    /// All copies of a broadcast share this value.
    message: Rc<V2xMessage>,
}

impl PartialEq for Flight {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}
impl Eq for Flight {}
impl PartialOrd for Flight {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
impl Ord for Flight {
    fn cmp(&self, other: &Self) -> Ordering {
        (self.arrives_us, self.number).cmp(&(other.arrives_us, other.number))
    }
}

/// A message that has arrived.
#[derive(Clone, Debug, PartialEq)]
pub struct Arrived {
    /// Time of arrival, in seconds of the run.
    pub at_s: f64,
    /// Index of the receiving vehicle.
    pub to: usize,
    /// The message.
    pub message: Rc<V2xMessage>,
}

/// The channel and all messages that are on their way in it.
#[derive(Clone)]
pub struct Air {
    channel: Channel,
    flights: BinaryHeap<Reverse<Flight>>,
    sent: u64,
}

impl Air {
    /// An empty channel: nothing has been sent yet.
    #[must_use]
    pub fn new(model: &ChannelModel, seed: u64) -> Self {
        Self { channel: Channel::new(model, seed).of_at_most(MOST_MESSAGES), flights: BinaryHeap::new(), sent: 0 }
    }

    /// The same without the record of what happened on it, which nobody asks for.
    #[must_use]
    pub fn unrecorded(self) -> Self {
        Self { channel: self.channel.of_at_most(0), ..self }
    }

    /// Sends a message from the vehicle `from` to the vehicles `to`.
    pub fn broadcast(&mut self, at_s: f64, from: usize, to: impl IntoIterator<Item = usize>, message: &Rc<V2xMessage>) {
        for to in to {
            for arrives_s in self.channel.send(Link { from, to }, at_s) {
                self.sent += 1;
                // No message arrives at the instant at which it is sent. So times alone tell what a tick could know.
                let arrives_us = micros(arrives_s).max(micros(at_s) + 1);
                self.flights.push(Reverse(Flight { arrives_us, number: self.sent, to, message: Rc::clone(message) }));
            }
        }
    }

    /// The next message that has arrived by `at_s`.
    pub fn arrived(&mut self, at_s: f64) -> Option<Arrived> {
        let now_us = micros(at_s);
        self.flights.peek().filter(|Reverse(flight)| flight.arrives_us <= now_us)?;
        let Reverse(flight) = self.flights.pop()?;
        let at_s = flight.arrives_us as f64 * 1e-6;
        Some(Arrived { at_s, to: flight.to, message: flight.message })
    }

    /// Whether every message that is sent over a link now is lost.
    #[must_use]
    pub fn is_silent(&self, link: Link, at_s: f64) -> bool {
        self.channel.is_silent(link, at_s)
    }

    /// What happens to the links beside the model.
    pub fn changes(&mut self) -> &mut Changes {
        self.channel.changes()
    }

    /// Of a vehicle or of all, the delay and the loss that were set since the start.
    #[must_use]
    pub fn radios(&self) -> &[(Option<usize>, Radio)] {
        self.channel.radios()
    }

    /// Forgets the links of a vehicle that has gone.
    pub fn forget(&mut self, vehicle: usize) {
        self.channel.forget(vehicle);
    }

    /// The channel, with the record of all that happened on it.
    #[must_use]
    pub fn into_channel(self) -> Channel {
        self.channel
    }
}
