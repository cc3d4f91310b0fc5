//! The arguments of `evaluate`, as they are typed.

use clap::Args;
use std::path::PathBuf;

use crate::commands::ending::OutputArguments;

/// The arguments of `evaluate`.
#[derive(Clone, Debug, Args)]
#[command(mut_arg("out", |out| out.default_value("holdover-report/evaluate")))]
pub struct EvaluateArguments {
    /// Recorded drive: t_s,position_m,speed_mps and, if known, acceleration_mps2; several drives are pooled
    #[arg(long, value_name = "FILE.csv", required = true, num_args = 1..)]
    pub motion: Vec<PathBuf>,

    /// Recorded link: t_s,delay_s, one row per message sent; an empty delay is a lost message
    #[arg(long, value_name = "FILE.csv")]
    pub channel: Option<PathBuf>,

    /// Instead of a link: 10 messages per second, and after each of them silences of these lengths
    #[arg(long, value_name = "SECONDS,...", allow_hyphen_values = true)]
    pub outage: Option<String>,

    /// Recorded drive of the vehicle that the target follows, along the same path; one for each --motion
    #[arg(long, value_name = "FILE.csv", num_args = 1..)]
    pub predecessor: Vec<PathBuf>,

    /// Prediction step of the core, and time between two ticks
    #[arg(long, value_name = "SECONDS", default_value = "0.01", allow_negative_numbers = true)]
    pub step: f64,

    /// Refuse recordings that say what no vehicle and no link does, instead of warning of them
    #[arg(long)]
    pub strict: bool,

    /// Where its results go.
    #[command(flatten)]
    pub output: OutputArguments,

    /// Write every tick that counts: time, truth, age, the unit's estimate and each baseline's
    #[arg(long, value_name = "FILE.csv")]
    pub trace: Option<PathBuf>,
}

/// Text below the options.
pub const AFTER_HELP: &str = "\
Examples:
  holdover-sim evaluate --motion drive.csv --channel link.csv
                             your recording of a drive, over your recording of
                             a link
  holdover-sim evaluate --motion drive.csv --outage 0.5,1,2,4
                             what becomes of the estimate in a silence
  holdover-sim evaluate --motion a.csv b.csv --outage 1,2 --json
                             both drives in one figure, as JSON

Over a link (--channel):
  Times of all files are times of one clock; what they do not share is left
  out. At each send time the newest recorded sample is sent, with its own time
  as stamp; an acceleration that the file does not have is the slope of the
  speeds of the last 0.5 s. The message is on the bus at send time + delay. The
  unit ticks at the multiples of --step. A tick counts from the first delivery
  to the last recorded sample or the last send, whichever is earlier; the truth
  is linear between samples. Age is the time from the stamp of the newest
  delivered sample. A message that is older than 10 s on arrival is dropped.

In silences (--outage):
  Messages are sent at 0, 0.1, 0.2, ... s of the recording and arrive at once.
  After each of them the unit is cloned, and the clone hears nothing more: its
  error counts at each length of silence after that last message, as long as
  the recording lasts. The overall figures are over all lengths together.

With the vehicle ahead (--predecessor):
  It is heard over the same link. The target says that it follows it, by the
  law that units are configured with, while its acceleration is what that law
  demands (within 0.5 m/s2); while it is not, it says that it follows nobody,
  as any vehicle does that a driver drives.

Output:
  Results go to stdout, as a table or with --json as one JSON value; progress
  goes to stderr. The report is one HTML file in the folder of --out. Equal
  input gives equal bytes, but for what stands under \"timing\".

Exit codes:
  0  evaluated
  1  there was nothing to compare: no message arrived, or no silence ended
  2  bad input; one line on stderr names file, line, cause and remedy";
