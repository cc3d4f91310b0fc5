//! The description of the V2X channel in a scenario: which links are impaired, and how. The simulated channel applies
//! it to the messages.

use crate::input::recording::ChannelTrace;

/// A link: one sender and one receiver.
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

/// How a link impairs messages.
#[derive(Clone, Debug, PartialEq)]
pub enum Impairment {
    /// Random impairment.
    Random {
        /// Mean of the delay before truncation at 0; not negative.
        delay_mean_s: f64,
        /// Standard deviation of the delay before truncation at 0.
        delay_std_s: f64,
        /// Fraction of messages lost, 0 to 1.
        loss: f64,
        /// Fraction of messages that arrive twice, 0 to 1.
        duplicate: f64,
        /// Times at which every message sent is lost. They may touch and overlap.
        outages: Vec<Window>,
    },
    /// As in a recording.
    Recorded(ChannelTrace),
}

/// Which links are impaired. The other links have no delay and no loss.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum AppliesTo {
    /// Every link.
    All,
    /// Every link on which one of these vehicles transmits or receives.
    Vehicles(Vec<usize>),
}

/// The channel as the scenario describes it.
#[derive(Clone, Debug, PartialEq)]
pub struct ChannelModel {
    /// The impairment.
    pub impairment: Impairment,
    /// The links that are impaired.
    pub applies_to: AppliesTo,
}

impl ChannelModel {
    /// Its outages; `None` for a recording.
    #[must_use]
    pub fn outages(&self) -> Option<&[Window]> {
        match &self.impairment {
            Impairment::Random { outages, .. } => Some(outages),
            Impairment::Recorded(_) => None,
        }
    }

    /// Whether a link is impaired.
    #[must_use]
    pub fn impairs(&self, link: Link) -> bool {
        match &self.applies_to {
            AppliesTo::All => true,
            AppliesTo::Vehicles(vehicles) => vehicles.iter().any(|&v| v == link.from || v == link.to),
        }
    }
}
