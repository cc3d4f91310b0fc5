//! The source text of the tables: they enter; the text of `src/controller/gain_table.rs` leaves.

use std::fmt::Write;

use super::Table;
use super::cell::Cell;
use super::design::POINTS;
use super::grid::{GAIN_STEP_MILLI, HEADWAY_FIRST_M, HEADWAY_STEP_M, HEADWAYS, SPEED_STEP_MPS, SPEEDS};

const HEAD: &str = "\
//! The tables of eq. 6. Generated, and every cell proved, by `holdover-sim gains --write src/controller/gain_table.rs`; do not
//! edit.

use super::gains::Table;

";

/// The text.
#[must_use]
pub fn text(tables: &[Table]) -> String {
    let mut text = String::from(HEAD);
    // Writing to a string cannot fail.
    let mut constant = |doc: &str, name: &str, kind: &str, value: u32| {
        let _ = writeln!(text, "/// {doc}\npub(super) const {name}: {kind} = {};", spelled(value));
    };
    constant("Own speeds and target's: so many, from 0.", "SPEEDS", "usize", SPEEDS as u32);
    constant("Steps of the speeds, in mm/s.", "SPEED_STEP_MM_PER_S", "i32", SPEED_STEP_MPS * 1000);
    constant("Headways, from front bumper to front bumper: so many.", "HEADWAYS", "usize", HEADWAYS as u32);
    constant("The first of them, in mm.", "HEADWAY_FIRST_MM", "i32", HEADWAY_FIRST_M * 1000);
    constant("Their steps, in mm.", "HEADWAY_STEP_MM", "i32", HEADWAY_STEP_M * 1000);
    constant("Points of a curve.", "POINTS", "usize", POINTS);
    for table in tables {
        write(&mut text, table);
    }
    text
}

fn write(text: &mut String, table: &Table) {
    let Table { design, curve, cells, .. } = table;
    let points: Vec<String> = curve.iter().map(|damping| spelled(*damping)).collect();
    let gap_s = design.smallest_gap_s();
    let _ = writeln!(
        text,
        "/// Of the law with a feed-forward of {}, from a time gap of {gap_s} s on.",
        design.feed_forward
    );
    let _ = writeln!(text, "#[rustfmt::skip]");
    let _ = writeln!(text, "pub(super) static {}: Table = Table {{", design.name);
    let _ = writeln!(text, "    first_milli: {},", design.first_milli);
    let _ = writeln!(text, "    step_milli: {},", design.step_milli);
    let _ = writeln!(text, "    curve: [{}],", points.join(", "));
    let _ = writeln!(text, "    gains: [");
    for own in cells.chunks(SPEEDS * HEADWAYS) {
        let _ = writeln!(text, "        [");
        for target in own.chunks(HEADWAYS) {
            let row: Vec<String> = target.iter().map(|cell| step(cell).to_string()).collect();
            let _ = writeln!(text, "            [{}],", row.join(", "));
        }
        let _ = writeln!(text, "        ],");
    }
    let _ = writeln!(text, "    ],\n}};");
}

/// `k` of a cell, in the table's steps.
fn step(cell: &Cell) -> u32 {
    (cell.pair.gain * 1e3 / f64::from(GAIN_STEP_MILLI)).round() as u32
}

/// A number with its thousands separated as in Rust.
fn spelled(value: u32) -> String {
    if value < 10_000 { value.to_string() } else { format!("{}_{:03}", value / 1000, value % 1000) }
}
