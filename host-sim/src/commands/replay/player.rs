//! One unit on the log's clock: lines of a log enter one by one, the frames that the unit sends leave tick by tick.

use std::io;

use holdover::time::{Duration, Instant};
use holdover::{Config, ConfigError};

use super::tally::Tally;
use super::timeline::Timeline;
use crate::bus::Frame;
use crate::bus::candump::{Content, Entry};
use crate::error::Error;
use crate::sim::vehicle::Unit;

/// The unit's clock is ahead of the log's by this. Logs may start at 0, and what a message's stamp dates lies before.
const POWERED_BEFORE: Duration = Duration::from_millis(60_000);

/// What keeps a replay from going on.
#[derive(Debug)]
pub enum Stop {
    /// The line cannot be replayed.
    Line(Error),
    /// The frames cannot be written.
    Output(io::Error),
}

/// A unit that lives by a log.
pub struct Player {
    unit: Unit,
    /// A unit that ticks with the other and hears nothing.
    deaf: Option<Unit>,
    timeline: Timeline,
    tally: Tally,
}

impl Player {
    /// A unit with that configuration. `compares`: whether it is to be compared with one that hears nothing.
    ///
    /// # Errors
    /// What the unit finds wrong with its configuration.
    pub fn new(config: &Config, compares: bool) -> Result<Self, ConfigError> {
        let unit = Unit::new(config)?;
        let deaf = compares.then(|| unit.clone());
        Ok(Self { unit, deaf, timeline: Timeline::new(config.period), tally: Tally::new(config.base_id) })
    }

    /// What became of the frames so far.
    #[must_use]
    pub fn tally(&self) -> &Tally {
        &self.tally
    }

    /// Whether there was a line to play.
    #[must_use]
    pub fn has_begun(&self) -> bool {
        self.timeline.last().is_some()
    }

    /// Takes note of a line that is none of this unit's bus.
    pub fn ignore(&mut self) {
        self.tally.ignore();
    }

    /// Plays a line: the ticks before it, then what it says. `send` is given what the unit sends, with its time.
    ///
    /// # Errors
    /// A line without a time or with an impossible one, and whatever `send` says.
    pub fn play(&mut self, entry: &Entry, mut send: impl FnMut(Instant, &Frame) -> io::Result<()>) -> Result<(), Stop> {
        let at = entry.at.ok_or_else(|| Stop::Line(no_time()))?;
        self.timeline.read(at).map_err(Stop::Line)?;
        while let Some(tick) = self.timeline.due() {
            self.tick(tick, &mut send).map_err(Stop::Output)?;
        }
        match &entry.content {
            Content::Frame(frame) => {
                let reception = self.unit.receive(at.plus(POWERED_BEFORE), frame);
                self.tally.count(frame, reception);
            }
            Content::Fd | Content::Xl | Content::ErrorFrame => self.tally.ignore(),
        }
        Ok(())
    }

    /// The last tick.
    ///
    /// # Errors
    /// Whatever `send` says.
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

    /// Whether the unit is in any other state than if it had heard nothing; `None` if that was not asked for. States are
    /// compared whole, field by field, as they are printed for debugging.
    #[must_use]
    pub fn has_changed(&self) -> Option<bool> {
        self.deaf.as_ref().map(|deaf| format!("{deaf:?}") != format!("{:?}", self.unit))
    }
}

pub(super) fn no_time() -> Error {
    Error::new("the line has no time", "record with `candump -l` or `candump -t a`")
}
