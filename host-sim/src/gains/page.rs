//! The report of the gains: the table enters, an HTML page with heat maps leaves.

use super::Table;
use super::cell::{Asked, Cell};
use super::grid::{HEADWAYS, SPEEDS};
use crate::report::page::Page;
use crate::report::plot::{HeatMap, Shade};

const WHAT: &str = "When a vehicle begins to follow another one, it looks its gains up by its own speed, its target’s speed \
                    and the headway between the two. Far away and fast the gains are soft, so that the approach is \
                    comfortable; near they are firm. All of them lie on one curve, along which a string of vehicles damps \
                    what its leader does. A cell with a cross asks nothing: not even braking from the start would avoid a \
                    collision there.";

/// The page.
pub fn render(table: &Table) -> String {
    let mut page = Page::new("holdover-sim · report of the gains", "The table of gains, eq. 6");
    let passed = "Every pair on the curve and every cell holds its limits.".to_owned();
    page.verdict(
        table.failures.is_empty(),
        &if table.failures.is_empty() { vec![passed] } else { table.failures.clone() },
    );
    page.paragraph(WHAT);
    page.command("holdover-sim gains");
    page.section("k in thousandths of 1/s²");
    for own in table.cells.chunks(SPEEDS * HEADWAYS) {
        let Some(first) = own.first() else { continue };
        let title = format!("own speed {} m/s", first.situation.own_mps);
        let caption = "k by headway (across) and the target’s speed (down).";
        page.figure(&title, caption, &[&map(own, caption)]);
    }
    page.finish()
}

fn map(cells: &[Cell], description: &str) -> HeatMap {
    let milli = |cell: &Cell| (cell.pair.gain * 1e3).round();
    let label = |cell: &Cell| match cell.asked {
        Asked::Nothing => "×".to_owned(),
        Asked::Everything | Asked::NoCollision => milli(cell).to_string(),
    };
    let shade = |cell: &Cell| Shade { share: (milli(cell) - 250.0) / 350.0, label: label(cell) };
    let names =
        |values: &mut dyn Iterator<Item = f64>, unit: &str| values.map(|value| format!("{value} {unit}")).collect();
    HeatMap {
        title: "k".into(),
        description: description.into(),
        columns: names(&mut cells.iter().take(HEADWAYS).map(|cell| cell.situation.headway_m), "m"),
        rows: names(&mut cells.chunks(HEADWAYS).filter_map(|row| Some(row.first()?.situation.target_mps)), "m/s"),
        shades: cells.chunks(HEADWAYS).map(|row| row.iter().map(shade).collect()).collect(),
    }
}
