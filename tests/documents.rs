//! The documents: every link between them leads to a file and a heading that are there, and the two that are read first stay
//! short. What they state of the bus is what the catalogue makes of it.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use holdover::wire::Identifiers;
use holdover::wire::catalogue::Line;
use holdover::wire::load::load_ppm;

/// All Markdown files below a folder.
fn markdown_in(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if path.is_dir() && name != "target" && !name.starts_with('.') {
            markdown_in(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "md") {
            found.push(path);
        }
    }
}

/// The lines that are not code.
fn prose(text: &str) -> impl Iterator<Item = &str> {
    let mut is_code = false;
    text.lines().filter(move |line| {
        let is_fence = line.trim_start().starts_with("```");
        is_code ^= is_fence;
        !is_code && !is_fence
    })
}

/// The anchor that a heading gets on a page: its words in lower case, joined by hyphens.
fn anchor(heading: &str) -> String {
    let kept = |letter: &char| letter.is_alphanumeric() || matches!(letter, ' ' | '-' | '_');
    heading.trim_start_matches('#').trim().to_lowercase().chars().filter(kept).collect::<String>().replace(' ', "-")
}

/// What `[text](target)` leads to, in a line.
fn targets(line: &str) -> impl Iterator<Item = &str> {
    line.split("](").skip(1).filter_map(|rest| rest.split_once(')')).map(|(target, _)| target)
}

#[test]
fn every_link_between_the_documents_leads_to_a_file_and_a_heading() {
    let mut files = Vec::new();
    markdown_in(Path::new(env!("CARGO_MANIFEST_DIR")), &mut files);
    let texts: BTreeMap<PathBuf, String> =
        files.into_iter().map(|path| (path.canonicalize().unwrap(), fs::read_to_string(&path).unwrap())).collect();
    let mut broken = Vec::new();
    for (page, text) in &texts {
        for target in prose(text).flat_map(targets).filter(|target| !target.contains("://")) {
            let (file, heading) =
                target.split_once('#').map_or((target, None), |(file, heading)| (file, Some(heading)));
            let file = if file.is_empty() { page.clone() } else { page.parent().unwrap().join(file) };
            let is_heading = |heading: &str| {
                let text = texts.get(&file.canonicalize().unwrap_or_default());
                text.is_some_and(|text| prose(text).any(|line| line.starts_with('#') && anchor(line) == heading))
            };
            if !file.exists() || heading.is_some_and(|heading| !is_heading(heading)) {
                broken.push(format!("{}: {target}", page.display()));
            }
        }
    }
    assert!(texts.len() > 10 && broken.is_empty(), "{broken:#?}");
}

#[test]
fn the_two_documents_that_are_read_first_have_at_most_two_hundred_lines() {
    for name in ["README.md", "ARCHITECTURE.md"] {
        let lines = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(name)).unwrap().lines().count();
        assert!(lines <= 200, "{name}: {lines} lines");
    }
}

#[test]
fn the_load_of_the_bus_is_the_one_that_the_catalogue_makes() {
    let page = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/CAN.md")).unwrap();
    let page = page.split_whitespace().collect::<Vec<_>>().join(" ");
    let percent =
        |counted: fn(&Line) -> bool| f64::from(load_ppm(500_000, 8, &Identifiers::DEFAULT, counted)) / 10_000.0;
    let (all, peers) = (percent(|_| true), percent(Line::is_per_slot));
    let stated = format!("at most {all:.1} % of the bus, the peers' messages {peers:.1} %");
    assert!(page.contains(&stated), "docs/CAN.md does not say: {stated}");
}

#[cfg(feature = "fd")]
#[test]
fn the_loads_of_both_buses_are_those_that_the_catalogue_makes() {
    use holdover::wire::load::fd;
    let page = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/CAN.md")).unwrap();
    let percent = |ppm: u32| format!("{:.1} %", f64::from(ppm) / 10_000.0);
    for peers in [1, 4, 8, 16] {
        let classic = load_ppm(500_000, peers, &Identifiers::DEFAULT, |_| true);
        let over_fd = fd::load_ppm((500_000, 2_000_000), peers, &Identifiers::DEFAULT, |_| true);
        let stated = format!("| {peers} | {} | {} |", percent(classic), percent(over_fd));
        assert!(page.contains(&stated), "docs/CAN.md does not say: {stated}");
    }
}

#[test]
fn the_timing_contract_has_the_counts_of_the_emulator() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let page = fs::read_to_string(root.join("docs/INTEGRATION.md")).unwrap();
    let counts = fs::read_to_string(root.join("tests/embedded/cost.csv")).unwrap();
    let most = |drives: &[&str], row: &str| {
        let of = |drive: &&str| {
            let name = format!("{drive}-{row},8,359,");
            counts.lines().find_map(|line| line.strip_prefix(&name)?.parse::<u32>().ok()).expect(&name)
        };
        drives.iter().map(of).max().unwrap()
    };
    let (without_map, all) = (["bare", "envelope", "sensor", "terse"], ["bare", "both", "sensor", "terse", "all"]);
    let (worst, frame) = (most(&all, "worst"), most(&all, "receive"));
    for count in [
        worst,
        most(&without_map, "worst"),
        most(&without_map, "quiet"),
        most(&all, "quiet"),
        frame,
        most(&all, "bus"),
        40 * frame,
        worst + 40 * frame,
    ] {
        // Two cycles for an instruction, at 168 MHz.
        let (thousands, milliseconds) =
            (format!("{},{:03}", count / 1_000, count % 1_000), f64::from(count) * 2.0 / 168e3);
        let times = [format!("{milliseconds:.1} ms"), format!("{milliseconds:.2} ms")];
        let has = |line: &str| times.iter().any(|time| line.ends_with(&format!("| {thousands} | {time} |")));
        assert!(page.lines().any(has), "{thousands} {times:?}");
    }
}
