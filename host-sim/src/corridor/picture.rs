//! The one-page picture of a corridor: results and journals enter, one SVG that stands by itself leaves.

use std::fmt::Write;

use super::command::Results;
use super::experiment::Experiment;
use super::figures::StepRow;
use super::journal::Journal;
use super::plots::plots;
use crate::report::plot::{Figure, Width};

const STYLE: &str = include_str!("../report/style.css");
/// Between two figures, in pixels.
const BETWEEN: f64 = 12.0;
const TITLE: f64 = 30.0;

/// The picture: what depends on the machine is left out, so that the same seed is the same bytes.
#[must_use]
pub fn draw(experiment: &Experiment, results: &Results, steps: &[(StepRow, Journal)]) -> String {
    let mut body = String::new();
    let mut top = BETWEEN;
    let timeless = Results { timing: super::command::Timing::default(), ..results.clone() };
    for (index, plot) in plots(experiment, &timeless, steps).iter().enumerate() {
        let drawn = plot.chart.draw(&format!("panel-{index}"), Width::Wide);
        let height = height(&drawn);
        // Writing to a String cannot fail.
        let _ = writeln!(
            body,
            "<text class=\"heading\" x=\"0\" y=\"{:.0}\">{}</text>\n<g transform=\"translate(0 {:.0})\">{}</g>",
            top + 14.0,
            crate::report::markup::escape(&plot.title),
            top + TITLE,
            drawn.replacen("<svg ", &format!("<svg width=\"{}\" height=\"{height}\" ", Width::Wide.pixels()), 1)
        );
        top += TITLE + height + BETWEEN;
    }
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"-10 0 {} {top:.0}\" role=\"img\">\n<style>{}\n\
         .heading{{font:600 15px system-ui,sans-serif;fill:currentColor}}</style>\n{body}</svg>\n",
        Width::Wide.pixels() + 20.0,
        crate::report::markup::escape(STYLE)
    )
}

/// The height that a figure says it has.
fn height(drawn: &str) -> f64 {
    let view = drawn.split_once("viewBox=\"").and_then(|(_, rest)| rest.split_once('"'));
    view.and_then(|(view, _)| view.split_whitespace().nth(3)?.parse().ok()).unwrap_or(300.0)
}
