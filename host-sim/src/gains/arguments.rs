//! What can follow `gains` on the command line: arguments enter, raw values leave.

use clap::Args;
use std::path::PathBuf;

/// The arguments of `gains`.
#[derive(Clone, Debug, Args)]
pub struct GainsArguments {
    /// Write the table here, as Rust
    #[arg(long, value_name = "FILE.rs")]
    pub write: Option<PathBuf>,

    /// Print the results as one JSON value on stdout
    #[arg(long)]
    pub json: bool,

    /// Folder for the HTML report; it is created
    #[arg(long, value_name = "DIR", default_value = "holdover-report/gains")]
    pub out: PathBuf,

    /// Write no report
    #[arg(long, conflicts_with = "out")]
    pub no_report: bool,
}

/// The end of `gains --help`.
pub const AFTER_HELP: &str = "\
Examples:
  holdover-sim gains                     prove the table, and draw it
  holdover-sim gains --write src/controller/gain_table.rs
                                         make the table that the core ships

The table:
  The gain k over own speed, target's speed and headway at the moment of
  association, and a curve of the damping over k. The time gap is 1 s.

Limits of every pair on the curve, thousandth by thousandth:
  string stability  t_g >= sqrt(g² + 2/k) - g; the largest amplification 1
                    without lag and with 0.3 s, 1.002 with 0.5 s
  margins           40 degrees and 0.2 s, with a lag of 0.5 s
Limits of every cell, for a car that comes up to a target of constant speed:
  always            2.5 and -4 m/s², 5 m/s³
  where braking at 3 m/s² from the start would do
                    the gap never falls by more than 0.25 m below the smaller
                    of that at the start and that in the end; settled in 45 s
  where braking at 4 m/s² would avoid a collision
                    no collision
  elsewhere         nothing; the largest gap that there is

Exit codes:
  0  every limit holds
  1  one does not; the results say where
  2  bad input; one line on stderr names option, cause and remedy";
