//! The report of the gains: the tables enter, an HTML page with heat maps leaves.

use super::Table;
use super::cell::{Asked, Cell, OVERSHOOT_M};
use super::grid::{HEADWAYS, SPEEDS};
use super::linear::{LEAST_DELAY_S, LEAST_PHASE};
use super::proof::Proof;
use crate::report::page::{Cell as Entry, Page};
use crate::report::plot::{HeatMap, Shade};

const WHAT: &str = "When a vehicle begins to follow another one, it looks its gains up by its own speed, its target’s speed \
                    and the headway between the two. Far away and fast the gains are soft, so that the approach is \
                    comfortable; near they are firm. All of them lie on one curve, along which a string of vehicles damps \
                    what its leader does. A cell with a cross asks nothing: not even braking from the start would avoid a \
                    collision there.";

const GAPS: &str = "Each table is made for its smallest time gap and proved at every tenth of a second up to 2 s. What holds of \
                    amplification along a string holds at every larger gap; margins do not: without feed-forward the phase margin is \
                    below 40° at 3.995 s. And an approach takes longer: the last of it dies out with a time constant that has the gap in \
                    it, so the limit on settling grows by 7 s for each second of gap. The limits on the demand, 2.5 and -4 m/s² and \
                    5 m/s³, hold by construction.";

/// The page.
pub fn render(tables: &[Table]) -> Page {
    let mut page = Page::new("holdover-sim · report of the gains", "The tables of gains, eq. 6");
    let failures = super::failures(tables);
    let passed =
        "Every pair on the curves and every cell holds its limits at every time gap that its table is made for.";
    page.verdict(failures.is_empty(), &if failures.is_empty() { vec![passed.to_owned()] } else { failures });
    page.paragraph(WHAT);
    page.command("holdover-sim gains");
    page.paragraph(GAPS);
    for table in tables {
        let design = &table.design;
        page.section(&match design.feed_forward {
            0.0 => "Without feed-forward".to_owned(),
            share => format!("With a feed-forward of {share}, as cars and vans with a range sensor drive"),
        });
        proofs(&mut page, &table.proofs);
        for own in table.cells.chunks(SPEEDS * HEADWAYS) {
            let Some(first) = own.first() else { continue };
            let title = format!("feed-forward {}, own speed {} m/s", design.feed_forward, first.situation.own_mps);
            let caption = "k in thousandths of 1/s², by headway (across) and the target’s speed (down).";
            page.figure(&title, caption, &[&map(table, own, caption)]);
        }
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

fn map(table: &Table, cells: &[Cell], description: &str) -> HeatMap {
    let design = &table.design;
    let milli = |cell: &Cell| (cell.pair.gain * 1e3).round();
    let label = |cell: &Cell| match Asked::of(&cell.situation, design.smallest_gap_s()) {
        Asked::Nothing => "×".to_owned(),
        Asked::Everything | Asked::NoCollision => milli(cell).to_string(),
    };
    let (first, last) = (f64::from(design.first_milli), f64::from(design.last_milli()));
    let shade = |cell: &Cell| Shade { share: (milli(cell) - first) / (last - first), label: label(cell) };
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
