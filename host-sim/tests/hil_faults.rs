//! The fault buttons on a bus in memory: what the device does, what the harness says, and that it recovers.

use holdover::time::{Duration, Instant};
use holdover_sim::bus::Frame;
use holdover_sim::bus::port::{BusError, Event, Port};
use holdover_sim::commands::hil::judge::{LATENCY_P99_MS, Results, judge};
use holdover_sim::commands::hil::outcome::Outcome;
use holdover_sim::commands::hil::rig::Rig;
use holdover_sim::commands::hil::session::{self, Setup};
use holdover_sim::commands::hil::virtual_bus::{Behaviour, VirtualPort, VirtualRig, bench};
use holdover_sim::input::scenario::{Overrides, Scenario};
use holdover_sim::sim::world::{self, MOST_TICKS};
use std::io;
use std::path::Path;

/// So many seconds on a clean channel, and one fault.
fn setup(duration_s: u32, fault: &str) -> Setup {
    let text = format!("duration_s = {duration_s}\n[channel]\noutages = []\nloss = 0.0");
    let scenario = Scenario::parse(Path::new("test"), &text, &Overrides::MESSAGES_ALONE).unwrap();
    let config = world::config(&scenario, scenario.ego);
    Setup {
        scenario,
        config,
        wait: Duration::from_millis(3000),
        latency_p99_ms: LATENCY_P99_MS,
        faults: vec![fault.parse().unwrap()],
        most_ticks: MOST_TICKS,
    }
}

/// A good device, with the hands that `rig` makes of those of the bus.
fn run<R: Rig>(setup: &Setup, rig: impl FnOnce(VirtualRig, VirtualPort) -> R) -> Outcome {
    let (port, hands) = bench(Behaviour::good(setup.config, false));
    let mut rig = rig(hands, port.clone());
    session::run(setup, port, &mut rig, |_| {}).unwrap()
}

fn press(fault: &str) -> Results {
    let setup = setup(12, fault);
    judge(&setup, &run(&setup, |hands, _| hands))
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
    let setup = setup(6, "babble@4:1");
    let [babble] = &run(&setup, |hands, _| hands).faults[..] else { panic!("one fault") };
    // All that a bus carries at 500 kbit/s: 4 frames in a millisecond.
    assert_eq!((babble.acts, &babble.failed), (4000, &None));
}

#[test]
fn a_fault_whose_node_cannot_get_onto_the_bus_makes_the_run_inconclusive() {
    for kind in ["babble", "foreign", "errors"] {
        let setup = setup(6, &format!("{kind}@4:1"));
        let results = judge(&setup, &run(&setup, |hands, _| NoInjector { hands, port: None }));
        let reason = format!("the fault {kind} could not be played: no second node here");
        assert_eq!((results.verdict, &results.reasons[..]), ("inconclusive", &[reason][..]));
    }
}

#[test]
fn a_fault_of_which_the_bus_takes_nothing_makes_the_run_inconclusive() {
    for kind in ["babble", "foreign", "errors"] {
        let setup = setup(6, &format!("{kind}@4:1"));
        let full = |hands, port| NoInjector { hands, port: Some(FullPort(port)) };
        let results = judge(&setup, &run(&setup, full));
        let reason = format!("the fault {kind} could not be played: the queue is full");
        assert_eq!((results.verdict, &results.reasons[..]), ("inconclusive", &[reason][..]));
    }
}

#[test]
fn a_fault_that_changes_nothing_while_it_is_on_makes_the_run_inconclusive() {
    // Between two ticks; between two frames; between two synchronisations, which come every half a second.
    for fault in ["babble@4.001:0.008", "corrupt@4.001:0.008", "clock-step=0.004@4.1:0.2"] {
        let setup = setup(6, fault);
        let results = judge(&setup, &run(&setup, |hands, _| hands));
        let kind = fault.split(['@', '=']).next().unwrap();
        let reason = format!("the fault {kind} could not be played: it changed nothing while it was on");
        assert_eq!((results.verdict, &results.reasons[..]), ("inconclusive", &[reason][..]));
    }
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
    // At 11 m/s that is 4.4 cm of the target's position, and half a centimetre for what ticks 0.3 ms apart and roundings add.
    assert!(results.deviation.position_m < 0.05, "{}", results.deviation.position_m);
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
        let said = "1 collision(s): a bumper gap fell below 0; first vehicle 3 ran into vehicle 2 at ";
        assert!(results.reasons[0].starts_with(said), "{fault}: {}", results.reasons[0]);
    }
}

#[test]
fn a_drift_of_the_time_synchronisation_is_followed() {
    let (worst, after_s, _) = recovered("clock-drift=200@4:3");
    assert_eq!(worst, "cooperative");
    assert!(after_s < 0.02, "{after_s}");
}

/// Hands without a second node on the bus, or with one that sends nothing.
struct NoInjector {
    hands: VirtualRig,
    port: Option<FullPort>,
}

impl Rig for NoInjector {
    fn power(&mut self, on: bool) -> io::Result<()> {
        self.hands.power(on)
    }

    fn interface(&mut self, up: bool) -> io::Result<()> {
        self.hands.interface(up)
    }

    fn injector(&mut self) -> io::Result<&mut dyn Port> {
        match &mut self.port {
            Some(port) => Ok(port),
            None => Err(io::Error::other("no second node here")),
        }
    }

    fn has_ended(&mut self) -> Option<String> {
        self.hands.has_ended()
    }
}

/// A port that takes nothing.
struct FullPort(VirtualPort);

impl Port for FullPort {
    fn now(&self) -> Instant {
        self.0.now()
    }

    fn send(&mut self, _: Frame) -> io::Result<()> {
        Err(io::Error::other("the queue is full"))
    }

    fn send_error(&mut self, _: BusError) -> io::Result<()> {
        Err(io::Error::other("the queue is full"))
    }

    fn wait(&mut self, until: Instant) -> io::Result<Option<(Instant, Event)>> {
        self.0.wait(until)
    }
}
