//! Writes candump logs: frames with their times enter, lines as of `candump -l` leave.

use super::Interface;
use crate::bus::Frame;
use embedded_can::{Frame as _, Id};
use holdover::time::Instant;
use std::fmt::Write as _;
use std::io::{self, Write};

/// Writes a log for one interface.
#[derive(Debug)]
pub struct LogWriter<W> {
    out: W,
    interface: Interface,
    line: String,
}

impl<W: Write> LogWriter<W> {
    /// Writes to `out`, best a buffered one; `None` if that cannot be the name of an interface: 1 to 15 characters
    /// without blanks.
    #[must_use]
    pub fn new(out: W, interface: &str) -> Option<Self> {
        if interface.is_empty() || interface.contains(|c: char| c.is_whitespace() || c.is_control()) {
            return None;
        }
        Some(Self { out, interface: Interface::try_from(interface).ok()?, line: String::new() })
    }

    /// Writes one frame.
    ///
    /// # Errors
    /// The writer's.
    pub fn write(&mut self, at: Instant, frame: &Frame) -> io::Result<()> {
        self.line.clear();
        self.format(at, frame).map_err(io::Error::other)?;
        self.out.write_all(self.line.as_bytes())
    }

    /// Ends the log.
    ///
    /// # Errors
    /// What the writer still holds cannot be written.
    pub fn finish(mut self) -> io::Result<W> {
        self.out.flush()?;
        Ok(self.out)
    }

    fn format(&mut self, at: Instant, frame: &Frame) -> std::fmt::Result {
        let line = &mut self.line;
        let micros = at.as_micros();
        write!(line, "({:010}.{:06}) {} ", micros / 1_000_000, micros % 1_000_000, self.interface)?;
        match frame.id() {
            Id::Standard(id) => write!(line, "{:03X}#", id.as_raw())?,
            Id::Extended(id) => write!(line, "{:08X}#", id.as_raw())?,
        }
        match (frame.is_remote_frame(), frame.dlc()) {
            (true, 0) => line.push('R'),
            (true, dlc) => write!(line, "R{dlc}")?,
            (false, _) => frame.data().iter().try_for_each(|byte| write!(line, "{byte:02X}"))?,
        }
        line.push('\n');
        Ok(())
    }
}
