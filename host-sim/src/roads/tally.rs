//! The amount of work in a run: ticks and messages enter as they occur, their counts leave.

/// The work for all vehicles that were on their way.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Ticks of vehicles.
    pub on_way: u64,
    /// Messages that the vehicles heard.
    pub heard: u64,
}

impl Tally {
    /// Adds two counts.
    #[must_use]
    pub fn with(self, other: Self) -> Self {
        Self { on_way: self.on_way + other.on_way, heard: self.heard + other.heard }
    }

    /// The work since an earlier count.
    #[must_use]
    pub fn less(self, earlier: Self) -> Self {
        Self { on_way: self.on_way - earlier.on_way, heard: self.heard - earlier.heard }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_came_after_an_earlier_tally_and_the_earlier_one_are_the_later_one() {
        let (earlier, later) = (Tally { on_way: 3, heard: 5 }, Tally { on_way: 10, heard: 7 });
        assert_eq!(later.less(earlier), Tally { on_way: 7, heard: 2 });
        assert_eq!(later.less(earlier).with(earlier), later);
    }
}
