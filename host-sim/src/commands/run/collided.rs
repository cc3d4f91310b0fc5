//! The collisions of a run, for its report: the figures and the trace enter; who ran into whom, when, and what the unit of the one behind
//! believed leave.

use crate::input::scenario::Scenario;
use crate::measure::figures::Summary;
use crate::report::plot::Series;
use crate::report::run::{Crash, Crashes};
use crate::sim::world::{Tick, Trace};

/// What is drawn of the first collision: so many seconds before it, and after it.
const SHOWN_S: (f64, f64) = (8.0, 2.0);

/// All that the report says of collisions; nothing without one.
pub fn crashes(scenario: &Scenario, trace: &Trace, summary: &Summary, names: &[String]) -> Option<Crashes> {
    let first = summary.collided.first()?;
    let list = summary.collided.iter().map(|collision| Crash {
        at_s: collision.at_s,
        vehicle: names[collision.vehicle].clone(),
        into: names[collision.into].clone(),
        speed_mps: collision.speed_mps,
        into_speed_mps: collision.into_speed_mps,
        believed_gap_m: collision.believed_gap_m,
        least_gap_m: collision.least_gap_m,
        age_s: collision.age_s,
        mode: collision.mode.to_owned(),
        command_mps2: collision.command_mps2,
    });
    let length_m = scenario.vehicles[first.into].length_m;
    let shown = first.at_s - SHOWN_S.0..=first.at_s + SHOWN_S.1;
    let (ahead, behind) = (&trace.vehicles[first.into], &trace.vehicles[first.vehicle]);
    let over_time = |of: &dyn Fn(&Tick, &Tick) -> Option<f64>| -> Vec<(f64, f64)> {
        let ticks = trace.times_s.iter().zip(ahead.iter().zip(behind)).filter(|(at_s, _)| shown.contains(*at_s));
        ticks.filter_map(|(at_s, (ahead, behind))| Some((*at_s, of(ahead, behind)?))).collect()
    };
    let gap = |rear_m: f64, behind: &Tick| Some(rear_m - length_m - behind.position_m);
    let joined_s = 1.5 * scenario.period_s * trace.thinning.stride() as f64;
    let bound = |behind: &Tick| behind.target.and_then(|target| target.bound);
    Some(Crashes {
        all: summary.collisions,
        list: list.collect(),
        gaps: vec![
            Series::new("least possible", over_time(&|_, b| gap(bound(b)?.lowest_position_m, b)))
                .joined_within(joined_s),
            Series::new("believed", over_time(&|_, b| gap(b.target?.position_m, b))).joined_within(joined_s),
            Series::new("true", over_time(&|a, b| gap(a.position_m, b))),
        ],
        speeds: vec![
            Series::new(names[first.into].clone(), over_time(&|a, _| Some(a.speed_mps))),
            Series::new(names[first.vehicle].clone(), over_time(&|_, b| Some(b.speed_mps))),
        ],
    })
}
