//! The proof of a table at one time gap: its design, curve and cells enter; the worst figures leave, and the requirements that do not hold.

use serde::Serialize;

use super::cell::{Asked, Cell, Judged, settled_by_s};
use super::design::Design;
use super::grid;
use super::linear::{CAR_S, LAZIEST_S, Law};
use crate::parallel;

/// The worst figures at one time gap.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Proof {
    /// The time gap.
    pub time_gap_s: f64,
    /// Cells of which everything is required.
    pub everything_asked: usize,
    /// Cells of which no collision is required.
    pub no_collision_asked: usize,
    /// Cells of which nothing is required.
    pub nothing_asked: usize,
    /// Largest amplification along a string, of all pairs on the curve: without lag, with a car's, with the slowest.
    pub largest_amplification: [f64; 3],
    /// Least phase margin of all pairs on the curve, with the slowest lag.
    pub least_phase_margin_deg: f64,
    /// Least delay margin of all pairs on the curve, with the slowest lag.
    pub least_delay_margin_s: f64,
    /// Latest allowed settling time.
    pub settling_limit_s: f64,
    /// Longest settling time of the cells of which everything is required.
    pub longest_settling_s: f64,
    /// Largest overshoot into the gap, of the same cells.
    pub largest_overshoot_m: f64,
    /// Hardest braking of the same cells, a magnitude; 4 at most by construction.
    pub hardest_braking_mps2: f64,
    /// Smallest gap of the cells of which no collision is required; `None` if there is no such cell.
    pub smallest_gap_m: Option<f64>,
    /// The requirements that do not hold, in words.
    #[serde(skip)]
    pub failures: Vec<String>,
}

impl Proof {
    /// The proof at a time gap, on all cores.
    #[must_use]
    pub fn at(time_gap_s: f64, design: &Design, curve: &[u32], cells: &[Cell]) -> Self {
        let feed_forward = design.feed_forward;
        let pairs = grid::pairs(design, curve);
        let laws: Vec<Law> = pairs.into_iter().map(|pair| pair.at(time_gap_s).fed(feed_forward)).collect();
        let sound = parallel::each(&laws, |law| law.is_sound());
        let unsound = laws.iter().zip(sound).filter(|(_, is_sound)| !is_sound).map(|(law, _)| {
            format!(
                "k = {:.3} 1/s² on the curve is not sound at a time gap of {time_gap_s} s and a feed-forward of {feed_forward}",
                law.pair.gain
            )
        });
        let margins: Vec<_> = laws.iter().map(|law| law.margins(LAZIEST_S)).collect();
        let least = |of: fn(&(f64, f64)) -> f64| margins.iter().map(of).fold(f64::INFINITY, f64::min);
        let amplification = |lag_s| laws.iter().map(|law| law.largest_gain(lag_s)).fold(0.0, f64::max);

        let judged: Vec<Judged> = parallel::each(cells, |cell| cell.at(time_gap_s));
        let wrong = cells.iter().zip(&judged).filter(|(_, judged)| !judged.holds).map(|(cell, judged)| {
            let situation = &cell.situation;
            format!(
                "{:?} does not hold at {} m/s behind {} m/s, {} m, and a time gap of {time_gap_s} s",
                judged.asked, situation.own_mps, situation.target_mps, situation.headway_m
            )
        });
        let of = |asked| judged.iter().filter(move |judged| judged.asked == asked).map(|judged| judged.approach);
        let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::max);
        Self {
            time_gap_s,
            everything_asked: of(Asked::Everything).count(),
            no_collision_asked: of(Asked::NoCollision).count(),
            nothing_asked: of(Asked::Nothing).count(),
            largest_amplification: [0.0, CAR_S, LAZIEST_S].map(amplification),
            least_phase_margin_deg: least(|margin| margin.0).to_degrees(),
            least_delay_margin_s: least(|margin| margin.1),
            settling_limit_s: settled_by_s(time_gap_s),
            longest_settling_s: largest(&mut of(Asked::Everything).map(|approach| approach.settled_s)),
            largest_overshoot_m: largest(&mut of(Asked::Everything).map(|approach| approach.overshoot_m)),
            hardest_braking_mps2: largest(&mut of(Asked::Everything).map(|approach| approach.braking_mps2)),
            smallest_gap_m: of(Asked::NoCollision).map(|approach| approach.least_gap_m).reduce(f64::min),
            failures: unsound.chain(wrong).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::approach::Situation;
    use super::super::design::PLAIN;
    use super::super::linear::Pair;
    use super::*;

    /// The cell that settles last, with the gains of the table.
    const LATE: Cell = Cell {
        situation: Situation { own_mps: 0.0, target_mps: 28.0, headway_m: 120.0 },
        pair: Pair { gain: 0.275, damping_s: 3.6075 },
    };

    #[test]
    fn a_cell_that_misses_its_limit_is_named_with_the_time_gap() {
        let curve = grid::curve(&PLAIN);
        let proof = Proof::at(1.6, &PLAIN, &curve, &[LATE]);
        assert!(proof.failures.is_empty(), "{:?}", proof.failures);
        assert!(proof.longest_settling_s > 45.0, "what 1 s allows is not enough: {proof:?}");
        let slow = Cell { pair: Pair { gain: 0.275, damping_s: 6.0 }, ..LATE };
        assert_eq!(
            Proof::at(1.6, &PLAIN, &curve, &[slow]).failures,
            ["Everything does not hold at 0 m/s behind 28 m/s, 120 m, and a time gap of 1.6 s"]
        );
    }

    #[test]
    fn at_a_time_gap_that_is_too_large_the_margins_of_the_curve_fail() {
        let proof = Proof::at(3.995, &PLAIN, &grid::curve(&PLAIN), &[]);
        assert!(!proof.failures.is_empty() && (36.9..37.1).contains(&proof.least_phase_margin_deg), "{proof:?}");
        // String stability holds nevertheless.
        assert!(proof.largest_amplification.into_iter().all(|largest| largest <= 1.000_1), "{proof:?}");
    }
}
