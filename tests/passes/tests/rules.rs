//! The rules of passes hold in every order of events, and the checker finds two vehicles in the area when a rule is taken out.

use holdover_passes::broken::Broken;
use holdover_passes::check::{APART, SERVED};
use holdover_passes::world::Plan;
use stateright::{Checker, Model};

/// Fewer states than this have not tried much.
fn holds(plan: Plan, least_states: usize) {
    let checker = plan.checker().threads(2).spawn_bfs().join();
    let found = checker.discoveries().into_iter().map(|(property, path)| (property, path.into_actions()));
    assert_eq!(found.collect::<Vec<_>>(), []);
    assert!(checker.unique_state_count() > least_states, "{} states", checker.unique_state_count());
}

#[test]
fn two_vehicles_whose_clocks_differ_are_never_in_the_area_at_once() {
    holds(Plan::CLOCKS, 800_000);
}

#[test]
fn two_vehicles_are_never_in_the_area_at_once_in_a_longer_time() {
    holds(Plan::LONG, 500_000);
}

#[test]
fn two_vehicles_that_add_windows_are_never_in_the_area_at_once() {
    holds(Plan::PIECES, 800_000);
    // No single window of this plan covers a stay. So vehicles that meet have used two windows each.
    let plan = Plan { broken: Some(Broken::HearsNobody), ..Plan::PIECES };
    assert!(plan.checker().threads(2).spawn_bfs().join().discovery(APART).is_some());
}

#[test]
fn two_vehicles_that_come_into_the_zone_are_never_in_the_area_at_once() {
    holds(Plan::QUEUE, 1_000_000);
}

#[test]
fn three_vehicles_are_never_in_the_area_at_once() {
    holds(Plan::THREE, 500_000);
}

#[test]
fn everybody_gets_through_once_all_messages_are_received() {
    holds(Plan::SETTLED, 300_000);
}

/// Nobody gets through if the end of time comes too early: so the property above says something.
#[test]
fn the_checker_finds_who_has_not_got_through() {
    let plan = Plan { until: 7, ..Plan::SETTLED };
    assert!(plan.checker().threads(2).spawn_bfs().join().discovery(SERVED).is_some());
}

#[test]
fn without_any_one_of_the_rules_two_vehicles_meet_in_the_area() {
    for broken in Broken::ALL {
        let is_of_clocks = matches!(broken, Broken::WaitsNoClocks | Broken::PadsNoClocks);
        let plan = match broken {
            Broken::LeavesOutTheQueue => Plan::QUEUE,
            _ if is_of_clocks => Plan::CLOCKS,
            _ => Plan::LONG,
        };
        let plan = Plan { broken: Some(broken), ..plan };
        assert!(plan.checker().threads(2).spawn_bfs().join().discovery(APART).is_some(), "{broken:?}");
    }
}
