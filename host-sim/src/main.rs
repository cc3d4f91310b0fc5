//! `holdover-sim`: the command line of the host harness. Parse, validate, dispatch, exit code.

use clap::Parser;
use holdover_sim::commands::cli::Cli;
use holdover_sim::commands::options::Options;
use holdover_sim::output;
use holdover_sim::verdict::Verdict;
use std::process::ExitCode;

fn main() -> ExitCode {
    match Options::read(Cli::parse()).and_then(|options| options.run()) {
        Ok(verdict) => verdict.into(),
        Err(error) => {
            output::say(&format!("error: {error}"));
            Verdict::BAD_INPUT.into()
        }
    }
}
