//! The table of gains that the core ships is the one that the generator makes, and every limit holds.

use holdover_sim::commands::gains::{Table, source};

#[test]
fn the_committed_table_is_made_anew_byte_for_byte_and_every_limit_holds() {
    let table = Table::made();
    assert_eq!(table.failures, Vec::<String>::new());
    let made = source::text(&table.curve, &table.cells);
    let committed = include_str!("../../src/controller/gain_table.rs");
    assert!(made == committed, "holdover-sim gains --write src/controller/gain_table.rs makes another table");
}

#[test]
fn the_table_is_proved_at_the_scenarios_time_gap_and_at_the_shipped_one() {
    let table = Table::made();
    let shipped_s = f64::from(holdover::parameters::TIME_GAP.to_millis()) / 1e3;
    assert_eq!(table.proofs.each_ref().map(|proof| proof.time_gap_s), [1.0, shipped_s]);
    for proof in &table.proofs {
        assert_eq!(proof.everything_asked + proof.no_collision_asked + proof.nothing_asked, table.cells.len());
        assert!(proof.longest_settling_s <= proof.settling_limit_s, "{proof:?}");
    }
    // 45 s are not enough at the shipped gap, which is why it has a limit of its own.
    let [made, shipped] = &table.proofs;
    assert!(made.settling_limit_s == 45.0 && shipped.longest_settling_s > 45.0, "{shipped:?}");
}
