//! The report of the gains: the table enters, an HTML page with heat maps leaves.

use super::Table;
use super::cell::{Asked, Cell, OVERSHOOT_M};
use super::grid::{HEADWAYS, SPEEDS};
use super::linear::{DESIGN_TIME_GAP_S, LEAST_DELAY_S, LEAST_PHASE};
use super::proof::Proof;
use crate::report::page::{Cell as Entry, Page};
use crate::report::plot::{HeatMap, Shade};

const WHAT: &str = "When a vehicle begins to follow another one, it looks its gains up by its own speed, its target’s speed \
                    and the headway between the two. Far away and fast the gains are soft, so that the approach is \
                    comfortable; near they are firm. All of them lie on one curve, along which a string of vehicles damps \
                    what its leader does. A cell with a cross asks nothing: not even braking from the start would avoid a \
                    collision there.";

const GAPS: &str = "The table is made for the smaller time gap and proved at all three. What holds of amplification along a string \
                    holds at every larger gap; margins do not: at 3.995 s the phase margin is below 40°. And an approach takes longer: the last \
                    of it dies out with a time constant that has the gap in it, so the limit on settling grows by 7 s for \
                    each second of gap. The limits on the demand, 2.5 and -4 m/s² and 5 m/s³, hold by construction.";

/// The page.
pub fn render(table: &Table) -> Page {
    let mut page = Page::new("holdover-sim · report of the gains", "The table of gains, eq. 6");
    let [made, shipped, seeing] = &table.proofs;
    let passed = format!(
        "Every pair on the curve and every cell holds its limits, at a time gap of {} s, at {} s, which is shipped, and at \
         {} s with a feed-forward of {}, which is shipped for vehicles with a range sensor.",
        made.time_gap_s, shipped.time_gap_s, seeing.time_gap_s, seeing.feed_forward
    );
    page.verdict(
        table.failures.is_empty(),
        &if table.failures.is_empty() { vec![passed] } else { table.failures.clone() },
    );
    page.paragraph(WHAT);
    page.command("holdover-sim gains");
    page.section("The worst figures");
    proofs(&mut page, &table.proofs);
    page.paragraph(GAPS);
    page.section("k in thousandths of 1/s²");
    for own in table.cells.chunks(SPEEDS * HEADWAYS) {
        let Some(first) = own.first() else { continue };
        let title = format!("own speed {} m/s", first.situation.own_mps);
        let caption = "k by headway (across) and the target’s speed (down).";
        page.figure(&title, caption, &[&map(own, caption)]);
    }
    page
}

fn proofs(page: &mut Page, proofs: &[Proof]) {
    let row = |proof: &Proof| {
        let [none, car, lazy] = proof.largest_amplification.map(|largest| format!("{largest:.5}"));
        let within = |value: f64, limit: f64, unit: &str| Entry::judged(format!("{value:.2} {unit}"), value <= limit);
        let nearest = proof.smallest_gap_m.map_or("-".into(), |gap_m| format!("{gap_m:.2} m"));
        vec![
            Entry::number(format!("{} s", proof.time_gap_s)),
            Entry::number(proof.feed_forward.to_string()),
            Entry::number(format!("{}, {}, {}", proof.everything_asked, proof.no_collision_asked, proof.nothing_asked)),
            Entry::number(format!("{none}, {car}, {lazy}")),
            Entry::judged(
                format!("{:.1}°", proof.least_phase_margin_deg),
                proof.least_phase_margin_deg >= LEAST_PHASE.to_degrees(),
            ),
            Entry::judged(format!("{:.2} s", proof.least_delay_margin_s), proof.least_delay_margin_s >= LEAST_DELAY_S),
            within(proof.longest_settling_s, proof.settling_limit_s, "s"),
            Entry::number(format!("{:.1} s", proof.settling_limit_s)),
            within(proof.largest_overshoot_m, OVERSHOOT_M, "m"),
            Entry::number(nearest),
        ]
    };
    let header = [
        "Time gap",
        "Feed-forward",
        "Everything, no collision, nothing asked",
        "Amplification, lag 0, 0.3, 0.5 s",
        "Phase margin",
        "Delay margin",
        "Settled",
        "Limit",
        "Into the gap",
        "Least gap where no collision is asked",
    ];
    let caption = "Cells by what is asked of them; of all pairs on the curve the largest amplification and the least margins with a \
                   lag of 0.5 s; of all cells of which everything is asked the latest settling and the farthest into the gap.";
    page.table(caption, &header, &proofs.iter().map(row).collect::<Vec<_>>());
}

fn map(cells: &[Cell], description: &str) -> HeatMap {
    let milli = |cell: &Cell| (cell.pair.gain * 1e3).round();
    let label = |cell: &Cell| match Asked::of(&cell.situation, DESIGN_TIME_GAP_S) {
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
