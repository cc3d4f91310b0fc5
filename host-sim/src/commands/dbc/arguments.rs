//! The arguments of `dbc`, as they are typed.

use clap::Args;

use crate::commands::identifiers::IdentifierArguments;

/// The arguments of `dbc`.
#[derive(Clone, Debug, Args)]
pub struct DbcArguments {
    /// Where the messages lie on the bus.
    #[command(flatten)]
    pub identifiers: IdentifierArguments,

    /// Slots of peers, 1 to 16; the firmware has 8
    #[arg(long, value_name = "N", default_value = "8", allow_negative_numbers = true)]
    pub slots: String,

    /// The bus is CAN FD
    #[arg(long)]
    pub fd: bool,
}

/// The end of `dbc --help`.
pub const AFTER_HELP: &str = "\
Examples:
  holdover-sim dbc > bus.dbc                              as holdover.dbc, which comes with the source
  holdover-sim dbc --fd > bus.dbc                         as holdover-fd.dbc
  holdover-sim dbc --base-id 0x300 --slots 16 > bus.dbc   for another bus
  holdover-sim dbc --place MotionCommand=0x0CFF022A --place PeerMotionA=0x18FF404A/0x100 > bus.dbc

The unit's are `identifiers` in its configuration, and the same options of ecu, hil and replay.
canmatrix (1.3.3 or later) makes ARXML, KCD and SYM of it: canconvert bus.dbc bus.arxml

Exit codes:
  0  it was written
  2  bad input; one line on stderr names option, cause and remedy";
