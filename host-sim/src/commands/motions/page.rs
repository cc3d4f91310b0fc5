//! The report of target motions: rows enter; a table and curves on a page leave, alone or in another command's report,
//! and bars for another command's picture.

use super::options::MotionsOptions;
use super::rows::{MethodFigures, Row};
use super::silence::NAMES;
use super::table::standing;
use crate::measure::baseline::spoken;
use crate::report::markup::{count, significant};
use crate::report::page::{Cell, Page};
use crate::report::plot::{Axis, Bars, Chart, Layer, Series, Tone};

const WHAT: &str = "A vehicle that has heard another one over the paper’s channel (delay Normal(40 ms, 25.9 ms), 10 % loss) \
                    hears nothing for 4 s. Shown is how far from the truth its unit’s estimate is meanwhile, and what others \
                    make of the same messages. The first two targets drive by their units and have said how. What a driver \
                    will do nobody says, so with the other three the only question is whose guess happens to suit: where \
                    the braking begins inside the silence, all predict the same.";

const OF_OTHERS: &str = "The literal paper takes 13.4 m/s for the request of a driver who has published none. That is the very \
                         speed that these drivers start from, and about which the sine goes up and down: the luckiest case \
                         for the paper. The consensus law of platoon simulators moves the message that came last on by its \
                         age times its speed; that differs from a constant speed only where the last message was overtaken.";

/// The page of `motions`.
pub fn render(options: &MotionsOptions, rows: &[Row]) -> Page {
    let mut page = Page::new("holdover-sim · report of target motions", "What a target does in a silence");
    section(&mut page, rows);
    page.command(&options.command());
    page
}

/// The section of a report, for the page of any command.
pub fn section(page: &mut Page, rows: &[Row]) {
    page.paragraph(WHAT);
    table(page, rows, "Rms of the position error in the silence, m", |figures| figures.rms_position_m);
    table(page, rows, "Largest position error in the silence, m", |figures| figures.max_position_m);
    page.list(&rows.iter().map(|row| format!("{}: {}.", row.motion, standing(row))).collect::<Vec<_>>());
    page.paragraph(OF_OTHERS);
    for row in rows {
        growth(page, row);
    }
}

/// The largest error of each method by motion. The axis is logarithmic, because the frozen position is far off.
#[must_use]
pub fn largest(rows: &[Row]) -> Bars {
    let errors = |method: usize| rows.iter().map(|row| Some(row.methods.get(method)?.max_position_m)).collect();
    let method = |(index, name): (usize, &str)| (spoken(name), tone(index, name), errors(index));
    Bars {
        title: "Largest position error in a silence of 4 s, by what the target does".into(),
        description: "A bar for each method, in groups by what the target does.".into(),
        x_label: "what the target does in the silence".into(),
        y: Axis::logarithmic("largest position error", "m"),
        height: 230.0,
        groups: rows.iter().map(first_words).collect(),
        methods: NAMES.into_iter().enumerate().map(method).collect(),
    }
}

fn first_words(row: &Row) -> String {
    row.motion.to_string().split(',').next().unwrap_or_default().to_owned()
}

fn tone(index: usize, method: &str) -> Tone {
    match method {
        "holdover" => Tone::Ours,
        "paper" => Tone::Paper,
        _ => Tone::Other(index),
    }
}

/// A table with a row for each method; the least value of each motion is bold.
fn table(page: &mut Page, rows: &[Row], caption: &str, figure: fn(&MethodFigures) -> f64) {
    let spelled = |figures: &MethodFigures| significant(figure(figures), 3);
    let least = |row: &Row| row.methods.iter().min_by(|a, b| figure(a).total_cmp(&figure(b))).map(spelled);
    let least: Vec<Option<String>> = rows.iter().map(least).collect();
    let of_method = |(index, name): (usize, &str)| {
        let cell = |(row, least): (&Row, &Option<String>)| {
            let text = row.methods.get(index).map(spelled);
            let is_least = text == *least;
            let text = text.unwrap_or_default();
            if is_least { Cell::strong(text) } else { Cell::number(text) }
        };
        let name = Cell::text(spoken(name));
        std::iter::once(name).chain(rows.iter().zip(&least).map(cell)).collect::<Vec<_>>()
    };
    let lines: Vec<Vec<Cell>> = NAMES.into_iter().enumerate().map(of_method).collect();
    let motions: Vec<String> = rows.iter().map(first_words).collect();
    let header: Vec<&str> = std::iter::once("").chain(motions.iter().map(String::as_str)).collect();
    page.table(caption, &header, &lines);
}

/// A curve of the errors over the silence. The frozen position is so far off that it would flatten all other lines; it
/// is only in the tables.
fn growth(page: &mut Page, row: &Row) {
    let line = |(index, method): (usize, &MethodFigures)| {
        let series = Series::new(spoken(method.name), method.growth.clone());
        Layer::Line { series, tone: tone(index, method.name), marked: false }
    };
    // The unit's line comes last, so that it lies on top.
    let layers = row.methods.iter().enumerate().rev().filter(|(_, method)| method.name != "freeze").map(line).collect();
    let axes = (Axis::linear("time since the silence began", "s"), Axis::linear("position error, rms", "m"));
    let title = row.motion.to_string();
    let caption = format!(
        "Rms of the position error over the time that the silence has lasted, {} silences; {}.",
        count(u64::from(row.silences)),
        standing(row)
    );
    let chart = Chart { description: caption.clone(), layers, ..Chart::new(&title, axes.0, axes.1) };
    page.figure(&title, &caption, &[&chart]);
}
