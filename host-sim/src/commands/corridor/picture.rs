//! The one-page picture of a corridor: results and journals enter, one self-contained SVG leaves.

use std::fmt::Write;

use super::plots::plots;
use super::{Results, Timing};
use crate::commands::motions::largest;
use crate::report::markup::escape;
use crate::report::plot::{Figure, Width};
use crate::roads::experiment::Experiment;
use crate::roads::figures::StepRow;
use crate::roads::journal::Journal;

const STYLE: &str = include_str!("../../report/style.css");
/// Distance between two figures, in pixels.
const BETWEEN: f64 = 12.0;
const TITLE: f64 = 30.0;
/// Height of a line of the note below the figures, in pixels.
const LINE: f64 = 18.0;

const NOTE: [&str; 4] = [
    "Where the ego's error leaps, it follows someone else from then on. The dots by themselves are what the paper",
    "reports from its own simulation. In free acceleration and slot following the target has said what it will do; what",
    "a driver will do nobody says. How many updates a second a core makes at each prediction step depends on the",
    "machine: the report has it, and this picture is the same for the same seed.",
];

/// A figure, and the title above it.
type Panel = (String, Box<dyn Figure>);

/// The picture. It has nothing that depends on the machine, so the same seed gives the same bytes.
#[must_use]
pub fn draw(experiment: &Experiment, results: &Results, steps: &[(StepRow, Journal)]) -> String {
    let mut body = String::new();
    let mut top = BETWEEN;
    for (index, (title, figure)) in panels(experiment, results, steps).iter().enumerate() {
        let drawn = figure.draw(&format!("panel-{index}"), Width::Wide);
        let height = height(&drawn);
        // Writing to a String cannot fail.
        let _ = writeln!(
            body,
            "<text class=\"heading\" x=\"0\" y=\"{:.0}\">{}</text>\n<g transform=\"translate(0 {:.0})\">{}</g>",
            top + 14.0,
            escape(title),
            top + TITLE,
            drawn.replacen("<svg ", &format!("<svg width=\"{}\" height=\"{height}\" ", Width::Wide.pixels()), 1)
        );
        top += TITLE + height + BETWEEN;
    }
    for line in NOTE {
        top += LINE;
        let _ = writeln!(body, "<text class=\"note\" x=\"0\" y=\"{top:.0}\">{}</text>", escape(line));
    }
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"-10 0 {} {:.0}\" role=\"img\">\n<style>{}\n\
         .heading{{font:600 15px system-ui,sans-serif;fill:var(--ink)}}\
         .note{{font:13px system-ui,sans-serif;fill:var(--ink)}}</style>\n\
         <rect x=\"-10\" y=\"0\" width=\"100%\" height=\"100%\" fill=\"var(--paper)\"/>\n{body}</svg>\n",
        Width::Wide.pixels() + 20.0,
        top + BETWEEN,
        escape(STYLE)
    )
}

/// The paper's figures of the corridor except the computing time, and the comparison with other methods.
fn panels(experiment: &Experiment, results: &Results, steps: &[(StepRow, Journal)]) -> Vec<Panel> {
    let timeless = Results { timing: Timing::default(), ..results.clone() };
    let plots = plots(experiment, &timeless, steps).into_iter();
    let mut panels: Vec<Panel> = plots.map(|plot| (plot.title, Box::new(plot.chart) as Box<dyn Figure>)).collect();
    let beside_others = largest(&results.motions);
    panels.push((beside_others.title.clone(), Box::new(beside_others)));
    panels
}

/// The height that an SVG states.
fn height(drawn: &str) -> f64 {
    let view = drawn.split_once("viewBox=\"").and_then(|(_, rest)| rest.split_once('"'));
    view.and_then(|(view, _)| view.split_whitespace().nth(3)?.parse().ok()).unwrap_or(300.0)
}
