//! `holdover-sim`: the command line of the host harness. Parse, validate, dispatch, exit code.

use clap::Parser;
use holdover_sim::commands::cli::Cli;
use holdover_sim::commands::mistyped;
use holdover_sim::commands::options::Options;
use holdover_sim::error::Error;
use holdover_sim::output;
use holdover_sim::verdict::Verdict;
use std::process::ExitCode;

fn main() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(refusal) => match mistyped::line(&refusal) {
            Some(error) => return refused(&error),
            None => refusal.exit(),
        },
    };
    match Options::read(cli).and_then(|options| options.run()) {
        Ok(verdict) => verdict.into(),
        Err(error) => refused(&error),
    }
}

fn refused(error: &Error) -> ExitCode {
    output::say(&format!("error: {error}"));
    Verdict::BAD_INPUT.into()
}
