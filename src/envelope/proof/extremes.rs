//! The gate at the ends of every format: words that no decimal makes, and the largest and the smallest that a configuration, a sensor or
//! a message can bring. No overflow makes the gate bolder: what it calls safe is safe.

use super::lattice::{Case, World, pick, stands};
use crate::config::Envelope;
use crate::envelope::*;
use crate::time::Duration;
use crate::units::{Acceleration, Distance, FineSeconds, Fraction, Jerk, Position, Speed};

fn extreme(index: u64) -> Case {
    let mut number = index.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 1;
    let mut pick = |values: &[i32]| pick(&mut number, values);
    let one = 1 << 25;
    let braking = pick(&[i32::MAX, 8 * one, 8 * one + 1, 8 * one - 1, one, one / 10, one / 10 + 77_777]);
    let limits = Envelope {
        acceleration: Acceleration::MAX,
        braking: Acceleration::from_bits(braking),
        jerk: Jerk::from_bits(pick(&[25 * one, one + 16_777, i32::MAX, one / 10, one / 10 + 54_321, 777, 1])),
        speed: Speed::MAX,
        margin: Distance::from_bits(pick(&[0, 1, 1 << 19, i32::MAX])),
        delay: Duration::from_micros(pick(&[30_000, 0, 1, 500_000]).into()),
        lag_tolerance: Fraction::from_bits(pick(&[0, 1, 1 << 28, 1 << 30])),
    };
    let half = FineSeconds::from_millis(999).to_bits();
    let ego = Ego {
        position: Position::ZERO,
        speed: Speed::from_bits(pick(&[13 << 23, 0, 1, 65 << 23, i32::MAX])),
        acceleration: Acceleration::from_bits(pick(&[0, 1, -1, 3 * one, -braking / 2, i32::MAX])),
        last: Acceleration::ZERO,
        lag: FineSeconds::from_bits(pick(&[half, 0, 1, 1 << 28, 12_345_678])),
    };
    let obstacle = Obstacle {
        position: Position::ZERO,
        speed: Speed::from_bits(pick(&[13 << 23, 0, 1, 65 << 23, i32::MAX])),
        braking: Acceleration::from_bits(pick(&[
            i32::MAX,
            8 * one,
            one / 10,
            one / 10 + 1,
            one / 50 * 51 + 3,
            4 * one,
        ])),
    };
    let period = Duration::from_micros(pick(&[10_000, 1_000, 100_000, 12_345]).into());
    let (own, lasts) = (hardest(&limits), pick(&[0, 1, -1, 3 * one, -i32::MAX, i32::MAX]));
    let last = encodable(&limits, Acceleration::from_bits(lasts).max(own.negated()));
    Case { limits, period, ego: Ego { last, ..ego }, obstacle, braking: own }
}

#[test]
fn what_is_called_safe_is_safe_at_the_ends_of_every_format() {
    let (mut judged, mut wrong) = (0, Vec::new());
    for case in (0..40_000).map(extreme) {
        let nearest = case.nearest_safe();
        let far = [i64::MIN, -(1 << 62), -1, 0, 2_047 << 20, 2_048 << 20, 1 << 40, i64::MAX];
        for gap in nearest.into_iter().flat_map(|gap| [gap, gap + 1, gap + 70_000]).chain(far) {
            let case = case.with_gap(gap);
            let (told, is_capped) = case.command();
            let lowest = floor(&case.limits, case.ego.last, case.period);
            let drives_on = case.ego.last > Acceleration::ZERO;
            for lag in case.lags() {
                let (world, now, delay) = (World::new(&case, lag), case.real(), case.limits.delay);
                let is_wrong = |says: bool, command, on| says && !world.is_safe(&now, command, on, delay);
                judged += 1;
                if is_wrong(case.is_safe() && !stands(&now, case.ego.last), lowest, drives_on)
                    || is_wrong(is_capped, told, true)
                {
                    wrong.push((case, lag, told, is_capped));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{} of {judged}, such as {:?}", wrong.len(), wrong[0]);
}
