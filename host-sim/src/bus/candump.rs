//! candump logs: lines of `candump -l` or of candump's screen enter, frames with their times leave; and back.
//!
//! ```text
//! (1436509052.249713) vcan0 044#2A366C2BBA           candump -l, the form that is written
//!  (1436509052.249713)  vcan0  044   [5]  2A 36 6C 2B BA    candump's screen with -t a, or without the time
//! ```
//! Both forms may be mixed. Three digits are a standard identifier, eight an extended one. `#R` and `remote request`
//! are remote frames. CAN FD (`##`, or two digits in the brackets), CAN XL and error frames are recognised, so that a
//! log of a real bus can be read to its end, but a classic node cannot be given such frames. Direction flags (`-x`),
//! the text column (`-a`) and blank lines are skipped. Anything else is an error with its line.

mod line;
mod writer;

use crate::bus::Frame;
use crate::error::Error;
use holdover::time::Instant;
use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
pub use writer::LogWriter;

/// The longest name of a network interface in Linux.
pub const INTERFACE_CHARS: usize = 15;

/// Name of a network interface.
pub type Interface = heapless::String<INTERFACE_CHARS>;

/// One line of a log.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Entry {
    /// Time of the frame on the log's clock, by 1 µs (finer digits are cut off); `None` in the screen form without a
    /// time. Times given as differences (`-t d`) look like any others and are read as they are.
    pub at: Option<Instant>,
    /// The interface that received the frame.
    pub interface: Interface,
    /// The frame.
    pub content: Content,
}

/// The content of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Content {
    /// A classic data or remote frame.
    Frame(Frame),
    /// A CAN FD frame.
    Fd,
    /// A CAN XL frame.
    Xl,
    /// An error frame of the controller.
    ErrorFrame,
}

/// Reads a log line by line.
#[derive(Debug)]
pub struct LogReader<R> {
    file: PathBuf,
    input: R,
    line: u64,
    text: Vec<u8>,
}

impl LogReader<BufReader<File>> {
    /// Opens a log.
    ///
    /// # Errors
    /// The file cannot be opened.
    pub fn open(file: &Path) -> Result<Self, Error> {
        let input = File::open(file).map_err(|error| Error::unreadable(file, &error))?;
        Ok(Self::new(file, BufReader::with_capacity(1 << 16, input)))
    }
}

impl<R: BufRead> LogReader<R> {
    /// Reads from `input`; errors name the file.
    pub fn new(file: &Path, input: R) -> Self {
        Self { file: file.into(), input, line: 0, text: Vec::new() }
    }

    /// The number of the line that was read last, counted from 1.
    pub fn line(&self) -> u64 {
        self.line
    }

    /// Reads up to the next line that is not blank; `None` at the end.
    fn read(&mut self) -> Result<Option<Entry>, Error> {
        /// An XL frame of 2048 bytes fits; a binary file without line ends does not fill the memory.
        const LONGEST_LINE: u64 = 8192;
        loop {
            self.text.clear();
            let mut rest = (&mut self.input).take(LONGEST_LINE);
            let length = rest.read_until(b'\n', &mut self.text).map_err(|e| Error::unreadable(&self.file, &e))?;
            if length == 0 {
                return Ok(None);
            }
            self.line += 1;
            let text = std::str::from_utf8(&self.text).map_err(|_| {
                let remedy = "give a log as `candump -l` writes it";
                Error::new("is not text", remedy).in_file(&self.file).at_line(self.line)
            })?;
            if let Some(entry) = line::parse(text).map_err(|e| e.in_file(&self.file).at_line(self.line))? {
                return Ok(Some(entry));
            }
        }
    }
}

impl<R: BufRead> Iterator for LogReader<R> {
    type Item = Result<Entry, Error>;

    fn next(&mut self) -> Option<Self::Item> {
        self.read().transpose()
    }
}
