//! One cell of the table: a situation and the sound pairs of gains enter; the best pair there leaves. For a time gap,
//! its approach leaves too, and whether the requirement of the situation holds.

use serde::Serialize;

use super::approach::{Approach, Situation};
use super::linear::{DESIGN_TIME_GAP_S, Pair};

/// How far the gap may fall below both the gap at the start and the final gap, in metres.
pub const OVERSHOOT_M: f64 = 0.25;
/// Braking from the start on, as a magnitude. If it keeps out of the gap, everything is required.
const MODERATE_MPS2: f64 = 3.0;
/// Latest settling time at the time gap that the gains are chosen for, in seconds.
const SETTLED_S: f64 = 45.0;
/// Number of factors of e from the largest distance to make up to the distance that counts as settled: `ln(260/0.25)`.
/// A car at rest, 120 m behind a target at 28 m/s, loses 28²/(2 · 2.5) m and a second of 28 m/s until it is as fast.
const FACTORS: f64 = 7.0;
/// `k` of a situation in which the vehicle need not react.
const USUAL_GAIN: f64 = 0.5;

/// The requirement of a situation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Asked {
    /// Everything: braking at 3 m/s² from the start would keep out of the gap.
    Everything,
    /// No collision: normal braking from the start would avoid a collision.
    NoCollision,
    /// Nothing: even normal braking from the start would not avoid a collision. Range sensor and envelope are for this.
    Nothing,
}

/// Latest settling time at a time gap.
///
/// At the end of an approach, the law demands the target's speed plus the remaining distance over `t_g + γ`. So the
/// distance decays with that time constant, and a time gap that is one second longer costs one second more for each
/// factor of e.
#[must_use]
pub fn settled_by_s(time_gap_s: f64) -> f64 {
    SETTLED_S + (time_gap_s - DESIGN_TIME_GAP_S) * FACTORS
}

/// A cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// Its situation.
    pub situation: Situation,
    /// Its gains.
    pub pair: Pair,
}

/// The result of a situation and a pair of gains at a time gap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Judged {
    /// The approach.
    pub approach: Approach,
    /// The requirement.
    pub asked: Asked,
    /// Whether the requirement holds.
    pub holds: bool,
}

impl Asked {
    /// The requirement of a situation at a time gap. The larger the gap, the sooner the vehicle is too near.
    #[must_use]
    pub fn of(situation: &Situation, time_gap_s: f64) -> Self {
        if situation.by_braking(MODERATE_MPS2, time_gap_s).overshoot_m <= OVERSHOOT_M {
            Self::Everything
        } else if situation.by_braking(4.0, time_gap_s).least_gap_m > 0.0 {
            Self::NoCollision
        } else {
            Self::Nothing
        }
    }

    fn holds(self, approach: &Approach, time_gap_s: f64) -> bool {
        match self {
            Self::Everything => approach.overshoot_m <= OVERSHOOT_M && approach.settled_s <= settled_by_s(time_gap_s),
            Self::NoCollision => approach.least_gap_m > 0.0,
            Self::Nothing => true,
        }
    }
}

impl Cell {
    /// The best pair at the time gap that the gains are chosen for. Of the pairs that meet the requirement, it is the
    /// most comfortable one. If none does, it is the pair with the largest gap.
    #[must_use]
    pub fn best(situation: Situation, pairs: &[Pair]) -> Option<Self> {
        let asked = Asked::of(&situation, DESIGN_TIME_GAP_S);
        let rank = |pair: Pair| Self { situation, pair }.judged(asked, DESIGN_TIME_GAP_S).rank(pair);
        let best = pairs.iter().map(|&pair| (rank(pair), pair)).min_by(|a, b| a.0.total_cmp(&b.0));
        best.map(|(_, pair)| Self { situation, pair })
    }

    /// The result at a time gap.
    #[must_use]
    pub fn at(&self, time_gap_s: f64) -> Judged {
        self.judged(Asked::of(&self.situation, time_gap_s), time_gap_s)
    }

    fn judged(&self, asked: Asked, time_gap_s: f64) -> Judged {
        let approach = self.situation.by_law(self.pair.at(time_gap_s));
        Judged { approach, asked, holds: asked.holds(&approach, time_gap_s) }
    }
}

impl Judged {
    /// The cost of a pair; smaller is better.
    fn rank(&self, pair: Pair) -> f64 {
        let Approach { least_gap_m, braking_mps2, acceleration_mps2, settled_s, .. } = self.approach;
        if !self.holds || self.asked != Asked::Everything {
            return (if self.holds { 1e6 } else { 1e9 }) - 1e3 * least_gap_m;
        }
        // Peaks as fractions of the limits; ten seconds count as much as one limit. If nothing else differs, the usual
        // gain wins.
        let unusual = (pair.gain - USUAL_GAIN).abs();
        braking_mps2 / 4.0 + acceleration_mps2 / 2.5 + settled_s / 10.0 + unusual
    }
}
