//! One cell of the table: a situation and the sound pairs enter; the pair that is best there leaves, and for a time gap how
//! its approach goes and whether what can be asked of it holds.

use serde::Serialize;

use super::approach::{Approach, Situation};
use super::linear::{DESIGN_TIME_GAP_S, Pair};

/// How far the gap may fall below what it is at first and in the end, in metres.
pub const OVERSHOOT_M: f64 = 0.25;
/// Braking, as a magnitude, that from the start on has to keep out of the gap for everything to be asked.
const MODERATE_MPS2: f64 = 3.0;
/// By when everything has settled at the time gap that the gains are chosen for, in seconds.
const SETTLED_S: f64 = 45.0;
/// How many factors of e there are from the farthest that anybody has to make up to what counts as settled: `ln(260/0.25)`.
/// A car at rest, 120 m behind a target at 28 m/s, loses 28²/(2 · 2.5) m and a second of 28 m/s until it is as fast.
const FACTORS: f64 = 7.0;
/// `k` of a situation in which there is nothing to do.
const USUAL_GAIN: f64 = 0.5;

/// What can be asked of a situation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Asked {
    /// Everything: braking at 3 m/s² from the start would keep out of the gap.
    Everything,
    /// No collision: normal braking from the start would avoid one.
    NoCollision,
    /// Nothing: not even that would. The range sensor and the envelope are for this.
    Nothing,
}

/// By when everything has to have settled at that time gap.
///
/// In the end of an approach the law asks for the target's speed and the distance left over `t_g + γ`, so the distance dies
/// out with that time constant, and a second of time gap more costs a second for each factor of e.
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

/// What a situation and a pair of gains come to at a time gap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Judged {
    /// How the approach goes.
    pub approach: Approach,
    /// What can be asked.
    pub asked: Asked,
    /// Whether that holds.
    pub holds: bool,
}

impl Asked {
    /// What can be asked of that situation at that time gap: the larger it is, the sooner one has come too near.
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
    /// The best pair at the time gap that the gains are chosen for: of those that hold what is asked the most comfortable;
    /// where none does, the one with the largest gap.
    #[must_use]
    pub fn best(situation: Situation, pairs: &[Pair]) -> Option<Self> {
        let asked = Asked::of(&situation, DESIGN_TIME_GAP_S);
        let rank = |pair: Pair| Self { situation, pair }.judged(asked, DESIGN_TIME_GAP_S).rank(pair);
        let best = pairs.iter().map(|&pair| (rank(pair), pair)).min_by(|a, b| a.0.total_cmp(&b.0));
        best.map(|(_, pair)| Self { situation, pair })
    }

    /// What it comes to at a time gap.
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
    /// Smaller is better.
    fn rank(&self, pair: Pair) -> f64 {
        let Approach { least_gap_m, braking_mps2, acceleration_mps2, settled_s, .. } = self.approach;
        if !self.holds || self.asked != Asked::Everything {
            return (if self.holds { 1e6 } else { 1e9 }) - 1e3 * least_gap_m;
        }
        // Peaks as shares of the limits, ten seconds as much as one limit. What makes no difference stays as usual.
        let unusual = (pair.gain - USUAL_GAIN).abs();
        braking_mps2 / 4.0 + acceleration_mps2 / 2.5 + settled_s / 10.0 + unusual
    }
}
