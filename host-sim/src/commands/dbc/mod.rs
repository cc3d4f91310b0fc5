//! `dbc`: the message catalogue as a DBC file. Identifiers and a number of slots enter, the file leaves on stdout.

pub mod arguments;

use holdover::wire::catalogue::SLOTS;
use holdover::wire::dbc::Dbc;
use holdover::wire::{Identifiers, Transport};

use crate::error::Error;
use crate::output;
use crate::verdict::Verdict;
use arguments::DbcArguments;

/// Checked identifiers and number of slots.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DbcOptions {
    identifiers: Identifiers,
    slots: u8,
    transport: Transport,
}

impl DbcOptions {
    /// Reads and checks the arguments.
    ///
    /// # Errors
    /// Identifiers that do not fit, and a number of slots that there are no identifiers for.
    pub fn read(arguments: &DbcArguments) -> Result<Self, Error> {
        let text = &arguments.slots;
        let refuse = |cause| Error::new(cause, format!("give 1 to {SLOTS}")).in_option("--slots");
        let slots: i128 = text.parse().map_err(|_| refuse(format!("`{text}` is no number")))?;
        let fits = |slots: &u8| (1..=SLOTS).contains(&u16::from(*slots));
        let slots = u8::try_from(slots).ok().filter(fits).ok_or_else(|| refuse(format!("{slots} slots")))?;
        let transport = if arguments.fd { Transport::Fd } else { Transport::Classic };
        Ok(Self { identifiers: arguments.identifiers.read(transport, slots)?, slots, transport })
    }
}

/// Prints the file.
///
/// # Errors
/// An output that cannot be written.
pub fn run(options: &DbcOptions) -> Result<Verdict, Error> {
    let classic = Dbc::new(options.identifiers, options.slots);
    let dbc = if options.transport == Transport::Fd { classic.over_fd() } else { classic };
    output::print(&dbc.to_string()).map(|()| Verdict::Pass)
}
