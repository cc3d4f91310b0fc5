//! Records the logs for the ECU: scenarios enter; for each leaves its log, and what a unit on this host sends when it lives through it.
//! Given what the ECU sent, it holds the two against one another, frame by frame.
//!
//! `holdover-log record FOLDER` writes `log.bin` and `host.bin` into `FOLDER/string` and `FOLDER/corridor`;
//! `holdover-log compare HOST ECU` fails at the first frame that differs.

mod corridor;
mod life;
mod string;

use std::error::Error;
use std::path::{Path, PathBuf};
use std::{env, fs};

use embedded_can::{Frame as _, Id};
use holdover::time::{Duration, Instant};
use holdover::wire::Identifiers;
use holdover::wire::catalogue::{self, Line, Node};
use holdover_replay::{Event, Frame, Head, RECORD, Room, decode, encode};
use life::Life;

/// The clock of the unit when the run begins.
const START: Instant = Instant::from_micros(60_000_000);

/// A log: what a unit has from the beginning, and what happens to it.
struct Log {
    head: Head,
    events: Vec<(Instant, Event)>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<_> = env::args().skip(1).collect();
    match &arguments[..] {
        [verb, folder] if verb == "record" => {
            let folder = Path::new(folder);
            let (log, life) = string::record()?;
            write(&folder.join("string"), &log, &life)?;
            let (log, life) = corridor::record()?;
            write(&folder.join("corridor"), &log, &life)
        }
        [verb, host, ecu] if verb == "compare" => compare(&PathBuf::from(host), &PathBuf::from(ecu)),
        _ => Err("usage: holdover-log record FOLDER | holdover-log compare HOST ECU".into()),
    }
}

fn write(folder: &Path, log: &Log, life: &Life) -> Result<(), Box<dyn Error>> {
    let mut bytes = log.head_bytes()?;
    bytes.extend(log.events.iter().flat_map(|(at, event)| encode(*at, event)));
    fs::create_dir_all(folder)?;
    fs::write(folder.join("log.bin"), bytes)?;
    fs::write(folder.join("host.bin"), &life.sent)?;
    let frames = log.events.iter().filter(|(_, event)| *event != Event::Tick).count();
    let ticks = log.events.len() - frames;
    println!("{}: {ticks} ticks, {frames} frames, {life}", folder.file_name().unwrap_or_default().display());
    Ok(())
}

impl Log {
    /// The head as it stands in the file. What the ECU makes of it has to be the head again.
    fn head_bytes(&self) -> Result<Vec<u8>, Box<dyn Error>> {
        let mut words = Vec::new();
        self.head.put(&mut |word| words.push(word));
        let mut left = words.iter().copied();
        let taken = Head::take(&mut || left.next(), Box::leak(Box::new(Room::new())));
        if taken != Some(self.head) {
            return Err(format!("{:?} is not what its words say: {taken:?}", self.head).into());
        }
        Ok(words.into_iter().flat_map(i64::to_le_bytes).collect())
    }
}

/// The instant of the unit's clock at a time of the run.
fn instant(at_s: f64) -> Instant {
    START.plus(Duration::from_micros(holdover_sim::sim::time::micros(at_s)))
}

/// A frame of a bus as an event.
fn heard(frame: &holdover_sim::bus::Frame) -> Event {
    let mut data = [0; 8];
    data.iter_mut().zip(frame.data()).for_each(|(place, byte)| *place = *byte);
    Event::Frame(Frame { id: frame.id(), length: frame.data().len() as u8, data })
}

/// Whether it is what the unit of the simulation itself sent.
fn is_of_the_unit(id: Id) -> bool {
    line(id).is_some_and(|line| line.sender == Node::Unit)
}

fn line(id: Id) -> Option<&'static Line> {
    let (_, line, _) = catalogue::find(Identifiers::DEFAULT.offset_of(id.into())?)?;
    Some(line)
}

fn compare(host: &Path, ecu: &Path) -> Result<(), Box<dyn Error>> {
    let (host, ecu) = (fs::read(host)?, fs::read(ecu)?);
    let (expected, got) = (host.chunks(RECORD), ecu.chunks(RECORD));
    let frames = expected.len();
    if let Some((place, (expected, got))) = expected.zip(got).enumerate().find(|(_, (expected, got))| expected != got) {
        let shown = |record: &[u8]| format!("{:x?}", record.try_into().ok().and_then(decode));
        return Err(format!("frame {place} differs: {} on the host, {} on the ECU", shown(expected), shown(got)).into());
    }
    if host.len() != ecu.len() {
        return Err(format!("{frames} frames on the host, {} on the ECU", ecu.len() / RECORD).into());
    }
    println!("{frames} frames, all the same");
    Ok(())
}
