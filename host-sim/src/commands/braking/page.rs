//! The report of `braking`: rows enter; an HTML page with a table and bars leaves.

use super::options::BrakingOptions;
use super::rows::{Comfort, Row, Side};
use crate::report::markup::{count, quantity, significant};
use crate::report::page::{Cell, Page};
use crate::report::plot::{Axis, Bars, Tone};

const WHAT: &str = "The links of all vehicles fall silent, and in the silence the leader brakes to a stop. By messages alone nobody \
                    hears of it; a range sensor sees it. Without the envelope a unit brakes as its law asks, and no harder than \
                    the law may. With it, it brakes as hard as it takes to stay able to stop.";

/// The page.
pub fn render(options: &BrakingOptions, rows: &[Row], failures: &[String]) -> Page {
    let mut page =
        Page::new("holdover-sim · report of braking", "Ten vehicles behind a leader that brakes in a silence");
    let passed = "With the envelope nobody collided, and no target was ever outside its bound.".to_owned();
    page.verdict(failures.is_empty(), &if failures.is_empty() { vec![passed] } else { failures.to_vec() });
    table(&mut page, rows);
    page.paragraph(WHAT);
    page.section("Runs");
    page.facts(&facts(options));
    page.command(&options.command());
    page.section("Gap and comfort");
    figures(&mut page, rows);
    page
}

fn table(page: &mut Page, rows: &[Row]) {
    let header = [
        "Time gap",
        "Leader, m/s²",
        "Envelope",
        "Gap, m",
        "Braking, m/s²",
        "Jerk, m/s³",
        "Collisions",
        "Avoidable",
        "Known at once",
    ];
    let names = |row: &Row, who: &str| [format!("{} s", row.time_gap_s), row.braking_mps2.to_string(), who.into()];
    let felt = |names: [String; 3], gap: String, comfort: &Comfort, collisions: [Cell; 3]| {
        let mut cells = names.map(Cell::text).to_vec();
        cells.extend([
            Cell::number(gap),
            Cell::number(significant(comfort.hardest_braking_mps2, 3)),
            Cell::number(significant(comfort.largest_jerk_mps3, 3)),
        ]);
        cells.extend(collisions);
        cells
    };
    let side = |row: &Row, envelope: &str, side: &Side| {
        let gap = side.min_gap_m.map_or("–".into(), |gap| significant(gap, 3));
        let collisions = Cell::judged(count(side.collisions as u64), side.collisions == 0);
        let [seen, at_once] = [side.avoidable, side.avoidable_at_once].map(|pairs| Cell::number(count(pairs as u64)));
        felt(names(row, envelope), gap, &side.comfort, [collisions, seen, at_once])
    };
    let group = |row: &Row| {
        let leader = felt(names(row, "(leader)"), "–".into(), &row.leader, ["", "", ""].map(Cell::text));
        [leader, side(row, "off", &row.off), side(row, "on", &row.on)]
    };
    let caption = "The worst of all runs. Jerk is the largest change of acceleration within 0.1 s, while a vehicle moves. There is \
                   no smallest gap where vehicles met. A collision was avoidable if the vehicle behind could have come to rest by the \
                   limits of its law and with its lag, had it begun to brake 0.1 s after the one ahead had lost 0.1 m/s, the largest \
                   error of the sensor's speed. The last column counts the same, had it begun in the moment in which the one ahead \
                   did. Pairs whose vehicle ahead had run into another before are never counted as avoidable.";
    page.table(caption, &header, &rows.iter().flat_map(group).collect::<Vec<_>>());
}

fn facts(options: &BrakingOptions) -> Vec<(String, String)> {
    vec![
        ("seeds".into(), format!("{} to {}", options.seed, options.seed + (options.seeds - 1))),
        ("speed".into(), format!("{} m/s", options.speed_mps)),
        ("silence".into(), format!("{} s", options.silence_s)),
        ("delay of every message".into(), format!("{} s", options.delay_s)),
        ("lost outside the silence".into(), quantity(100.0 * options.loss, "%")),
        ("range sensors".into(), options.range_sensors.to_string()),
    ]
}

fn figures(page: &mut Page, rows: &[Row]) {
    let bars =
        |title: &str, unit: &str, value: &dyn Fn(&Side) -> Option<f64>, leader: Option<fn(&Comfort) -> f64>| {
            let of = |side: fn(&Row) -> &Side| rows.iter().map(|row| value(side(row))).collect();
            let mut methods = vec![
                ("without the envelope".into(), Tone::Idle, of(|row| &row.off)),
                ("with it".into(), Tone::Ours, of(|row| &row.on)),
            ];
            methods.extend(leader.map(|of| {
                ("the leader".into(), Tone::Other(0), rows.iter().map(|row| Some(of(&row.leader))).collect())
            }));
            Bars {
                title: title.into(),
                description: format!(
                    "{title} for each time gap and braking of the leader, without the envelope and with it."
                ),
                x_label: "time gap (s), braking of the leader (m/s²)".into(),
                y: Axis::linear(title, unit),
                height: 150.0,
                groups: rows.iter().map(|row| format!("{}, {}", row.time_gap_s, row.braking_mps2)).collect(),
                methods,
            }
        };
    let gap = bars("smallest gap", "m", &|side| side.min_gap_m, None);
    let braking = bars(
        "hardest braking",
        "m/s²",
        &|side| Some(side.comfort.hardest_braking_mps2),
        Some(|leader| leader.hardest_braking_mps2),
    );
    let jerk = bars(
        "largest jerk",
        "m/s³",
        &|side| Some(side.comfort.largest_jerk_mps3),
        Some(|leader| leader.largest_jerk_mps3),
    );
    page.figure("Safety", &say_safety(rows), &[&gap]);
    page.figure("Comfort", "What those inside feel, beside what those inside the leader do.", &[&braking, &jerk]);
}

fn say_safety(rows: &[Row]) -> String {
    let met = |side: fn(&Row) -> &Side| rows.iter().map(|row| side(row).collisions).sum::<usize>();
    let gap = rows.iter().filter_map(|row| row.on.min_gap_m).reduce(f64::min);
    format!(
        "Pairs that met: {} without the envelope, {} with it. The smallest gap with it is {}.",
        met(|row| &row.off),
        met(|row| &row.on),
        gap.map_or("–".into(), |gap| quantity(gap, "m"))
    )
}
