//! `replay --bus`: a candump log enters, its frames leave on a CAN interface with the log's timing.

use std::io::BufRead;
use std::path::Path;

use holdover::time::{Duration, Instant};

use super::timeline::Timeline;
use crate::bus::candump::{Content, Entry, Interface, LogReader};
use crate::bus::{self, Port};
use crate::error::Error;
use crate::output;
use crate::verdict::Verdict;

/// Replays the log on an interface.
pub(super) fn replay<R: BufRead>(
    bus: &str,
    interface: Option<&Interface>,
    file: &Path,
    log: LogReader<R>,
) -> Result<Verdict, Error> {
    let mut port = bus::open(bus)?;
    let Sent { frames, latest } = play(&mut port, interface, file, log)?;
    let latest_ms = latest.as_micros() as f64 * 1e-3;
    output::say(&format!("{frames} frames sent, the latest {latest_ms:.1} ms after its time"));
    Ok(Verdict::Pass)
}

/// The frames that were sent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sent {
    /// Number of frames.
    pub frames: u64,
    /// Largest delay of a frame behind its time.
    pub latest: Duration,
}

/// Sends the frames of one interface of the log, by default that of its first line. The first frame is sent now.
///
/// # Errors
/// A log that cannot be read or replayed or has no frame of that interface, and a port that cannot send.
pub fn play<R: BufRead>(
    port: &mut impl Port,
    interface: Option<&Interface>,
    file: &Path,
    mut log: LogReader<R>,
) -> Result<Sent, Error> {
    let mut chosen = interface.cloned();
    let mut timeline = Timeline::new(Duration::from_millis(1));
    let mut start = None;
    let mut sent = Sent { frames: 0, latest: Duration::ZERO };
    while let Some(entry) = log.next() {
        let Entry { at, interface, content } = entry?;
        if *chosen.get_or_insert_with(|| interface.clone()) != interface {
            continue;
        }
        let in_line = |error: Error| error.in_file(file).at_line(log.line());
        let at = at.ok_or_else(|| in_line(super::player::no_time()))?;
        timeline.read(at).map_err(in_line)?;
        let Content::Frame(frame) = content else { continue };
        let (log_start, port_start) = *start.get_or_insert_with(|| (at, port.now()));
        let due = port_start.plus(at.since(log_start));
        wait(port, due).and_then(|()| port.send(frame)).map_err(|error| unsent(&error))?;
        sent.frames += 1;
        sent.latest = sent.latest.max(port.now().since(due));
    }
    if sent.frames == 0 {
        return Err(Error::new("has no frames to send", "name an interface of the log by --interface").in_file(file));
    }
    Ok(sent)
}

/// Waits until `until`, whatever happens on the bus.
fn wait(port: &mut impl Port, until: Instant) -> std::io::Result<()> {
    while port.now() < until {
        port.wait(until)?;
    }
    Ok(())
}

fn unsent(error: &std::io::Error) -> Error {
    Error::new(format!("the interface takes no frame ({error})"), "see whether it is up, and its bus terminated")
        .in_option("--bus")
}
