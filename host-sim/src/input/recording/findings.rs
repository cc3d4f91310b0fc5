//! What no vehicle and no link does: checked rows enter; one finding for each way in which they cannot be leaves, with the line of the
//! worst place.
//!
//! A finding is no error: the rows can be read, and figures can be made of them. Limits are wide, so that an honest recording with its
//! noise passes.

mod link;
mod units;

pub use link::of_channel;

use std::path::Path;

use super::MotionRow;
use crate::error::Error;
use units::Share;

/// A gap is longer than this many usual intervals,
const GAP_INTERVALS: f64 = 5.0;
/// and than this, in seconds. What is between two samples is drawn straight.
const GAP_S: f64 = 0.5;
/// No road vehicle brakes or accelerates harder, in m/s²: the worst that a unit believes of another vehicle.
const HARDEST_MPS2: (f64, f64) = (12.0, 8.0);
/// Noise of a recorded speed, in m/s, which a short interval turns into a large slope.
const SPEED_NOISE_MPS: f64 = 0.3;
/// Time over which slopes are looked at besides those from sample to sample.
const SLOPE_S: f64 = 0.5;
/// Noise of a recorded position, in metres.
const POSITION_NOISE_M: f64 = 1.0;
/// Time over which speed and position are compared.
const COMPARED_S: f64 = 2.0;
/// They may differ by this, in m/s, and by this share of the speed.
const APART: (f64, f64) = (2.0, 0.2);

/// An interval between two samples, by the index of the later one.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Step {
    to: usize,
    length_s: f64,
    /// Distance by the positions.
    moved_m: f64,
    /// Distance by the speeds.
    driven_m: f64,
}

/// The place of the worst of several findings of one kind.
struct Worst {
    at: usize,
    value: f64,
    count: usize,
}

impl Worst {
    /// The largest magnitude of those that are given, if there are any.
    fn of(found: impl Iterator<Item = (usize, f64)>) -> Option<Self> {
        found.fold(None, |worst: Option<Self>, (at, value)| match worst {
            Some(Self { value: most, at: before, count }) if most.abs() >= value.abs() => {
                Some(Self { at: before, value: most, count: count + 1 })
            }
            other => Some(Self { at, value, count: 1 + other.map_or(0, |other| other.count) }),
        })
    }

    /// "(the worst of 4 such places)", if there are several.
    fn among(&self) -> String {
        if self.count > 1 { format!(" (the worst of {} such places)", self.count) } else { String::new() }
    }
}

/// The findings of a recorded drive, whose rows stand in these lines of a file.
pub fn of_motion(file: &Path, rows: &[MotionRow], lines: &[u64]) -> Vec<Error> {
    let steps: Vec<Step> = rows.windows(2).zip(1..).map(|(pair, to)| Step::of(pair, to)).collect();
    let longest_s = longest(steps.iter().map(|step| step.length_s));
    let (whole, gaps): (Vec<Step>, Vec<Step>) = steps.into_iter().partition(|step| step.length_s <= longest_s);
    let found = |at: usize, cause: String, remedy: &str| {
        Error::new(cause, remedy).in_file(file).at_line(lines.get(at).copied().unwrap_or(1))
    };
    let gap = Worst::of(gaps.iter().map(|step| (step.to, step.length_s))).map(|gap| {
        let from_s = rows[gap.at - 1].t_s;
        let cause = format!(
            "no sample for {} s from {} s on{}, and what is between is drawn straight",
            short(gap.value),
            short(from_s),
            gap.among()
        );
        found(gap.at, cause, "split the recording here")
    });
    let unit = units::of(&whole).map(|(cause, remedy)| found(0, cause, remedy));
    let place = if unit.is_some() { None } else { jump(&whole).or_else(|| apart(rows, &whole)) };
    let place =
        place.map(|(at, cause)| found(at, cause, "correct the column that is wrong, or split the recording here"));
    let slope =
        slope(rows, longest_s).map(|(at, cause)| found(at, cause, "correct the speeds, or split the recording here"));
    let said =
        said(rows).map(|(at, cause)| found(at, cause, "give `acceleration_mps2` in m/s², or leave the column out"));
    [gap, unit, place, slope, said].into_iter().flatten().collect()
}

impl Step {
    fn of(pair: &[MotionRow], to: usize) -> Self {
        let (a, b) = (pair[0], pair[1]);
        let length_s = b.t_s - a.t_s;
        Self {
            to,
            length_s,
            moved_m: b.position_m - a.position_m,
            driven_m: 0.5 * (a.speed_mps + b.speed_mps) * length_s,
        }
    }
}

/// The longest interval that is no gap.
pub fn longest(intervals_s: impl Iterator<Item = f64>) -> f64 {
    (GAP_INTERVALS * median(intervals_s)).max(GAP_S)
}

/// The upper median; 0 of nothing.
fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut sorted: Vec<f64> = values.collect();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or(0.0)
}

/// A position that leaps from one sample to the next.
fn jump(steps: &[Step]) -> Option<(usize, String)> {
    let hardest = HARDEST_MPS2.0;
    let beyond = |step: &Step| {
        let apart_m = step.moved_m - step.driven_m;
        let allowed_m =
            POSITION_NOISE_M + APART.1 * step.driven_m.abs() + 0.5 * hardest * step.length_s * step.length_s;
        (apart_m.abs() > allowed_m).then_some((step.to, apart_m))
    };
    let worst = Worst::of(steps.iter().filter_map(beyond))?;
    let cause = format!("the position jumps by {} m from one sample to the next{}", short(worst.value), worst.among());
    Some((worst.at, cause))
}

/// Positions that move at another speed than the one beside them, for a while.
fn apart(rows: &[MotionRow], steps: &[Step]) -> Option<(usize, String)> {
    let (mut from, mut share) = (0, Share::default());
    let mut found = Vec::new();
    for (index, step) in steps.iter().enumerate() {
        share = share.with(step);
        while share.length_s - steps[from].length_s >= COMPARED_S {
            share = share.without(&steps[from]);
            from += 1;
        }
        // A gap in between is not compared across.
        let is_whole = step.to - steps[from].to == index - from && share.length_s >= COMPARED_S;
        let (moved, driven) = (share.moved_m / share.length_s, share.driven_m / share.length_s);
        if is_whole && (moved - driven).abs() > APART.0.max(APART.1 * driven.abs()) {
            found.push((steps[from].to - 1, moved, driven));
        }
    }
    let worst = Worst::of(found.iter().map(|(at, moved, driven)| (*at, moved - driven)))?;
    let (_, moved, driven) = found.into_iter().find(|(at, ..)| *at == worst.at)?;
    let at_s = rows[worst.at].t_s;
    let cause = format!(
        "from {} s on the positions move at {} m/s where the speed is {} m/s",
        short(at_s),
        short(moved),
        short(driven)
    );
    Some((worst.at, cause))
}

/// A change of speed that no road vehicle is capable of.
fn slope(rows: &[MotionRow], longest_s: f64) -> Option<(usize, String)> {
    let between = |from: usize, to: usize| {
        let (a, b) = (rows.get(from)?, rows.get(to)?);
        let (length_s, change) = (b.t_s - a.t_s, b.speed_mps - a.speed_mps);
        let limit = if change < 0.0 { HARDEST_MPS2.0 } else { HARDEST_MPS2.1 };
        let is_beyond = change.abs() > limit * length_s + SPEED_NOISE_MPS && length_s <= longest_s.max(2.0 * SLOPE_S);
        is_beyond.then_some((to, change / length_s))
    };
    let later = |from: usize| {
        let to = rows.partition_point(|row| row.t_s < rows[from].t_s + SLOPE_S);
        if to > from + 1 { between(from, to) } else { None }
    };
    let next = Worst::of((0..rows.len()).filter_map(|from| between(from, from + 1)));
    let worst = next.or_else(|| Worst::of((0..rows.len()).filter_map(later)))?;
    let cause = format!(
        "the speed changes at {} m/s²{}, and no road vehicle brakes harder than {} or accelerates harder than {} m/s²",
        short(worst.value),
        worst.among(),
        HARDEST_MPS2.0,
        HARDEST_MPS2.1
    );
    Some((worst.at, cause))
}

/// A recorded acceleration that no road vehicle is capable of.
fn said(rows: &[MotionRow]) -> Option<(usize, String)> {
    let (braking, accelerating) = HARDEST_MPS2;
    let beyond = |(at, row): (usize, &MotionRow)| {
        let said = row.acceleration_mps2.filter(|said| !(-braking..=accelerating).contains(said))?;
        Some((at, said))
    };
    let worst = Worst::of(rows.iter().enumerate().filter_map(beyond))?;
    let cause =
        format!("`acceleration_mps2` is {}{}, which no road vehicle is capable of", short(worst.value), worst.among());
    Some((worst.at, cause))
}

/// A number to three places at the most, without trailing zeros.
fn short(value: f64) -> String {
    let places = if value.abs() < 10.0 { 3 } else { 1 };
    let spelled = format!("{value:.places$}");
    let bare = if spelled.contains('.') { spelled.trim_end_matches('0').trim_end_matches('.') } else { &spelled };
    if bare == "-0" { "0".into() } else { bare.into() }
}
