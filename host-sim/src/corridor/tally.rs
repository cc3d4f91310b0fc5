//! What there is to do in a run: ticks and messages enter as they come, their numbers leave.

/// What there was to do, of all who were on their way.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Ticks of vehicles.
    pub on_way: u64,
    /// Messages that they heard.
    pub heard: u64,
}

impl Tally {
    /// Both together.
    #[must_use]
    pub fn with(self, other: Self) -> Self {
        Self { on_way: self.on_way + other.on_way, heard: self.heard + other.heard }
    }

    /// What came after an earlier one.
    #[must_use]
    pub fn less(self, earlier: Self) -> Self {
        Self { on_way: self.on_way - earlier.on_way, heard: self.heard - earlier.heard }
    }
}
