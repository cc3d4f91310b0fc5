//! The fault buttons on a bus in memory: what the device does, what the harness says, and that it recovers.

use holdover::time::Duration;
use holdover_sim::commands::hil::judge::{LATENCY_P99_MS, Results, judge};
use holdover_sim::commands::hil::session::{self, Setup};
use holdover_sim::commands::hil::virtual_bus::{Behaviour, bench};
use holdover_sim::input::scenario::{Overrides, Scenario};
use holdover_sim::sim::world;
use std::path::Path;

/// Twelve seconds on a clean channel, and one fault.
fn press(fault: &str) -> Results {
    let text = "duration_s = 12\n[channel]\noutages = []\nloss = 0.0";
    let scenario = Scenario::parse(Path::new("test"), text, &Overrides::default()).unwrap();
    let config = world::config(&scenario, scenario.ego);
    let setup = Setup {
        scenario,
        config,
        wait: Duration::from_millis(3000),
        latency_p99_ms: LATENCY_P99_MS,
        faults: vec![fault.parse().unwrap()],
    };
    let (port, mut rig) = bench(Behaviour::good(config, false));
    let outcome = session::run(&setup, port, &mut rig, |_| {}).unwrap();
    judge(&setup, &outcome)
}

/// The worst of the device, after how long it drove again, and the results.
fn recovered(fault: &str) -> (&'static str, f64, Results) {
    let results = press(fault);
    assert_eq!((results.verdict, &results.reasons[..]), ("passed", &[][..]), "{fault}");
    let [recovery] = &results.faults[..] else { panic!("{fault}: {:?}", results.faults) };
    (recovery.worst, recovery.recovered_after_s.unwrap(), results)
}

#[test]
fn a_device_without_power_is_silent_and_drives_again_soon_after_it_has_it_back() {
    let (worst, after_s, results) = recovered("power@4:1");
    assert_eq!(worst, "silent");
    assert!((0.05..1.0).contains(&after_s), "{after_s}");
    assert!(results.device.modes.contains_key("standby"), "a unit begins in standby: {:?}", results.device.modes);
}

#[test]
fn with_the_interface_down_nothing_is_heard_and_the_unit_is_in_fault_until_it_hears_its_vehicle() {
    let (worst, after_s, results) = recovered("interface@4:1");
    assert_eq!(worst, "silent");
    assert!(after_s < 1.5, "{after_s}");
    assert!(results.device.modes.contains_key("fault"), "{:?}", results.device.modes);
    assert!(results.timing.harness.refused > 100);
}

#[test]
fn a_babbling_node_is_none_of_the_units_business() {
    let (worst, after_s, results) = recovered("babble@4:1");
    assert_eq!(worst, "cooperative");
    assert!(after_s < 0.02);
    assert_eq!(results.timing.harness.lost, 0);
}

#[test]
fn frames_with_a_wrong_bit_are_refused_and_counted() {
    let (worst, after_s, results) = recovered("corrupt@4:1");
    assert!(results.device.refusals["checksum"] > 50, "{:?}", results.device.refusals);
    assert!(after_s < 1.0, "{worst} {after_s}");
}

#[test]
fn frames_cut_short_are_refused_and_counted() {
    let (worst, after_s, results) = recovered("truncate@4:1");
    assert!(results.device.refusals["length"] > 50, "{:?}", results.device.refusals);
    assert!(after_s < 1.0, "{worst} {after_s}");
}

#[test]
fn a_foreign_node_on_the_vehicles_identifiers_is_refused_and_seen_by_the_harness() {
    let (_, after_s, results) = recovered("foreign@4:1");
    assert!(results.device.foreign_frames > 150, "{}", results.device.foreign_frames);
    let refused: u32 = ["repeated", "counter_gap", "torn"]
        .iter()
        .map(|cause| results.device.refusals.get(cause).copied().unwrap_or(0))
        .sum();
    assert!(refused > 50, "{:?}", results.device.refusals);
    assert!(after_s < 1.0, "{after_s}");
}

#[test]
fn error_frames_are_counted_and_disturb_nobody() {
    let (worst, _, results) = recovered("errors@4:1");
    assert_eq!(worst, "cooperative");
    assert!((90..=110).contains(&results.device.bus_errors), "{}", results.device.bus_errors);
}

#[test]
fn a_small_step_of_the_time_synchronisation_is_taken() {
    let (worst, _, results) = recovered("clock-step=0.004@4:2");
    assert_eq!(worst, "cooperative");
    // At 11 m/s that is 4.4 cm of the target's position.
    assert!(results.deviation.position_m < 0.06, "{}", results.deviation.position_m);
}

#[test]
fn a_large_step_makes_the_unit_brake_because_its_own_motion_is_not_of_now_and_that_has_its_price() {
    for (fault, cause) in [("clock-step=0.2@4:2", "stale"), ("clock-step=-0.2@4:2", "future")] {
        let results = press(fault);
        let [recovery] = &results.faults[..] else { panic!("{fault}: {:?}", results.faults) };
        assert_eq!(recovery.worst, "fault", "{fault}");
        // The second synchronisation by which time has stepped back is believed.
        assert!(recovery.recovered_after_s.unwrap() < 1.1, "{fault}: {recovery:?}");
        assert!(results.device.refusals[cause] > 100, "{fault}: {:?}", results.device.refusals);
        // A unit without its own motion cannot tell the others that it brakes, and no envelope is engaged.
        assert_eq!(results.verdict, "failed", "{fault}");
        assert_eq!(results.reasons[0], "1 collision(s): a bumper gap fell below 0", "{fault}");
    }
}

#[test]
fn a_drift_of_the_time_synchronisation_is_followed() {
    let (worst, after_s, _) = recovered("clock-drift=200@4:3");
    assert_eq!(worst, "cooperative");
    assert!(after_s < 0.02, "{after_s}");
}
