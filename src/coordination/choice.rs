//! The vehicles that the ego has to mind. The findings of a review enter; the vehicle to follow, and the vehicles to yield to, leave.

use super::ComfortBraking;

/// The vehicles that the ego has to mind, as of the last review.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Choice {
    /// The slot of the vehicle that the ego follows.
    pub target: Option<u8>,
    /// The vehicles that the ego lets pass first: they are ahead in the order, on ways that conflict with the ego's, announced for long
    /// enough, and are not estimated to have left the conflict area.
    pub first: Slots,
    /// The slot of that one of `first` behind which the law asks for the most caution.
    pub order: Option<u8>,
    /// The slot of the vehicle that is estimated to be just ahead on the ego's own leg.
    pub lane: Option<u8>,
    /// Whether the ego has to stop before the next conflict area, whichever vehicle it follows.
    pub is_held: bool,
    /// How gently the ego brakes for the target.
    pub comfort: ComfortBraking,
    /// The vehicles whose name means another one to those who hear it, which is nearer ahead of the ego. The ego does not follow them by
    /// the order.
    pub namesakes: Slots,
    /// All vehicles that are ahead in the order, also those that are only estimated to have left.
    pub ahead: Slots,
    /// All vehicles that are ahead on the ego's own leg. No vehicle passes another there. So a vehicle that was ahead for certain stays
    /// ahead, whatever is estimated of it since.
    pub leading: Slots,
    /// Those of `leading` that were out of the radio's reach when they were heard last.
    pub beyond: Slots,
    /// The vehicles that were not heard for long, and are far ahead by their estimate, or behind for certain. The ego does not follow them.
    pub lost: Slots,
    /// The vehicles that are estimated to be in the next conflict area, by estimates that are older than a holdover, and which the ego sees
    /// not to be there. It does not go by these estimates.
    pub missed: Slots,
}

impl Choice {
    /// No vehicle: all zero.
    pub(crate) const NONE: Self = Self {
        target: None,
        first: Slots::NONE,
        order: None,
        lane: None,
        is_held: false,
        comfort: ComfortBraking::NONE,
        namesakes: Slots::NONE,
        ahead: Slots::NONE,
        leading: Slots::NONE,
        beyond: Slots::NONE,
        lost: Slots::NONE,
        missed: Slots::NONE,
    };

    /// Another station has this slot now.
    pub(crate) fn vacate(&mut self, index: usize) {
        for held in [&mut self.target, &mut self.order, &mut self.lane] {
            *held = held.filter(|slot| usize::from(*slot) != index);
        }
        self.first.set(index, false);
        self.namesakes.set(index, false);
        self.ahead.set(index, false);
        self.leading.set(index, false);
        self.beyond.set(index, false);
        self.lost.set(index, false);
        self.missed.set(index, false);
    }
}

/// A set of the first 16 slots.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Slots(u16);

impl Slots {
    /// The empty set.
    pub(crate) const NONE: Self = Self(0);

    /// Whether a slot is in the set.
    #[must_use]
    pub fn contains(self, index: usize) -> bool {
        self.0 & bit(index) != 0
    }

    /// Adds a slot to the set, or removes it.
    pub(crate) fn set(&mut self, index: usize, is_in: bool) {
        self.0 = if is_in { self.0 | bit(index) } else { self.0 & !bit(index) };
    }
}

fn bit(index: usize) -> u16 {
    u32::try_from(index).ok().and_then(|index| 1u16.checked_shl(index)).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slot_that_another_station_has_now_is_nobody_s() {
        let mut slots = Slots::NONE;
        [0, 3, 15, 16].into_iter().for_each(|index| slots.set(index, true));
        assert_eq!([0, 1, 3, 15, 16].map(|index| slots.contains(index)), [true, false, true, true, false]);
        let held =
            Choice { target: Some(3), order: Some(3), lane: Some(0), ahead: slots, leading: slots, ..Choice::NONE };
        let mut left = held;
        left.vacate(3);
        assert_eq!((left.target, left.order, left.lane), (None, None, Some(0)));
        assert!(!left.ahead.contains(3) && !left.leading.contains(3) && left.ahead.contains(0));
        left.vacate(1);
        assert!(left.ahead.contains(0) && left.leading.contains(15));
    }
}
