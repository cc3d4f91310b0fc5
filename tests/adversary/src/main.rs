//! The command: random drives by a seed, or a drive from a file.

use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

use holdover_adversary::run::{Plan, Report, run};
use holdover_adversary::scenario::{Family, Scenario};
use holdover_adversary::shrink::shrink;
use holdover_adversary::verdict::Finding;
use holdover_adversary::world;

const HELP: &str = "\
Random drives against holdover, in a world of their own that knows it by its CAN frames alone.

usage: holdover-adversary [--drives N] [--first N] [--seed N] [--threads N] [--family NAME]... [--kept-only] [--keep DIR] [--all]
       holdover-adversary --replay FILE

  --drives N      so many drives (1000); every other one breaks one assumption of use
  --first N       from that number on (0): with --drives 1, one that was printed
  --seed N        of everything that is drawn (1); the same seed draws the same drives, whatever the number of threads
  --threads N     so many at a time (as many as there are processors)
  --family NAME   only this family, or these: following, closing, stranger, cut-in, lorry, silence, restart, slots,
                  garbage, crossing
  --kept-only     no drive breaks an assumption
  --no-envelope   without the last gate: what the checker finds then
  --keep DIR      makes the first violation of each family and kind smaller and writes it into this directory
  --all           prints every violation; or else the first 200
  --replay FILE   runs one that was kept, and says what is found in it
  --help          this

Violations of kept assumptions are printed one on a line: family, drive, seed, time, what at
first, and in brackets how much at most (m/s of impact or beyond the request, m outside, s). Progress goes to stderr.
exit code: 0 everything held; 1 an assumption was kept and something was violated; 2 bad arguments
";

struct Arguments {
    plan: Plan,
    threads: usize,
    keep: Option<PathBuf>,
    replay: Option<PathBuf>,
    all: bool,
}

fn main() -> ExitCode {
    let arguments = match parse(std::env::args().skip(1)) {
        Ok(Some(arguments)) => arguments,
        Ok(None) => {
            print!("{HELP}");
            return ExitCode::SUCCESS;
        }
        Err(error) => {
            eprintln!("holdover-adversary: {error}\n\n{HELP}");
            return ExitCode::from(2);
        }
    };
    let found = match &arguments.replay {
        Some(file) => replay(file),
        None => drive(&arguments),
    };
    match found {
        Ok(false) => ExitCode::SUCCESS,
        Ok(true) => ExitCode::from(1),
        Err(error) => {
            eprintln!("holdover-adversary: {error}");
            ExitCode::from(2)
        }
    }
}

fn parse(mut words: impl Iterator<Item = String>) -> Result<Option<Arguments>, String> {
    let mut plan = Plan { first: 0, drives: 1000, seed: 1, families: Vec::new(), breaks: true, envelope: true };
    let mut arguments = Arguments { plan: plan.clone(), threads: 0, keep: None, replay: None, all: false };
    while let Some(word) = words.next() {
        let mut value = || words.next().ok_or(format!("{word} needs a value"));
        let number = |text: String| text.parse::<u64>().map_err(|_| format!("'{text}' is not a number"));
        match word.as_str() {
            "--drives" => plan.drives = number(value()?)?,
            "--first" => plan.first = number(value()?)?,
            "--seed" => plan.seed = number(value()?)?,
            "--threads" => arguments.threads = number(value()?)? as usize,
            "--family" => {
                let name = value()?;
                let family = Family::ALL.into_iter().find(|family| family.name() == name);
                plan.families.push(family.ok_or(format!("no family '{name}'"))?);
            }
            "--kept-only" => plan.breaks = false,
            "--no-envelope" => plan.envelope = false,
            "--keep" => arguments.keep = Some(value()?.into()),
            "--replay" => arguments.replay = Some(value()?.into()),
            "--all" => arguments.all = true,
            "--help" | "-h" => return Ok(None),
            _ => return Err(format!("no argument '{word}'")),
        }
    }
    if plan.families.is_empty() {
        plan.families = Family::ALL.to_vec();
    }
    arguments.plan = plan;
    Ok(Some(arguments))
}

fn replay(file: &PathBuf) -> Result<bool, String> {
    let text = std::fs::read_to_string(file).map_err(|error| format!("{}: {error}", file.display()))?;
    let scenario = Scenario::from_text(&text).map_err(|error| format!("{}: {error}", file.display()))?;
    let outcome = world::run(&scenario);
    for Finding { fault, at, text, .. } in &outcome.findings {
        println!("{:9} {at:7.2} s  {}: {text}", scenario.family.name(), fault.name());
    }
    println!(
        "{} ticks, the bound was checked in {}, the truth was outside in {}",
        outcome.ticks, outcome.checked, outcome.outside
    );
    Ok(!outcome.findings.is_empty())
}

fn drive(arguments: &Arguments) -> Result<bool, String> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(arguments.threads).build();
    let pool = pool.map_err(|error| error.to_string())?;
    let (start, told) = (Instant::now(), AtomicU64::new(0));
    let drives = arguments.plan.drives;
    let tell = |done: u64| {
        let tenths = start.elapsed().as_millis() as u64 / 2000;
        if told.fetch_max(tenths, Ordering::Relaxed) < tenths || done == drives {
            eprint!("\r{done} of {drives} drives, {:.0} s ", start.elapsed().as_secs_f64());
        }
    };
    let report = pool.install(|| run(&arguments.plan, &tell));
    eprintln!("\r{drives} drives in {:.1} s          ", start.elapsed().as_secs_f64());
    print_violations(&report, arguments.all);
    println!(
        "\nAssumptions kept ({} ticks, the bound checked in {}):\n\n{}",
        report.ticks,
        report.checked,
        report.summary()
    );
    if !report.broken.is_empty() {
        println!("One assumption broken, per 1,000 drives:\n\n{}", report.table());
    }
    if let Some(keep) = &arguments.keep {
        pool.install(|| keep_smaller(&report, keep))?;
    }
    Ok(!report.violations.is_empty())
}

fn print_violations(report: &Report, all: bool) {
    let lines = report.violations.iter().flat_map(|violation| {
        violation.outcome.findings.iter().map(move |Finding { fault, at, text, amount }| {
            let (family, seed) = (violation.scenario.family.name(), violation.scenario.seed);
            let drive = violation.drive;
            format!("{family:9} drive {drive:6} seed {seed:19} {at:7.2} s  {}: {text} [{amount:.3}]", fault.name())
        })
    });
    let most = if all { usize::MAX } else { 200 };
    for line in lines.clone().take(most) {
        println!("{line}");
    }
    let left = lines.count().saturating_sub(most);
    if left > 0 {
        println!("and {left} more (--all)");
    }
}

fn keep_smaller(report: &Report, keep: &PathBuf) -> Result<(), String> {
    std::fs::create_dir_all(keep).map_err(|error| format!("{}: {error}", keep.display()))?;
    let mut kept = std::collections::HashSet::new();
    for violation in &report.violations {
        for finding in &violation.outcome.findings {
            let family = violation.scenario.family;
            if !kept.insert((family, finding.fault)) {
                continue;
            }
            let smaller = shrink(&violation.scenario, finding.fault);
            let name = format!("{}-{}.toml", family.name(), finding.fault.name().replace(' ', "-"));
            let head =
                format!("# {}: {}\n# drive {}, made smaller\n", finding.fault.name(), finding.text, violation.drive);
            let file = keep.join(name);
            std::fs::write(&file, head + &smaller.to_text()).map_err(|error| format!("{}: {error}", file.display()))?;
            eprintln!("kept {}", file.display());
        }
    }
    Ok(())
}
