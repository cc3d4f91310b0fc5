//! The command: the plans of the tests, or longer ones, with the numbers of states.

use std::process::ExitCode;
use std::time::Instant;

use clap::Parser;
use holdover_passes::broken::Broken;
use holdover_passes::world::Plan;
use stateright::{Checker, Model};

/// Tries every combination of claims, lost and late messages, and entries of vehicles that come to one conflict area, by the rules of
/// passes.
#[derive(Parser)]
#[command(after_help = "\
plans:
  clocks   two vehicles whose clocks differ, which come at different times, with messages that are lost or late
  long     two vehicles with one clock that come at once
  pieces   two vehicles that add a window to the one that they have, and need both for one stay
  queue    two vehicles that say for a while that they are before the zone
  three    three vehicles that repeat what they know of one another
  settled  two vehicles, and after some time no message is lost any more: everybody has to get through

A step is the time in which every vehicle does one thing and sends one message. Memory grows with the states: about 1 GB for
a million.

exit code: 0 every property holds; 1 one does not, and the events that lead there are printed; 2 bad arguments")]
struct Arguments {
    /// The plans; all of them if none is given
    #[arg(value_parser = Plan::ALL.map(|(name, _)| name))]
    plans: Vec<String>,
    /// Steps, instead of the plan's own
    #[arg(long, value_name = "STEPS", value_parser = clap::value_parser!(u8).range(1..=40))]
    until: Option<u8>,
    /// Threads
    #[arg(long, default_value_t = 2, value_parser = clap::value_parser!(u8).range(1..=64))]
    threads: u8,
    /// Also tries the plans with one rule taken out at a time, and tells which of these are found out
    #[arg(long)]
    broken: bool,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let is_wanted = |name: &str| arguments.plans.is_empty() || arguments.plans.iter().any(|plan| plan == name);
    let mut has_failed = false;
    for (name, plan) in Plan::ALL.into_iter().filter(|(name, _)| is_wanted(name)) {
        let plan = Plan { until: arguments.until.unwrap_or(plan.until), ..plan };
        has_failed |= !check(name, plan.clone(), arguments.threads);
        for broken in Broken::ALL.into_iter().filter(|_| arguments.broken) {
            let plan = Plan { broken: Some(broken), ..plan.clone() };
            let found = plan.checker().threads(arguments.threads.into()).spawn_bfs().join().discoveries();
            println!("{name}, {broken:?}: {}", if found.is_empty() { "not found" } else { "found" });
        }
    }
    ExitCode::from(u8::from(has_failed))
}

/// Checks a plan and prints what was found; whether every property holds.
fn check(name: &str, plan: Plan, threads: u8) -> bool {
    let begun = Instant::now();
    let until = plan.until;
    let checker = plan.checker().threads(threads.into()).spawn_bfs().join();
    let (states, seconds) = (checker.unique_state_count(), begun.elapsed().as_secs_f64());
    println!("{name}: {states} states in {until} steps, {seconds:.1} s");
    let properties = checker.model().properties();
    let mut holds = true;
    for property in &properties {
        let Some(path) = checker.discovery(property.name) else {
            println!("  holds: {}", property.name);
            continue;
        };
        holds = false;
        println!("  DOES NOT HOLD: {}", property.name);
        for event in path.into_actions() {
            println!("    {event:?}");
        }
    }
    holds
}
