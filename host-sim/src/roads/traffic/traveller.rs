//! A vehicle on the roads of a corridor: its way, its bus, and what befalls it.

use std::io;

use holdover::time::Instant;

use super::drivers::Driver;
use super::emergencies::Emergency;
use super::faults::Fault;
use crate::bus::memory::MemoryNode;
use crate::bus::{Bus, Frame};
use crate::input::impairment::Window;
use crate::roads::sight::Body;
use crate::sim::road::Ground;
use crate::sim::vehicle::Vehicle;

/// A vehicle on the roads.
pub struct Traveller {
    /// Its trip.
    pub trip: usize,
    /// Time at which the vehicle left, if it has.
    pub left_s: Option<f64>,
    /// Body, unit, modem and bus.
    pub vehicle: Box<Vehicle>,
    /// Its road.
    pub ground: Ground,
    /// The time in which its radio is silent.
    pub dark: Window,
    /// A node on its bus, if that is logged.
    pub(super) log: Option<MemoryNode>,
    /// Whether it has a range sensor.
    pub sees: bool,
    /// Its emergency stop, if it makes one.
    pub(super) emergency: Option<Emergency>,
    /// Its fault, if it has one.
    pub(super) fault: Option<Fault>,
    /// Its driver.
    pub(super) driver: Driver,
}

impl Clone for Traveller {
    fn clone(&self) -> Self {
        let vehicle = self.vehicle.clone();
        let log = self.log.as_ref().map(|node| vehicle.adopt(node));
        Self { vehicle, log, ..*self }
    }
}

impl Traveller {
    /// Where its front is, from the beginning of the road.
    #[must_use]
    pub fn way_m(&self) -> f64 {
        self.vehicle.plant.position_m - self.ground.odometer_m
    }

    /// Appends the frames of its bus to the log, if its bus is logged.
    pub(super) fn hand_in(&mut self, log: &mut Vec<(f64, Frame)>) -> io::Result<()> {
        let Some(node) = &mut self.log else { return Ok(()) };
        while let Some((at, frame)) = node.receive(Instant::from_micros(u64::MAX))? {
            log.push((self.vehicle.time_of(at), frame));
        }
        Ok(())
    }

    /// Its body, on this road.
    #[must_use]
    pub fn body(&self, road: usize) -> Body {
        let vehicle = &self.vehicle;
        Body { road, front_m: self.way_m(), length_m: vehicle.length_m, speed_mps: vehicle.plant.speed_mps }
    }

    /// Whether it has left.
    #[must_use]
    pub fn has_left(&self) -> bool {
        self.left_s.is_some()
    }

    /// Whether its radio is in its silence.
    #[must_use]
    pub fn is_dark(&self, at_s: f64) -> bool {
        (self.dark.from_s..self.dark.to_s).contains(&at_s)
    }

    /// Whether its modem receives what comes over the air.
    #[must_use]
    pub fn hears(&self, at_s: f64) -> bool {
        !self.is_dark(at_s) && !self.is_deaf(at_s)
    }

    /// Whether what it broadcasts goes out.
    #[must_use]
    pub fn sends(&self, at_s: f64) -> bool {
        !self.is_dark(at_s) && !self.is_mute(at_s)
    }

    /// Whether its receiver is dead.
    #[must_use]
    pub fn is_deaf(&self, at_s: f64) -> bool {
        matches!(self.fault, Some(Fault::DeafFrom(from_s)) if at_s >= from_s)
    }

    /// Whether its sender is dead.
    #[must_use]
    pub fn is_mute(&self, at_s: f64) -> bool {
        matches!(self.fault, Some(Fault::MuteFrom(from_s)) if at_s >= from_s)
    }

    /// Whether its range sensor is at work.
    #[must_use]
    pub fn sees_at(&self, at_s: f64) -> bool {
        self.sees && !matches!(self.fault, Some(Fault::BlindFrom(from_s)) if at_s >= from_s)
    }

    /// Whether it stands in an emergency stop, or brakes for it.
    pub(super) fn stops_by_itself(&self) -> bool {
        self.emergency.as_ref().is_some_and(Emergency::is_under_way)
    }

    /// Whether its fault has not begun.
    pub(super) fn fault_is_to_come(&self, at_s: f64) -> bool {
        let Some(Fault::DeafFrom(from_s) | Fault::MuteFrom(from_s) | Fault::BlindFrom(from_s)) = self.fault else {
            return false;
        };
        at_s < from_s
    }

    /// Whether its clock is off.
    #[must_use]
    pub fn mistakes_time(&self) -> bool {
        matches!(self.fault, Some(Fault::TimeAheadBy(_)))
    }
}
