//! The outcome of a run on the bench, before it is judged.

use holdover::time::{Duration, Instant};

use super::deviation::Deviation;
use super::fault_injector::Played;
use super::lateness::Lateness;
use super::monitor::Monitor;
use super::record::Recorded;
use super::talk::Counts;

/// Why a run ended early.
#[derive(Clone, Debug, PartialEq)]
pub enum Cut {
    /// The device never sent anything.
    Silent {
        /// Time for which the harness waited.
        waited: Duration,
        /// How its process ended, if it did.
        ended: Option<String>,
    },
    /// The device fell silent and stayed so.
    Gone {
        /// Time since which it is silent, in seconds of the run.
        at_s: f64,
        /// How its process ended, if it did.
        ended: Option<String>,
    },
    /// In lock step: the device had ticked before, or it ticks by itself.
    NotFresh {
        /// The count of its first answer.
        tick: u8,
    },
}

impl Cut {
    /// Whether the device's process ended by itself.
    #[must_use]
    pub const fn has_ended(&self) -> bool {
        matches!(self, Self::Silent { ended: Some(_), .. } | Self::Gone { ended: Some(_), .. })
    }
}

/// The frames of lock step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Steps {
    /// Steps that were taken.
    pub steps: u64,
    /// Frames that were compared.
    pub frames: u64,
    /// Frames that were not the same, or missing.
    pub different: u64,
    /// The first of them: time of the run, what the device sent, what its twin sent.
    pub first: Option<(f64, String, String)>,
}

/// The whole outcome.
pub struct Outcome {
    /// The world.
    pub recorded: Recorded,
    /// The device.
    pub monitor: Monitor,
    /// The device beside its twin, in real time.
    pub deviation: Deviation,
    /// The device beside its twin, in lock step.
    pub steps: Option<Steps>,
    /// The lateness of the harness, tick by tick.
    pub lateness: Lateness,
    /// Counts of the harness's frames.
    pub counts: Counts,
    /// Frames on the identifiers of the vehicle or the modem that are not the harness's.
    pub foreign: u64,
    /// Error frames.
    pub bus_errors: u64,
    /// The time of the bus at which the run began.
    pub origin: Instant,
    /// The faults that were injected, with the reason why one could not be.
    pub faults: Vec<Played>,
    /// Why it ended early.
    pub cut: Option<Cut>,
}

impl Outcome {
    /// A time of the bus, as a time of the run in seconds.
    #[must_use]
    pub fn time_of(&self, at: Instant) -> f64 {
        at.since(self.origin).as_micros() as f64 * 1e-6
    }
}
