//! The fault injector: a schedule and the time of the run enter; switchings, altered frames and the frames of a hostile
//! node leave. A fault that has changed nothing has tested nothing, so it counts as not played, with the reason.

use std::io;

use holdover::time::Duration;
use holdover::units::Position;
use holdover::wire::motion::{Motion, WirePosition};
use holdover::wire::{Identifiers, Message, Said, Sender, Transport};

use super::content::EgoMotion;
use super::fault::{Fault, Kind};
use super::rig::Rig;
use super::talk::Altered;
use crate::bus::Frame;
use crate::bus::port::BusError;

/// Time between two bursts of a fault.
const EVERY: Duration = Duration::from_millis(1);
/// Frames of a babbling node in that time: as many as a bus at 500 kbit/s carries.
const BABBLE: usize = 4;
/// Distance from the vehicle's true position to the one that the foreign node sends, in metres.
const OFF_M: i64 = 50;

/// The fault injector.
pub struct FaultInjector {
    faults: Vec<Played>,
    identifiers: Identifiers,
    sender: Sender<0>,
    motion: EgoMotion,
    truth: Option<Motion>,
    /// Time of the next act of a fault that acts a hundred times a second.
    next_s: f64,
    /// Frames that the harness had altered at the last check.
    altered: Altered,
}

/// A fault and its effect.
#[derive(Clone, Debug, PartialEq)]
pub struct Played {
    /// The fault.
    pub fault: Fault,
    /// Number of acts: switchings, frames of the foreign node, altered frames.
    pub acts: u64,
    /// Why the fault was not injected, or not completely.
    pub failed: Option<String>,
    is_on: bool,
    /// The last reason why the bus refused one of its frames.
    refused: Option<String>,
}

impl Played {
    const fn new(fault: Fault) -> Self {
        Self { fault, acts: 0, failed: None, is_on: false, refused: None }
    }

    /// Records an act: it was done, or the bus refused it. A full bus need not take every frame.
    fn note(&mut self, done: io::Result<()>) {
        match done {
            Ok(()) => self.acts += 1,
            Err(error) => self.refused = Some(error.to_string()),
        }
    }

    /// The fault at the end of a run. A fault without an act was not played.
    fn ended(mut self) -> Self {
        if self.acts == 0 && self.failed.is_none() {
            let nothing = "it changed nothing while it was on".to_owned();
            self.failed = Some(self.refused.take().unwrap_or(nothing));
        }
        self
    }
}

impl FaultInjector {
    /// An injector with these faults.
    #[must_use]
    pub fn new(faults: &[Fault], identifiers: Identifiers) -> Self {
        let faults = faults.iter().copied().map(Played::new).collect();
        let (sender, motion, altered) = (Sender::new(identifiers), EgoMotion::default(), Altered::default());
        Self { faults, identifiers, sender, motion, truth: None, next_s: 0.0, altered }
    }

    /// The same on a bus with these frames.
    #[must_use]
    pub fn over(self, transport: Transport) -> Self {
        Self { sender: self.sender.over(transport), ..self }
    }

    /// Switches the faults that are due at this time. Returns whether the device was powered up anew.
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

    /// Switches everything on again that is still off.
    pub fn stop(&mut self, rig: &mut dyn Rig) {
        self.switch(f64::INFINITY, rig);
    }

    /// The faults and their effects. In a run that was cut short, a fault may not have been due.
    #[must_use]
    pub fn played(self, is_whole: bool) -> Vec<Played> {
        self.faults.into_iter().map(|played| if is_whole { played.ended() } else { played }).collect()
    }

    fn on(&self) -> impl Iterator<Item = Fault> + '_ {
        self.faults.iter().filter(|played| played.is_on).map(|played| played.fault)
    }

    /// The present error of the time synchronisation, in microseconds.
    #[must_use]
    pub fn clock_error_us(&self, at_s: f64) -> i64 {
        crate::sim::time::micros(self.on().map(|fault| fault.kind.clock_error_s(at_s - fault.from_s)).sum())
    }

    /// How the harness's own frames are to be altered.
    #[must_use]
    pub fn spoils(&self) -> Option<Kind> {
        self.on().map(|fault| fault.kind).find(|kind| matches!(kind, Kind::Corrupt | Kind::Truncate))
    }

    /// Records how much the harness has altered since the run began. It has to be called before faults are switched.
    pub fn note_altered(&mut self, altered: Altered) {
        let (frames, times) = (altered.frames - self.altered.frames, altered.times - self.altered.times);
        self.altered = altered;
        let spoils = self.spoils();
        for played in self.faults.iter_mut().filter(|played| played.is_on) {
            played.acts += match played.fault.kind {
                // If both of these faults are on, one of them alters frames.
                kind if Some(kind) == spoils => frames,
                Kind::ClockStep(_) | Kind::ClockDrift(_) => times,
                _ => 0,
            };
        }
    }

    /// Takes in a frame that the harness has sent.
    pub fn overhear(&mut self, frame: &Frame) {
        self.truth = self.motion.take(&self.identifiers, frame).or(self.truth);
    }

    /// Sends the frames of the faults that are on. Returns the time until the next act. Frames that the bus refuses are
    /// lost.
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

    /// The vehicle's motion at another place: with valid protection, and with counters of its own.
    fn lies(&mut self) -> Vec<Frame> {
        let Some(truth) = self.truth else { return Vec::new() };
        let position = truth.position.nearest_to(Position::default()).get().to_num::<i64>() + OFF_M;
        let lie = Motion { position: WirePosition::from_mm(position * 1000), ..truth };
        let mut frames = Vec::new();
        let sent = self.sender.send(&Message::Ego(Said::Motion(lie)), &mut |frame| frames.push((&frame).into()));
        sent.expect("the catalogue has a line for the ego's motion");
        frames
    }
}
