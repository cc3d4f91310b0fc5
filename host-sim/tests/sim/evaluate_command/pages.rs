//! The report and the table.

use super::bench::Bench;

fn bench() -> Bench {
    let bench = Bench::new();
    for name in ["a.csv", "b<&>.csv"] {
        bench.drive(name, (0..=200).map(|n| (n as f64 / 20.0, n as f64 / 2.0, 10.0 + (n as f64 / 20.0).sin())));
    }
    let silent = |n: usize| (60..90).contains(&n);
    bench.link("c.csv", (0..=180).map(|n| (n as f64 / 18.0, (!silent(n)).then_some(0.02))));
    bench
}

fn page(bench: &Bench, arguments: &str) -> String {
    let output = bench.run(&format!("{arguments} --out report"));
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(String::from_utf8_lossy(&output.stderr).contains("report: report/index.html"));
    std::fs::read_to_string(bench.file("report/index.html")).unwrap()
}

/// The number of figures on a page that is well-formed, complete in itself and free of repeated ids.
fn figures(page: &str) -> usize {
    let parsed = roxmltree::Document::parse_with_options(
        page,
        roxmltree::ParsingOptions { allow_dtd: true, ..roxmltree::ParsingOptions::default() },
    );
    let document = parsed.unwrap();
    let mut ids: Vec<&str> = document.descendants().filter_map(|node| node.attribute("id")).collect();
    let all = ids.len();
    ids.sort_unstable();
    ids.dedup();
    assert_eq!(ids.len(), all);
    for node in document.descendants() {
        assert!(!["link", "img", "iframe"].contains(&node.tag_name().name()));
        assert!(node.attribute("src").is_none() && node.attribute("href").is_none_or(|link| link.starts_with('#')));
    }
    document
        .descendants()
        .filter(|node| node.has_tag_name((node.tag_name().namespace().unwrap_or(""), "figure")))
        .count()
}

#[test]
fn the_report_over_a_link_shows_classes_each_drive_the_distribution_and_the_link() {
    let bench = bench();
    let page = page(&bench, "--motion a.csv b<&>.csv --channel c.csv");
    assert_eq!(figures(&page), 5);
    for words in
        ["2 recorded drives over c", "by age of the newest sample", "The longest silence lasted", "literal paper"]
    {
        assert!(page.contains(words), "{words}");
    }
    assert!(page.contains("b&lt;&amp;&gt;") && !page.contains("b<&>"));
}

#[test]
fn the_report_of_silences_shows_classes_each_drive_and_the_distribution() {
    let page = page(&bench(), "--motion a.csv --outage 0.5,1,3");
    assert_eq!(figures(&page), 3);
    for words in ["a in silence", "After 1 s without a message", "by length of the silence"] {
        assert!(page.contains(words), "{words}");
    }
}

#[test]
fn a_report_of_nothing_is_a_page_that_says_why_and_fails() {
    let bench = bench();
    bench.link("deaf.csv", [(0.0, None), (9.0, None)]);
    let output = bench.run("--motion a.csv --channel deaf.csv --out report");
    assert_eq!(output.status.code(), Some(1), "{}", String::from_utf8_lossy(&output.stderr));
    let page = std::fs::read_to_string(bench.file("report/index.html")).unwrap();
    assert!(page.contains("<b>Failed</b><p>no message of a.csv arrives over deaf.csv</p>"));
    assert!(page.contains("Nothing could be compared"));
    assert_eq!(figures(&page), 4);
}

#[test]
fn the_table_names_every_method_and_class() {
    let bench = bench();
    let text = |arguments: &str| String::from_utf8(bench.run(arguments).stdout).unwrap();
    let link = text("--motion a.csv --channel c.csv --no-report");
    let silence = text("--motion a.csv b<&>.csv --outage 0.5,2 --no-report");
    for name in [
        "holdover",
        "freeze",
        "constant speed",
        "constant acceleration",
        "Singer's model",
        "Kalman filter",
        "literal paper",
    ] {
        assert!(link.contains(name) && silence.contains(name), "{name}");
    }
    assert!(link.contains("0.1–0.5 s") && link.contains("181 messages sent, 151 delivered"), "{link}");
    assert!(silence.contains("holdover / best baseline, recording by recording"), "{silence}");
}

#[test]
fn what_the_unit_refused_is_named() {
    let bench = Bench::new();
    bench.drive("m.csv", (0..=20).map(|n| (n as f64 / 5.0, 2.0 * n as f64, 10.0)));
    bench.link("once.csv", (0..=20).map(|n| (n as f64 / 5.0, Some(0.0))));
    bench.link("twice.csv", (0..=40).map(|n| (n as f64 / 10.0, Some(0.0))));
    let text = |channel: &str| {
        String::from_utf8(bench.run(&format!("--motion m.csv --channel {channel} --no-report")).stdout).unwrap()
    };
    assert!(!text("once.csv").contains("refused"));
    assert!(text("twice.csv").contains("refused by the unit: duplicate 20\n"));
}

#[test]
fn help_has_examples_and_says_what_counts() {
    let help = String::from_utf8(bench().run("--help").stdout).unwrap();
    for words in ["Examples:", "--outage 0.5,1,2,4", "--predecessor", "Exit codes:"] {
        assert!(help.contains(words), "{words}");
    }
}
