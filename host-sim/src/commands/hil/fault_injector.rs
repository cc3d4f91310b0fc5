//! The one who presses the fault buttons: a schedule and the time of the run enter; what is switched, what is spoilt and what
//! a node of ill will sends leave. A fault that has changed nothing has tested nothing, so it counts as not played, with the
//! reason.

use std::io;

use holdover::time::Duration;
use holdover::units::Position;
use holdover::wire::catalogue::{About, Content, Speaker};
use holdover::wire::motion::{Motion, WirePosition};
use holdover::wire::{BaseId, Message, Said, Sender};

use super::fault::{Fault, Kind};
use super::rig::Rig;
use super::talk::{Altered, line_of, payload};
use crate::bus::Frame;
use crate::bus::port::BusError;

/// Between two doings of it.
const EVERY: Duration = Duration::from_millis(1);
/// Frames of a babbling node in that time: as many as a bus at 500 kbit/s carries.
const BABBLE: usize = 4;
/// How far off the vehicle is by the foreign node's account, in metres.
const OFF_M: i64 = 50;

/// The presser.
pub struct FaultInjector {
    faults: Vec<Played>,
    base: BaseId,
    sender: Sender<0>,
    motion: [Option<Frame>; 2],
    /// When it next does what it does a hundred times a second.
    next_s: f64,
    /// What the harness had altered by the last look.
    altered: Altered,
}

/// A fault and what came of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Played {
    /// What was to be done.
    pub fault: Fault,
    /// How often it was: switchings, frames of the foreign node, frames that were altered.
    pub acts: u64,
    /// Why it was not done, or not all of it.
    pub failed: Option<String>,
    is_on: bool,
    /// Why the bus did not take a frame of it, the last time.
    refused: Option<String>,
}

impl Played {
    const fn new(fault: Fault) -> Self {
        Self { fault, acts: 0, failed: None, is_on: false, refused: None }
    }

    /// One act of it was done, or the bus did not take it. A full bus need not take every frame.
    fn note(&mut self, done: io::Result<()>) {
        match done {
            Ok(()) => self.acts += 1,
            Err(error) => self.refused = Some(error.to_string()),
        }
    }

    /// At the end of a run: a fault without an act was not played.
    fn ended(mut self) -> Self {
        if self.acts == 0 && self.failed.is_none() {
            let nothing = "it changed nothing while it was on".to_owned();
            self.failed = Some(self.refused.take().unwrap_or(nothing));
        }
        self
    }
}

impl FaultInjector {
    /// With these faults in mind.
    #[must_use]
    pub fn new(faults: &[Fault], base: BaseId) -> Self {
        let faults = faults.iter().copied().map(Played::new).collect();
        Self { faults, base, sender: Sender::new(base), motion: [None; 2], next_s: 0.0, altered: Altered::default() }
    }

    /// Switches what is due at that time; whether the device has got power anew.
    pub fn switch(&mut self, at_s: f64, rig: &mut dyn Rig) -> bool {
        let mut powered = false;
        for played in &mut self.faults {
            let is_on = played.fault.is_on(at_s);
            if is_on == played.is_on {
                continue;
            }
            played.is_on = is_on;
            let done = match played.fault.kind {
                Kind::Power => {
                    powered |= !is_on;
                    rig.power(!is_on)
                }
                Kind::Interface => rig.interface(!is_on),
                _ => continue,
            };
            match done {
                Ok(()) => played.acts += 1,
                Err(error) => played.failed = Some(error.to_string()),
            }
        }
        powered
    }

    /// What is still switched off is switched on.
    pub fn stop(&mut self, rig: &mut dyn Rig) {
        self.switch(f64::INFINITY, rig);
    }

    /// The faults and what came of them. In a run that was cut short, a fault may not have had its time.
    #[must_use]
    pub fn played(self, is_whole: bool) -> Vec<Played> {
        self.faults.into_iter().map(|played| if is_whole { played.ended() } else { played }).collect()
    }

    fn on(&self) -> impl Iterator<Item = Fault> + '_ {
        self.faults.iter().filter(|played| played.is_on).map(|played| played.fault)
    }

    /// What the time synchronisation is to be wrong by, in microseconds.
    #[must_use]
    pub fn clock_error_us(&self, at_s: f64) -> i64 {
        crate::sim::time::micros(self.on().map(|fault| fault.kind.clock_error_s(at_s - fault.from_s)).sum())
    }

    /// How the harness's own frames are to be spoilt.
    #[must_use]
    pub fn spoils(&self) -> Option<Kind> {
        self.on().map(|fault| fault.kind).find(|kind| matches!(kind, Kind::Corrupt | Kind::Truncate))
    }

    /// The harness has altered so much since the run began; to be told before faults are switched.
    pub fn note_altered(&mut self, altered: Altered) {
        let (frames, times) = (altered.frames - self.altered.frames, altered.times - self.altered.times);
        self.altered = altered;
        let spoils = self.spoils();
        for played in self.faults.iter_mut().filter(|played| played.is_on) {
            played.acts += match played.fault.kind {
                // Of two that are on, one spoils.
                kind if Some(kind) == spoils => frames,
                Kind::ClockStep(_) | Kind::ClockDrift(_) => times,
                _ => 0,
            };
        }
    }

    /// The harness has sent a frame.
    pub fn overhear(&mut self, frame: &Frame) {
        match line_of(self.base, frame).map(|line| line.content) {
            Some(Content::Said(Speaker::Ego, About::MotionA)) => self.motion[0] = Some(*frame),
            Some(Content::Said(Speaker::Ego, About::MotionB)) => self.motion[1] = Some(*frame),
            _ => {}
        }
    }

    /// Does what it does all the while; how soon again. What the bus does not take is lost.
    pub fn act(&mut self, at_s: f64, rig: &mut dyn Rig) -> Option<Duration> {
        let is_due = at_s >= self.next_s;
        if is_due {
            self.next_s = at_s + 0.01;
        }
        let lies = if is_due && self.on().any(|fault| fault.kind == Kind::Foreign) { self.lies() } else { Vec::new() };
        let mut acts_on = false;
        for played in self.faults.iter_mut().filter(|played| played.is_on) {
            let frames = match played.fault.kind {
                Kind::Babble => Frame::standard(0, &[0xFF; 8]).into_iter().cycle().take(BABBLE).collect(),
                Kind::Foreign => lies.clone(),
                Kind::Errors => Vec::new(),
                _ => continue,
            };
            acts_on = true;
            let is_error = is_due && played.fault.kind == Kind::Errors;
            if played.failed.is_some() || (frames.is_empty() && !is_error) {
                continue;
            }
            match rig.injector() {
                Ok(port) => {
                    frames.into_iter().for_each(|frame| played.note(port.send(frame)));
                    if is_error {
                        played.note(port.send_error(BusError::NO_ACKNOWLEDGEMENT));
                    }
                }
                Err(error) => played.failed = Some(error.to_string()),
            }
        }
        acts_on.then_some(EVERY)
    }

    /// The vehicle's motion, somewhere else; well protected, with counters of its own.
    fn lies(&mut self) -> Vec<Frame> {
        let [Some(a), Some(b)] = self.motion else { return Vec::new() };
        let truth = Motion::decode(&[payload(&a), payload(&b)]);
        let position = truth.position.nearest_to(Position::default()).get().to_num::<i64>() + OFF_M;
        let lie = Motion { position: WirePosition::from_mm(position * 1000), ..truth };
        let mut frames = Vec::new();
        let sent = self.sender.send(&Message::Ego(Said::Motion(lie)), &mut |frame| frames.push((&frame).into()));
        debug_assert!(sent.is_ok(), "the catalogue has a line for the ego's motion");
        frames
    }
}
