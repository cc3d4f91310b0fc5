//! The arguments of `live`, as they are typed.

use std::net::IpAddr;
use std::path::PathBuf;

use clap::Args;

use crate::commands::ecu::arguments::UnitArguments;

/// The port, unless another one is given.
pub const PORT: u16 = 8137;

/// The arguments of `live`.
#[derive(Clone, Debug, Args)]
pub struct LiveArguments {
    /// The scenario, a file or a name from `run --list`; by default the paper's
    #[arg(value_name = "SCENARIO")]
    pub scenario: Option<PathBuf>,

    /// Port of the page; 0: any that is free
    #[arg(long, value_name = "N", default_value_t = PORT)]
    pub port: u16,

    /// Do not open a browser
    #[arg(long)]
    pub no_browser: bool,

    /// Address on which the page is served. By default only this computer reaches it; 0.0.0.0: every computer of the network does, and
    /// can drive
    #[arg(long, value_name = "ADDRESS", default_value = "127.0.0.1")]
    pub listen: IpAddr,

    /// At the end, write every tick of the run up to then for Foxglove and other readers of MCAP
    #[arg(long, value_name = "FILE.mcap")]
    pub mcap: Option<PathBuf>,

    /// Put the device on this CAN interface into the world, in real time: it drives the ego, or the vehicle of --vehicle. A string of
    /// vehicles only; Linux only
    #[arg(long, value_name = "INTERFACE")]
    pub bus: Option<String>,

    /// The device.
    #[command(flatten)]
    pub unit: UnitArguments,

    /// Start the device by this command, and end it after the run
    #[arg(long, value_name = "COMMAND", requires = "bus")]
    pub device: Option<String>,

    /// Seed of everything random, instead of the scenario's
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub seed: Option<u64>,

    /// Set a key of the scenario, as often as needed, as in `run`
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
}

/// Examples and further notes.
pub const AFTER_HELP: &str = "\
Examples:
  holdover-sim live                      the paper's scenario, in your browser
  holdover-sim live motorway             a platoon of ten
  holdover-sim live corridor             four intersections; vehicles come and go
  holdover-sim live --set vehicle.2.time_gap_s=0.6 my.toml
                                         yours, with another value
  holdover-sim live --no-browser --port 0
                                         prints the address and waits
  holdover-sim run drive.toml            repeats what was saved on the page

  holdover-sim live --bus vcan0 --device 'holdover-sim ecu --bus vcan0'
                                         with a device that drives the ego
  holdover-sim live --bus can0 --vehicle 1
                                         with a device that drives the first
                                         follower

The page shows the vehicles and what each believes of the one ahead. There you
drive, break the links and switch things off. The address is printed on stdout.
Ctrl-C ends it. docs/LIVE.md has the keys and the protocol.";
