//! The arguments of `gains`, as they are typed.

use clap::Args;
use std::path::PathBuf;

use crate::commands::ending::OutputArguments;

/// The arguments of `gains`.
#[derive(Clone, Debug, Args)]
#[command(mut_arg("out", |out| out.default_value("holdover-report/gains")))]
pub struct GainsArguments {
    /// Write the tables to this file, as Rust
    #[arg(long, value_name = "FILE.rs")]
    pub write: Option<PathBuf>,

    /// Where its results go.
    #[command(flatten)]
    pub output: OutputArguments,
}

/// The end of `gains --help`.
pub const AFTER_HELP: &str = "\
Examples:
  holdover-sim gains                     prove the tables, and draw them
  holdover-sim gains --write src/controller/gain_table.rs
                                         make the tables that the core ships

The tables:
  The gain k over own speed, target's speed and headway at the moment of
  association, and a curve of the damping g over k. One is for the law of eq. 5,
  made for a time gap of 1 s, that of the scenarios. The other is for that law
  with half of the acceleration ahead passed on (feed-forward f = 0.5), as cars
  and vans with a range sensor drive, and made for 0.7 s. Both are proved at
  every tenth of a second from there to 2 s, for the linear string, without
  limits on jerk.

Limits of every pair on the curve, thousandth by thousandth:
  string stability  t_g >= sqrt(g² + 2 (1 - f)/k) - g;
                    the largest amplification 1 without lag and with
                    0.3 s, 1.002 with 0.5 s
  margins           40 degrees and 0.2 s, with a lag of 0.5 s
Limits of every cell, for a car that comes up to a target of constant speed:
  where braking at 3 m/s² from the start would do
                    the gap never falls by more than 0.25 m below the smaller
                    of that at the start and that in the end; settled in 45 s
                    at a time gap of 1 s, and 7 s later for each second more: the
                    distance left dies out with a time constant that has the
                    gap in it, and from 260 m to 0.25 m is 7 factors of e
  where braking at 4 m/s² would avoid a collision
                    no collision
  elsewhere         nothing; the largest gap that there is
The demand keeps to 2.5 and -4 m/s² and 5 m/s³ by construction.

Other time gaps:
  String stability holds at every larger one, which is proved too. Settling and
  margins do not: without feed-forward the phase margin is below 40 degrees at
  3.995 s.

Exit codes:
  0  every limit holds
  1  one does not; the results say where
  2  bad input; one line on stderr names option, cause and remedy";
