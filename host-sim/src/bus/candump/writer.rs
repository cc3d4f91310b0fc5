//! Writes candump logs: frames with their times enter, lines in the form of `candump -l` leave.

use super::Interface;
use crate::bus::Frame;
use crate::bus::port::BusError;
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
    /// A log that is written to `out`, which should be buffered. `None` if `interface` is not a possible name of an
    /// interface: 1 to 15 characters without blanks.
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
    /// Errors of the writer.
    pub fn write(&mut self, at: Instant, frame: &Frame) -> io::Result<()> {
        self.line.clear();
        self.format(at, frame).map_err(io::Error::other)?;
        self.out.write_all(self.line.as_bytes())
    }

    /// Writes one error frame.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn write_error(&mut self, at: Instant, error: &BusError) -> io::Result<()> {
        const ERROR_FLAG: u32 = 0x2000_0000;
        self.line.clear();
        self.begin(at).map_err(io::Error::other)?;
        write!(self.line, "{:08X}#", error.classes | ERROR_FLAG).map_err(io::Error::other)?;
        error.data.iter().try_for_each(|byte| write!(self.line, "{byte:02X}")).map_err(io::Error::other)?;
        self.line.push('\n');
        self.out.write_all(self.line.as_bytes())
    }

    /// Writes what is still buffered.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }

    /// Ends the log.
    ///
    /// # Errors
    /// The buffered rest cannot be written.
    pub fn finish(mut self) -> io::Result<W> {
        self.out.flush()?;
        Ok(self.out)
    }

    fn begin(&mut self, at: Instant) -> std::fmt::Result {
        let micros = at.as_micros();
        write!(self.line, "({:010}.{:06}) {} ", micros / 1_000_000, micros % 1_000_000, self.interface)
    }

    fn identify(&mut self, id: Id) -> std::fmt::Result {
        match id {
            Id::Standard(id) => write!(self.line, "{:03X}#", id.as_raw()),
            Id::Extended(id) => write!(self.line, "{:08X}#", id.as_raw()),
        }
    }

    fn format(&mut self, at: Instant, frame: &Frame) -> std::fmt::Result {
        self.begin(at)?;
        self.identify(frame.id())?;
        let line = &mut self.line;
        if frame.is_fd() {
            write!(line, "#{:X}", frame.flags())?;
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
