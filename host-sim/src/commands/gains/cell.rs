//! One cell of the table: a situation and the sound pairs of gains enter; the best pair there leaves. For a time gap,
//! its approach leaves too, and whether the requirement of the situation holds.

use serde::Serialize;

use super::approach::{Approach, Situation};
use super::design::Design;
use super::linear::Pair;

/// How far the gap may fall below both the gap at the start and the final gap, in metres.
pub const OVERSHOOT_M: f64 = 0.25;
/// Braking from the start on, as a magnitude. If it keeps out of the gap, everything is required.
const MODERATE_MPS2: f64 = 3.0;
/// Latest settling time at a time gap of 1 s, in seconds.
const SETTLED_S: f64 = 45.0;
/// Number of factors of e from the largest distance to make up to the distance that counts as settled: `ln(260/0.25)`.
/// A car at rest, 120 m behind a target at 28 m/s, loses 28²/(2 · 2.5) m and a second of 28 m/s until it is as fast.
const FACTORS: f64 = 7.0;

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
    SETTLED_S + (time_gap_s - 1.0) * FACTORS
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
    /// The best pair at the smallest time gap of a design, of those whose requirements hold at all its time gaps; of all pairs, if there
    /// is none. Where everything is required it is the most comfortable one. Elsewhere it is the pair with the largest gap.
    #[must_use]
    pub fn best(situation: Situation, design: &Design, pairs: &[Pair]) -> Option<Self> {
        let mut cells: Vec<(f64, Self)> = pairs
            .iter()
            .map(|&pair| {
                let cell = Self { situation, pair };
                (cell.at(design.smallest_gap_s()).cost(pair.gain - design.usual_gain), cell)
            })
            .collect();
        cells.sort_by(|a, b| a.0.total_cmp(&b.0));
        let holds = |cell: &Self| design.time_gaps_s().all(|time_gap_s| cell.at(time_gap_s).holds);
        cells.iter().find(|(_, cell)| holds(cell)).or(cells.first()).map(|(_, cell)| *cell)
    }

    /// The result at a time gap.
    #[must_use]
    pub fn at(&self, time_gap_s: f64) -> Judged {
        let asked = Asked::of(&self.situation, time_gap_s);
        let approach = self.situation.by_law(self.pair.at(time_gap_s));
        Judged { approach, asked, holds: asked.holds(&approach, time_gap_s) }
    }
}

impl Judged {
    /// The cost of a pair whose `k` differs by so much from the usual one; smaller is better.
    fn cost(&self, unusual: f64) -> f64 {
        let Approach { least_gap_m, braking_mps2, acceleration_mps2, settled_s, .. } = self.approach;
        if !self.holds || self.asked != Asked::Everything {
            return (if self.holds { 1e6 } else { 1e9 }) - 1e3 * least_gap_m;
        }
        // Peaks as fractions of the limits; ten seconds count as much as one limit. If nothing else differs, the usual
        // gain wins.
        braking_mps2 / 4.0 + acceleration_mps2 / 2.5 + settled_s / 10.0 + unusual.abs()
    }
}
