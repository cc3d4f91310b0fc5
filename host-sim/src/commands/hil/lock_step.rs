//! A run in lock step: device and twin get the same frames and the same time, step by step, and have to send the same
//! frames, bit for bit. A setup, a port and a rig enter; the outcome leaves.
//!
//! A step has three parts: the world's frames to the device; then a `Sync` and a `FollowUp` that date the step; then
//! the device's whole answer, as many frames as the twin's. The world goes on when the answer is there, as fast as the
//! device answers.

use std::collections::VecDeque;
use std::io;

use embedded_can::Frame as _;
use holdover::LockStep;
use holdover::time::{Duration, Instant};
use holdover::wire::catalogue::{Content, Node};
use holdover::wire::command::Command;
use holdover::wire::sync::{FollowUp, Sync};
use holdover::wire::{Identifiers, Message, Sender};

use super::content::{line_of, payloads};
use super::deviation::Deviation;
use super::lateness::Lateness;
use super::monitor::Monitor;
use super::outcome::{Cut, Outcome, Steps};
use super::record::Record;
use super::rig::Rig;
use super::session::Setup;
use super::talk::Talk;
use crate::bus::memory::MemoryNode;
use crate::bus::port::{Event, Port};
use crate::bus::{Bus, Frame};
use crate::sim::stages::Stages;
use crate::sim::time::{EPOCH_US, micros};
use crate::sim::vehicle::Unit;
use crate::sim::world::{WARM_UP_S, World};

/// Longest time of an answer.
const PATIENCE: Duration = Duration::from_millis(2000);
/// Time between two pairs of `Sync` and `FollowUp` while no device has answered.
const PROBE_EVERY: Duration = Duration::from_millis(200);

/// The device's side of the run.
struct Bench<P> {
    talk: Talk<P>,
    seat: MemoryNode,
    identifiers: Identifiers,
    sender: Sender<0>,
    sequence: u8,
    twin: (Unit, LockStep),
    monitor: Monitor,
    steps: Steps,
    foreign: u64,
    bus_errors: u64,
    /// Time at which the last step was on the bus.
    asked: Option<Instant>,
    answer: VecDeque<(Instant, Frame)>,
}

/// Runs the setup. `progress` gets the time of the run from time to time.
///
/// # Errors
/// Errors of the port. A configuration that the unit refuses counts as one.
pub fn run<P: Port>(setup: &Setup, port: P, rig: &mut dyn Rig, mut progress: impl FnMut(f64)) -> io::Result<Outcome> {
    let Setup { scenario, config, .. } = setup;
    let mut world = World::new(scenario, scenario.seed, None).map_err(io::Error::other)?;
    let mut bench = Bench {
        talk: Talk::new(port, config.identifiers),
        seat: world.give_seat(scenario.ego, setup.alias()),
        identifiers: config.identifiers,
        sender: Sender::new(config.identifiers).over(config.transport),
        sequence: 0,
        twin: (Unit::new(config).map_err(io::Error::other)?, LockStep::new()),
        monitor: Monitor::new(config.identifiers, config.period).over(config.transport),
        steps: Steps::default(),
        foreign: 0,
        bus_errors: 0,
        asked: None,
        answer: VecDeque::new(),
    };
    bench.talk.dates = false; // the time of a step is that of the world
    let mut record = Record::of(&world, setup, true);
    rig.power(true)?;
    let warm_up = i64::from(world.warm_up_ticks(WARM_UP_S));
    let ticks = i64::try_from(world.ticks()).unwrap_or(i64::MAX);
    let time = |tick: i64| tick as f64 * scenario.period_s;
    let mut cut = bench.find(setup, time(-warm_up - 1), rig)?;
    let begun = bench.talk.now();
    for tick in -warm_up..ticks {
        if cut.is_some() {
            break;
        }
        let at_s = time(tick);
        if tick == 0 {
            world.begin()?;
        }
        if tick < 0 {
            world.approach(at_s)?
        } else {
            world.speak(at_s)?
        }
        let own = world.vehicles()[scenario.ego].instant(at_s);
        let mut frames = Vec::new();
        while let Some((_, frame)) = bench.seat.receive(own)? {
            // The pair of the step replaces that of the vehicle.
            let content = line_of(&bench.identifiers, &frame).map(|line| line.content);
            if !matches!(content, Some(Content::Sync | Content::FollowUp)) {
                frames.push(frame);
            }
        }
        let pair = bench.pair(at_s);
        frames.extend(pair);
        if !bench.step(at_s, &frames, own)? {
            cut = Some(Cut::Gone { at_s, ended: rig.has_ended() });
            break;
        }
        if tick < 0 {
            world.answer(at_s)?;
        } else {
            world.act(at_s)?;
            record.note(&world, at_s)?;
            world.drive(at_s)?;
        }
        if tick % 100 == 0 {
            progress(at_s);
        }
    }
    let took_s = bench.talk.now().since(begun).as_micros() as f64 * 1e-6;
    let realtime_factor = time(record.ticks()) / took_s.max(1e-6);
    rig.power(false)?;
    Ok(Outcome {
        recorded: record.finish(world, realtime_factor)?,
        monitor: bench.monitor,
        deviation: Deviation::new(config.period),
        steps: Some(bench.steps),
        lateness: Lateness::default(),
        counts: bench.talk.counts(),
        foreign: bench.foreign,
        bus_errors: bench.bus_errors,
        origin: Instant::from_micros(0),
        faults: Vec::new(),
        cut,
    })
}

impl<P: Port> Bench<P> {
    /// The two frames that date a step.
    fn pair(&mut self, at_s: f64) -> Vec<Frame> {
        self.sequence = (self.sequence + 1) % 16;
        let (sequence, time) = (self.sequence, EPOCH_US.saturating_add_signed(micros(at_s)));
        let (seconds, micros) = ((time / 1_000_000) as u32, (time % 1_000_000) as u32);
        let mut frames = Vec::new();
        for message in [Message::Sync(Sync { sequence, seconds }), Message::FollowUp(FollowUp { sequence, micros })] {
            let sent = self.sender.send(&message, &mut |frame| frames.push((&frame).into()));
            sent.expect("the catalogue has a line for each step of the time synchronisation");
        }
        frames
    }

    /// Looks for a device by sending pairs of the same time. The count in its first answer is the number of pairs that
    /// it has seen, and its twin gets as many.
    fn find(&mut self, setup: &Setup, at_s: f64, rig: &mut dyn Rig) -> io::Result<Option<Cut>> {
        let end = self.talk.now().plus(setup.wait);
        let mut probes: Vec<Vec<Frame>> = Vec::new();
        while self.talk.now() < end {
            let pair = self.pair(at_s);
            probes.push(pair.clone());
            pair.into_iter().for_each(|frame| self.talk.send(frame));
            let until = self.talk.now().plus(PROBE_EVERY);
            self.listen(until, usize::MAX)?;
            if let Some(first) = self.answer.iter().find_map(|(_, frame)| command(&self.identifiers, frame)) {
                let seen = usize::from(first.tick);
                // The answers to all pairs that the device has seen have arrived, or are on their way.
                self.listen(self.talk.now().plus(PROBE_EVERY), usize::MAX)?;
                let answers = self.answer.iter().filter_map(|(_, frame)| command(&self.identifiers, frame)).count();
                let Some(unseen) = probes.len().checked_sub(seen + answers - 1).filter(|_| seen == 1) else {
                    return Ok(Some(Cut::NotFresh { tick: first.tick }));
                };
                let probes: Vec<Frame> = probes.into_iter().skip(unseen).flatten().collect();
                let expected = self.twin(&probes);
                self.compare(at_s, &expected);
                return Ok(None);
            }
            if let Some(ended) = rig.has_ended() {
                return Ok(Some(Cut::Silent { waited: setup.wait, ended: Some(ended) }));
            }
        }
        Ok(Some(Cut::Silent { waited: setup.wait, ended: None }))
    }

    /// One step. Returns whether the device answered at all.
    fn step(&mut self, at_s: f64, frames: &[Frame], own: Instant) -> io::Result<bool> {
        frames.iter().for_each(|frame| self.talk.send(*frame));
        let expected = self.twin(frames);
        self.listen(self.talk.now().plus(PATIENCE), expected.len())?;
        let has_answered = !self.answer.is_empty();
        for (_, frame) in &self.answer {
            self.seat.send(own, *frame)?;
        }
        self.steps.steps += 1;
        self.compare(at_s, &expected);
        Ok(has_answered)
    }

    /// The twin's answer to these frames.
    fn twin(&mut self, frames: &[Frame]) -> Vec<Frame> {
        let (unit, shell) = &mut self.twin;
        let answers = frames.iter().filter_map(|frame| shell.receive(unit, frame));
        answers.flat_map(|answer| answer.frames.iter().map(Frame::from).collect::<Vec<_>>()).collect()
    }

    /// Listens until `until`, or until the device has sent `enough` frames and everything is sent.
    fn listen(&mut self, until: Instant, enough: usize) -> io::Result<()> {
        while self.talk.now() < until && (self.answer.len() < enough || !self.talk.is_idle()) {
            let Self { talk, identifiers, answer, monitor, foreign, bus_errors, asked, .. } = self;
            let mut is_enough = false;
            let pause = talk.now().plus(Duration::from_millis(if answer.len() + 1 >= enough { 1 } else { 5 }));
            talk.pump_while(until.min(pause), |at, event| {
                match event {
                    Event::Sent(frame) => {
                        if line_of(identifiers, &frame).is_some_and(|line| line.content == Content::FollowUp) {
                            *asked = Some(at);
                        }
                    }
                    Event::Received(frame) => match line_of(identifiers, &frame) {
                        Some(line) if line.sender == Node::Unit => {
                            if let Some(asked) = asked.take_if(|_| line.content == Content::Command) {
                                monitor.ask(asked);
                            }
                            monitor.hear(at, &frame);
                            answer.push_back((at, frame));
                            is_enough = answer.len() >= enough;
                        }
                        line => *foreign += u64::from(line.is_some()),
                    },
                    Event::Error(_) => *bus_errors += 1,
                    Event::Down => {}
                }
                !is_enough
            })?;
        }
        Ok(())
    }

    /// Compares the answer with the expected one, frame by frame, and clears it.
    fn compare(&mut self, at_s: f64, expected: &[Frame]) {
        let mut got = self.answer.drain(..);
        for expected in expected {
            self.steps.frames += 1;
            let got = got.next().map(|(_, frame)| frame);
            if got != Some(*expected) {
                self.steps.different += 1;
                self.steps.first.get_or_insert_with(|| {
                    (at_s, got.map_or("nothing".into(), |frame| spelled(&frame)), spelled(expected))
                });
            }
        }
        for (_, more) in got {
            self.steps.frames += 1;
            self.steps.different += 1;
            self.steps.first.get_or_insert_with(|| (at_s, spelled(&more), "nothing".into()));
        }
    }
}

/// The command in a frame, without a check of its counter.
fn command(identifiers: &Identifiers, frame: &Frame) -> Option<Command> {
    let line = line_of(identifiers, frame)?;
    let [payload, _] = payloads(identifiers, frame);
    (line.content == Content::Command).then(|| Command::decode(&[payload]))
}

fn spelled(frame: &Frame) -> String {
    let id = match frame.id() {
        embedded_can::Id::Standard(id) => format!("{:03X}", id.as_raw()),
        embedded_can::Id::Extended(id) => format!("{:08X}", id.as_raw()),
    };
    frame.data().iter().fold(id + "#", |text, byte| text + &format!("{byte:02X}"))
}
