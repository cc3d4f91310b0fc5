//! `record`: the events on a CAN interface enter, a candump log with the kernel's time stamps leaves.

pub mod arguments;

use std::fmt;
use std::fs::File;
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};

use holdover::time::{Duration, Instant};

use crate::bus;
use crate::bus::candump::LogWriter;
use crate::bus::port::{Event, Port};
use crate::commands::interruption::Interruption;
use crate::error::Error;
use crate::output;
use crate::places::can_be_file;
use crate::sim::quantities::duration;
use crate::verdict::Verdict;
use arguments::RecordArguments;

/// Time between two checks of the end, and between two flushes of the log.
const PAUSE: Duration = Duration::from_millis(100);

/// A recording.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordOptions {
    /// The interface.
    pub interface: String,
    /// The log; `None`: standard output.
    pub file: Option<PathBuf>,
    /// Length of the recording; `None`: until it is interrupted.
    pub length: Option<Duration>,
}

impl RecordOptions {
    /// Checks the arguments.
    ///
    /// # Errors
    /// Impossible values.
    pub fn read(arguments: RecordArguments) -> Result<Self, Error> {
        let RecordArguments { bus, out, duration: length_s } = arguments;
        if let Some(file) = &out {
            can_be_file("--out", file, &[])?;
        }
        if let Some(length_s) = length_s.filter(|length_s| !(0.001..=1e6).contains(length_s)) {
            return Err(Error::new(format!("is {length_s}"), "give seconds from 0.001 to 1e6").in_option("--duration"));
        }
        Ok(Self { interface: bus, file: out, length: length_s.map(duration) })
    }
}

/// Records until the end: of the time, or by SIGINT or SIGTERM.
///
/// # Errors
/// An interface that cannot be used, and a log that cannot be written.
pub fn run(options: &RecordOptions) -> Result<Verdict, Error> {
    let interruption = Interruption::awaited()?;
    let mut port = bus::open(&options.interface)?;
    let (name, out): (&Path, Box<dyn Write>) = match &options.file {
        Some(file) => (file, Box::new(File::create(file).map_err(|error| Error::unwritable(file, &error))?)),
        None => (Path::new("standard output"), Box::new(io::stdout().lock())),
    };
    let log = LogWriter::new(BufWriter::new(out), &options.interface)
        .ok_or_else(|| Error::new("is no name of an interface", "name one, such as vcan0").in_option("--bus"))?;
    let until = options.length.map(|length| port.now().plus(length));
    match record(&mut port, log, until, &interruption) {
        Ok(recorded) => output::say(&recorded.to_string()),
        Err(Failure::Log(error)) if error.kind() == ErrorKind::BrokenPipe => {}
        Err(Failure::Log(error)) => return Err(Error::unwritable(name, &error)),
        Err(Failure::Port(error)) => {
            let remedy = "see whether it is still there: ip -details link";
            return Err(Error::new(format!("the interface failed: {error}"), remedy).in_option("--bus"));
        }
    }
    Ok(Verdict::Pass)
}

/// What can end a recording early.
#[derive(Debug)]
pub enum Failure {
    /// The interface was removed.
    Port(io::Error),
    /// The log cannot be written.
    Log(io::Error),
}

/// Number of frames in a recording.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Recorded {
    /// All frames, error frames among them.
    pub frames: u64,
    /// Those of CAN FD.
    pub fd: u64,
}

impl fmt::Display for Recorded {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} frames recorded", self.frames)?;
        if self.fd > 0 { write!(f, ", {} of them CAN FD", self.fd) } else { Ok(()) }
    }
}

/// Records the events until `until`, or until it is interrupted. However it ends, the log is complete up to a tenth of a
/// second before.
///
/// # Errors
/// Errors of the port and of the log.
pub fn record(
    port: &mut impl Port,
    mut log: LogWriter<impl Write>,
    until: Option<Instant>,
    interruption: &Interruption,
) -> Result<Recorded, Failure> {
    let (mut recorded, mut flushed) = (Recorded::default(), port.now());
    loop {
        let now = port.now();
        if now.since(flushed) >= PAUSE {
            log.flush().map_err(Failure::Log)?;
            flushed = now;
        }
        if interruption.is_asked() || until.is_some_and(|until| until <= now) {
            log.finish().map_err(Failure::Log)?;
            return Ok(recorded);
        }
        let pause = now.plus(PAUSE);
        match port.wait(until.map_or(pause, |until| until.min(pause))).map_err(Failure::Port)? {
            Some((at, Event::Sent(frame) | Event::Received(frame))) => {
                log.write(at, &frame).map_err(Failure::Log)?;
                recorded.fd += u64::from(frame.is_fd());
            }
            Some((at, Event::Error(error))) => log.write_error(at, &error).map_err(Failure::Log)?,
            Some((_, Event::Down)) => {
                output::say("the interface is down; going on when it is up");
                continue;
            }
            None => continue,
        }
        recorded.frames += 1;
    }
}
