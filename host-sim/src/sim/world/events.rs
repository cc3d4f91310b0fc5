//! The events of a run: those of the scenario, and those that are added while it runs, enter; the vehicles and the links change.

use holdover::ConfigError;

use super::World;
use crate::input::impairment::Link;
use crate::input::scenario::{Change, Envelope, Event, Part};

/// A tick's time is a product of a count and a period that binary fractions cannot hold.
const SAME_TICK_S: f64 = 1e-9;

impl World<'_> {
    /// Adds an event that is due at the next tick, in the place of all that were to happen later.
    pub fn add(&mut self, event: Event) {
        let is_due = |other: &Event| other.at_s <= event.at_s + SAME_TICK_S;
        self.events.truncate(self.events.partition_point(is_due));
        self.events.push(event);
    }

    /// The same world with other events, before it has begun.
    ///
    /// # Errors
    /// A configuration that the units refuse.
    pub fn with_events(mut self, events: Vec<Event>) -> Result<Self, ConfigError> {
        self.events = events;
        self.fit_twins()?;
        Ok(self)
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

    /// Whether every message of the vehicle ahead that is sent now is lost on its way to this one.
    #[must_use]
    pub fn is_in_silence(&self, index: usize, at_s: f64) -> bool {
        index.checked_sub(1).is_some_and(|ahead| self.air.is_silent(Link { from: ahead, to: index }, at_s))
    }

    /// Whether the envelopes can be switched. For that every unit has a twin from the beginning.
    #[must_use]
    pub fn has_twins(&self) -> bool {
        self.events.iter().any(switches_envelope)
    }

    /// Gives every unit a twin with the other envelope, if an event needs one.
    pub(super) fn fit_twins(&mut self) -> Result<(), ConfigError> {
        if !self.has_twins() {
            return Ok(());
        }
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

/// Whether an event needs twins.
fn switches_envelope(event: &Event) -> bool {
    matches!(event.change, Change::Switch(Part::Envelope, _))
}
