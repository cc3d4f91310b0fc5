//! The page of a sweep: well-formed, and its plot shows the rows.

use holdover_sim::report::run::Verdict;
use holdover_sim::report::sweep::{SweepReport, SweepRow};
use roxmltree::{Document, Node, ParsingOptions};

fn row(step_s: f64, error_m: f64) -> SweepRow {
    let (ours, paper) = (Some(error_m), Some(100.0 * error_m));
    let (rms, rms_intervals, less_rms) =
        ([ours, paper], [ours, paper].map(|rms| rms.map(|rms| [rms / 2.0, rms * 2.0])), Some("holdover"));
    let ns_per_tick = 250.0 / step_s;
    SweepRow {
        step_s,
        max_ours: ours,
        p99_ours: ours,
        max_paper: paper,
        p99_paper: paper,
        rms,
        rms_intervals,
        less_rms,
        ns_per_tick,
    }
}

fn report(rows: Vec<SweepRow>) -> SweepReport {
    SweepReport {
        title: "Steps & <more>".into(),
        facts: vec![("runs".into(), "3".into())],
        verdict: Verdict { passed: true, reasons: vec!["All well.".into()] },
        command: "holdover-sim sweep --seeds 1".into(),
        rows,
    }
}

fn parse(page: &str) -> Document<'_> {
    Document::parse_with_options(page, ParsingOptions { allow_dtd: true, ..Default::default() }).unwrap()
}

/// The dots of a path, as `(x, y)`.
fn dots(svg: Node, class: &str) -> Vec<(f64, f64)> {
    let paths = svg.descendants().filter(|node| node.attribute("class") == Some(class));
    let pair = |dot: &str| {
        let dot = dot.split('h').next()?;
        let (x, y) = dot.split_once([',', ' '])?;
        Some((x.parse().ok()?, y.parse().ok()?))
    };
    paths.flat_map(|path| path.attribute("d").unwrap().split('M').filter_map(pair).collect::<Vec<_>>()).collect()
}

#[test]
fn the_page_is_well_formed_and_loads_nothing() {
    let page = report(vec![row(0.01, 0.01), row(0.1, 0.02), row(1.0, 0.2)]).render();
    parse(&page);
    assert!(!page.contains("src=") && !page.contains("href=\"http"));
    assert!(page.contains("Steps &amp; &lt;more&gt;") && page.contains("5.80"));
    assert_eq!(page, report(vec![row(1.0, 0.2), row(0.01, 0.01), row(0.1, 0.02)]).render());
}

#[test]
fn a_power_law_is_a_straight_line_on_the_axes() {
    let page = report(vec![row(0.01, 0.01), row(0.1, 0.1), row(1.0, 1.0)]).render();
    let document = parse(&page);
    let svg = document.descendants().find(|node| node.tag_name().name() == "svg").unwrap();
    for class in ["dots big ours", "dots big paper"] {
        let dots = dots(svg, class);
        assert_eq!(dots.len(), 3, "{class}");
        let [a, b, c] = dots[..] else { unreachable!() };
        assert!((b.0 - a.0 - (c.0 - b.0)).abs() < 0.2 && (b.1 - a.1 - (c.1 - b.1)).abs() < 0.2, "{dots:?}");
        assert!(c.0 > a.0 && c.1 < a.1, "up is less in SVG: {dots:?}");
    }
    assert_eq!(dots(svg, "dots big o1").len(), 2, "the two that the paper reports");
}

#[test]
fn without_any_estimate_the_page_says_so() {
    let row = SweepRow { max_ours: None, p99_ours: None, max_paper: None, p99_paper: None, ..row(0.1, 1.0) };
    let page = report(vec![row]).render();
    parse(&page);
    assert!(page.contains("There is nothing to show"));
}
