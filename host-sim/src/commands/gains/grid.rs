//! The table: nothing enters; the curve of `γ` over `k` and all cells leave, searched on all cores.
//!
//! With the lag of a bus the sound pairs are a narrow strip, and the mean of two of them may lie beside it. So there is one
//! curve through its middle, the cells say where on it, and whatever is interpolated is on it too: the whole of it is
//! proved, thousandth by thousandth. Curve and cells are chosen at one time gap, and [proved](super::proof) at more.

use super::approach::Situation;
use super::cell::Cell;
use super::linear::{DESIGN_TIME_GAP_S, Pair};
use crate::parallel;

/// Speeds, own and target's: so many, from 0, in steps of this many m/s.
pub const SPEEDS: usize = 8;
/// See [`SPEEDS`].
pub const SPEED_STEP_MPS: u32 = 4;
/// Headways: so many, from this many metres, in steps of this many.
pub const HEADWAYS: usize = 8;
/// See [`HEADWAYS`].
pub const HEADWAY_FIRST_M: u32 = 8;
/// See [`HEADWAYS`].
pub const HEADWAY_STEP_M: u32 = 16;
/// The first `k` of the curve, in thousandths, and the steps in which it goes on.
pub const CURVE_FIRST_MILLI: u32 = 250;
/// See [`CURVE_FIRST_MILLI`].
pub const CURVE_STEP_MILLI: u32 = 50;
/// Steps of `k` in the cells, in thousandths.
pub const GAIN_STEP_MILLI: u32 = 5;

/// `γ` of the sound pairs is tried in steps of this, in milliseconds.
const DAMPING_STEP_MILLI: u32 = 10;
const POINTS: u32 = 8;
/// Candidates for the cells are this far apart, in thousandths of `k`.
const TRIED_EVERY_MILLI: u32 = 25;

/// `γ` in milliseconds at each point of `k`: the middle of all that are sound there.
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

/// The pair of that `k`, in thousandths, on the curve.
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

/// All situations: own speed slowest, headway fastest.
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

/// The best pair on the curve of every situation.
#[must_use]
pub fn cells(curve: &[u32]) -> Vec<Cell> {
    let last = CURVE_FIRST_MILLI + (POINTS - 1) * CURVE_STEP_MILLI;
    let tried = (CURVE_FIRST_MILLI..=last).step_by(TRIED_EVERY_MILLI as usize);
    let pairs: Vec<Pair> = tried.map(|gain| on_curve(curve, gain)).collect();
    parallel::each(situations(), |situation| Cell::best(situation, &pairs)).into_iter().flatten().collect()
}
