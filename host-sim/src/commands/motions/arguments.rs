//! The arguments of `motions`, as they are typed.

use clap::Args;

use crate::commands::ending::OutputArguments;
use crate::input::scenario::SensorShare;

/// The arguments of `motions`.
#[derive(Clone, Debug, Args)]
#[command(mut_arg("out", |out| out.default_value("holdover-report/motions")))]
pub struct MotionsArguments {
    /// Silences of each motion, 1 to 1000; ten successive ones differ in their beginning, or in when the target brakes
    /// in them
    #[arg(long, value_name = "N", default_value = "50", allow_negative_numbers = true)]
    pub silences: u32,

    /// Seed of the first silence of each motion; each further silence has the next seed
    #[arg(long, value_name = "N", default_value = "1", allow_negative_numbers = true)]
    pub seed: u64,

    /// Whether every follower has a range sensor, or a share of them, from 0 to 1; the other methods have none
    #[arg(long, value_name = "on|off|SHARE", allow_negative_numbers = true, default_value = "off")]
    pub range_sensors: SensorShare,

    /// Where its results go.
    #[command(flatten)]
    pub output: OutputArguments,
}

/// The end of `motions --help`.
pub const AFTER_HELP: &str = "\
Examples:
  holdover-sim motions                           50 silences of each motion
  holdover-sim motions --silences 10 --json
  holdover-sim motions --seed 100 --out m        others, their report in m/
  holdover-sim motions --range-sensors on        the unit sees its target too

Runs:
  The last vehicle listens to the one ahead of it, the target, over a channel
  with a delay of Normal(40 ms, 25.9 ms) and 10 % loss, and then hears nobody
  for 4 s. Every 10 ms of these its unit's estimate of the target is compared
  with the truth, and so is what others make of the same decoded messages.

Motions:
  free_acceleration  it leads, from 1-4 m/s to 13.4 m/s; it says so
  slot_following     it finds its slot behind an accelerating leader, from a gap
                     of 6-30 m; it says so
  sine               a driver's speed is 13.4 m/s ± 10 km/h at 0.2 Hz
  braking_2          a driver brakes at 2 m/s² from inside the silence on
  braking_5          a driver brakes at 5 m/s² to a stop inside the silence
  What a driver will do nobody says beforehand.

Methods:
  holdover           the unit
  freeze, constant speed, constant acceleration, Singer's model, Kalman filter
                     from the target's last messages
  literal paper      the paper's equations as printed
  consensus          the consensus law of platoon simulators: the message that
                     came last, moved on by its age times its speed

Figures:
  Errors of position (rms, 99 %, largest) and of speed (rms). `holdover' wins,
  draws or loses against the best of the others: its rms is more than 5 %
  smaller, within 5 %, or larger.

Exit codes:
  0  measured
  2  bad input; one line on stderr names option, cause and remedy";
