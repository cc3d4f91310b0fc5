//! The table of gains that the core ships is the one that the generator makes, and every limit holds.

use holdover_sim::commands::gains::{Table, source};

#[test]
fn the_committed_table_is_made_anew_byte_for_byte_and_every_limit_holds() {
    let table = Table::made();
    assert_eq!(table.failures, Vec::<String>::new());
    let made = source::text(&table.curve, &table.cells);
    let committed = include_str!("../../../src/controller/gain_table.rs");
    assert!(made == committed, "holdover-sim gains --write src/controller/gain_table.rs makes another table");
}

#[test]
fn the_table_is_proved_at_the_scenarios_time_gap_and_as_shipped() {
    let table = Table::made();
    let shipped_s = f64::from(holdover::parameters::TIME_GAP.to_millis()) / 1e3;
    let sensor_s = f64::from(holdover::parameters::TIME_GAP_WITH_SENSOR.to_millis()) / 1e3;
    let feed_forward: f64 = holdover::parameters::FEED_FORWARD.get().to_num();
    assert_eq!(
        table.proofs.each_ref().map(|proof| (proof.time_gap_s, proof.feed_forward)),
        [(1.0, 0.0), (shipped_s, 0.0), (sensor_s, feed_forward)]
    );
    for proof in &table.proofs {
        assert_eq!(proof.everything_asked + proof.no_collision_asked + proof.nothing_asked, table.cells.len());
        assert!(proof.longest_settling_s <= proof.settling_limit_s, "{proof:?}");
    }
    // 45 s are not enough at the shipped gap, which is why it has a limit of its own.
    let [made, shipped, _] = &table.proofs;
    assert!(made.settling_limit_s == 45.0 && shipped.longest_settling_s > 45.0, "{shipped:?}");
}

#[test]
fn the_worst_figures_are_the_documented_ones() {
    let proofs = Table::made().proofs;
    let is = |figure: f64, documented: f64, rounding: f64| (figure - documented).abs() <= rounding;
    // Amplification without lag, with a car's 0.3 s and with the 0.5 s of a bus; margins; cells; settling; way into the gap.
    let documented = [
        ([1.0000, 1.0000, 1.0005], [40.3, 0.51], [420, 25, 67], [41.7, 45.0, 0.24]),
        ([0.9998, 0.9998, 0.9998], [40.8, 0.45], [411, 34, 67], [48.2, 49.2, 0.00]),
        ([0.9999, 0.9999, 0.9999], [40.3, 0.51], [420, 25, 67], [41.7, 45.0, 0.24]),
    ];
    for (proof, (amplification, [degrees, delay_s], cells, [settled_s, limit_s, overshoot_m])) in
        proofs.iter().zip(documented)
    {
        // Half of the last digit that is documented, each: the figures are deterministic.
        for (figure, documented) in proof.largest_amplification.into_iter().zip(amplification) {
            assert!(is(figure, documented, 5.1e-5), "{proof:?}");
        }
        assert!(is(proof.least_phase_margin_deg, degrees, 0.05) && is(proof.least_delay_margin_s, delay_s, 0.005));
        assert_eq!([proof.everything_asked, proof.no_collision_asked, proof.nothing_asked], cells);
        assert!(is(proof.longest_settling_s, settled_s, 0.05) && is(proof.settling_limit_s, limit_s, 0.05));
        assert!(is(proof.largest_overshoot_m, overshoot_m, 0.005), "{proof:?}");
    }
}
