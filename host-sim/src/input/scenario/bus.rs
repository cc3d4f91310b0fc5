//! The section `[bus]`: its key enters; the kind of every vehicle's own bus leaves.

use holdover::wire::Transport;

use super::keys::Section;
use crate::error::Error;

/// Reads the section; classic CAN by default.
pub fn read(mut section: Section) -> Result<Transport, Error> {
    const KEY: &str = "kind";
    let transport = match section.value(KEY) {
        None => Transport::Classic,
        Some(value) => match value.get_ref().as_str() {
            Some("classic") => Transport::Classic,
            Some("fd") => Transport::Fd,
            _ => return Err(section.mismatch(KEY, value, "\"classic\" or \"fd\"")),
        },
    };
    section.finish()?;
    Ok(transport)
}
