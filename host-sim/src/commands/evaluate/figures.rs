//! The figures of an evaluation: comparisons enter, the numbers of the results leave.

use serde::Serialize;
use std::collections::BTreeMap;

use super::listener::METHODS;
use super::sample::{NAMES, Outcome, Sample};
use crate::measure::metrics::{AGE_CLASSES_S, ErrorStatistics, errors_by_age, errors_by_outage};

/// The errors of one method at one class of ages.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct AgeClass {
    /// Least age.
    pub from_s: f64,
    /// Below this age; `None`: no end.
    pub to_s: Option<f64>,
    /// Number of ticks.
    pub count: usize,
    /// Root of the mean square.
    pub rms_position_m: Option<f64>,
    /// Largest magnitude.
    pub max_position_m: Option<f64>,
}

/// The errors of one method after silences of one length.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct OutageClass {
    /// The length.
    pub outage_s: f64,
    /// Number of silences.
    pub count: usize,
    /// Root of the mean square.
    pub rms_position_m: Option<f64>,
    /// 99th percentile of the magnitude, by nearest rank.
    pub p99_position_m: Option<f64>,
    /// Largest magnitude.
    pub max_position_m: Option<f64>,
}

/// The errors of one method; `None` where there is no measurement.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Figures {
    /// Root of the mean square of the position error.
    pub rms_position_m: Option<f64>,
    /// 99th percentile of its magnitude, by nearest rank.
    pub p99_position_m: Option<f64>,
    /// Its largest magnitude.
    pub max_position_m: Option<f64>,
    /// Root of the mean square of the speed error.
    pub rms_speed_mps: Option<f64>,
    /// Over a link: by age of the newest sample.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub by_age: Option<Vec<AgeClass>>,
    /// In silences: by the length of the silence.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub by_outage: Option<Vec<OutageClass>>,
}

/// Wall-clock figures. All other figures are the same for the same input.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Timing {
    /// Ticks of the unit per second, all cores together.
    pub ticks_per_s: f64,
}

/// The results, as in the JSON.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Results {
    /// Figures of the unit.
    pub ours: Figures,
    /// Figures of the baselines by name, on the same decoded messages.
    pub baselines: BTreeMap<&'static str, Figures>,
    /// Comparisons with the truth.
    pub ticks: usize,
    /// Messages that the recorded vehicles sent.
    pub messages_sent: usize,
    /// Messages that were not lost.
    pub messages_delivered: usize,
    /// The recordings of which nothing could be compared, and why; empty if all could.
    pub failures: Vec<String>,
    /// Wall-clock figures.
    pub timing: Timing,
}

impl Results {
    /// The figures of all recordings together. `lengths_s` are the lengths of the silences, if silences were measured.
    #[must_use]
    pub fn pooled(outcomes: &[Outcome], lengths_s: Option<&[f64]>, failures: Vec<String>, timing: Timing) -> Self {
        let samples: Vec<&Sample> = outcomes.iter().flat_map(|outcome| &outcome.samples).collect();
        let [ours, baselines @ ..] = figures(&samples, lengths_s);
        Self {
            ours,
            baselines: NAMES.into_iter().skip(1).zip(baselines).collect(),
            ticks: samples.len(),
            messages_sent: outcomes.iter().map(|outcome| outcome.sent).sum(),
            messages_delivered: outcomes.iter().map(|outcome| outcome.delivered).sum(),
            failures,
            timing,
        }
    }

    /// The unit, then the baselines in the order of [`NAMES`].
    #[must_use]
    pub fn methods(&self) -> [(&'static str, &Figures); METHODS] {
        NAMES.map(|name| (name, self.baselines.get(name).unwrap_or(&self.ours)))
    }
}

/// The figures of each method.
#[must_use]
pub fn figures(samples: &[&Sample], lengths_s: Option<&[f64]>) -> [Figures; METHODS] {
    std::array::from_fn(|method| {
        let classed = |class: fn(&Sample) -> Option<f64>| -> Vec<(f64, f64)> {
            samples.iter().filter_map(|sample| Some((class(sample)?, sample.position_error(method)?))).collect()
        };
        let positions: Vec<f64> = samples.iter().filter_map(|sample| sample.position_error(method)).collect();
        let speeds: Vec<f64> = samples.iter().filter_map(|sample| sample.speed_error(method)).collect();
        let position = ErrorStatistics::of(&positions);
        Figures {
            rms_position_m: position.rms,
            p99_position_m: position.p99,
            max_position_m: position.max,
            rms_speed_mps: ErrorStatistics::of(&speeds).rms,
            by_age: lengths_s.is_none().then(|| by_age(&classed(|sample| Some(sample.age_s)))),
            by_outage: lengths_s.map(|lengths_s| by_outage(&classed(|sample| sample.outage_s), lengths_s)),
        }
    })
}

fn by_age(errors: &[(f64, f64)]) -> Vec<AgeClass> {
    let class = |((from_s, to_s), figures): ((f64, f64), ErrorStatistics)| AgeClass {
        from_s,
        to_s: to_s.is_finite().then_some(to_s),
        count: figures.count,
        rms_position_m: figures.rms,
        max_position_m: figures.max,
    };
    AGE_CLASSES_S.into_iter().zip(errors_by_age(errors)).map(class).collect()
}

fn by_outage(errors: &[(f64, f64)], lengths_s: &[f64]) -> Vec<OutageClass> {
    let class = |(&outage_s, figures): (&f64, ErrorStatistics)| OutageClass {
        outage_s,
        count: figures.count,
        rms_position_m: figures.rms,
        p99_position_m: figures.p99,
        max_position_m: figures.max,
    };
    lengths_s.iter().zip(errors_by_outage(errors, lengths_s)).map(class).collect()
}
