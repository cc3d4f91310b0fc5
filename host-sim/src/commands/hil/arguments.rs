//! The arguments of `hil`, as they are typed.

use clap::Args;
use std::path::PathBuf;

use super::judge::LATENCY_P99_MS;
use crate::commands::ecu::arguments::UnitArguments;
use crate::input::scenario::SensorShare;

/// The arguments of `hil`.
#[derive(Clone, Debug, Args)]
pub struct HilArguments {
    /// The scenario: a file, or `paper`; the device drives its ego
    #[arg(value_name = "SCENARIO", default_value = "paper")]
    pub scenario: PathBuf,

    /// The CAN interface that the device is on
    #[arg(long, value_name = "INTERFACE")]
    pub bus: String,

    /// Step by step: the device ticks by the time synchronisation alone, and has to send the same as its twin, bit for
    /// bit
    #[arg(long)]
    pub lock_step: bool,

    /// The device; its twin has the same configuration.
    #[command(flatten)]
    pub unit: UnitArguments,

    /// Whether every vehicle that follows another has a range sensor, or none, or a share from 0 to 1, instead of what the scenario says
    #[arg(long, value_name = "on|off|SHARE", allow_negative_numbers = true)]
    pub range_sensors: Option<SensorShare>,

    /// Start the device by this command, and end it after the run
    #[arg(long, value_name = "COMMAND")]
    pub device: Option<String>,

    /// Write every tick of every vehicle for Foxglove and other readers of MCAP
    #[arg(long, value_name = "FILE.mcap")]
    pub mcap: Option<PathBuf>,

    /// Longest wait for the first frame of the device
    #[arg(long, value_name = "SECONDS", default_value_t = 10.0, allow_negative_numbers = true)]
    pub wait: f64,

    /// Longest time from the vehicle's motion to the device's command that rests on it, except for one command in 100;
    /// in real time
    #[arg(long, value_name = "MS", default_value_t = LATENCY_P99_MS, allow_negative_numbers = true)]
    pub latency: f64,

    /// Inject a fault, such as power@5:1 (below); may be repeated
    #[arg(long, value_name = "FAULT")]
    pub fault: Vec<String>,

    /// Seed of everything random, instead of the scenario's
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub seed: Option<u64>,

    /// Print the results as one JSON value on stdout
    #[arg(long)]
    pub json: bool,

    /// Folder for the HTML report; it is created. Without it there is no report
    #[arg(long, alias = "output", value_name = "DIR")]
    pub out: Option<PathBuf>,

    /// Write no report, which is so without --out
    #[arg(long, hide = true, conflicts_with = "out")]
    pub no_report: bool,
}

/// The end of `hil --help`.
pub const AFTER_HELP: &str = "\
Examples:
  holdover-sim ecu --bus vcan0 &
  holdover-sim hil --bus vcan0               the paper's scenario against a process
  holdover-sim hil --bus can0 --station 1    against a board with the firmware
  holdover-sim hil --bus vcan0 --lock-step --device 'holdover-sim ecu --bus vcan0 --lock-step'
  holdover-sim hil --bus vcan0 --device 'holdover-sim ecu --bus vcan0' --fault power@5:1

Fault buttons, KIND[=VALUE]@START[:DURATION] in seconds of the run:
  power@5:1          cut the device's power for 1 s (needs --device)
  interface@5:1      take the interface down (needs root)
  babble@5:1         a node that takes all of the bus
  corrupt@5:1        every third frame to the device has a wrong bit
  truncate@5:1       every third frame to the device is cut short
  foreign@5:1        another node on the vehicle's identifiers
  errors@5:1         100 error frames a second
  clock-step=0.1@5:2      the time synchronisation is off by so many seconds
  clock-drift=1000@5:5    it runs fast by so many millionths

Exit codes:
  0  the verdict is: passed
  1  the verdict is: failed; the device was silent, late, gone, wrong, or the
     scenario's own verdict is
  2  bad input; one line on stderr names cause and remedy
  3  inconclusive: this program itself was late";
