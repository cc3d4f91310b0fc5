//! The events of a run: those of the scenario, and those that are added while it runs, enter; the vehicles and the links change.

use holdover::ConfigError;

use super::World;
use crate::input::impairment::Link;
use crate::input::scenario::{Change, Envelope, Event, Part, Radio};

/// A tick's time is a product of a count and a period that binary fractions cannot hold.
const SAME_TICK_S: f64 = 1e-9;

impl World<'_> {
    /// Adds an event that is due at the next tick, in the place of all that were to happen later.
    pub fn add(&mut self, event: Event) {
        let is_due = |other: &Event| other.at_s <= event.at_s + SAME_TICK_S;
        self.events.truncate(self.events.partition_point(is_due));
        self.events.push(event);
    }

    /// From now on these events happen, the first of which are those that have happened.
    pub fn expect(&mut self, events: &[Event]) {
        self.events = events.to_vec();
    }

    /// The same world without the record of what its channel does.
    #[must_use]
    pub fn unrecorded(self) -> Self {
        Self { air: self.air.unrecorded(), ..self }
    }

    /// Of a vehicle or of all, the delay and the loss that were set since the start.
    #[must_use]
    pub fn radios(&self) -> &[(Option<usize>, Radio)] {
        self.air.radios()
    }

    /// Whether every message of the vehicle ahead that is sent now is lost on its way to this one.
    #[must_use]
    pub fn is_in_silence(&self, index: usize, at_s: f64) -> bool {
        index.checked_sub(1).is_some_and(|ahead| self.air.is_silent(Link { from: ahead, to: index }, at_s))
    }

    /// Whether an event switches an envelope. For that every unit has to have a twin from the beginning.
    pub(super) fn needs_twins(&self) -> bool {
        self.events.iter().any(|event| matches!(event.change, Change::Switch(Part::Envelope, _)))
    }

    /// Gives every unit a twin with the other envelope, before the world has begun: envelopes can then be switched at any time.
    ///
    /// # Errors
    /// A configuration that the units refuse.
    pub fn fit_twins(&mut self) -> Result<(), ConfigError> {
        let other = Envelope { engaged: !self.scenario.envelope.engaged, ..self.scenario.envelope };
        self.vehicles.iter_mut().try_for_each(|vehicle| {
            let capable = vehicle.unit.config().limits.emergency_braking;
            let limits = other.limits();
            vehicle.fit_twin(
                limits.map(|limits| holdover::config::Envelope { braking: limits.braking.min(capable), ..limits }),
            )
        })
    }

    /// Lets happen what is due.
    pub(super) fn happen(&mut self, at_s: f64) {
        while let Some(event) = self.events.get(self.happened).filter(|event| event.at_s <= at_s + SAME_TICK_S).copied()
        {
            self.happened += 1;
            match event.change {
                Change::Links(radio) => self.air.changes().set_radio(event.vehicle, radio),
                Change::Outage(length_s) => self.air.changes().silence(event.vehicle, at_s, length_s),
                Change::Drive(_) | Change::Release | Change::Switch(..) => self.befall(&event),
            }
        }
    }

    fn befall(&mut self, event: &Event) {
        for vehicle in self.vehicles.iter_mut().filter(|vehicle| event.is_of(vehicle.index)) {
            match event.change {
                Change::Drive(wanted_mps2) => vehicle.take_over(wanted_mps2),
                Change::Release => vehicle.let_go(),
                Change::Switch(Part::Holdover, on) => vehicle.drive_plainly(!on && vehicle.index > 0),
                Change::Switch(Part::Envelope, on) => vehicle.switch_envelope(on),
                Change::Switch(Part::RangeSensor, on) => vehicle.cover_sensor(!on),
                Change::Links(_) | Change::Outage(_) => {}
            }
        }
    }
}
