//! What the harness keeps of a run, and what of it counts, on a bus in memory whose time leaps.

use std::path::Path;

use holdover::time::Duration;
use holdover_sim::commands::hil::judge::{LATENCY_P99_MS, judge};
use holdover_sim::commands::hil::lateness::Lateness;
use holdover_sim::commands::hil::lock_step;
use holdover_sim::commands::hil::session::{self, Setup};
use holdover_sim::commands::hil::virtual_bus::{Behaviour, bench};
use holdover_sim::input::scenario::{Overrides, Scenario};
use holdover_sim::measure::figures::{Summary, Tally, Timing};
use holdover_sim::sim::world::{self, MOST_TICKS};

/// Four seconds on a clean channel, by messages alone.
fn setup(most_ticks: usize) -> Setup {
    let text = "duration_s = 4\n[channel]\noutages = []\nloss = 0.0";
    let scenario = Scenario::parse(Path::new("test"), text, &Overrides::MESSAGES_ALONE).unwrap();
    let (config, wait) = (world::config(&scenario, scenario.ego), Duration::from_millis(3000));
    Setup { scenario, config, wait, latency_p99_ms: LATENCY_P99_MS, faults: Vec::new(), most_ticks }
}

#[test]
fn what_is_kept_of_a_run_does_not_grow_with_it_and_its_figures_are_of_every_tick() {
    for lock_step in [true, false] {
        let run = |most_ticks| {
            let setup = setup(most_ticks);
            let (port, mut rig) = bench(Behaviour::good(setup.config, lock_step));
            let outcome = match lock_step {
                true => lock_step::run(&setup, port, &mut rig, |_| {}).unwrap(),
                false => session::run(&setup, port, &mut rig, |_| {}).unwrap(),
            };
            (outcome.recorded.trace.times_s.len(), judge(&setup, &outcome).scenario)
        };
        let ((all, whole), (kept, thinned)) = (run(MOST_TICKS), run(64));
        assert_eq!((all, kept), (400, 50), "one in eight");
        let of = |summary: Summary| Summary { timing: Timing { realtime_factor: 1.0 }, ..summary };
        assert_eq!(of(whole), of(thinned));
    }
}

#[test]
fn a_target_outside_its_bound_counts_unless_the_harness_was_late_around_it() {
    let setup = setup(MOST_TICKS);
    let (port, mut rig) = bench(Behaviour::good(setup.config, false));
    let mut outcome = session::run(&setup, port, &mut rig, |_| {}).unwrap();
    assert!(outcome.recorded.outside_s.is_empty());
    // At one tick the vehicle ahead of the ego is not where its follower takes it to be for certain.
    let mut tally = Tally::new(&setup.scenario);
    outcome.recorded.trace.each(|at_s, ticks, paper_m| {
        let mut ticks = ticks.to_vec();
        let leaps = (at_s - 2.0).abs() < 1e-6;
        ticks[1].position_m += if leaps { 3.0 } else { 0.0 };
        assert_eq!(tally.note(at_s, &ticks, paper_m), usize::from(leaps), "{at_s}");
    });
    assert_eq!(tally.finish(1.0).bound.violations, 1);

    outcome.recorded.outside_s = vec![1.0, 2.0, 2.0];
    outcome.lateness = Lateness::new(setup.config.period, 0);
    (0..400).for_each(|tick| outcome.lateness.note(Duration::from_millis(if tick == 100 { 9 } else { 0 })));
    let results = judge(&setup, &outcome);
    assert_eq!((results.verdict, results.scenario.bound.violations), ("failed", 2), "{:?}", results.reasons);
}
