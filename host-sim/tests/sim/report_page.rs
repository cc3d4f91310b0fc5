//! Facts about the page of a run, on a synthetic run: well-formed, self-contained, escaped, deterministic, small.

use std::collections::HashSet;

use holdover_sim::report::{
    RunReport,
    plot::{Interval, Series},
    run::{BoundSample, Drive, Limit, ModeTrack, SummaryRow, Verdict},
};
use roxmltree::{Document, ParsingOptions};

/// A number in [-1, 1) that looks random and depends on `seed` alone.
fn noise(seed: u64) -> f64 {
    let mut word = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15);
    word = (word ^ (word >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    ((word ^ (word >> 27)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

fn name(vehicle: usize) -> String {
    match vehicle {
        0 => "0 leader".into(),
        2 => "2 ego".into(),
        other => other.to_string(),
    }
}

/// Five vehicles for `seconds` at 100 Hz, with a silence of the ego's link from 4 s to 8 s.
fn five_vehicles(seconds: u32) -> RunReport {
    let ticks = || (0..=seconds * 100).map(|k| f64::from(k) * 0.01);
    let silent = |t: f64| (4.0..8.0).contains(&t);
    let speed = |n: usize, t: f64| 11.0 - (2.2 - 0.5 * n as f64) * (-t / 3.5).exp() + 0.3 * (0.5 * t - n as f64).sin();
    let gap = |n: usize, t: f64| {
        13.0 + 0.5 * n as f64 + (4.0 - n as f64) * (-t / 4.0).exp() + 0.4 * (0.5 * t - n as f64).cos()
    };
    let position = |n: usize, t: f64| 11.0 * t - 19.0 * n as f64 - (1..=n).map(|k| gap(k, t) - 13.0).sum::<f64>();
    let wander = |t: f64| 0.006 * (3.0 * t).sin() + 0.002 * noise((t * 100.0) as u64);
    let ours = |t: f64| if silent(t) { 0.006 * (t - 4.0) } else { wander(t) };
    let paper = |t: f64| if silent(t) { -0.3 * (t - 4.0) + 0.2 } else { 0.35 * noise((t * 10.0) as u64) };
    let channel = (0..seconds * 10).map(|k| {
        let t = f64::from(k) * 0.1;
        let lost = silent(t) || noise(u64::from(k) + 77) > 0.8;
        (t, (!lost).then(|| (0.04 + 0.04 * noise(u64::from(k) + 5)).max(0.0)))
    });
    let bound = |t: f64| {
        let age_s = if silent(t) { t - 4.0 } else { 0.1 };
        let reach_m = |limit: f64| 0.1 + 0.5 * limit * age_s * age_s;
        BoundSample { at_s: t, lowest_m: -reach_m(8.0), truth_m: -ours(t), highest_m: reach_m(2.5) }
    };
    let command = |t: f64| if (5.0..7.0).contains(&t) { -6.5 } else { 0.4 * (0.7 * t).sin() };
    let modes = |n: usize| ModeTrack {
        vehicle: name(n),
        changes: ticks()
            .map(|t| {
                (
                    t,
                    if t < 0.3 {
                        "standby"
                    } else if n == 3 && silent(t - 0.2) {
                        "holdover"
                    } else {
                        "cooperative"
                    }
                    .into(),
                )
            })
            .collect(),
    };
    RunReport {
        crashes: None,
        title: "The paper’s scenario: five vehicles, four seconds of silence".into(),
        facts: [
            ("Seed", "1"),
            ("Prediction step", "0.01 s"),
            ("Duration", "20 s"),
            ("Vehicles", "5, the ego is number 2"),
            ("Messages", "10 Hz"),
            ("Delay", "Normal(40 ms, 25.9 ms), cut at 0"),
            ("Random loss", "10 %"),
            ("Silence", "4–8 s"),
        ]
        .map(|(name, value)| (name.into(), value.into()))
        .to_vec(),
        verdict: Verdict {
            passed: true,
            reasons: vec!["No collision, no full stop; the largest position error is 0.024 m.".into()],
        },
        command: "holdover-sim run scenarios/paper.toml --seed 1 --out report".into(),
        summary: [
            ("Largest position error", 0.024, Some(1.0), "m", Some(Limit::AtMost(0.025))),
            ("99th percentile of the position error", 0.0231, Some(0.96), "m", None),
            ("Root mean square of the position error", 0.00812, Some(0.41), "m", None),
            ("Smallest gap", 11.63, None, "m", Some(Limit::AtLeast(2.0))),
            ("Lowest speed", 8.8, None, "m/s", None),
            ("Full stops", 0.0, None, "", Some(Limit::AtMost(0.0))),
            ("Collisions", 0.0, None, "", Some(Limit::AtMost(0.0))),
        ]
        .map(|(metric, ours, paper, unit, limit)| SummaryRow {
            metric: metric.into(),
            ours: Some(ours),
            paper,
            unit: unit.into(),
            limit,
        })
        .to_vec(),
        trajectories: (0..5).map(|n| Series::new(name(n), ticks().map(|t| (t, position(n, t))))).collect(),
        ego: 2,
        error_ours: Series::new("ours", ticks().map(|t| (t, ours(t)))),
        error_paper: Series::new("literal paper", ticks().map(|t| (t, paper(t)))),
        silences: vec![Interval::new(4.0, 8.0, "silence")],
        channel: channel.collect(),
        speeds: (0..5).map(|n| Series::new(name(n), ticks().map(|t| (t, speed(n, t))))).collect(),
        gaps: (1..5).map(|n| Series::new(name(n), ticks().map(|t| (t, gap(n, t))))).collect(),
        modes: (0..5).map(modes).collect(),
        refusals: vec![("stale stamp".into(), 3), ("wrong CRC".into(), 0), ("duplicate".into(), 1204)],
        notes: vec!["Errors count from 1 s on.".into()],
        bound: ticks().map(bound).collect(),
        drive: Drive {
            vehicle: name(3),
            engaged: true,
            command: Series::new("commanded", ticks().map(|t| (t, command(t)))),
            reached: Series::new("reached", ticks().map(|t| (t, command(t - 0.3)))),
            limited_s: ticks().filter(|t| (5.0..7.0).contains(t)).collect(),
        },
    }
}

/// Parses the page as XML and checks what holds for every page.
fn check(html: &str) -> Vec<String> {
    let document =
        Document::parse_with_options(html, ParsingOptions { allow_dtd: true, ..Default::default() }).unwrap();
    let elements = || document.descendants().filter(|node| node.is_element());
    let mut ids = HashSet::new();
    for id in elements().filter_map(|element| element.attribute("id")) {
        assert!(ids.insert(id), "id {id} stands twice");
    }
    for figure in elements().filter(|element| element.tag_name().name() == "svg") {
        for (reference, tag) in [("aria-labelledby", "title"), ("aria-describedby", "desc")] {
            let id = figure.attribute(reference).unwrap();
            let named = figure.children().find(|child| child.attribute("id") == Some(id)).unwrap();
            assert_eq!(named.tag_name().name(), tag);
            assert!(!named.text().unwrap_or_default().is_empty(), "{id} is empty");
        }
    }
    for element in elements() {
        let name = element.tag_name().name();
        assert!(!["link", "img", "iframe", "object", "foreignObject", "image", "use"].contains(&name), "<{name}>");
        for attribute in element.attributes() {
            let is_inside = attribute.name() == "href" && attribute.value().starts_with('#');
            assert!(is_inside || !["href", "src", "style"].contains(&attribute.name()), "{name} {}", attribute.name());
            assert!(!attribute.name().starts_with("on"), "{name} {}", attribute.name());
        }
        if let Some(data) = element.attribute("d") {
            assert!(!data.contains("NaN") && !data.contains("inf") && !data.is_empty(), "{data}");
        }
    }
    let scripts: Vec<_> = elements().filter(|element| element.tag_name().name() == "script").collect();
    let script = scripts.first().and_then(|script| script.text()).unwrap_or_default();
    assert!(scripts.len() == 1 && !["fetch", "import", "Worker"].iter().any(|word| script.contains(word)));
    let style = elements().find(|element| element.tag_name().name() == "style").and_then(|style| style.text()).unwrap();
    assert!(!style.contains("url(") && !style.contains("@import"));
    document.descendants().filter_map(|node| node.text().map(String::from)).collect()
}

/// The caption of the figure whose title contains `title`.
fn caption(html: &str, title: &str) -> String {
    let start = html.find(&format!(". {title}.</span>")).unwrap();
    html[start..].split("</figcaption>").next().unwrap().to_string()
}

#[test]
fn a_run_of_five_vehicles_makes_one_small_well_formed_page() {
    let html = five_vehicles(20).render();
    check(&html);
    assert!(html.len() < 3_000_000, "{} bytes", html.len());
    // Left where a browser can open it: target/tmp/report.html.
    std::fs::write(concat!(env!("CARGO_TARGET_TMPDIR"), "/report.html"), &html).unwrap();
    assert_eq!(html.matches("<li><a href=\"#section-").count(), html.matches("<h2 id=").count());
    let sections: Vec<&str> = html.split("<h2 ").skip(1).collect();
    assert!(sections[0].contains("Position error of the estimate"), "the picture that matters comes first");
    assert_eq!(html.matches("<figure ").count(), 9);
    assert_eq!(html.matches("<svg ").count(), 3 * 11, "nine figures, two with two panels, at three widths");
}

#[test]
fn ten_minutes_are_still_a_small_page() {
    let html = five_vehicles(600).render();
    check(&html);
    assert!(html.len() < 3_000_000, "{} bytes", html.len());
}

#[test]
fn the_same_run_is_the_same_bytes() {
    assert!(five_vehicles(20).render() == five_vehicles(20).render());
}

#[test]
fn captions_say_what_the_series_hold() {
    let html = five_vehicles(20).render();
    let error = caption(&html, "Position error of the estimate");
    assert!(error.contains("by 23.9\u{a0}mm at the most") && error.contains("by 0.997\u{a0}m, 42 times"), "{error}");
    assert!(error.contains("The lower panel shows ours alone") && error.contains("silent, 4–8 s"), "{error}");
    let channel = caption(&html, "The ego’s link");
    assert!(channel.contains("Of 200 messages"), "{channel}");
    let bound = caption(&html, "What is certain of the position");
    assert!(bound.contains("Its width is 0.253\u{a0}m in the median and 83.8\u{a0}m at the most"), "{bound}");
    assert!(bound.contains("inside at every one of 2,001 ticks") && bound.contains("enlarged and cut off"), "{bound}");
    let drive = caption(&html, "Command and acceleration");
    assert!(drive.contains("brakes with 6.50\u{a0}m/s² (at 5 s)"), "{drive}");
    assert!(drive.contains("The envelope limits that for 10.0\u{a0}% of the time"), "{drive}");
    let modes = caption(&html, "Modes");
    assert!(
        modes
            .contains("In this run the ego spends 0.300\u{a0}s in standby, 19.7\u{a0}s in cooperative, changing once."),
        "{modes}"
    );
}

#[test]
fn a_truth_outside_its_bound_is_counted_and_a_gap_in_the_bound_is_no_band() {
    let mut report = five_vehicles(20);
    report.bound[500].truth_m = report.bound[500].highest_m + 0.001;
    report.bound.drain(1000..1100);
    let html = report.render();
    check(&html);
    let bound = caption(&html, "What is certain of the position");
    assert!(bound.contains("is outside at 1 of 1,901 ticks"), "{bound}");
    assert_eq!(html.matches("class=\"band ours\" d=").count(), 2 * 2 * 3, "two bands, two panels, three widths");
}

#[test]
fn a_missed_limit_shows_and_not_a_number_misses_every_limit() {
    let mut report = five_vehicles(2);
    assert!(!report.render().contains("missed<"));
    for value in [0.0251, f64::NAN, f64::INFINITY] {
        report.summary[0].ours = Some(value);
        assert_eq!(report.render().matches("0.0250, missed<").count(), 1, "{value}");
    }
    report.summary[0].ours = Some(0.025);
    assert!(report.render().contains("0.0250, met<"));
    report.summary[0].ours = None;
    assert!(report.render().contains("missed<"), "a limit on nothing is not met");
}

#[test]
fn text_from_outside_stays_text() {
    let nasty = "</svg></title></style><script>alert(\"1\")</script>&amp; ' \u{0} \u{1b}";
    let mut report = five_vehicles(2);
    report.title = nasty.into();
    report.facts.push((nasty.into(), nasty.into()));
    report.verdict.reasons = vec![nasty.into(), nasty.into()];
    report.command = nasty.into();
    report.summary[0].metric = nasty.into();
    report.summary[0].unit = nasty.into();
    for series in report.trajectories.iter_mut().chain(&mut report.speeds).chain(&mut report.gaps) {
        series.name.push_str(nasty);
    }
    report.error_ours.name = nasty.into();
    report.silences[0].label = nasty.into();
    report.drive.vehicle = nasty.into();
    report.modes[0].vehicle = nasty.into();
    report.modes[0].changes[0].1 = nasty.into();
    report.refusals[0].0 = nasty.into();
    report.notes = vec![nasty.into()];
    let html = report.render();
    let texts = check(&html);
    assert_eq!(html.matches("<script").count(), 1, "that of the page");
    let spelled = nasty.replace(['\u{0}', '\u{1b}'], "\u{FFFD}");
    assert!(texts.iter().filter(|text| text.contains(&spelled)).count() >= 10);
}

#[test]
fn an_empty_report_is_a_page_that_says_so() {
    let html = RunReport::default().render();
    check(&html);
    assert_eq!(html.matches("no data</text>").count(), 3 * 9);
    assert!(html.contains("There is nothing to show") && html.contains("No frame was refused."));
    let one_point = RunReport { error_ours: Series::new("ours", [(0.0, 0.0)]), ..Default::default() };
    check(&one_point.render());
}

#[test]
fn values_that_are_not_finite_are_left_out_and_counted() {
    let mut report = five_vehicles(20);
    report.error_ours.points[300].1 = f64::NAN;
    report.error_ours.points[301].1 = f64::INFINITY;
    report.gaps[0].points[10].0 = f64::NAN;
    report.channel[3] = (f64::NAN, None);
    let html = report.render();
    check(&html);
    assert!(caption(&html, "Position error of the estimate").contains("4 values are not drawn"), "two in each panel");
    assert!(caption(&html, "Gap to the vehicle ahead").contains("One value is not drawn"));
    assert!(caption(&html, "The ego’s link").contains("One value is not drawn"));
    assert!(!caption(&html, "Speed").contains("not drawn"));
}

#[test]
fn refusals_stand_in_order_of_their_number() {
    let html = five_vehicles(2).render();
    let (often, seldom) = (html.find("duplicate</th>").unwrap(), html.find("stale stamp</th>").unwrap());
    assert!(often < seldom);
    assert!(html.contains("1,204") && !html.contains("wrong CRC"));
}
