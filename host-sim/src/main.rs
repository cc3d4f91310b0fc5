//! `holdover-sim`: the command line of the host harness. Parse, validate, dispatch, exit code.

use clap::Parser;
use holdover_sim::cli::Cli;
use holdover_sim::options::Options;
use holdover_sim::verdict::Verdict;
use holdover_sim::{capture, corridor, ecu, evaluate, gains, hil, library, motions, output, price, replay, run};
use holdover_sim::{string, sweep};
use std::process::ExitCode;

fn main() -> ExitCode {
    let verdict = Options::read(Cli::parse()).and_then(|options| match options {
        Options::Run(options) => run::run(&options),
        Options::Corridor(options) => corridor::command::run(&options),
        Options::List => output::print(&library::list()).map(|()| Verdict::Pass),
        Options::Evaluate(options) => evaluate::evaluate(&options),
        Options::Sweep(options) => sweep::sweep(&options),
        Options::Gains(options) => gains::gains(&options),
        Options::String(options) => string::string(&options),
        Options::Motions(options) => motions::motions(&options),
        Options::Price(options) => price::price(&options),
        Options::Replay(options) => replay::replay(&options),
        Options::Record(options) => capture::capture(&options),
        Options::Ecu(options) => ecu::run(&options),
        Options::Hil(options) => hil::run(&options),
    });
    match verdict {
        Ok(verdict) => verdict.into(),
        Err(error) => {
            output::say(&format!("error: {error}"));
            Verdict::BAD_INPUT.into()
        }
    }
}
