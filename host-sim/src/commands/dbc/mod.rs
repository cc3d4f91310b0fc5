//! `dbc`: the message catalogue as a DBC file. A base identifier and a number of slots enter, the file leaves on stdout.

pub mod arguments;

use holdover::wire::BaseId;
use holdover::wire::catalogue::SLOTS;
use holdover::wire::dbc::Dbc;

use crate::commands::base_id;
use crate::error::Error;
use crate::output;
use crate::verdict::Verdict;
use arguments::DbcArguments;

/// A checked base and number of slots.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DbcOptions {
    base: BaseId,
    slots: u8,
    fd: bool,
}

impl DbcOptions {
    /// Reads and checks the arguments.
    ///
    /// # Errors
    /// A base that leaves no room for the block, and a number of slots that there are no identifiers for.
    pub fn read(arguments: &DbcArguments) -> Result<Self, Error> {
        let slots = arguments.slots;
        if slots == 0 || u16::from(slots) > SLOTS {
            let cause = format!("{slots} slots");
            return Err(Error::new(cause, format!("give 1 to {SLOTS}")).in_option("--slots"));
        }
        Ok(Self { base: base_id::checked(arguments.base_id)?, slots, fd: arguments.fd })
    }
}

/// Prints the file.
///
/// # Errors
/// An output that cannot be written.
pub fn run(options: &DbcOptions) -> Result<Verdict, Error> {
    let classic = Dbc::new(options.base, options.slots);
    let dbc = if options.fd { classic.over_fd() } else { classic };
    output::print(&dbc.to_string()).map(|()| Verdict::Pass)
}
