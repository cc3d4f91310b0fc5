//! The arguments of `ecu`, as they are typed.

use clap::Args;
use std::path::PathBuf;

use crate::commands::identifiers::IdentifierArguments;
use crate::input::scenario::SensorShare;

/// Identity of the unit. `hil` uses the same arguments for the device under test.
#[derive(Clone, Debug, Default, Args)]
pub struct UnitArguments {
    /// The car that is built into the firmware (station 1 there), with this station, 0 to 255
    #[arg(long, value_name = "N", conflicts_with = "vehicle", allow_negative_numbers = true)]
    pub station: Option<u8>,

    /// The unit of the vehicle with this index in the scenario; by default the ego's
    #[arg(long, value_name = "INDEX", allow_negative_numbers = true)]
    pub vehicle: Option<usize>,

    /// Where the messages lie on the bus.
    #[command(flatten)]
    pub identifiers: IdentifierArguments,

    /// The bus is CAN FD, whatever the scenario says
    #[arg(long)]
    pub fd: bool,
}

/// The arguments of `ecu`.
#[derive(Clone, Debug, Args)]
pub struct EcuArguments {
    /// The scenario of the unit's vehicle: a file, or `paper`
    #[arg(value_name = "SCENARIO", default_value = "paper")]
    pub scenario: PathBuf,

    /// The CAN interface
    #[arg(long, value_name = "INTERFACE")]
    pub bus: String,

    /// Tick by the bus's time synchronisation instead of by a clock
    #[arg(long)]
    pub lock_step: bool,

    /// Whether every vehicle that follows another has a range sensor, or none, or a share from 0 to 1, instead of what the scenario says
    #[arg(long, value_name = "on|off|SHARE", allow_negative_numbers = true, conflicts_with = "station")]
    pub range_sensors: Option<SensorShare>,

    /// The unit.
    #[command(flatten)]
    pub unit: UnitArguments,
}

/// The end of `ecu --help`.
pub const AFTER_HELP: &str = "\
Examples:
  holdover-sim ecu --bus vcan0 &           the unit as a process
  holdover-sim hil --bus vcan0             and the harness that drives it
  holdover-sim ecu --bus can0 --station 1  on a real bus, as the firmware would be

It is the same core as on the ECU, behind a socket instead of a CAN controller.
It runs until it is ended by Ctrl-C (SIGINT) or SIGTERM.

Exit codes:
  0  it was ended by one of the two
  2  bad input; one line on stderr names cause and remedy";
