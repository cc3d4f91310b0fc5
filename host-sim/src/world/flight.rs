//! A message on its way through the channel: what was sent enters; flights leave a heap in the order of arrival.

use crate::modem::V2xMessage;

/// A message on its way.
pub struct Flight {
    /// When it arrives, in microseconds of the run.
    pub arrives_us: i64,
    /// Tells messages apart that arrive at the same time.
    pub number: u64,
    /// At whom.
    pub to: usize,
    /// What it says.
    pub message: V2xMessage,
}

impl PartialEq for Flight {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Flight {}

impl PartialOrd for Flight {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Flight {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        (self.arrives_us, self.number).cmp(&(other.arrives_us, other.number))
    }
}
