//! The verdict on a corridor: the figures of all seeds enter; why they fail, if they do, leaves.

use super::description::Corridor;
use super::experiment::Sides;

/// Why the figures fail; empty if they pass.
#[must_use]
pub fn failures(corridor: &Corridor, sides: &Sides) -> Vec<String> {
    let (limits, main) = (&corridor.limits, &sides.holdover);
    let mut failures = Vec::new();
    let both = [
        (if corridor.envelope.engaged { " with the envelope" } else { "" }, main),
        (if corridor.envelope.engaged { " without the envelope" } else { " with the envelope" }, &sides.envelope),
    ];
    for (how, side) in both {
        if side.collisions() > 0 {
            let (roads, crossings) = (side.collisions_on_roads, side.collisions_at_intersections);
            failures.push(format!("collisions{how}: {roads} on roads, {crossings} in conflict areas"));
        }
        if side.unserved > 0 {
            failures.push(format!("{} vehicle(s) did not get through{how}", side.unserved));
        }
        if side.bound_violations > 0 {
            failures.push(format!("{} tick(s){how} at which a target was outside its bound", side.bound_violations));
        }
    }
    if !corridor.envelope.engaged && limits.full_stops.is_some_and(|most| main.full_stops as u64 > most) {
        failures.push(format!("{} full stop(s)", main.full_stops));
    }
    if let (Some(most_m), Some(error_m)) = (limits.position_error_m, main.position_error.max_m)
        && error_m > most_m
    {
        failures.push(format!("the largest position error is {error_m:.3} m, and {most_m} m is the limit"));
    }
    let times = (main.mean_travel_time_s, sides.perfect_link.mean_travel_time_s);
    if let (Some(most), (Some(ours_s), Some(perfect_s))) = (limits.travel_time_ratio, times)
        && ours_s > most * perfect_s
    {
        let cause = format!("the mean travel time is {ours_s:.2} s, with a perfect link {perfect_s:.2} s");
        failures.push(format!("{cause}, and {most} times that is the limit"));
    }
    failures
}
