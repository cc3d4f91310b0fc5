//! One cell of the table: a situation and the sound pairs enter; the pair that is best there leaves, with how its approach
//! goes and which limits hold.

use serde::Serialize;

use super::approach::{Approach, Situation};
use super::linear::Pair;

/// How far the gap may fall below what it is at first and in the end, in metres.
const OVERSHOOT_M: f64 = 0.25;
/// Braking, as a magnitude, that from the start on has to keep out of the gap for everything to be asked.
const MODERATE_MPS2: f64 = 3.0;
/// By when everything has settled, in seconds.
const SETTLED_S: f64 = 45.0;
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

/// A cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// Its situation.
    pub situation: Situation,
    /// Its gains.
    pub pair: Pair,
    /// How the approach goes with them.
    pub approach: Approach,
    /// What can be asked.
    pub asked: Asked,
    /// Whether that holds.
    pub holds: bool,
}

impl Asked {
    fn of(situation: &Situation) -> Self {
        if situation.by_braking(MODERATE_MPS2).overshoot_m <= OVERSHOOT_M {
            Self::Everything
        } else if situation.by_braking(4.0).least_gap_m > 0.0 {
            Self::NoCollision
        } else {
            Self::Nothing
        }
    }

    fn holds(self, approach: &Approach) -> bool {
        match self {
            Self::Everything => approach.overshoot_m <= OVERSHOOT_M && approach.settled_s <= SETTLED_S,
            Self::NoCollision => approach.least_gap_m > 0.0,
            Self::Nothing => true,
        }
    }
}

impl Cell {
    /// The best pair: of those that hold what is asked the most comfortable; where none does, the one with the largest gap.
    #[must_use]
    pub fn best(situation: Situation, pairs: &[Pair]) -> Option<Self> {
        let asked = Asked::of(&situation);
        let tried = pairs.iter().map(|&pair| {
            let approach = situation.by_law(pair);
            Self { situation, pair, approach, asked, holds: asked.holds(&approach) }
        });
        tried.min_by(|a, b| a.rank().total_cmp(&b.rank()))
    }

    /// Smaller is better.
    fn rank(&self) -> f64 {
        let Approach { least_gap_m, braking_mps2, acceleration_mps2, settled_s, .. } = self.approach;
        if !self.holds || self.asked != Asked::Everything {
            return (if self.holds { 1e6 } else { 1e9 }) - 1e3 * least_gap_m;
        }
        // Peaks as shares of the limits, ten seconds as much as one limit. What makes no difference stays as usual.
        let unusual = (self.pair.gain - USUAL_GAIN).abs();
        braking_mps2 / 4.0 + acceleration_mps2 / 2.5 + settled_s / 10.0 + unusual
    }
}
