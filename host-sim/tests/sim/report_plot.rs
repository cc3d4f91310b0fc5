//! Facts about the kinds of figures, each drawn and read back from its SVG.

use holdover_sim::report::{
    page::Page,
    plot::{Axis, Bars, Chart, Figure, Guide, Layer, Series, Tone, Width, cumulative, histogram},
};
use proptest::prelude::*;
use roxmltree::{Document, Node};

const STEPS_S: [f64; 7] = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0];

/// The elements of `svg` with this class, as they are drawn.
fn drawn<'a>(svg: &'a Document, class: &str) -> Vec<Node<'a, 'a>> {
    svg.descendants().filter(|node| node.attribute("class") == Some(class)).collect()
}

fn number(node: &Node, attribute: &str) -> f64 {
    node.attribute(attribute).unwrap().parse().unwrap()
}

fn by_outage(y: Axis) -> Bars {
    let errors = |scale: f64| [0.5, 1.0, 2.0, 4.0].map(|outage: f64| Some(scale * outage.powf(1.6))).to_vec();
    let mut methods =
        vec![("ours".to_string(), Tone::Ours, errors(0.1)), ("paper".to_string(), Tone::Paper, errors(0.4))];
    let others = ["freeze", "constant_speed", "constant_acceleration", "singer", "kalman"];
    methods.extend(
        others
            .iter()
            .enumerate()
            .map(|(n, name)| (name.to_string(), Tone::Other(n), errors([8.0, 0.2, 0.26, 0.12, 0.24][n]))),
    );
    Bars {
        title: "Error by outage".into(),
        description: "Root mean square of the position error of seven methods at four lengths of outage.".into(),
        x_label: "length of the outage (s)".into(),
        y,
        height: 220.0,
        groups: ["0.5", "1", "2", "4"].map(String::from).to_vec(),
        methods,
    }
}

fn by_step() -> Chart {
    let mut chart = Chart::new(
        "Error by prediction step",
        Axis::logarithmic("prediction step", "s").over(0.008, 1.25),
        Axis::logarithmic("largest position error", "m"),
    );
    chart.description = "Error over prediction step on logarithmic axes.".into();
    let line = |name: &str, at: &dyn Fn(f64) -> f64| Series::new(name, STEPS_S.map(|step| (step, at(step))));
    let ours = |step: f64| 0.02 + 0.4 * step.powf(1.5);
    let edges = STEPS_S.map(|step| (step, 0.6 * ours(step), ours(step))).to_vec();
    chart.layers = vec![
        Layer::Band { name: "median to worst seed".into(), edges, tone: Tone::Ours },
        Layer::Line { series: line("literal paper", &|step| 0.8 + 9.0 * step), tone: Tone::Paper, marked: true },
        Layer::Line { series: line("ours", &ours), tone: Tone::Ours, marked: true },
    ];
    chart
}

fn errors() -> Vec<f64> {
    (0..2000).map(|k| (f64::from(k) * 0.7).sin() * (f64::from(k) * 0.013).cos() * 0.04).collect()
}

#[test]
fn every_kind_of_figure_fits_on_one_page() {
    let mut bins =
        Chart::new("Histogram", Axis::linear("position error", "m"), Axis::linear("samples", "").including(0.0));
    bins.description = "Histogram of the error.".into();
    bins.layers = vec![Layer::Columns { name: String::new(), bins: histogram(&errors(), 40), tone: Tone::Ours }];
    let mut scatter = Chart::new("Scatter", Axis::linear("age", "s"), Axis::linear("position error", "m"));
    scatter.description = "Error over age.".into();
    scatter.guides = vec![Guide { at: 0.0, label: String::new() }];
    let points = errors().into_iter().enumerate().map(|(k, error)| (k as f64 * 0.001, error * k as f64 * 0.001));
    scatter.layers = vec![Layer::Dots { series: Series::new("samples", points), tone: Tone::Other(3) }];
    let mut page = Page::new("figures", "Every kind of figure");
    page.figure("Grouped bars", "Linear.", &[&by_outage(Axis::linear("rms position error", "m"))]);
    page.figure("Grouped bars", "Logarithmic.", &[&by_outage(Axis::logarithmic("rms position error", "m"))]);
    page.figure("Sweep", "Log-log lines with a band.", &[&by_step()]);
    page.figure("Histogram", "Forty bins.", &[&bins]);
    page.figure("Scatter", "Two thousand dots.", &[&scatter]);
    let html = page.finish();
    // Left where a browser can open it: target/tmp/figures.html.
    std::fs::write(concat!(env!("CARGO_TARGET_TMPDIR"), "/figures.html"), &html).unwrap();
    assert_eq!(html.matches("<svg ").count(), 15);
    assert!(!html.contains("not drawn") && !html.contains("NaN") && !html.contains("no data"));
}

#[test]
fn linear_bars_are_as_long_as_their_values() {
    let mut bars = by_outage(Axis::linear("error", "m"));
    bars.methods.truncate(1);
    bars.methods[0].2 = vec![Some(1.0), None, Some(4.0), Some(f64::NAN)];
    let text = bars.draw("bars", Width::Wide);
    let svg = Document::parse(&text).unwrap();
    let fills = drawn(&svg, "fill ours");
    // The legend's swatch, then one bar for each value there is.
    assert_eq!(fills.len(), 1 + 2);
    let ratio = number(&fills[2], "height") / number(&fills[1], "height");
    assert!((ratio - 4.0).abs() < 0.02, "{ratio}");
    assert_eq!(bars.undrawable(), 1);
}

#[test]
fn logarithmic_bars_differ_by_equal_lengths_for_equal_factors() {
    let mut bars = by_outage(Axis::logarithmic("error", "m"));
    bars.methods.truncate(1);
    bars.methods[0].2 = vec![Some(0.02), Some(0.2), Some(2.0), Some(0.0)];
    let text = bars.draw("bars", Width::Narrow);
    let svg = Document::parse(&text).unwrap();
    let heights: Vec<f64> = drawn(&svg, "fill ours").iter().skip(1).map(|bar| number(bar, "height")).collect();
    assert_eq!(heights.len(), 3, "zero has no place on a logarithmic axis");
    assert!((heights[2] - 2.0 * heights[1] + heights[0]).abs() < 0.3, "{heights:?}");
    assert!(heights[0] > 10.0, "the smallest bar is seen: {heights:?}");
    assert_eq!(bars.undrawable(), 1);
}

#[test]
fn a_power_law_is_straight_on_logarithmic_axes() {
    let mut chart = by_step();
    let series = Series::new("power law", STEPS_S.map(|step| (step, step.powf(1.5))));
    chart.layers = vec![Layer::line(series, Tone::Ours)];
    let text = chart.draw("sweep", Width::Wide);
    let svg = Document::parse(&text).unwrap();
    let line = drawn(&svg, "line ours")[0].attribute("d").unwrap();
    assert_eq!(line.matches(',').count(), 2, "two points are enough: {line}");
}

#[test]
fn lines_are_named_at_their_ends_where_there_is_room_and_in_a_legend_where_not() {
    for (width, at_the_ends) in [(Width::Wide, 2), (Width::Narrow, 0)] {
        let text = by_step().draw("sweep", width);
        let svg = Document::parse(&text).unwrap();
        let ends = drawn(&svg, "label ink ours").len() + drawn(&svg, "label ink paper").len();
        assert_eq!(ends, at_the_ends);
        for name in ["ours", "literal paper", "median to worst seed"] {
            let named = svg.descendants().filter(|node| node.is_text() && node.text() == Some(name)).count();
            assert_eq!(named, 1, "{name}, {width:?}");
        }
    }
}

#[test]
fn a_staircase_reaches_the_whole() {
    let steps = cumulative(&errors(), 1e-6);
    assert_eq!(steps.len(), 2 * errors().len());
    assert_eq!(steps.last().unwrap().1, 100.0);
    assert!(steps.windows(2).all(|pair| pair[0].0 <= pair[1].0 && pair[0].1 <= pair[1].1));
}

proptest! {
    #[test]
    fn whatever_the_values_are_the_drawing_is_well_formed(
        points in prop::collection::vec((any::<f64>(), any::<f64>()), 0..40),
        logarithmic in any::<bool>(),
        label in any::<String>(),
    ) {
        let axis = |title: &str| if logarithmic { Axis::logarithmic(title, "") } else { Axis::linear(title, "") };
        let mut chart = Chart::new(label.clone(), axis(&label), axis("y"));
        chart.description = label.clone();
        chart.layers = vec![
            Layer::Line { series: Series::new(label.clone(), points.clone()), tone: Tone::Ours, marked: true },
            Layer::Rug { name: label.clone(), at: points.iter().map(|point| point.0).collect(), tone: Tone::Alarm },
            Layer::Band { name: label, edges: points.iter().map(|p| (p.0, p.1, p.0)).collect(), tone: Tone::Calm },
        ];
        for width in [Width::Wide, Width::Narrow] {
            let text = chart.draw("any", width);
            let svg = Document::parse(&text).unwrap();
            for data in svg.descendants().filter_map(|node| node.attribute("d")) {
                prop_assert!(!data.contains("NaN") && !data.contains("inf"), "{}", data);
            }
        }
    }
}
