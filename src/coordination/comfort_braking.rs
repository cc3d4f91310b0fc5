//! How gently the ego makes way for a vehicle on another leg. The way to the conflict area and the ego's speed enter; a limit on the
//! ego's braking leaves.

use crate::units::{Acceleration, Distance, Seconds, Speed};

/// How hard the ego brakes, at most, to make way for a vehicle on another leg, whether that leg crosses the ego's or not. Of these, the
/// ego takes the gentlest by which it still comes to a stand before the conflict area. The order may put a vehicle ahead of the ego that
/// is just as near, and the law then asks for a gap of tens of metres. But the gap is needed at the crossing only. The gentler the ego
/// brakes, the less it surprises a vehicle that drives behind it and cannot hear it. In 4 s the gentlest braking takes
/// `½ · 0.6 · 4² = 5 m` of the 11 m of a time gap.
const GENTLE_MM_PER_S2: [i32; 3] = [1_500, 1_000, 600];

/// The time until the brakes are on.
const GENTLE_REACTION: Seconds = Seconds::from_millis(1_000);

/// How gently the ego brakes for its target: the 1-based index of its limit, or 0 for as hard as the configuration lets the controller
/// brake. So the smaller number brakes harder.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ComfortBraking(u8);

impl ComfortBraking {
    /// No gentler than the configuration says.
    pub(crate) const NONE: Self = Self(0);

    /// The gentlest braking by which the ego comes to a stand within this way.
    #[allow(clippy::cast_possible_truncation)] // at most three
    pub(crate) fn within(way: Distance, speed: Speed) -> Self {
        let left = way.minus(speed.over(GENTLE_REACTION));
        // `v²/2b <= s`, without a division and to the whole millimetre: speeds are below 2¹⁸ mm/s and ways below 2²² mm.
        let (mm_per_s, bits) = (i64::from(speed.to_mm_per_s()), i64::from(left.to_bits()));
        let beyond = (bits.saturating_mul(1_000).saturating_add(500) >> 20).saturating_add(1);
        let squared = mm_per_s.saturating_mul(mm_per_s);
        let stands = |mm_per_s2: &&i32| squared < beyond.saturating_mul(i64::from(**mm_per_s2)).saturating_mul(2);
        Self(GENTLE_MM_PER_S2.iter().take_while(stands).count() as u8)
    }

    /// The limit on braking: `braking` is the limit that is configured.
    pub(crate) fn limit(self, braking: Acceleration) -> Acceleration {
        const GENTLE: [Acceleration; 3] = {
            let [hard, middle, gentle] = GENTLE_MM_PER_S2;
            [
                Acceleration::from_mm_per_s2(hard),
                Acceleration::from_mm_per_s2(middle),
                Acceleration::from_mm_per_s2(gentle),
            ]
        };
        let gentle = usize::from(self.0).checked_sub(1).and_then(|place| GENTLE.get(place));
        gentle.map_or(braking, |gentle| braking.min(*gentle))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_the_gentlest_braking_that_stands_within_the_way_and_not_a_millimetre_more() {
        let allowed = |mm, mm_per_s| {
            let gentle = ComfortBraking::within(Distance::from_mm(mm), Speed::from_mm_per_s(mm_per_s));
            gentle.limit(Acceleration::from_mm_per_s2(4_000)).to_mm_per_s2()
        };
        // 12 m/s for 1 s, then v²/2b.
        for (mm_per_s2, mm) in [(600, 132_000), (1_000, 84_000), (1_500, 60_000)] {
            assert_eq!(allowed(mm + 1, 12_000), mm_per_s2);
            assert!(allowed(mm - 1, 12_000) > mm_per_s2);
        }
        assert_eq!(allowed(59_900, 12_000), 4_000);
        assert_eq!(allowed(-1, 0), 4_000);
        assert_eq!(allowed(0, 0), 600);
    }

    #[test]
    fn it_never_makes_a_vehicle_brake_harder_than_it_would() {
        let gentle = ComfortBraking::within(Distance::from_mm(60_001), Speed::from_mm_per_s(12_000));
        assert_eq!(gentle.limit(Acceleration::from_mm_per_s2(1_200)).to_mm_per_s2(), 1_200);
        assert_eq!(ComfortBraking::NONE.limit(Acceleration::from_mm_per_s2(4_000)).to_mm_per_s2(), 4_000);
    }

    #[test]
    fn of_two_the_harder_is_the_smaller() {
        assert!(ComfortBraking::NONE < ComfortBraking::within(Distance::from_mm(61_000), Speed::from_mm_per_s(12_000)));
        let (near, far) = (Distance::from_mm(61_000), Distance::from_mm(200_000));
        let speed = Speed::from_mm_per_s(12_000);
        assert!(ComfortBraking::within(near, speed) < ComfortBraking::within(far, speed));
    }
}
