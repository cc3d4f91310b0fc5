//! Looks at the world between two ticks: it enters; its vehicles, and what is lost between them, leave. To look changes nothing.

use std::io;

use super::{Traffic, Traveller};
use crate::bus::Frame;
use crate::input::impairment::Link;
use crate::input::scenario::Radio;

impl Traffic<'_> {
    /// Appends to the log what has been on the logged bus since it was asked for the last time.
    ///
    /// # Errors
    /// Errors of the buses.
    pub fn hand_in(&mut self, log: &mut Vec<(f64, Frame)>) -> io::Result<()> {
        self.travellers.values_mut().try_for_each(|traveller| traveller.hand_in(log))
    }

    /// Number of ticks so far.
    #[must_use]
    pub fn ticks(&self) -> u64 {
        self.ticks
    }

    /// The vehicles on the roads, in the order of their trips.
    pub fn travellers(&self) -> impl Iterator<Item = &Traveller> {
        self.travellers.values()
    }

    /// The vehicle with this trip, if it is on the roads.
    #[must_use]
    pub fn traveller(&self, trip: usize) -> Option<&Traveller> {
        self.travellers.get(&trip)
    }

    /// Of a vehicle or of all, the delay and the loss that were set since the start.
    #[must_use]
    pub fn radios(&self) -> &[(Option<usize>, Radio)] {
        self.air.radios()
    }

    /// Whether every message that one vehicle sends another now is lost.
    #[must_use]
    pub fn is_cut_off(&self, from: usize, to: usize, at_s: f64) -> bool {
        let sends = self.traveller(from).is_none_or(|one| one.sends(at_s));
        let hears = self.traveller(to).is_none_or(|one| one.hears(at_s));
        !sends || !hears || self.air.is_silent(Link { from, to }, at_s)
    }
}
