//! The map of a corridor: roads and a journal enter; the map with the ego's passage leaves.

use crate::report::plot::{Map, Mover};
use crate::roads::experiment::Experiment;
use crate::roads::journal::{EVERY_S, Journal};
use crate::sim::globe::Shift;
use crate::sim::ground::Point;

/// Time shown before and after the ego is on its way.
const AROUND_S: f64 = 2.0;

/// Distance between the points of a road.
const STEP_M: f64 = 25.0;

/// The map over the ego's passage, turned so that the ego drives to the right; `None` without an ego.
#[must_use]
pub fn passage(experiment: &Experiment, journal: &Journal) -> Option<Map> {
    let ego = journal.ego?;
    let own = journal.tracks.get(&ego)?;
    let (first, last) = (own.points.first()?, own.points.last()?);
    let lanes = &experiment.network.lanes;
    let of_ego = lanes.get(own.road)?;
    let origin = of_ego.road.at(of_ego.entry_m).0;
    let along = Shift::between(origin, of_ego.road.at(of_ego.exit_m).0);
    let place = |point: Point| {
        let shift = Shift::between(origin, point);
        (shift.along(along), -shift.along(along.right()))
    };
    let on_road = |road: usize, way_m: f64| place(lanes[road].road.at(way_m).0);
    let roads = lanes.iter().enumerate().map(|(road, lane)| {
        let steps = ((lane.exit_m - lane.entry_m) / STEP_M).ceil().max(1.0);
        (0..=steps as u32)
            .map(|step| on_road(road, lane.entry_m + (lane.exit_m - lane.entry_m) * f64::from(step) / steps))
            .collect()
    });
    let span_s = (first.0 - AROUND_S, last.0 + AROUND_S);
    let movers = journal.tracks.iter().filter_map(|(trip, track)| {
        let seen: Vec<&(f64, f64)> =
            track.points.iter().filter(|(at_s, _)| (span_s.0..=span_s.1).contains(at_s)).collect();
        let from_s = seen.first()?.0;
        let way = seen.iter().map(|(_, way_m)| on_road(track.road, *way_m)).collect();
        Some(Mover { is_ego: *trip == ego, from_s, way })
    });
    let silent_s = journal.dark.map(|dark| (dark.from_s, dark.to_s));
    // The end of the silence is the moment that matters most.
    let at_s = silent_s.map_or((span_s.0 + span_s.1) / 2.0, |(from_s, to_s)| to_s.min(last.0).max(from_s) - EVERY_S);
    let plans = experiment.corridor.intersections.iter();
    Some(Map {
        title: "The ego’s passage".into(),
        description: format!(
            "The ego (red) drives from the left to the right through the roads and intersections of the scenario, among all other \
             vehicles. It is shown as it is at {at_s:.1} s{}. The map is turned; the squares are the conflict areas.",
            silent_s.map_or(String::new(), |(from_s, to_s)| format!(
                "; it is hollow while it is silent, from {from_s:.1} to {to_s:.1} s"
            ))
        ),
        roads: roads.collect(),
        areas: plans.map(|plan| (place(plan.at), plan.half_m)).collect(),
        movers: movers.collect(),
        every_s: EVERY_S,
        span_s,
        at_s,
        silent_s,
    })
}
