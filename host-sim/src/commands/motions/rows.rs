//! The figures: silences enter; the errors of each motion and each method leave.

use serde::Serialize;

use super::motion::{PHASES, SILENCE_S, TargetMotion};
use super::silence::{self, Errors, METHODS, NAMES};
use crate::error::Error;
use crate::input::scenario::SensorShare;
use crate::measure::bootstrap::{Interval, Squares, interval};
use crate::measure::metrics::{ErrorStatistics, rms};
use crate::parallel;

/// Width of a class of [`MethodFigures::growth`].
const CLASS_S: f64 = 0.25;
/// The unit is level with another method whose rms differs from its own by at most this fraction.
const LEVEL: f64 = 0.05;

/// Rms values within this fraction count as equal, because the rest is rounding. The simpler method is then named.
const SAME: f64 = 1e-6;

/// The figures of one motion.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// The motion of the target.
    #[serde(serialize_with = "key")]
    pub motion: TargetMotion,
    /// Whether the target had published it.
    pub published: bool,
    /// Number of silences.
    pub silences: u32,
    /// Comparisons, every 10 ms of each silence.
    pub comparisons: usize,
    /// The baseline with the least rms of the position error.
    pub best_baseline: &'static str,
    /// The unit's rms over that of the best baseline.
    pub ours_over_best: f64,
    /// Its interval of 95 % confidence over the silences.
    pub ours_over_best_interval: Option<Interval>,
    /// The unit beside the best baseline.
    pub standing: Outcome,
    /// The figures of the unit, then of the baselines.
    pub methods: Vec<MethodFigures>,
}

/// How the unit comes out beside the best baseline, by the rms of the position error.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// More than 5 % smaller, and smaller in the whole interval.
    Wins,
    /// Neither.
    Draws,
    /// More than 5 % larger, and larger in the whole interval.
    Loses,
}

/// The errors of one method.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MethodFigures {
    /// Its name.
    pub name: &'static str,
    /// Root of the mean square of the position error.
    pub rms_position_m: f64,
    /// 99th percentile of its magnitude, by nearest rank.
    pub p99_position_m: f64,
    /// Its largest magnitude.
    pub max_position_m: f64,
    /// Root of the mean square of the speed error.
    pub rms_speed_mps: f64,
    /// `(end of a quarter of a second since the beginning of the silence, rms of the position error in it)`.
    #[serde(skip)]
    pub growth: Vec<(f64, f64)>,
}

fn key<S: serde::Serializer>(motion: &TargetMotion, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(motion.key())
}

/// Runs this many silences of each motion on all cores, each with a seed of its own from `seed` on. The units have range sensors as this
/// share says; the other methods hear messages alone. `done` is called after each silence.
///
/// # Errors
/// The errors of [`silence::run`].
pub fn run(seed: u64, silences: u32, range_sensors: SensorShare, done: impl Fn() + Sync) -> Result<Vec<Row>, Error> {
    let one = |motion, number: u32| {
        let errors = silence::run(motion, number % PHASES, seed.wrapping_add(u64::from(number)), range_sensors);
        done();
        errors
    };
    let of_motion = |motion| {
        let errors = parallel::each(0..silences, |number| one(motion, number));
        let errors: Vec<Vec<Errors>> = errors.into_iter().collect::<Result<_, _>>()?;
        row(motion, silences, &errors)
            .ok_or_else(|| Error::new(format!("{motion}: nobody ever heard the target"), "report this"))
    };
    TargetMotion::ALL.into_iter().map(of_motion).collect()
}

fn row(motion: TargetMotion, silences: u32, of_silences: &[Vec<Errors>]) -> Option<Row> {
    let errors = &of_silences.concat();
    let methods: Vec<MethodFigures> = (0..METHODS).map(|method| figures(method, errors)).collect::<Option<_>>()?;
    let (ours, baselines) = methods.split_first()?;
    let is_better = |a: &MethodFigures, b: &MethodFigures| a.rms_position_m < b.rms_position_m * (1.0 - SAME);
    let best = baselines.iter().reduce(|best, other| if is_better(other, best) { other } else { best })?;
    let ours_over_best = ours.rms_position_m / best.rms_position_m;
    let best_method = NAMES.iter().position(|name| *name == best.name)?;
    let squares = [0, best_method].map(|method| {
        of_silences.iter().map(|one| Squares::of(one.iter().map(|e| e.position_m[method]))).collect::<Vec<_>>()
    });
    let ours_over_best_interval = interval(of_silences.len(), |drawn| {
        let [ours, best] = squares.each_ref().map(|of| Squares::rms(drawn.iter().map(|silence| &of[*silence])));
        Some(ours? / best?)
    });
    Some(Row {
        motion,
        published: motion.is_published(),
        silences,
        comparisons: errors.len(),
        best_baseline: best.name,
        ours_over_best,
        ours_over_best_interval,
        standing: Outcome::of(ours_over_best, ours_over_best_interval),
        methods,
    })
}

impl Outcome {
    /// Without an interval nothing is said.
    fn of(ours_over_best: f64, interval: Option<Interval>) -> Self {
        match interval {
            Some([_, high]) if ours_over_best < 1.0 - LEVEL && high < 1.0 => Self::Wins,
            Some([low, _]) if ours_over_best > 1.0 + LEVEL && low > 1.0 => Self::Loses,
            _ => Self::Draws,
        }
    }

    /// The result in a word.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Wins => "wins",
            Self::Draws => "draws",
            Self::Loses => "loses",
        }
    }
}

fn figures(method: usize, errors: &[Errors]) -> Option<MethodFigures> {
    let positions: Vec<f64> = errors.iter().map(|errors| errors.position_m[method]).collect();
    let speeds: Vec<f64> = errors.iter().map(|errors| errors.speed_mps[method]).collect();
    let position = ErrorStatistics::of(&positions);
    Some(MethodFigures {
        name: NAMES[method],
        rms_position_m: position.rms?,
        p99_position_m: position.p99?,
        max_position_m: position.max?,
        rms_speed_mps: rms(&speeds)?,
        growth: growth(method, errors),
    })
}

fn growth(method: usize, errors: &[Errors]) -> Vec<(f64, f64)> {
    let classes = (SILENCE_S / CLASS_S).round() as u32;
    let class = |number: u32| {
        let (from_s, to_s) = (f64::from(number) * CLASS_S, f64::from(number + 1) * CLASS_S);
        let inside = errors.iter().filter(|errors| (from_s..to_s).contains(&errors.since_s));
        Some((to_s, rms(&inside.map(|errors| errors.position_m[method]).collect::<Vec<_>>())?))
    };
    (0..classes).filter_map(class).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_least_rms_is_the_best_and_ours_stands_to_it() {
        let mut errors = Errors { since_s: 0.1, position_m: [3.0; METHODS], speed_mps: [1.0; METHODS] };
        for (singers, standing) in [(4.0, Outcome::Wins), (3.1, Outcome::Draws), (2.9, Outcome::Draws)] {
            errors.position_m = [9.0; METHODS];
            (errors.position_m[0], errors.position_m[4]) = (-3.0, singers);
            let row = row(TargetMotion::Sine, 6, &vec![vec![errors]; 6]).unwrap();
            assert_eq!((row.best_baseline, row.standing, row.comparisons), ("singer", standing, 6));
        }
        errors.position_m[4] = 1.0;
        let row = row(TargetMotion::Sine, 6, &vec![vec![errors]; 6]).unwrap();
        assert_eq!((row.standing, row.ours_over_best, row.methods[0].max_position_m), (Outcome::Loses, 3.0, 3.0));
    }

    #[test]
    fn of_silences_that_contradict_one_another_none_is_won() {
        let mut silences =
            vec![vec![Errors { since_s: 0.1, position_m: [9.0; METHODS], speed_mps: [1.0; METHODS] }]; 6];
        for (number, silence) in silences.iter_mut().enumerate() {
            silence[0].position_m[0] = if number == 0 { 12.0 } else { 3.0 };
            silence[0].position_m[4] = 6.0;
        }
        let row = row(TargetMotion::Sine, 6, &silences).unwrap();
        let [low, high] = row.ours_over_best_interval.unwrap();
        assert!(low < row.ours_over_best && row.ours_over_best < high && high > 1.0, "{low} {high}");
        assert_eq!((row.ours_over_best < 0.95, row.standing), (true, Outcome::Draws));
    }

    #[test]
    fn of_those_that_are_alike_the_simplest_is_the_best() {
        let mut errors = Errors { since_s: 0.1, position_m: [3.0; METHODS], speed_mps: [1.0; METHODS] };
        (errors.position_m[1], errors.position_m[5]) = (9.0, 3.0 - 1e-8);
        assert_eq!(row(TargetMotion::Braking, 1, &[vec![errors]]).unwrap().best_baseline, "constant_speed");
    }

    #[test]
    fn without_comparisons_there_is_no_row() {
        assert_eq!(row(TargetMotion::Sine, 1, &[]), None);
    }
}
