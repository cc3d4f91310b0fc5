//! The arguments of `check`, as they are typed.

use clap::Args;
use std::path::PathBuf;

/// The arguments of `check`.
#[derive(Clone, Debug, Args)]
pub struct CheckArguments {
    /// Recordings of drives and of links, which are told by their columns, and scenarios
    #[arg(value_name = "FILE", required = true)]
    pub files: Vec<PathBuf>,
}

/// The end of `check --help`.
pub const AFTER_HELP: &str = "\
Examples:
  holdover-sim check drive.csv link.csv     recordings
  holdover-sim check city.toml              a scenario, and the recordings that it
                                            names

A finding is what a recording says and no vehicle or link does:
  gaps       no sample for more than 0.5 s and five usual intervals; no message
             for more than 1 s and five usual intervals
  positions  that jump, or move at another speed than the one beside them
  slopes     of the speed beyond 12 m/s² of braking or 8 m/s² of acceleration
  units      times or delays as in milliseconds, speeds as in km/h, positions as
             in millimetres or against the direction of driving
  deaf       a link on which no message arrives
Each kind has one line, with the worst place. `run`, `evaluate`, `sweep`,
`envelope-cost` and `hil` warn of the same findings and go on; with --strict the
first four refuse them.

Exit codes:
  0  nothing was found
  1  something was found; the results say what, file by file
  2  bad input; one line on stderr for each file names line, cause and remedy";
