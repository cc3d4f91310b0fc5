//! Counts of the frames of a log: receptions enter; counts by message and by cause leave.

use std::collections::BTreeMap;

use embedded_can::Frame as _;
use holdover::Reception;
use holdover::health::Cause;
use holdover::wire::catalogue::{self, Line, OnFd};
use holdover::wire::{Identifiers, MessageName, Transport};

use crate::bus::Frame;

/// The counts. Every frame is either recognised, refused or ignored.
#[derive(Clone, Debug)]
pub struct Tally {
    identifiers: Identifiers,
    transport: Transport,
    /// By offset in the catalogue.
    recognised: BTreeMap<u16, u64>,
    refused: [u64; Cause::ALL.len()],
    ignored: u64,
    ticks: u64,
}

impl Tally {
    /// Counts of 0, on a bus with these identifiers.
    #[must_use]
    pub fn new(identifiers: Identifiers) -> Self {
        let transport = Transport::Classic;
        Self {
            identifiers,
            transport,
            recognised: BTreeMap::new(),
            refused: [0; Cause::ALL.len()],
            ignored: 0,
            ticks: 0,
        }
    }

    /// The same on a bus with these frames.
    #[must_use]
    pub fn over(self, transport: Transport) -> Self {
        Self { transport, ..self }
    }

    /// Counts a frame that the unit received.
    pub fn count(&mut self, frame: &Frame, reception: Result<Reception, Cause>) {
        match (reception, self.identifiers.offset_of(frame.id().into())) {
            (Ok(Reception::Pending | Reception::Taken), Some(offset)) => {
                *self.recognised.entry(offset).or_default() += 1;
            }
            (Ok(_), _) => self.ignored += 1,
            (Err(cause), _) => self.refused[cause as usize] += 1,
        }
    }

    /// Counts a frame that was not passed to the unit.
    pub fn ignore(&mut self) {
        self.ignored += 1;
    }

    /// Counts a tick.
    pub fn tick(&mut self) {
        self.ticks += 1;
    }

    /// All frames.
    #[must_use]
    pub fn frames(&self) -> u64 {
        self.recognised.values().sum::<u64>() + self.refused.iter().sum::<u64>() + self.ignored
    }

    /// Good frames of each message, by its name in the DBC, in the order of the catalogue.
    #[must_use]
    pub fn recognised(&self) -> Vec<(String, u64)> {
        self.recognised.iter().map(|(offset, count)| (self.name(*offset), *count)).collect()
    }

    /// Refused frames by cause, without causes that did not occur.
    #[must_use]
    pub fn refused(&self) -> Vec<(&'static str, u64)> {
        let counts = Cause::ALL.iter().zip(self.refused);
        counts.filter(|(_, count)| *count > 0).map(|(cause, count)| (cause.name(), count)).collect()
    }

    /// Frames that are not for the unit.
    #[must_use]
    pub fn ignored(&self) -> u64 {
        self.ignored
    }

    /// Ticks of the unit.
    #[must_use]
    pub fn ticks(&self) -> u64 {
        self.ticks
    }

    fn name(&self, offset: u16) -> String {
        match catalogue::find(offset) {
            Some((_, Line { on_fd: OnFd::Frame(name), .. }, slot)) if self.transport == Transport::Fd => {
                name.replace("{slot}", &slot.0.to_string())
            }
            _ => MessageName::at(offset).to_string(),
        }
    }
}
