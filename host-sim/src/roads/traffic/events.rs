//! The events of a run on the roads: those of the scenario, and those that are added while it runs, enter; vehicles and links change.
//!
//! A vehicle is named by the index of its trip. An event that befalls a vehicle that is not on the roads changes nothing. A switch of all
//! vehicles is for those too that appear later.

use super::Traffic;
use crate::input::scenario::{Change, Envelope, Event, Part};
use crate::roads::conditions::Heeds;
use crate::sim::vehicle::Vehicle;

/// A tick's time is a product of a count and a period that binary fractions cannot hold.
const SAME_TICK_S: f64 = 1e-9;

/// What happens, and what has happened.
#[derive(Clone)]
pub(super) struct Happenings {
    events: Vec<Event>,
    happened: usize,
    heeds: Heeds,
    /// Whether any envelope may be switched at any time.
    fits_twins: bool,
    /// How the parts of all vehicles were switched last.
    standing: [Option<bool>; Part::ALL.len()],
}

impl Happenings {
    /// These events, as far as the run heeds them.
    pub fn of(events: &[Event], heeds: Heeds) -> Self {
        Self { events: heeded(events, heeds), happened: 0, heeds, fits_twins: false, standing: [None; Part::ALL.len()] }
    }

    /// Whether nothing happens at any time.
    pub fn is_empty(&self) -> bool {
        self.events.is_empty()
    }

    /// Whether the envelope of the vehicle is switched at some time. For that its unit has a twin since it appears.
    fn needs_twin(&self, trip: usize) -> bool {
        let is = |event: &&Event| matches!(event.change, Change::Switch(Part::Envelope, _)) && event.is_of(trip);
        self.fits_twins || self.events.iter().any(|event| is(&event))
    }
}

fn heeded(events: &[Event], heeds: Heeds) -> Vec<Event> {
    let is_heeded = |event: &&Event| match event.change {
        Change::Links(_) | Change::Outage(_) => heeds.links,
        Change::Switch(Part::Envelope, _) => heeds.envelope,
        _ => true,
    };
    events.iter().filter(is_heeded).copied().collect()
}

impl Traffic<'_> {
    /// Adds an event that is due at the next tick, in the place of all that were to happen later.
    pub fn add(&mut self, event: Event) {
        let happenings = &mut self.happenings;
        let is_due = |other: &Event| other.at_s <= event.at_s + SAME_TICK_S;
        happenings.events.truncate(happenings.events.partition_point(is_due));
        happenings.events.push(event);
    }

    /// From now on these events happen, the first of which are those that have happened.
    pub fn expect(&mut self, events: &[Event]) {
        self.happenings.events = heeded(events, self.happenings.heeds);
    }

    /// Gives every unit that appears from now on a twin with the other envelope: envelopes can then be switched at any time.
    pub fn fit_twins(&mut self) {
        self.happenings.fits_twins = true;
    }

    /// Makes a vehicle that appears ready for what befalls it, and switches its parts as those of all were.
    pub(super) fn prepare(&self, trip: usize, vehicle: &mut Vehicle) -> Result<(), holdover::ConfigError> {
        if self.happenings.needs_twin(trip) {
            let envelope = self.conditions.envelope;
            let other = Envelope { engaged: !envelope.engaged, ..envelope };
            let capable = vehicle.unit.config().limits.emergency_braking;
            let limits = other.limits();
            vehicle.fit_twin(
                limits.map(|limits| holdover::config::Envelope { braking: limits.braking.min(capable), ..limits }),
            )?;
        }
        for (part, on) in Part::ALL.into_iter().zip(self.happenings.standing) {
            on.into_iter().for_each(|on| switch(vehicle, part, on));
        }
        Ok(())
    }

    /// Lets happen what is due.
    pub(super) fn happen(&mut self, at_s: f64) {
        let is_due = |event: &&Event| event.at_s <= at_s + SAME_TICK_S;
        while let Some(event) = self.happenings.events.get(self.happenings.happened).filter(is_due).copied() {
            self.happenings.happened += 1;
            match event.change {
                Change::Links(radio) => self.air.changes().set_radio(event.vehicle, radio),
                Change::Outage(length_s) => self.air.changes().silence(event.vehicle, at_s, length_s),
                Change::Drive(_) | Change::Release | Change::Switch(..) => self.befall(&event),
            }
        }
    }

    fn befall(&mut self, event: &Event) {
        if let (Change::Switch(part, on), None) = (event.change, event.vehicle)
            && let Some(place) = Part::ALL.iter().position(|other| *other == part)
        {
            self.happenings.standing[place] = Some(on);
        }
        for traveller in self.travellers.values_mut().filter(|traveller| event.is_of(traveller.trip)) {
            match event.change {
                Change::Drive(wanted_mps2) if !traveller.has_left() => traveller.vehicle.take_over(wanted_mps2),
                Change::Release => traveller.vehicle.let_go(),
                Change::Switch(part, on) => switch(&mut traveller.vehicle, part, on),
                Change::Drive(_) | Change::Links(_) | Change::Outage(_) => {}
            }
        }
    }

    /// After the units' ticks: hands that have let go are gone when the unit drives, and who drives without the estimate does.
    pub(super) fn intervene(&mut self) {
        for traveller in self.travellers.values_mut() {
            traveller.vehicle.intervene_on_way(self.corridor.period_s);
        }
    }
}

fn switch(vehicle: &mut Vehicle, part: Part, on: bool) {
    match part {
        Part::Holdover => vehicle.drive_plainly(!on),
        Part::Envelope => vehicle.switch_envelope(on),
        Part::RangeSensor => vehicle.cover_sensor(!on),
    }
}
