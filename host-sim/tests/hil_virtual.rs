//! The harness on a bus in memory: good devices pass, and each kind of bad one has its own clear verdict.

use holdover::time::Duration;
use holdover_sim::hil::judge::{Results, judge};
use holdover_sim::hil::lock_step;
use holdover_sim::hil::session::{self, Setup};
use holdover_sim::hil::virtual_bus::{Behaviour, bench};
use holdover_sim::scenario::{Overrides, Scenario};
use holdover_sim::world;
use std::path::Path;

fn setup(scenario: &str, faults: &[&str]) -> Setup {
    let scenario = Scenario::parse(Path::new("test"), scenario, &Overrides::default()).unwrap();
    let config = world::config(&scenario, scenario.ego);
    let faults = faults.iter().map(|fault| fault.parse().unwrap()).collect();
    Setup { scenario, config, wait: Duration::from_millis(3000), faults }
}

fn run(setup: &Setup, change: impl FnOnce(&mut Behaviour)) -> Results {
    let mut behaviour = Behaviour::good(setup.config, false);
    change(&mut behaviour);
    let (port, mut rig) = bench(behaviour);
    let outcome = session::run(setup, port, &mut rig, |_| {}).unwrap();
    judge(setup, &outcome)
}

#[test]
fn a_good_device_passes_the_papers_scenario_and_its_twin_is_never_far_from_it() {
    let results = run(&setup("", &[]), |_| {});
    assert_eq!((results.verdict, &results.reasons[..]), ("passed", &[][..]));
    println!("{results:?}");
}

#[test]
fn in_lock_step_device_and_twin_say_the_same_bit_for_bit() {
    let setup = setup("", &[]);
    let (port, mut rig) = bench(Behaviour::good(setup.config, true));
    let outcome = lock_step::run(&setup, port, &mut rig, |_| {}).unwrap();
    let results = judge(&setup, &outcome);
    assert_eq!((results.verdict, &results.reasons[..]), ("passed", &[][..]));
    assert_eq!((results.deviation.ticks, results.deviation.different_frames), (2100, 0));
    assert!(results.deviation.frames > 3 * 2100, "{}", results.deviation.frames);
    println!("{results:?}");
}
