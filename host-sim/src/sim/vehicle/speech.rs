//! What a vehicle puts on its unit's bus: its state at a time enters; the messages that are due leave.

use std::io;

use holdover::time::Instant;
use holdover::wire::driver_request::DriverRequest;
use holdover::wire::motion::{Motion, WirePosition};
use holdover::wire::{Message, Said};

use super::Vehicle;
use crate::sim::modem::UNSERVED_EVERY_S;
use crate::sim::quantities::{acceleration, metres, speed};
use crate::sim::sensors::{Ahead, RANGE_EVERY_S};
use crate::sim::station::station;

/// Cycle of the time base, in seconds.
const SYNC_EVERY_S: f64 = 0.5;
/// Cycle of the position on the globe, in seconds.
const LOCATE_EVERY_S: f64 = 0.1;
/// Cycle of what the actuators say, in seconds.
const ACTUATORS_EVERY_S: f64 = 0.02;
/// Cycle of the driver's request, in seconds.
const REQUEST_EVERY_S: f64 = 0.1;

impl Vehicle {
    /// Puts on the unit's bus what the vehicle sends in a period: its motion, and when they are due the view of the
    /// vehicle `ahead`, the driver's request and the time base. `None`: the range sensor is not at work.
    ///
    /// # Errors
    /// Errors of the bus.
    pub fn speak(&mut self, at_s: f64, period_s: f64, ahead: Option<Ahead>) -> io::Result<()> {
        let now = self.instant(at_s);
        if is_due(at_s, SYNC_EVERY_S, period_s) || !self.master.is_awake() {
            self.master.synchronise(&mut self.sender, now, at_s)?;
        }
        self.sense(at_s)?;
        if let Some(ground) = self.ground.filter(|_| is_due(at_s, LOCATE_EVERY_S, period_s)) {
            let way_m = self.plant.position_m - ground.odometer_m;
            let place = ground.road.said(way_m, self.tag, self.master.gnss(at_s).stamp());
            self.put(at_s, &Message::Ego(Said::Geo(place)))?;
        }
        if let Some(ahead) = ahead.filter(|_| self.intervention.sees() && is_due(at_s, RANGE_EVERY_S, period_s))
            && let Some(seen) = self.sensors.look(at_s, self.plant.position_m, self.plant.speed_mps, ahead)
        {
            self.put(at_s, &Message::Range(seen))?;
        }
        if let Some(state) = self.actuator_state.filter(|_| is_due(at_s, ACTUATORS_EVERY_S, period_s)) {
            self.put(at_s, &Message::Actuators(state))?;
        }
        if is_due(at_s, UNSERVED_EVERY_S, period_s)
            && let Some(unserved) = self.relay.unserved(at_s)
        {
            self.put(at_s, &Message::Unserved(unserved))?;
        }
        if is_due(at_s, REQUEST_EVERY_S, period_s) || self.intervention.asks_anew() {
            self.request(at_s)?;
        }
        self.follow_up() // at once, if a frame takes no time
    }

    /// Sends the second message of the time base, once the first one has been on the bus.
    pub(super) fn follow_up(&mut self) -> io::Result<()> {
        let began = Instant::from_micros(self.clock_offset_us);
        self.master.follow_up(&mut self.sender, |at| at.since(began).as_micros() as f64 * 1e-6)
    }

    /// Sends the vehicle's own motion, as its sensors measure it now.
    fn sense(&mut self, at_s: f64) -> io::Result<()> {
        self.tag = (self.tag + 1) % 4;
        let motion = Motion {
            tag: self.tag,
            position: WirePosition::from_position(metres(self.plant.position_m)),
            speed: speed(self.plant.speed_mps),
            acceleration: acceleration(self.plant.acceleration_mps2),
            demand: acceleration(self.command_mps2),
            stamp: self.master.gnss(at_s).stamp(),
            position_accuracy: Some(self.sensors.position_accuracy),
            speed_accuracy: Some(self.sensors.speed_accuracy),
            station: self.alias.of(station(self.index)),
        };
        self.put(at_s, &Message::Ego(Said::Motion(motion)))
    }

    /// Sends the driver's request.
    fn request(&mut self, at_s: f64) -> io::Result<()> {
        let predecessor = self.alias.of_predecessor(self.request.predecessor);
        let request = DriverRequest { engaged: self.engaged, predecessor, ..self.request };
        self.put(at_s, &Message::DriverRequest(request))
    }
}

/// Whether a message with this cycle is due in the tick at `at_s`.
fn is_due(at_s: f64, cycle_s: f64, period_s: f64) -> bool {
    let phase = (at_s + 1e-9).rem_euclid(cycle_s);
    phase < period_s - 1e-9
}
