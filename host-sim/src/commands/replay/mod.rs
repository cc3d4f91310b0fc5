//! `replay`: a candump log enters; the frames of a unit on that bus leave, or a summary of how it used the frames.
//!
//! ```text
//! log -> candump -> player (timeline -> tick, receive) -> candump
//!                   `-> tally -> summary
//! ```
//! The log is read and answered line by line, so it may have any length. With `--bus` its frames are sent on a CAN
//! interface instead ([`onto_bus`]).

pub mod arguments;
pub mod onto_bus;
pub mod options;
pub mod player;
pub mod summary;
pub mod tally;
pub mod timeline;

use std::io::{self, BufRead, BufWriter, ErrorKind, StdoutLock};
use std::path::Path;
use std::time;

use holdover::time::Instant;
use holdover::wire::Transport;

use crate::bus::Frame;
use crate::bus::candump::{Content, Interface, LogReader, LogWriter};
use crate::commands::ending::json;
use crate::error::{Error, quoted};
use crate::output;
use crate::verdict::Verdict;
use options::{Output, ReplayOptions};
use player::{Player, Stop};
use summary::Summary;
use tally::Tally;

/// Replays the log.
///
/// # Errors
/// A log that cannot be read or replayed, and a standard output that cannot be written.
pub fn run(options: &ReplayOptions) -> Result<Verdict, Error> {
    match &options.log {
        Some(file) => play(options, file, LogReader::open(file)?),
        None => play(options, Path::new(STDIN), LogReader::new(Path::new(STDIN), io::stdin().lock())),
    }
}

const STDIN: &str = "standard input";

fn play<R: BufRead>(options: &ReplayOptions, file: &Path, mut log: LogReader<R>) -> Result<Verdict, Error> {
    if let Output::Bus(bus) = &options.output {
        return onto_bus::replay(bus, options.interface.as_ref(), file, log);
    }
    let start = time::Instant::now();
    let compares = options.output != Output::Frames;
    let mut player = Player::new(&options.config, compares)
        .map_err(|cause| Error::new(format!("the unit refuses its configuration: {cause}"), "change the options"))?;
    if let Some(itinerary) = options.itinerary {
        player.set_out(itinerary).map_err(|cause| {
            Error::new(format!("the unit refuses the map: {cause:?}"), "report this with the scenario")
        })?;
    }
    let mut chosen = options.interface.clone();
    let (mut other, mut is_fd) = (None, false);
    let mut sink = Sink::new(options.output == Output::Frames);
    while let Some(entry) = log.next() {
        let entry = entry?;
        let interface = chosen.get_or_insert_with(|| entry.interface.clone());
        if entry.interface != *interface {
            other = Some(entry.interface);
            player.ignore();
            continue;
        }
        is_fd |= matches!(&entry.content, Content::Frame(frame) if frame.is_fd());
        match player.play(&entry, |at, frame| sink.put(interface, at, frame)) {
            Ok(()) => {}
            Err(Stop::Line(error)) => return Err(error.in_file(file).at_line(log.line())),
            Err(Stop::Output(error)) => return without_reader(&error),
        }
    }
    let interface = chosen.filter(|_| player.has_begun()).ok_or_else(|| nothing(file, options, other))?;
    let finished = player.finish(|at, frame| sink.put(&interface, at, frame)).and_then(|()| sink.finish());
    if let Err(error) = finished {
        return without_reader(&error);
    }
    let elapsed_s = start.elapsed().as_secs_f64();
    warn_of_nothing(player.tally(), is_fd && options.config.transport == Transport::Classic);
    let summary = Summary::new(player.tally(), player.has_changed().unwrap_or(false), elapsed_s);
    match options.output {
        Output::Frames | Output::Bus(_) => {}
        Output::Summary => output::print(&summary.text())?,
        Output::Json => output::print(&format!("{}\n", json(&summary)?))?,
    }
    Ok(Verdict::Pass)
}

/// Destination of the unit's frames: standard output, or none.
enum Sink {
    Nowhere,
    /// The writer; it needs the interface, which is known with the first frame.
    Stdout(Option<LogWriter<BufWriter<StdoutLock<'static>>>>),
}

impl Sink {
    fn new(prints: bool) -> Self {
        if prints { Self::Stdout(None) } else { Self::Nowhere }
    }

    fn put(&mut self, interface: &Interface, at: Instant, frame: &Frame) -> io::Result<()> {
        let Self::Stdout(writer) = self else { return Ok(()) };
        if writer.is_none() {
            *writer = LogWriter::new(BufWriter::with_capacity(1 << 16, io::stdout().lock()), interface);
        }
        writer.as_mut().map_or(Ok(()), |writer| writer.write(at, frame))
    }

    fn finish(self) -> io::Result<()> {
        let Self::Stdout(Some(writer)) = self else { return Ok(()) };
        writer.finish().map(|_| ())
    }
}

/// The end of a replay whose output failed. It passes if the reader of the output has closed it; anything else is an
/// error.
fn without_reader(error: &io::Error) -> Result<Verdict, Error> {
    match error.kind() {
        ErrorKind::BrokenPipe => Ok(Verdict::Pass),
        _ => Err(Error::unwritable(Path::new("standard output"), error)),
    }
}

/// Says so if no frame was one of the catalogue's: the log is of another bus, or of this one by other identifiers.
fn warn_of_nothing(tally: &Tally, is_fd: bool) {
    if tally.recognised().is_empty() && tally.refused().is_empty() {
        let remedy = if is_fd { "the log has CAN FD frames: give --fd" } else { "give --base-id or --place" };
        output::say(&format!("warning: none of {} frames is for the unit; {remedy}", tally.frames()));
    }
}

/// The error of a log without frames for this unit's bus.
fn nothing(file: &Path, options: &ReplayOptions, other: Option<Interface>) -> Error {
    let error = match (&options.interface, other) {
        (Some(wanted), Some(there)) => {
            let cause = format!("has no frame on interface {}", quoted(wanted));
            Error::new(cause, format!("give one that it has, such as {}", quoted(&there)))
        }
        _ => Error::new("has no frames", "give a log as `candump -l` writes it"),
    };
    error.in_file(file)
}
