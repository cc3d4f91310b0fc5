//! The table of gains that the core ships is the one that the generator makes, and every limit holds.

use holdover_sim::gains::{Table, source};

#[test]
fn the_committed_table_is_made_anew_byte_for_byte_and_every_limit_holds() {
    let table = Table::made();
    assert_eq!(table.failures, Vec::<String>::new());
    let made = source::text(&table.curve, &table.cells);
    let committed = include_str!("../../src/controller/gain_table.rs");
    assert!(made == committed, "holdover-sim gains --write src/controller/gain_table.rs makes another table");
}
