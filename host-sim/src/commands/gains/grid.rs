//! A table: the curve of `γ` over `k` and all cells, searched on all cores.
//!
//! With the lag of a bus the sound pairs are a narrow strip, and the mean of two of them may lie outside it. So one
//! curve runs along the strip, and each cell is a point on it. Interpolated pairs are on it too. The whole curve is proved, thousandth
//! by thousandth. Curve and cells are chosen for one [design](super::design), and [proved](super::proof) at all its time gaps.

use super::approach::Situation;
use super::cell::Cell;
use super::design::{Design, POINTS};
use super::linear::Pair;
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
/// Steps of `k` in the cells, in thousandths.
pub const GAIN_STEP_MILLI: u32 = 5;

/// `γ` in milliseconds at each point of the curve.
#[must_use]
pub fn curve(design: &Design) -> Vec<u32> {
    let gains = (0..POINTS).map(|point| f64::from(design.first_milli + point * design.step_milli) / 1e3);
    gains.map(|gain| design.damping_milli(gain)).collect()
}

/// The pair on the curve with this `k`, in thousandths.
#[must_use]
pub fn on_curve(design: &Design, curve: &[u32], gain_milli: u32) -> Pair {
    let along = f64::from(gain_milli.saturating_sub(design.first_milli)) / f64::from(design.step_milli);
    let cell = (along as usize).min(curve.len().saturating_sub(2));
    let share = along - cell as f64;
    let at = |point: usize| curve.get(point).copied().map_or(0.0, f64::from);
    let damping_milli = at(cell) * (1.0 - share) + at(cell + 1) * share;
    Pair { gain: f64::from(gain_milli) / 1e3, damping_s: damping_milli / 1e3 }
}

/// All pairs on the curve, thousandth by thousandth of `k`.
#[must_use]
pub fn pairs(design: &Design, curve: &[u32]) -> Vec<Pair> {
    (design.first_milli..=design.last_milli()).map(|gain| on_curve(design, curve, gain)).collect()
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
pub fn cells(design: &Design, curve: &[u32]) -> Vec<Cell> {
    let tried = (design.first_milli..=design.last_milli()).step_by(design.tried_every_milli as usize);
    let pairs: Vec<Pair> = tried.map(|gain| on_curve(design, curve, gain)).collect();
    parallel::each(situations(), |situation| Cell::best(situation, design, &pairs)).into_iter().flatten().collect()
}
