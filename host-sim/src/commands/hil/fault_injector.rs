//! The one who presses the fault buttons: a schedule and the time of the run enter; what is switched, what is spoilt and what
//! a node of ill will sends leave.

use holdover::time::Duration;
use holdover::units::Position;
use holdover::wire::catalogue::{About, Content, Speaker};
use holdover::wire::motion::{Motion, WirePosition};
use holdover::wire::{BaseId, Message, Said, Sender};

use super::fault::{Fault, Kind};
use super::rig::Rig;
use super::talk::{line_of, payload};
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
}

struct Played {
    fault: Fault,
    is_on: bool,
    failed: Option<String>,
}

impl FaultInjector {
    /// With these faults in mind.
    #[must_use]
    pub fn new(faults: &[Fault], base: BaseId) -> Self {
        let faults = faults.iter().map(|fault| Played { fault: *fault, is_on: false, failed: None }).collect();
        Self { faults, base, sender: Sender::new(base), motion: [None; 2], next_s: 0.0 }
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
                _ => Ok(()),
            };
            if let Err(error) = done {
                played.failed = Some(error.to_string());
            }
        }
        powered
    }

    /// What is still switched off is switched on.
    pub fn stop(&mut self, rig: &mut dyn Rig) {
        self.switch(f64::INFINITY, rig);
    }

    /// The faults, and why one could not be played.
    #[must_use]
    pub fn played(self) -> Vec<(Fault, Option<String>)> {
        self.faults.into_iter().map(|played| (played.fault, played.failed)).collect()
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
        let kinds: Vec<Kind> = self.on().map(|fault| fault.kind).collect();
        let is_due = at_s >= self.next_s;
        let mut frames = Vec::new();
        let mut errors = false;
        for kind in &kinds {
            match kind {
                Kind::Babble => frames.extend(Frame::standard(0, &[0xFF; 8]).into_iter().cycle().take(BABBLE)),
                Kind::Foreign if is_due => frames.extend(self.lies()),
                Kind::Errors if is_due => errors = true,
                _ => {}
            }
        }
        if is_due {
            self.next_s = at_s + 0.01;
        }
        if (errors || !frames.is_empty())
            && let Ok(port) = rig.injector()
        {
            frames.into_iter().for_each(|frame| drop(port.send(frame)));
            if errors {
                let _ = port.send_error(BusError::NO_ACKNOWLEDGEMENT);
            }
        }
        kinds.iter().any(|kind| matches!(kind, Kind::Babble | Kind::Foreign | Kind::Errors)).then_some(EVERY)
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
