//! One unit on the log's clock: lines of a log enter one by one; the frames that the unit sends leave tick by tick.

use std::io;

use holdover::coordination::{Itinerary, MapError};
use holdover::time::{Duration, Instant};
use holdover::wire::Transport;
use holdover::{Config, ConfigError};

use super::tally::Tally;
use super::timeline::Timeline;
use crate::bus::Frame;
use crate::bus::candump::{Content, Entry};
use crate::error::Error;
use crate::sim::vehicle::Unit;

/// The unit's clock is ahead of the log's by this time. Logs may start at 0, and stamps are from before their message.
const POWERED_BEFORE: Duration = Duration::from_millis(60_000);

/// What ends a replay early.
#[derive(Debug)]
pub enum Stop {
    /// The line cannot be replayed.
    Line(Error),
    /// The frames cannot be written.
    Output(io::Error),
}

/// A unit that receives a log.
pub struct Player {
    unit: Unit,
    /// A unit that ticks at the same times and receives nothing.
    deaf: Option<Unit>,
    timeline: Timeline,
    tally: Tally,
}

impl Player {
    /// A unit with this configuration. `compares`: whether it is to be compared with a unit that receives nothing.
    ///
    /// # Errors
    /// An error of the unit's configuration.
    pub fn new(config: &Config, compares: bool) -> Result<Self, ConfigError> {
        let unit = Unit::new(config)?;
        let deaf = compares.then(|| unit.clone());
        Ok(Self {
            unit,
            deaf,
            timeline: Timeline::new(config.period),
            tally: Tally::new(config.identifiers).over(config.transport),
        })
    }

    /// Sets out on a way through intersections, before the first line.
    ///
    /// # Errors
    /// An error of the map that the unit found.
    pub fn set_out(&mut self, itinerary: &'static Itinerary) -> Result<(), MapError> {
        self.deaf.iter_mut().try_for_each(|deaf| deaf.set_out(itinerary))?;
        self.unit.set_out(itinerary)
    }

    /// Counts of the frames so far.
    #[must_use]
    pub fn tally(&self) -> &Tally {
        &self.tally
    }

    /// Whether a line has been played.
    #[must_use]
    pub fn has_begun(&self) -> bool {
        self.timeline.last().is_some()
    }

    /// Counts a line that is not for this unit's bus.
    pub fn ignore(&mut self) {
        self.tally.ignore();
    }

    /// Plays a line: first the ticks before it, then its content. `send` gets the unit's frames with their times.
    ///
    /// # Errors
    /// A line without a time or with an impossible one, and errors of `send`.
    pub fn play(&mut self, entry: &Entry, mut send: impl FnMut(Instant, &Frame) -> io::Result<()>) -> Result<(), Stop> {
        let at = entry.at.ok_or_else(|| Stop::Line(no_time()))?;
        self.timeline.read(at).map_err(Stop::Line)?;
        while let Some(tick) = self.timeline.due() {
            self.tick(tick, &mut send).map_err(Stop::Output)?;
        }
        match &entry.content {
            // A classic controller hears no frame of CAN FD; one of CAN FD hears both, and the unit refuses what is classic.
            Content::Frame(frame) if frame.is_fd() && self.unit.config().transport == Transport::Classic => {
                self.tally.ignore();
            }
            Content::Frame(frame) => {
                let reception = self.unit.receive(at.plus(POWERED_BEFORE), frame);
                self.tally.count(frame, reception);
            }
            Content::Xl | Content::ErrorFrame => self.tally.ignore(),
        }
        Ok(())
    }

    /// The last tick.
    ///
    /// # Errors
    /// Errors of `send`.
    pub fn finish(&mut self, mut send: impl FnMut(Instant, &Frame) -> io::Result<()>) -> io::Result<()> {
        self.timeline.last().map_or(Ok(()), |tick| self.tick(tick, &mut send))
    }

    fn tick(&mut self, at: Instant, send: &mut impl FnMut(Instant, &Frame) -> io::Result<()>) -> io::Result<()> {
        let now = at.plus(POWERED_BEFORE);
        let answer = self.unit.tick(now);
        if let Some(deaf) = &mut self.deaf {
            deaf.tick(now);
        }
        self.tally.tick();
        answer.frames.iter().try_for_each(|frame| send(at, &frame.into()))
    }

    /// Whether the state of the unit differs from that of a unit that received nothing; `None` if they are not
    /// compared. The whole states are compared, field by field, by their debug output.
    #[must_use]
    pub fn has_changed(&self) -> Option<bool> {
        self.deaf.as_ref().map(|deaf| format!("{deaf:?}") != format!("{:?}", self.unit))
    }
}

pub(super) fn no_time() -> Error {
    Error::new("the line has no time", "record with `candump -l`, or on the screen with -t a, z or d")
}
