//! The software twin: a unit that gets the frames on the device's bus at their times, and ticks when the device did.
//! Frames with their time stamps enter; the frames that the device should have sent leave.

use std::collections::VecDeque;

use holdover::time::{Duration, Instant};
use holdover::{Config, ConfigError};

use super::said::{Said, said};
use crate::bus::Frame;
use crate::sim::vehicle::Unit;

/// Time from the start of its clock to its first frame.
const POWERED_BEFORE: Duration = Duration::from_millis(60_000);

/// The twin.
pub struct Twin {
    unit: Unit,
    start: Option<Instant>,
    waiting: VecDeque<(Instant, Frame)>,
}

impl Twin {
    /// A unit that was just powered up.
    ///
    /// # Errors
    /// An error of the unit's configuration.
    pub fn new(config: &Config) -> Result<Self, ConfigError> {
        Ok(Self { unit: Unit::new(config)?, start: None, waiting: VecDeque::new() })
    }

    /// Takes in a frame that was on the bus.
    pub fn hear(&mut self, at: Instant, frame: Frame) {
        self.waiting.push_back((at, frame));
    }

    /// Ticks, as the device did.
    pub fn tick(&mut self, at: Instant) -> Option<Said> {
        let start = *self.start.get_or_insert(at);
        let local = |at: Instant| Instant::from_micros(0).plus(POWERED_BEFORE).plus(at.since(start));
        while let Some((heard, frame)) = self.waiting.pop_front_if(|(heard, _)| *heard <= at) {
            let _ = self.unit.receive(local(heard), &frame); // the unit counts refusals
        }
        let answer = self.unit.tick(local(at));
        said(&self.unit.config().identifiers, &answer.frames)
    }

    /// The unit.
    pub fn unit(&self) -> &Unit {
        &self.unit
    }
}
