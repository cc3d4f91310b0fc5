//! `dbc`: the message catalogue as a DBC file. Identifiers and a number of slots enter, the file leaves on stdout.

pub mod arguments;

use holdover::wire::Identifiers;
use holdover::wire::catalogue::SLOTS;
use holdover::wire::dbc::Dbc;

use crate::error::Error;
use crate::output;
use crate::verdict::Verdict;
use arguments::DbcArguments;

/// Checked identifiers and number of slots.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DbcOptions {
    identifiers: Identifiers,
    slots: u8,
    fd: bool,
}

impl DbcOptions {
    /// Reads and checks the arguments.
    ///
    /// # Errors
    /// Identifiers that do not fit, and a number of slots that there are no identifiers for.
    pub fn read(arguments: &DbcArguments) -> Result<Self, Error> {
        let slots = arguments.slots;
        if slots == 0 || u16::from(slots) > SLOTS {
            let cause = format!("{slots} slots");
            return Err(Error::new(cause, format!("give 1 to {SLOTS}")).in_option("--slots"));
        }
        Ok(Self { identifiers: arguments.identifiers.read()?, slots, fd: arguments.fd })
    }
}

/// Prints the file.
///
/// # Errors
/// An output that cannot be written.
pub fn run(options: &DbcOptions) -> Result<Verdict, Error> {
    let classic = Dbc::new(options.identifiers, options.slots);
    let dbc = if options.fd { classic.over_fd() } else { classic };
    output::print(&dbc.to_string()).map(|()| Verdict::Pass)
}
