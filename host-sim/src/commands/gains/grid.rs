//! The table: the curve of `γ` over `k` and all cells, searched on all cores.
//!
//! With the lag of a bus the sound pairs are a narrow strip, and the mean of two of them may lie outside it. So one
//! curve runs through the middle of the strip, and each cell is a point on it. Interpolated pairs are on it too. The
//! whole curve is proved, thousandth by thousandth. Curve and cells are chosen at one time gap, and
//! [proved](super::proof) at more.

use super::approach::Situation;
use super::cell::Cell;
use super::linear::{DESIGN_TIME_GAP_S, Pair};
use crate::parallel;

/// Number of own and of target speeds, from 0, in steps of [`SPEED_STEP_MPS`].
pub const SPEEDS: usize = 8;
/// See [`SPEEDS`].
pub const SPEED_STEP_MPS: u32 = 4;
/// Number of headways, from [`HEADWAY_FIRST_M`], in steps of [`HEADWAY_STEP_M`].
pub const HEADWAYS: usize = 8;
/// See [`HEADWAYS`].
pub const HEADWAY_FIRST_M: u32 = 8;
/// See [`HEADWAYS`].
pub const HEADWAY_STEP_M: u32 = 16;
/// The first `k` of the curve, in thousandths.
pub const CURVE_FIRST_MILLI: u32 = 250;
/// Steps of `k` on the curve, in thousandths.
pub const CURVE_STEP_MILLI: u32 = 50;
/// Steps of `k` in the cells, in thousandths.
pub const GAIN_STEP_MILLI: u32 = 5;

/// Steps of `γ` in which sound pairs are searched, in milliseconds.
const DAMPING_STEP_MILLI: u32 = 10;
const POINTS: u32 = 8;
/// Distance between the candidates for the cells, in thousandths of `k`.
const TRIED_EVERY_MILLI: u32 = 25;

/// `γ` in milliseconds at each point of `k`: the middle of all sound values there.
#[must_use]
pub fn curve() -> Vec<u32> {
    let middle = |point: u32| {
        let gain = f64::from(CURVE_FIRST_MILLI + point * CURVE_STEP_MILLI) / 1e3;
        let sound = (50..=399)
            .map(|step| step * DAMPING_STEP_MILLI)
            .filter(|damping| Pair { gain, damping_s: f64::from(*damping) / 1e3 }.at(DESIGN_TIME_GAP_S).is_sound());
        let (low, high) = sound.fold((u32::MAX, 0), |(low, high), damping| (low.min(damping), high.max(damping)));
        (low.min(high) + high) / 2
    };
    (0..POINTS).map(middle).collect()
}

/// The pair on the curve with this `k`, in thousandths.
#[must_use]
pub fn on_curve(curve: &[u32], gain_milli: u32) -> Pair {
    let along = f64::from(gain_milli.saturating_sub(CURVE_FIRST_MILLI)) / f64::from(CURVE_STEP_MILLI);
    let cell = (along as usize).min(curve.len().saturating_sub(2));
    let share = along - cell as f64;
    let at = |point: usize| curve.get(point).copied().map_or(0.0, f64::from);
    let damping_milli = at(cell) * (1.0 - share) + at(cell + 1) * share;
    Pair { gain: f64::from(gain_milli) / 1e3, damping_s: damping_milli / 1e3 }
}

/// All pairs on the curve, thousandth by thousandth of `k`.
#[must_use]
pub fn pairs(curve: &[u32]) -> Vec<Pair> {
    let last = CURVE_FIRST_MILLI + (POINTS - 1) * CURVE_STEP_MILLI;
    (CURVE_FIRST_MILLI..=last).map(|gain| on_curve(curve, gain)).collect()
}

/// All situations; the own speed varies slowest, the headway fastest.
#[must_use]
pub fn situations() -> Vec<Situation> {
    let mut situations = Vec::new();
    for own in 0..SPEEDS {
        for target in 0..SPEEDS {
            situations.extend((0..HEADWAYS).map(|headway| Situation {
                own_mps: (own * SPEED_STEP_MPS as usize) as f64,
                target_mps: (target * SPEED_STEP_MPS as usize) as f64,
                headway_m: (HEADWAY_FIRST_M as usize + headway * HEADWAY_STEP_M as usize) as f64,
            }));
        }
    }
    situations
}

/// The best pair on the curve for every situation.
#[must_use]
pub fn cells(curve: &[u32]) -> Vec<Cell> {
    let last = CURVE_FIRST_MILLI + (POINTS - 1) * CURVE_STEP_MILLI;
    let tried = (CURVE_FIRST_MILLI..=last).step_by(TRIED_EVERY_MILLI as usize);
    let pairs: Vec<Pair> = tried.map(|gain| on_curve(curve, gain)).collect();
    parallel::each(situations(), |situation| Cell::best(situation, &pairs)).into_iter().flatten().collect()
}
