//! Records a log for the ECU: a scenario enters; the log, and what a unit on this host sends when it lives through it, leave.
//! Given what the ECU sent, it holds the two against one another, frame by frame.
//!
//! `holdover-log record FOLDER` writes `log.bin`, `host-8-8-400.bin` and `host-3-4-100.bin`;
//! `holdover-log compare HOST ECU` fails at the first frame that differs.

use std::collections::BTreeSet;
use std::error::Error;
use std::path::{Path, PathBuf};
use std::{env, fs};

use embedded_can::{Frame as _, Id};
use holdover::OnboardUnit;
use holdover::time::{Duration, Instant};
use holdover::wire::Identifiers;
use holdover::wire::catalogue::{self, Content, Node, Speaker};
use holdover_replay::{Event, Frame, RECORD, config, decode, encode, live, refusals};
use holdover_sim::bus::Bus;
use holdover_sim::bus::fault::{FaultModel, Faults};
use holdover_sim::bus::memory::MemoryBus;
use holdover_sim::input::scenario::{Overrides, Scenario};
use holdover_sim::sim::world::World;

/// The clock of the unit when the run begins.
const START: Instant = Instant::from_micros(30_000_000);
const PERIOD: Duration = Duration::from_millis(10);

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<_> = env::args().skip(1).collect();
    match &arguments[..] {
        [verb, folder] if verb == "record" => record(Path::new(folder)),
        [verb, host, ecu] if verb == "compare" => compare(&PathBuf::from(host), &PathBuf::from(ecu)),
        _ => Err("usage: holdover-log record FOLDER | holdover-log compare HOST ECU".into()),
    }
}

fn record(folder: &Path) -> Result<(), Box<dyn Error>> {
    let events = events()?;
    let log: Vec<u8> = events.iter().flat_map(|(at, event)| encode(*at, event)).collect();
    fs::write(folder.join("log.bin"), &log)?;
    let frames = events.iter().filter(|(_, event)| *event != Event::Tick).count();
    println!("log: {} ticks, {frames} frames, {} s", events.len() - frames, (events.len() - frames) / 100);
    fs::write(folder.join("host-8-8-400.bin"), sent::<8, 8, 400>(&events)?)?;
    fs::write(folder.join("host-3-4-100.bin"), sent::<3, 4, 100>(&events)?)?;
    Ok(())
}

/// The bus of the ego in the scenario, behind faults, with the ticks.
fn events() -> Result<Vec<(Instant, Event)>, Box<dyn Error>> {
    let file = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/replay.toml"));
    let scenario = Scenario::read(Some(file), &Overrides::default()).map_err(|error| error.to_string())?;
    let world = World::new(&scenario, scenario.seed, Some(scenario.ego))?;
    let trace = world.run(|_| ())?;
    let bus = MemoryBus::new();
    let (mut sender, receiver) = (bus.node(), bus.node());
    let model = FaultModel {
        drop: 0.01,
        corrupt: 0.01,
        duplicate: 0.01,
        delay: 0.02,
        longest_delay: Duration::from_millis(30),
    };
    let mut receiver = Faults::new(receiver, model, scenario.seed, 0);
    let mut end = 0.0f64;
    for (at_s, frame) in &trace.log {
        end = end.max(*at_s);
        if is_for_the_unit(&frame.id()) && !is_silenced(*at_s, &frame.id()) {
            sender.send(START.plus(Duration::from_micros((at_s * 1e6).round() as i64)), *frame)?;
        }
    }
    let mut events = Vec::new();
    let mut now = START.minus(Duration::from_millis(1_000));
    let last = START.plus(Duration::from_micros((end * 1e6) as i64));
    while now <= last {
        // A tick begins some microseconds after its period, never the same.
        now = now.plus(PERIOD);
        let jitter = Duration::from_micros((now.as_micros() / 10_000 % 7) as i64);
        while let Some((at, frame)) = receiver.receive(now.plus(jitter))? {
            let mut data = [0; 8];
            data.iter_mut().zip(frame.data()).for_each(|(place, byte)| *place = *byte);
            events.push((at, Event::Frame(Frame { id: frame.id(), length: frame.data().len() as u8, data })));
        }
        events.push((now.plus(jitter), Event::Tick));
    }
    Ok(events)
}

/// All but what the unit of the simulation itself sent.
fn is_for_the_unit(id: &Id) -> bool {
    line(id).is_none_or(|line| line.sender != Node::Unit)
}

/// For a while the ego's own motion is missing, and at the end the driver's request.
fn is_silenced(at_s: f64, id: &Id) -> bool {
    let is_own = line(id).is_some_and(|line| matches!(line.content, Content::Said(Speaker::Ego, _)));
    is_own && (50.0..50.4).contains(&at_s)
}

fn line(id: &Id) -> Option<&'static catalogue::Line> {
    let (_, line, _) = catalogue::find(Identifiers::DEFAULT.offset_of((*id).into())?)?;
    Some(line)
}

/// All that a unit sends. It has to pass through every mode, and to have something to refuse, or the log shows little.
fn sent<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
    events: &[(Instant, Event)],
) -> Result<Vec<u8>, Box<dyn Error>> {
    let mut unit = Box::new(OnboardUnit::<PEERS, SAMPLES, STEPS>::new(&config(STEPS))?);
    let mut bytes = Vec::new();
    let mut modes = BTreeSet::new();
    for (at, event) in events {
        live(&mut unit, *at, event, |record| bytes.extend(record));
        modes.insert(format!("{:?}", unit.mode().code()));
    }
    println!(
        "OnboardUnit<{PEERS}, {SAMPLES}, {STEPS}>: {} frames, {} refusals, modes {modes:?}",
        bytes.len() / RECORD,
        unit.health().total()
    );
    if modes.len() < 5 || unit.health().total() == 0 {
        return Err("the log does not lead through all modes, or nothing in it is refused".into());
    }
    bytes.extend(refusals(&unit).flatten());
    Ok(bytes)
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
