//! What a scenario says of the V2X channel: which links are impaired, and how. What that means for a message is
//! the channel's to say.

use crate::input::recording::ChannelTrace;

/// One sender, one receiver, by the vehicles' indices.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Link {
    /// Index of the sender.
    pub from: usize,
    /// Index of the receiver.
    pub to: usize,
}

/// A span of time in seconds, `from_s <= t < to_s`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    /// Its beginning.
    pub from_s: f64,
    /// Its end.
    pub to_s: f64,
}

/// What a link does to messages.
#[derive(Clone, Debug, PartialEq)]
pub enum Impairment {
    /// By chance.
    Random {
        /// Mean of the delay before truncation at 0; not negative.
        delay_mean_s: f64,
        /// Standard deviation of the delay before truncation at 0.
        delay_std_s: f64,
        /// Share of messages lost, 0 to 1.
        loss: f64,
        /// Share of messages that arrive twice, 0 to 1.
        duplicate: f64,
        /// When everything sent is lost; they may touch and overlap.
        outages: Vec<Window>,
    },
    /// As recorded.
    Recorded(ChannelTrace),
}

/// Which links are impaired; the others are clean, without delay and without loss.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum AppliesTo {
    /// Every link.
    All,
    /// Every link that one of these vehicles transmits or receives on.
    Vehicles(Vec<usize>),
}

/// The channel as the scenario describes it.
#[derive(Clone, Debug, PartialEq)]
pub struct ChannelModel {
    /// What impaired links do.
    pub impairment: Impairment,
    /// Which links those are.
    pub applies_to: AppliesTo,
}

impl ChannelModel {
    /// Whether that link is impaired.
    #[must_use]
    pub fn impairs(&self, link: Link) -> bool {
        match &self.applies_to {
            AppliesTo::All => true,
            AppliesTo::Vehicles(vehicles) => vehicles.iter().any(|&v| v == link.from || v == link.to),
        }
    }
}
