//! Who comes when in a corridor: rates, headways, kinds and silences of the trips that are drawn, and what they depend on.

use std::path::Path;

use holdover_sim::input::kind::Kind;
use holdover_sim::input::scenario::Overrides;
use holdover_sim::roads::trips::{HEARD_S, Trip, trips};
use holdover_sim::roads::{Corridor, Network, read};

/// The corridor with arrivals of a day, and whatever else is said.
fn a_day(from: &str, to: &str) -> (Corridor, Network) {
    let text = std::fs::read_to_string("scenarios/corridor.toml").unwrap();
    assert!(text.contains(from), "{from}");
    let text = text.replacen("duration_s = 600.0", "duration_s = 86400.0", 1).replacen(from, to, 1);
    let corridor = read::corridor(Path::new("corridor.toml"), &text, &Overrides::default()).unwrap();
    let network = Network::of(&corridor);
    (corridor, network)
}

fn as_it_is() -> (Corridor, Network) {
    a_day("seed = 1", "seed = 1")
}

fn of_road(trips: &[Trip], road: usize) -> Vec<Trip> {
    trips.iter().filter(|trip| trip.road == road).copied().collect()
}

#[test]
fn every_road_brings_as_many_as_it_is_said_to_and_never_two_within_the_least_headway() {
    let (corridor, network) = as_it_is();
    let trips = trips(&corridor, &network, 1);
    assert!(trips.is_sorted_by_key(|trip| trip.at_s));
    for (road, plan) in corridor.roads.iter().enumerate() {
        let here = of_road(&trips, road);
        // Of 2,880 and more, whose standard deviation is 2 % at most.
        let ratio = here.len() as f64 / (plan.vehicles_per_min * corridor.duration_s / 60.0);
        assert!((ratio - 1.0).abs() < 0.05, "{}: {ratio}", plan.name);
        let least_s = here.windows(2).map(|pair| pair[1].at_s - pair[0].at_s).fold(f64::INFINITY, f64::min);
        assert!(least_s >= corridor.traffic.headway_s && least_s < corridor.traffic.headway_s + 0.5, "{least_s}");
        assert!(here.iter().all(|trip| (0.0..corridor.duration_s).contains(&trip.at_s)));
    }
}

#[test]
fn nobody_comes_by_a_road_that_brings_nobody_and_the_others_do_not_mind() {
    let (corridor, network) = as_it_is();
    let (quieter, quieter_network) = a_day("vehicles_per_min = 3.8", "vehicles_per_min = 0");
    let road = corridor.roads.iter().position(|road| road.vehicles_per_min == 3.8).unwrap();
    let (all, others) = (trips(&corridor, &network, 1), trips(&quieter, &quieter_network, 1));
    assert_eq!(of_road(&others, road), []);
    assert_eq!(others, all.into_iter().filter(|trip| trip.road != road).collect::<Vec<_>>());
}

#[test]
fn speeds_and_kinds_are_those_that_are_asked_for() {
    let (corridor, network) = as_it_is();
    let trips = trips(&corridor, &network, 1);
    let span = corridor.traffic.entry_speed_mps;
    assert!(trips.iter().all(|trip| (span.low..=span.high).contains(&trip.speed_mps)));
    for (kind, share) in [(Kind::Van, 0.15), (Kind::Bus, 0.1), (Kind::Car, 0.75)] {
        let found = trips.iter().filter(|trip| trip.kind == kind).count() as f64 / trips.len() as f64;
        assert!((found - share).abs() < 0.01, "{kind:?}: {found}");
    }
}

#[test]
fn everyone_falls_silent_once_on_its_way_but_not_before_it_has_been_heard() {
    let (corridor, network) = as_it_is();
    let trips = trips(&corridor, &network, 1);
    for (road, lane) in network.lanes.iter().enumerate() {
        let way_s = (lane.exit_m - lane.entry_m) / corridor.traffic.target_speed_mps;
        let after_s: Vec<f64> = of_road(&trips, road).iter().map(|trip| trip.dark_after_s).collect();
        let (first_s, last_s) =
            after_s.iter().fold((f64::INFINITY, 0.0_f64), |(low, high), after| (low.min(*after), high.max(*after)));
        assert!((HEARD_S..HEARD_S + 0.5).contains(&first_s), "{first_s}");
        assert!((way_s - 0.5..=way_s).contains(&last_s), "{last_s} {way_s}");
    }
    let silence = trips[0].dark(1_000.0, &corridor.radio);
    assert!((silence.from_s - 1_000.0 - trips[0].dark_after_s).abs() < 1e-9);
    assert!((silence.to_s - silence.from_s - corridor.radio.dark_s).abs() < 1e-9);
}

#[test]
fn under_one_seed_the_trips_are_the_same_over_whatever_link_and_under_another_they_are_others() {
    let (corridor, network) = as_it_is();
    let (lossy, _) = a_day("loss = 0.1", "loss = 0.9");
    let once = trips(&corridor, &network, 7);
    assert_eq!(trips(&lossy, &network, 7), once);
    assert_ne!(trips(&corridor, &network, 8), once);
}
