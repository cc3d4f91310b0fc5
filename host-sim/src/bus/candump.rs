//! candump logs: lines of `candump -l` or of candump's screen enter, frames with their times leave; and back.
//!
//! ```text
//! (1436509052.249713) vcan0 044#2A366C2BBA           candump -l, the form that is written
//!  (1436509052.249713)  vcan0  044   [5]  2A 36 6C 2B BA    candump's screen with -t a, or without the time
//!  (001.249713)  vcan0  044   [5]  2A 36 6C 2B BA           the same with -t z, or with -t d, whose times are summed up
//! (1436509052.249713) vcan0 044##5112233445566778899AABBCC  CAN FD, with its flags
//!  (1436509052.249713)  vcan0  044  [12]  11 22 33 44 55 66 77 88 99 AA BB CC    the same on the screen, without them
//! ```
//! Both forms may be mixed. Three digits are a standard identifier, eight an extended one. `#R` and `remote request`
//! are remote frames. CAN XL and error frames are recognised, so that a log of a real bus can be read to its end, but a
//! node cannot be given such frames. Direction flags (`-x`),
//! the text column (`-a`) and blank lines are skipped. Logs in the formats of other tools are refused by name. Anything
//! else is an error with its line.

mod clock;
mod foreign;
mod line;
mod writer;

use crate::bus::Frame;
use crate::error::Error;
use clock::Clock;
use holdover::time::Instant;
use line::Line;
use std::collections::VecDeque;
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
    /// time.
    pub at: Option<Instant>,
    /// The interface that received the frame.
    pub interface: Interface,
    /// The frame.
    pub content: Content,
}

/// The content of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Content {
    /// A frame, classic or CAN FD.
    Frame(Frame),
    /// A CAN XL frame.
    Xl,
    /// An error frame of the controller.
    ErrorFrame,
}

/// Reads a log line by line. Where the times are those of `-t z` or `-t d`, it reads up to 100 lines ahead at the
/// beginning, to tell the two apart.
#[derive(Debug)]
pub struct LogReader<R> {
    file: PathBuf,
    input: R,
    /// Number of lines that were read, and of the line that was returned last.
    read: u64,
    line: u64,
    text: Vec<u8>,
    /// Whether a line has been understood.
    has_begun: bool,
    /// The meaning of relative times, once there was one.
    clock: Option<Clock>,
    /// Lines that were read ahead, with their numbers.
    ahead: VecDeque<(u64, Result<Line, Error>)>,
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
        Self {
            file: file.into(),
            input,
            read: 0,
            line: 0,
            text: Vec::new(),
            has_begun: false,
            clock: None,
            ahead: VecDeque::new(),
        }
    }

    /// The number of the line that was returned last, counted from 1.
    pub fn line(&self) -> u64 {
        self.line
    }

    /// Reads up to the next line that is not blank; `None` at the end.
    fn read(&mut self) -> Result<Option<Line>, Error> {
        /// An XL frame of 2048 bytes fits; a binary file without line ends does not fill the memory.
        const LONGEST_LINE: u64 = 8192;
        loop {
            self.text.clear();
            let mut rest = (&mut self.input).take(LONGEST_LINE);
            let length = rest.read_until(b'\n', &mut self.text).map_err(|e| Error::unreadable(&self.file, &e))?;
            if length == 0 {
                return Ok(None);
            }
            self.read += 1;
            let text = std::str::from_utf8(&self.text)
                .map_err(|_| Error::new("is not text", "give a log as `candump -l` writes it"));
            match text.and_then(line::parse) {
                Ok(None) => {}
                Ok(line) => {
                    self.has_begun = true;
                    return Ok(line);
                }
                Err(error) => {
                    // The last line of a log that was being written when the machine stopped may end anywhere.
                    let is_cut = self.has_begun && length < LONGEST_LINE as usize && !self.text.ends_with(b"\n");
                    let error = if is_cut { line::cut_off() } else { error };
                    let foreign = if self.has_begun { None } else { foreign::named(&self.file, &self.text) };
                    return Err(foreign.unwrap_or_else(|| error.in_file(&self.file).at_line(self.read)));
                }
            }
        }
    }

    /// The next line, with its number.
    fn numbered(&mut self) -> Option<(u64, Result<Line, Error>)> {
        let line = self.read().transpose()?;
        Some((self.read, line))
    }

    /// Reads ahead from the first line with a relative time, and finds what such times mean.
    fn look_ahead(&mut self, first: (u64, Result<Line, Error>)) -> Clock {
        self.ahead.push_back(first);
        while self.ahead.len() < clock::ENOUGH && self.ahead.back().is_some_and(|(_, line)| line.is_ok()) {
            let Some(next) = self.numbered() else { break };
            self.ahead.push_back(next);
        }
        let lines = self.ahead.iter().filter_map(|(_, line)| line.as_ref().ok()).filter(|line| line.is_relative);
        Clock::of(lines.filter_map(|line| Some((line.entry.interface.as_str(), line.entry.at?))))
    }
}

impl<R: BufRead> Iterator for LogReader<R> {
    type Item = Result<Entry, Error>;

    fn next(&mut self) -> Option<Self::Item> {
        let mut next = match self.ahead.pop_front() {
            Some(next) => next,
            None => self.numbered()?,
        };
        if self.clock.is_none() && next.1.as_ref().is_ok_and(|line| line.is_relative) {
            self.clock = Some(self.look_ahead(next));
            next = self.ahead.pop_front()?;
        }
        self.line = next.0;
        Some(next.1.map(|Line { mut entry, is_relative }| {
            if let (true, Some(clock), Some(at)) = (is_relative, &mut self.clock, entry.at) {
                entry.at = Some(clock.read(at));
            }
            entry
        }))
    }
}
