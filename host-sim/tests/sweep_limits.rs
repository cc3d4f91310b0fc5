//! The accuracy that the product claims: the worst of 100 seeds of the paper's scenario, at three prediction steps.

use holdover_sim::commands::sweep::rows::run;
use holdover_sim::input::scenario::{Overrides, Scenario};

#[test]
fn the_worst_of_100_seeds_keeps_the_limit_of_its_step_and_the_paper_does_not() {
    let paper = Scenario::read(None, &Overrides::default()).unwrap();
    for (step_s, limit_m) in [(0.01, 0.025), (0.1, 0.05), (1.0, 1.0)] {
        let runs = run(&paper.at_step(step_s).unwrap(), 1, 100, || {}).unwrap();
        let ours = runs.ours.max_position_error_m.unwrap();
        assert!(ours <= limit_m, "{ours} m at a step of {step_s} s");
        assert!(ours > 1e-4, "{ours} m is less than the messages resolve");
        assert!(runs.paper.max_position_error_m.unwrap() > 10.0 * ours);
        assert!(runs.ours.p99_position_error_m.unwrap() < ours);
        assert_eq!(runs.failures, []);
    }
}
