//! The arguments of `replay`, as they are typed.

use clap::Args;

use crate::commands::identifiers::IdentifierArguments;
use std::path::PathBuf;

/// The arguments of `replay`.
#[derive(Clone, Debug, Args)]
pub struct ReplayArguments {
    /// The log, as `candump -l` or candump's screen with `-t a`, `-t z` or `-t d` writes it; - for standard input
    #[arg(value_name = "LOG")]
    pub log: PathBuf,

    /// Put the log's frames on this CAN interface instead, with their timing
    #[arg(long, value_name = "INTERFACE", conflicts_with_all = ["scenario", "vehicle", "seed", "station", "base_id",
        "place", "identifiers",
        "period", "step", "summary", "json"])]
    pub bus: Option<String>,

    /// Replay as a unit of this scenario, a file or a name from `run --list`; the paper's if only --vehicle is given. In a
    /// corridor the unit has the map
    #[arg(long, value_name = "SCENARIO")]
    pub scenario: Option<PathBuf>,

    /// Seed of the run whose vehicle it is, if it is not the scenario's. It counts in a corridor
    #[arg(long, value_name = "N", requires = "scenario", allow_negative_numbers = true)]
    pub seed: Option<u64>,

    /// The vehicle whose unit receives the log; by default the ego. In a corridor, 0 to 254 by arrival
    #[arg(long, value_name = "INDEX", allow_negative_numbers = true)]
    pub vehicle: Option<usize>,

    /// The unit's own station, 0 to 255 [default: 1]
    #[arg(long, value_name = "N", conflicts_with_all = ["scenario", "vehicle"])]
    pub station: Option<u8>,

    /// Where the messages lie on the bus.
    #[command(flatten)]
    pub identifiers: IdentifierArguments,

    /// The bus is CAN FD, whatever the scenario says
    #[arg(long)]
    pub fd: bool,

    /// Period of the unit's task, 0.001 to 0.1 [default: 0.01]
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true, conflicts_with_all = ["scenario", "vehicle"])]
    pub period: Option<f64>,

    /// Prediction step, 0.001 to 1 [default: 0.01, or the scenario's]
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true)]
    pub step: Option<f64>,

    /// The interface of the log to replay; by default that of its first frame
    #[arg(long, value_name = "NAME")]
    pub interface: Option<String>,

    /// Print what was recognised, refused and ignored instead of the unit's frames
    #[arg(long)]
    pub summary: bool,

    /// Print that summary as one JSON value
    #[arg(long)]
    pub json: bool,
}

/// The end of `replay --help`.
pub const AFTER_HELP: &str = "\
Examples:
  holdover-sim replay drive.log              what a unit on that bus would have sent
  holdover-sim replay drive.log --summary    what it would have made of the traffic
  candump -L can0 | holdover-sim replay - --base-id 0x500 --station 7
  holdover-sim --candump ego.log && holdover-sim replay ego.log --vehicle 2
                                             the ego's unit of a run once more
  holdover-sim run corridor --no-report --candump ego.log
  holdover-sim replay ego.log --scenario corridor
                                             a unit that crosses intersections
  holdover-sim replay drive.log --bus vcan0  the same traffic on a CAN interface

Logs:
  candump -l, and candump's screen with -t a, -t z or -t d, which is told from
  -t z by the first 100 lines. Logs of other tools (.asc, .blf, .trc, .mf4) are
  refused by name; python-can converts them:
  python -m can.logconvert IN.blf OUT.log
  By a log that `run --candump` writes a unit sends the same bits as in the run,
  identifier by identifier, and those of one tick more.

Time:
  The unit lives by the log's clock: its first tick is at the time of the first
  frame, every further one a period later, and before each it receives the
  frames up to and including that time. What it sends has the time of its tick.
  The last tick is the first one at or after the last frame. A line may lie up
  to 1 s before an earlier one, as in logs merged of several; it is received
  late, at its own time. Beyond that, after a gap of more than an hour, and
  without times the log is refused, by line. Lines are read one by one, so
  frames may have been printed by then.

  With --bus the first frame is sent at once and every further one as long after
  it as the log says, those of CAN FD too; error frames are left out, and so is
  CAN XL. How late the latest of them was is told at the end.

What becomes of a frame:
  recognised  a good frame of one of the catalogue's messages to the unit
  refused     such a frame that is damaged, repeated, late, torn or implausible;
              with --fd also one of classic CAN (length)
  ignored     any other: of other senders, the unit's own, CAN FD without --fd,
              CAN XL, error frames, and other interfaces

Exit codes:
  0  the whole log was replayed
  2  bad input; one line on stderr names file, line, cause and remedy";
