//! A few hundred drives, those that were kept, and that the checker finds what is wrong: all in about a minute.

use std::path::Path;

use holdover_adversary::family;
use holdover_adversary::run::{Plan, run};
use holdover_adversary::scenario::{Family, Scenario};
use holdover_adversary::shrink::shrink;
use holdover_adversary::verdict::{Fault, Outcome};
use holdover_adversary::world;

fn plan(drives: u64, families: &[Family]) -> Plan {
    Plan { first: 0, drives, seed: 15, families: families.to_vec(), breaks: false, envelope: true }
}

fn run_on(threads: usize, plan: &Plan) -> holdover_adversary::run::Report {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| run(plan, &|_| {}))
}

#[test]
fn nothing_is_violated_in_random_drives_that_keep_every_assumption() {
    let report = run_on(0, &plan(600, &Family::ALL));
    let found: Vec<String> = report
        .violations
        .iter()
        .flat_map(|violation| {
            let family = violation.scenario.family.name();
            let findings = violation.outcome.findings.iter();
            findings.map(move |found| {
                format!(
                    "{family} drive {} at {:.2} s, {}: {}",
                    violation.drive,
                    found.at,
                    found.fault.name(),
                    found.text
                )
            })
        })
        .collect();
    assert!(report.checked > 1_000_000, "the bound was checked in {} ticks only", report.checked);
    assert!(found.is_empty(), "{} violations:\n{}\n{}", found.len(), found.join("\n"), report.summary());
}

#[test]
fn nothing_is_violated_any_more_in_the_drives_that_were_kept() {
    let mut found = Vec::new();
    let kept = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios");
    let mut files: Vec<_> = std::fs::read_dir(kept).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    for file in files.iter().filter(|file| file.extension().is_some_and(|extension| extension == "toml")) {
        let scenario = Scenario::from_text(&std::fs::read_to_string(file).unwrap()).unwrap();
        for finding in world::run(&scenario).findings {
            let name = file.file_name().unwrap().to_string_lossy().into_owned();
            found.push(format!("{name} at {:.2} s, {}: {}", finding.at, finding.fault.name(), finding.text));
        }
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn without_the_envelope_collisions_are_found() {
    let plan = Plan { envelope: false, ..plan(60, &[Family::Lorry, Family::Stranger]) };
    let report = run_on(0, &plan);
    let collisions = report.violations.iter().filter(|violation| violation.outcome.of(Fault::Collision).is_some());
    assert!(collisions.count() >= 10);
}

#[test]
fn a_truth_that_is_a_metre_off_is_found_in_every_drive_that_is_certain_of_less() {
    for seed in 0..20 {
        let mut scenario = family::draw(Family::Following, seed);
        scenario.shifted = 1.0;
        (scenario.event, scenario.length, scenario.radio.loss) = (Vec::new(), 10.0, 0.0);
        scenario.peer[0].sensor.position = 0.05;
        scenario.bus.loss = 0.0;
        assert!(world::run(&scenario).of(Fault::Bound).is_some(), "{seed}");
    }
}

#[test]
fn the_same_is_found_on_one_thread_and_on_many() {
    let found = |threads| {
        let report = run_on(threads, &Plan { breaks: true, ..plan(68, &Family::ALL) });
        format!("{:?} {} {}", report.violations, report.summary(), report.table())
    };
    let one = found(1);
    assert_eq!(one, found(2));
    assert_eq!(one, found(24));
}

#[test]
fn a_drive_reads_as_it_was_written() {
    for (seed, family) in Family::ALL.into_iter().enumerate() {
        let scenario = family::draw(family, seed as u64);
        assert_eq!(Scenario::from_text(&scenario.to_text()).unwrap(), scenario);
    }
}

#[test]
fn a_smaller_drive_still_shows_the_fault() {
    let mut scenario = family::draw(Family::Lorry, 3);
    scenario.shifted = 1.0;
    let smaller = shrink(&scenario, Fault::Bound);
    assert!(world::run(&smaller).of(Fault::Bound).is_some());
    assert!(smaller.event.len() <= 1 && smaller.length < scenario.length, "{}", smaller.to_text());
}

#[test]
fn a_broken_assumption_is_not_a_violation_but_counted() {
    let report = run_on(0, &Plan { breaks: true, ..plan(68, &[Family::Following, Family::Lorry]) });
    assert_eq!(report.broken.values().map(|row| row.drives).sum::<u64>(), 34);
    assert!(report.violations.iter().all(|violation| violation.scenario.broken.is_none()));
    let Outcome { ticks, .. } = world::run(&family::draw(Family::Lorry, 1));
    assert!(ticks > 100);
}
