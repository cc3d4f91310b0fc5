//! The software twin: a unit that is given what was on the device's bus, when it was, and ticks when the device did. Frames
//! with their time stamps enter, what the device should have said leaves.

use std::collections::VecDeque;

use holdover::time::{Duration, Instant};
use holdover::{Config, ConfigError};

use super::said::{Said, said};
use crate::bus::Frame;
use crate::sim::vehicle::Unit;

/// Its clock started so long before its first frame.
const POWERED_BEFORE: Duration = Duration::from_millis(60_000);

/// The twin.
pub struct Twin {
    unit: Unit,
    start: Option<Instant>,
    waiting: VecDeque<(Instant, Frame)>,
}

impl Twin {
    /// A unit that has just got power.
    ///
    /// # Errors
    /// What the unit finds wrong with its configuration.
    pub fn new(config: &Config) -> Result<Self, ConfigError> {
        Ok(Self { unit: Unit::new(config)?, start: None, waiting: VecDeque::new() })
    }

    /// A frame was on the bus.
    pub fn hear(&mut self, at: Instant, frame: Frame) {
        self.waiting.push_back((at, frame));
    }

    /// The device has ticked.
    pub fn tick(&mut self, at: Instant) -> Option<Said> {
        let start = *self.start.get_or_insert(at);
        let local = |at: Instant| Instant::from_micros(0).plus(POWERED_BEFORE).plus(at.since(start));
        while let Some((heard, frame)) = self.waiting.pop_front_if(|(heard, _)| *heard <= at) {
            let _ = self.unit.receive(local(heard), &frame); // a refusal is the unit's to count
        }
        said(self.unit.config().base_id, &self.unit.tick(local(at)).frames)
    }

    /// The unit.
    pub fn unit(&self) -> &Unit {
        &self.unit
    }
}
