//! The arguments of `record`, as they are typed.

use clap::Args;
use std::path::PathBuf;

/// The arguments of `record`.
#[derive(Clone, Debug, Args)]
pub struct RecordArguments {
    /// The CAN interface
    #[arg(long, value_name = "INTERFACE")]
    pub bus: String,

    /// The log, as `candump -l` writes it; by default standard output
    #[arg(short, long, alias = "output", value_name = "FILE")]
    pub out: Option<PathBuf>,

    /// Stop after this long; otherwise it records until it is interrupted by Ctrl-C (SIGINT) or SIGTERM
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true)]
    pub duration: Option<f64>,
}

/// The end of `record --help`.
pub const AFTER_HELP: &str = "\
Examples:
  holdover-sim record --bus vcan0 -o drive.log     until it is interrupted
  holdover-sim record --bus can0 --duration 60 | grep ' 482#'
  holdover-sim replay drive.log --bus vcan0        the same traffic once more
  canplayer vcan0=can0 -I drive.log                the same, by can-utils

The log has the kernel's time stamps, since 1970, all frames, CAN FD (`##`)
among them, and what the controller reports as errors. can-utils, Wireshark
and python-can read it as it is. SIGINT and SIGTERM end it as --duration does:
the log is complete, and the number of frames is told.

Exit codes:
  0  recorded, however it was ended
  2  bad input; one line on stderr names cause and remedy";
