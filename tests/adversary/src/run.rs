//! Many drives: a seed and a number enter; the findings leave. They do not depend on the number of threads.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;

use crate::broken::Assumption;
use crate::family;
use crate::random::{Random, mix};
use crate::scenario::{Family, Scenario};
use crate::verdict::{Fault, Outcome};
use crate::world;

/// The drives to run.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Number of the first drive, and how many drives.
    pub first: u64,
    pub drives: u64,
    /// Seed of all drives.
    pub seed: u64,
    /// The families to draw from.
    pub families: Vec<Family>,
    /// Whether every second drive breaks an assumption; otherwise all drives keep all assumptions.
    pub breaks: bool,
    /// Whether the envelope is engaged.
    pub envelope: bool,
}

/// A drive that keeps all assumptions, and in which a fault was found nevertheless.
#[derive(Clone, Debug)]
pub struct Violation {
    /// Number of the drive.
    pub drive: u64,
    /// The scenario.
    pub scenario: Scenario,
    /// The outcome.
    pub outcome: Outcome,
}

/// Counts of one row of the table.
#[derive(Clone, Copy, Debug, Default)]
pub struct Row {
    pub drives: u64,
    pub collisions: u64,
    pub hardest: f64,
    pub impacts: f64,
    pub outside: u64,
    pub refused: u64,
    pub stuck: u64,
}

/// The findings of all drives.
#[derive(Clone, Debug, Default)]
pub struct Report {
    /// Number of drives that keep all assumptions, by family.
    pub kept: BTreeMap<usize, u64>,
    /// Violations in the order of the drives.
    pub violations: Vec<Violation>,
    /// Counts by broken assumption.
    pub broken: BTreeMap<Assumption, Row>,
    /// Ticks, and those whose bound was checked, of drives that keep all assumptions.
    pub ticks: u64,
    pub checked: u64,
}

/// The scenario of the drive with this number.
pub fn scenario(plan: &Plan, drive: u64) -> Scenario {
    let seed = mix(plan.seed ^ mix(drive)) >> 1;
    let is_broken = plan.breaks && drive % 2 == 1;
    let turn = if plan.breaks { drive / 2 } else { drive };
    let families = &plan.families;
    let mut scenario = if is_broken {
        let assumption = Assumption::ALL[(turn % Assumption::ALL.len() as u64) as usize];
        let family = assumption.family(families, turn / Assumption::ALL.len() as u64);
        let mut scenario = family::draw(family, seed);
        assumption.apply(&mut scenario, &mut Random::new(seed, 7));
        scenario
    } else {
        family::draw(families[(turn % families.len() as u64) as usize], seed)
    };
    scenario.ego.envelope = plan.envelope;
    scenario
}

/// Runs the drives. `tell` is called with the number of drives that are done.
pub fn run(plan: &Plan, tell: &(impl Fn(u64) + Sync)) -> Report {
    let done = AtomicU64::new(0);
    let outcomes: Vec<_> = (plan.first..plan.first + plan.drives)
        .into_par_iter()
        .map(|drive| {
            let outcome = one(plan, drive);
            tell(done.fetch_add(1, Ordering::Relaxed) + 1);
            outcome
        })
        .collect();
    let mut report = Report::default();
    for (drive, (family, broken, outcome)) in (plan.first..).zip(outcomes) {
        if let Some(assumption) = broken {
            report.broken.entry(assumption).or_default().add(&outcome);
            continue;
        }
        *report.kept.entry(family as usize).or_default() += 1;
        report.ticks += outcome.ticks;
        report.checked += outcome.checked;
        if !outcome.findings.is_empty() {
            report.violations.push(Violation { drive, scenario: scenario(plan, drive), outcome });
        }
    }
    report
}

#[inline(never)] // a drive's stack must not be part of every split's
fn one(plan: &Plan, drive: u64) -> (Family, Option<Assumption>, Outcome) {
    let scenario = scenario(plan, drive);
    (scenario.family, scenario.broken, world::run(&scenario))
}

impl Row {
    fn add(&mut self, outcome: &Outcome) {
        self.drives += 1;
        if let Some(collision) = outcome.of(Fault::Collision) {
            self.collisions += 1;
            self.impacts += collision.amount;
            self.hardest = self.hardest.max(collision.amount);
        }
        self.outside += u64::from(outcome.of(Fault::Bound).is_some());
        self.refused += u64::from(outcome.of(Fault::Refused).is_some());
        self.stuck += u64::from(outcome.of(Fault::Deadlock).is_some());
    }
}

impl Report {
    /// The table of broken assumptions, in Markdown, per 1,000 drives.
    pub fn table(&self) -> String {
        let mut text = String::from(
            "| what is broken | drives | collisions | mean impact, m/s | hardest, m/s | outside the bound | honest ones refused | does not drive again |\n\
             |---|---|---|---|---|---|---|---|\n",
        );
        for assumption in Assumption::ALL {
            let Some(row) = self.broken.get(&assumption) else { continue };
            let per = |count: u64| count as f64 * 1000.0 / row.drives.max(1) as f64;
            let mean = row.impacts / row.collisions.max(1) as f64;
            text += &format!(
                "| {} | {} | {:.1} | {mean:.1} | {:.1} | {:.1} | {:.1} | {:.1} |\n",
                assumption.says(),
                row.drives,
                per(row.collisions),
                row.hardest,
                per(row.outside),
                per(row.refused),
                per(row.stuck),
            );
        }
        text
    }

    /// The findings where all assumptions are kept, in Markdown, by family and kind of fault.
    pub fn summary(&self) -> String {
        let mut text = format!("| family | drives | {} |\n|---|---|", Fault::ALL.map(Fault::name).join(" | "));
        text += &"---|".repeat(Fault::ALL.len());
        text.push('\n');
        for (family, drives) in &self.kept {
            let family = Family::ALL[*family];
            text += &format!("| {} | {drives} |", family.name());
            for fault in Fault::ALL {
                let of_it = |violation: &&Violation| {
                    violation.scenario.family == family && violation.outcome.of(fault).is_some()
                };
                text += &format!(" {} |", self.violations.iter().filter(of_it).count());
            }
            text.push('\n');
        }
        text
    }
}
