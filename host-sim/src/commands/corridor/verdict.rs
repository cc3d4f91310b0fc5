//! The verdict on a corridor: the figures of all seeds enter; the reasons of a failure leave.
//!
//! A figure that was not measured has not passed. The scenario's limits apply to driving without the envelope, whether
//! the scenario engages it or not. The checks of safety apply to driving with the envelope too.

use crate::roads::description::Limits;
use crate::roads::experiment::Sides;
use crate::roads::figures::Side;
use crate::roads::shares::ShareRow;

/// The reasons why the figures fail; empty if they pass.
#[must_use]
pub fn failures(limits: &Limits, seeds: usize, sides: &Sides) -> Vec<String> {
    let mut failures = safety("", &sides.holdover);
    failures.extend(safety(" with the envelope", &sides.envelope));
    failures.extend(safety(" with the envelope over a perfect link", &sides.envelope_perfect_link));
    failures.extend(safety(" with emergencies", &sides.emergencies));
    failures.extend(limits.full_stops.and_then(|most| full_stops(most, seeds, &sides.holdover)));
    failures.extend(limits.position_error_m.and_then(|most_m| position_error(most_m, seeds, &sides.holdover)));
    failures.extend(limits.travel_time_ratio.and_then(|most| travel_time(most, &sides.holdover, &sides.perfect_link)));
    failures
}

/// The same of vehicles among which a share keeps no passes.
#[must_use]
pub fn of_shares(rows: &[ShareRow]) -> Vec<String> {
    let how = |share: f64| format!(" with {:.0} % without passes", 100.0 * share);
    rows.iter().flat_map(|row| safety(&how(row.share), &row.side)).collect()
}

/// The failures of safety, and vehicles that were not served; `how` names the side.
pub(super) fn safety(how: &str, side: &Side) -> Vec<String> {
    let mut failures = Vec::new();
    if side.collisions() > 0 {
        let (roads, crossings) = (side.collisions_on_roads, side.collisions_at_intersections);
        failures.push(format!("collisions{how}: {roads} on roads, {crossings} in conflict areas"));
    }
    if side.served == 0 {
        failures.push(format!("nobody got through{how}, so nothing was measured"));
    }
    // Where a radio is dead, A13 does not hold: a unit may wait for ever for a vehicle that it will not hear (P12), unless its driver does not.
    if side.unserved > 0 && (side.faults == 0 || side.takeovers > 0) {
        failures.push(format!("{} vehicle(s) did not get through{how}", side.unserved));
    }
    if side.bound_violations > 0 {
        failures.push(format!("{} tick(s){how} at which a target was outside its bound", side.bound_violations));
    }
    failures
}

/// Of many seeds one full stop in a hundred vehicles is no failure: the more vehicles, the surer one of them stops, over a perfect link too.
fn full_stops(most: u64, seeds: usize, side: &Side) -> Option<String> {
    let (stops, vehicles) = (side.full_stops as u64, side.served as u64);
    let allowed = if seeds == 1 { most } else { most + vehicles / 100 };
    let of = if seeds == 1 { String::new() } else { format!(" of {vehicles} vehicles") };
    (stops > allowed).then(|| format!("{stops} full stop(s){of}"))
}

/// Of one seed the largest error counts. That of many seeds grows with every seed that is added, so there that of 99 % of the pairs counts.
fn position_error(most_m: f64, seeds: usize, side: &Side) -> Option<String> {
    let (of, error_m) = match seeds {
        1 => ("", side.position_error.max_m),
        _ => (" of 99 % of the pairs of a unit and its target", side.pairs_p99_m),
    };
    let Some(error_m) = error_m else {
        return Some(format!("no position error was measured, and {most_m} m is the limit"));
    };
    (error_m > most_m).then(|| format!("the largest position error{of} is {error_m:.3} m, and {most_m} m is the limit"))
}

fn travel_time(most: f64, ours: &Side, perfect: &Side) -> Option<String> {
    let (Some(ours_s), Some(perfect_s)) = (ours.mean_travel_time_s, perfect.mean_travel_time_s) else {
        return Some(format!(
            "there are no travel times to compare, and {most} times that with a perfect link is the limit"
        ));
    };
    (ours_s > most * perfect_s).then(|| {
        let cause = format!("the mean travel time is {ours_s:.2} s, with a perfect link {perfect_s:.2} s");
        format!("{cause}, and {most} times that is the limit")
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::roads::figures::ErrorFigures;

    const LIMITS: Limits = Limits { position_error_m: Some(0.2), travel_time_ratio: Some(1.03), full_stops: Some(0) };

    fn good() -> Sides {
        let side = Side {
            served: 10,
            mean_travel_time_s: Some(30.0),
            position_error: ErrorFigures { ticks: 1000, max_m: Some(0.2), rms_m: Some(0.05) },
            ..Side::of(&[])
        };
        Sides {
            holdover: side,
            perfect_link: side,
            alone: side,
            envelope: side,
            envelope_perfect_link: side,
            emergencies: side,
        }
    }

    fn failing(spoil: impl Fn(&mut Sides)) -> Vec<String> {
        let mut sides = good();
        spoil(&mut sides);
        failures(&LIMITS, 1, &sides)
    }

    #[test]
    fn good_figures_pass() {
        assert_eq!(failing(|_| {}), [""; 0]);
    }

    #[test]
    fn one_bad_figure_fails_by_just_that() {
        let on_roads = failing(|sides| sides.holdover.collisions_on_roads = 2);
        assert_eq!(on_roads, ["collisions: 2 on roads, 0 in conflict areas"]);
        let in_areas = failing(|sides| sides.holdover.collisions_at_intersections = 1);
        assert_eq!(in_areas, ["collisions: 0 on roads, 1 in conflict areas"]);
        assert_eq!(failing(|sides| sides.holdover.unserved = 1), ["1 vehicle(s) did not get through"]);
        let outside = failing(|sides| sides.holdover.bound_violations = 3);
        assert_eq!(outside, ["3 tick(s) at which a target was outside its bound"]);
        assert_eq!(failing(|sides| sides.holdover.full_stops = 1), ["1 full stop(s)"]);
        let error = failing(|sides| sides.holdover.position_error.max_m = Some(0.201));
        assert_eq!(error, ["the largest position error is 0.201 m, and 0.2 m is the limit"]);
        let time = failing(|sides| sides.holdover.mean_travel_time_s = Some(30.91));
        let said = "the mean travel time is 30.91 s, with a perfect link 30.00 s, and 1.03 times that is the limit";
        assert_eq!(time, [said]);
        assert_eq!(failing(|sides| sides.holdover.mean_travel_time_s = Some(30.89)), [""; 0]);
    }

    #[test]
    fn of_many_seeds_one_vehicle_in_a_hundred_may_stop() {
        let mut sides = good();
        (sides.holdover.served, sides.holdover.position_error.max_m) = (299, Some(0.1));
        sides.holdover.pairs_p99_m = Some(0.1);
        let of_many = |full_stops| {
            let holdover = Side { full_stops, ..sides.holdover };
            failures(&LIMITS, 2, &Sides { holdover, ..sides })
        };
        assert_eq!(of_many(2), [""; 0]);
        assert_eq!(of_many(3), ["3 full stop(s) of 299 vehicles"]);
    }

    #[test]
    fn of_many_seeds_one_pair_in_a_hundred_may_be_farther_off() {
        let mut sides = good();
        sides.holdover.position_error.max_m = Some(1.2);
        let of_many = |p99_m| {
            let holdover = Side { pairs_p99_m: p99_m, ..sides.holdover };
            failures(&LIMITS, 2, &Sides { holdover, ..sides })
        };
        assert_eq!(of_many(Some(0.2)), [""; 0]);
        let said = "the largest position error of 99 % of the pairs of a unit and its target is 0.201 m, and 0.2 m is the limit";
        assert_eq!(of_many(Some(0.201)), [said]);
        assert_eq!(of_many(None), ["no position error was measured, and 0.2 m is the limit"]);
    }

    #[test]
    fn with_the_envelope_everyone_has_to_be_safe_and_served_but_may_be_late_and_may_stop() {
        let unsafe_ = failing(|sides| {
            sides.envelope.collisions_on_roads = 1;
            sides.envelope.unserved = 2;
            sides.envelope.bound_violations = 3;
        });
        assert_eq!(
            unsafe_,
            [
                "collisions with the envelope: 1 on roads, 0 in conflict areas",
                "2 vehicle(s) did not get through with the envelope",
                "3 tick(s) with the envelope at which a target was outside its bound"
            ]
        );
        let late = failing(|sides| {
            sides.envelope.mean_travel_time_s = Some(60.0);
            sides.envelope.full_stops = 5;
            sides.envelope.position_error.max_m = Some(1.0);
        });
        assert_eq!(late, [""; 0]);
    }

    #[test]
    fn with_emergencies_everyone_has_to_be_safe_and_served() {
        let unsafe_ = failing(|sides| {
            sides.emergencies.collisions_at_intersections = 1;
            sides.emergencies.unserved = 2;
        });
        assert_eq!(
            unsafe_,
            [
                "collisions with emergencies: 0 on roads, 1 in conflict areas",
                "2 vehicle(s) did not get through with emergencies"
            ]
        );
        assert_eq!(failing(|sides| sides.emergencies.full_stops = 5), [""; 0]);
    }

    #[test]
    fn with_faults_everyone_has_to_be_safe_but_may_wait_for_a_radio_that_is_dead() {
        let faulty = |spoil: fn(&mut Side)| {
            failing(|sides| {
                sides.emergencies.faults = 1;
                spoil(&mut sides.emergencies);
            })
        };
        assert_eq!(faulty(|side| (side.unserved, side.bound_violations_by_clock) = (2, 3)), [""; 0]);
        assert_eq!(
            faulty(|side| (side.unserved, side.takeovers) = (2, 1)),
            ["2 vehicle(s) did not get through with emergencies"]
        );
        assert_eq!(
            faulty(|side| side.collisions_on_roads = 1),
            ["collisions with emergencies: 1 on roads, 0 in conflict areas"]
        );
        assert_eq!(
            faulty(|side| side.bound_violations = 1),
            ["1 tick(s) with emergencies at which a target was outside its bound"]
        );
        assert_eq!(faulty(|side| side.served = 0), ["nobody got through with emergencies, so nothing was measured"]);
    }

    #[test]
    fn where_a_share_keeps_no_passes_everyone_has_to_be_safe_and_served() {
        let good = ShareRow { share: 0.1, side: good().envelope };
        let bad = ShareRow { share: 0.5, side: Side { collisions_on_roads: 1, ..good.side } };
        assert_eq!(of_shares(&[good, bad]), ["collisions with 50 % without passes: 1 on roads, 0 in conflict areas"]);
    }

    #[test]
    fn the_references_are_not_judged() {
        let reference = |sides: &mut Sides| {
            sides.alone.collisions_on_roads = 1;
            sides.perfect_link.unserved = 1;
        };
        assert_eq!(failing(reference), [""; 0]);
    }

    #[test]
    fn what_was_not_measured_has_not_passed() {
        let nobody = failing(|sides| sides.holdover.served = 0);
        assert_eq!(nobody, ["nobody got through, so nothing was measured"]);
        let nobody = failing(|sides| sides.envelope.served = 0);
        assert_eq!(nobody, ["nobody got through with the envelope, so nothing was measured"]);
        let unknown = failing(|sides| sides.holdover.position_error.max_m = None);
        assert_eq!(unknown, ["no position error was measured, and 0.2 m is the limit"]);
        for which in [0, 1] {
            let times = failing(|sides| {
                let side = if which == 0 { &mut sides.holdover } else { &mut sides.perfect_link };
                side.mean_travel_time_s = None;
            });
            let said = "there are no travel times to compare, and 1.03 times that with a perfect link is the limit";
            assert_eq!(times, [said]);
        }
    }

    #[test]
    fn a_limit_that_is_not_stated_is_not_asked_for() {
        let mut sides = good();
        sides.holdover.full_stops = 9;
        sides.holdover.position_error.max_m = None;
        sides.holdover.mean_travel_time_s = Some(99.0);
        let nothing = Limits { position_error_m: None, travel_time_ratio: None, full_stops: None };
        assert_eq!(failures(&nothing, 1, &sides), [""; 0]);
    }
}
