//! The tables of gains that the core ships are those that the generator makes, and every limit holds.

use std::sync::LazyLock;

use holdover_sim::commands::gains::{Table, design, failures, source};

static TABLES: LazyLock<[Table; 2]> = LazyLock::new(Table::both);

#[test]
fn the_committed_tables_are_made_anew_byte_for_byte_and_every_limit_holds() {
    assert_eq!(failures(&*TABLES), Vec::<String>::new());
    let made = source::text(&*TABLES);
    let committed = include_str!("../../../src/controller/gain_table.rs");
    assert!(made == committed, "holdover-sim gains --write src/controller/gain_table.rs makes other tables");
}

#[test]
fn the_tables_are_proved_at_every_tenth_of_the_time_gap_and_at_the_shipped_ones() {
    let gaps =
        |table: &Table| table.proofs.iter().map(|proof| (proof.time_gap_s * 10.0).round() as u32).collect::<Vec<_>>();
    let [plain, fed] = &*TABLES;
    assert_eq!(gaps(plain), (10..=design::LARGEST_GAP_TENTHS).collect::<Vec<_>>());
    assert_eq!(gaps(fed), (7..=design::LARGEST_GAP_TENTHS).collect::<Vec<_>>());
    let tenths = |gap: holdover::units::Seconds| u32::try_from(gap.to_millis()).unwrap() / 100;
    assert!(gaps(plain).contains(&tenths(holdover::parameters::TIME_GAP)));
    assert!(gaps(fed).contains(&tenths(holdover::parameters::TIME_GAP_WITH_SENSOR)));
    for table in &*TABLES {
        for proof in &table.proofs {
            assert_eq!(proof.everything_asked + proof.no_collision_asked + proof.nothing_asked, table.cells.len());
            assert!(proof.longest_settling_s <= proof.settling_limit_s, "{proof:?}");
        }
    }
}

#[test]
fn the_worst_figures_are_the_documented_ones() {
    let [plain, fed] = &*TABLES;
    let at = |table: &'static Table, gap_s: f64| table.proofs.iter().find(|proof| proof.time_gap_s == gap_s).unwrap();
    let is = |figure: f64, documented: f64, rounding: f64| (figure - documented).abs() <= rounding;
    // Amplification without lag, with a car's 0.3 s and with the 0.5 s of a bus; margins; cells; settling; way into the gap.
    let documented = [
        (at(plain, 1.0), [1.0000, 1.0000, 1.0005], [40.3, 0.51], [420, 25, 67], [41.7, 45.0, 0.24]),
        (at(plain, 1.6), [0.9998, 0.9998, 0.9998], [40.8, 0.45], [411, 34, 67], [48.2, 49.2, 0.00]),
        (at(fed, 0.7), [1.0000, 1.0000, 1.0000], [43.1, 0.72], [424, 21, 67], [38.4, 42.9, 0.24]),
        (at(fed, 0.8), [0.9999, 0.9999, 0.9999], [43.6, 0.71], [422, 23, 67], [41.1, 43.6, 0.00]),
    ];
    for (proof, amplification, [degrees, delay_s], cells, [settled_s, limit_s, overshoot_m]) in documented {
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
