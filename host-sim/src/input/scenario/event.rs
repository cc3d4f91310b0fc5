//! The sections `[[event]]`: what befalls the vehicles and their links from a time on. Keys enter; checked events leave, in the order of
//! time. [`Event::toml`] writes one as it is read.

use std::fmt::Write;
use std::ops::RangeInclusive;

use super::keys::{Document, Number, Section};
use super::{Leader, Vehicle};
use crate::error::Error;

/// The accelerations that a person asks for, in m/s²: up to more than any vehicle is capable of.
pub const DRIVEN_MPS2: RangeInclusive<f64> = -12.0..=12.0;
/// The lengths of an outage, in seconds.
pub const OUTAGES_S: RangeInclusive<f64> = 0.0..=600.0;

const AT: Number = Number { key: "at_s", unit: "seconds", limits: 0.0..=86_400.0, default: 0.0 };
const DRIVE: Number = Number { key: "drive_mps2", unit: "m/s²", limits: DRIVEN_MPS2, default: 0.0 };
const DELAY_MEAN: Number = Number { key: "delay_mean_s", unit: "seconds", limits: 0.0..=10.0, default: 0.0 };
const DELAY_STD: Number = Number { key: "delay_std_s", unit: "seconds", limits: 0.0..=10.0, default: 0.0 };
const LOSS: Number = Number { key: "loss", unit: "a share", limits: 0.0..=1.0, default: 0.0 };
const OUTAGE: Number = Number { key: "outage_s", unit: "seconds", limits: OUTAGES_S, default: 0.0 };

/// Something that happens during a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Event {
    /// When: from the first tick at or after this time on.
    pub at_s: f64,
    /// The vehicle; `None`: every vehicle.
    pub vehicle: Option<usize>,
    /// What.
    pub change: Change,
}

/// What happens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Change {
    /// A person drives the vehicle: the acceleration that the pedals ask for. The unit is disengaged.
    Drive(f64),
    /// The person lets go, and the unit drives again.
    Release,
    /// All links of the vehicle have this delay and this loss from now on, and none of the channel's outages any more.
    Links(Radio),
    /// The vehicle neither sends nor receives for so many seconds.
    Outage(f64),
    /// Something is switched on or off.
    Switch(Part, bool),
}

/// Delay and loss of a link.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Radio {
    /// Mean of the delay before truncation at 0, in seconds.
    pub delay_mean_s: f64,
    /// Standard deviation of the delay before truncation at 0, in seconds.
    pub delay_std_s: f64,
    /// Fraction of messages lost, 0 to 1.
    pub loss: f64,
}

/// What can be switched.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Part {
    /// The estimate. Without it the vehicle drives by the newest message as it stands, and without the envelope.
    Holdover,
    /// The envelope of the unit.
    Envelope,
    /// The range sensor.
    RangeSensor,
}

impl Part {
    /// Every part.
    pub const ALL: [Self; 3] = [Self::Holdover, Self::Envelope, Self::RangeSensor];

    /// Its key.
    #[must_use]
    pub const fn key(self) -> &'static str {
        match self {
            Self::Holdover => "holdover",
            Self::Envelope => "envelope",
            Self::RangeSensor => "range_sensor",
        }
    }
}

/// The vehicles, as far as events need to know them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fleet {
    /// For each vehicle, whether it has a range sensor.
    sensors: Vec<bool>,
    /// Whether the leader replays a recording.
    is_recorded: bool,
}

impl Fleet {
    /// These vehicles behind this leader.
    pub(super) fn of(vehicles: &[Vehicle], leader: &Leader) -> Self {
        let sensors = vehicles.iter().map(|vehicle| vehicle.range_sensor.is_some()).collect();
        Self { sensors, is_recorded: leader.motion.is_some() }
    }

    /// Vehicles that all may be driven. For each, whether it has a range sensor.
    pub(crate) fn fitted(sensors: Vec<bool>) -> Self {
        Self { sensors, is_recorded: false }
    }
}

/// Reads the sections of a scenario with these vehicles.
pub(crate) fn read(document: &Document, sections: Vec<Section>, fleet: &Fleet) -> Result<Vec<Event>, Error> {
    let mut events: Vec<Event> = Vec::new();
    for section in sections {
        let line = section.line();
        let event = event(document, section, fleet.sensors.len())?;
        if events.last().is_some_and(|last| last.at_s > event.at_s) {
            let cause = format!("an event at {} s stands after a later one", event.at_s);
            return Err(document.error_at(line, cause, "list the events in the order of time"));
        }
        event.check(fleet).map_err(|error| document.place(error, line))?;
        events.push(event);
    }
    Ok(events)
}

fn event(document: &Document, mut section: Section, vehicles: usize) -> Result<Event, Error> {
    let line = section.line();
    let at = section.number(&AT)?;
    let vehicle = section.whole("vehicle")?;
    let drive = section.number(&DRIVE)?;
    let release = section.flag("release")?.filter(|flag| flag.value);
    let radio = [section.number(&DELAY_MEAN)?, section.number(&DELAY_STD)?, section.number(&LOSS)?];
    let outage = section.number(&OUTAGE)?;
    let mut changes = Vec::new();
    for part in Part::ALL {
        changes.extend(section.flag(part.key())?.map(|flag| Change::Switch(part, flag.value)));
    }
    section.finish()?;
    changes.extend(drive.line.map(|_| Change::Drive(drive.value)));
    changes.extend(release.map(|_| Change::Release));
    let [delay_mean_s, delay_std_s, loss] = radio.map(|number| number.value);
    let is_radio = radio.iter().any(|number| number.line.is_some());
    changes.extend(is_radio.then_some(Change::Links(Radio { delay_mean_s, delay_std_s, loss })));
    changes.extend(outage.line.map(|_| Change::Outage(outage.value)));
    let [change] = changes[..] else {
        let cause = format!("an event has {} changes", changes.len());
        let remedy = "give it one: drive_mps2, release, delay_mean_s with delay_std_s and loss, outage_s, holdover, envelope or \
                      range_sensor";
        return Err(document.error_at(line, cause, remedy));
    };
    let named = vehicle.map(|found| (found.line, usize::try_from(found.value).unwrap_or(usize::MAX)));
    if let Some((line, index)) = named.filter(|(_, index)| *index >= vehicles) {
        let cause = format!("an event is of vehicle {index}, and there is none");
        return Err(document.error_at(line, cause, format!("give an index from 0 to {}", vehicles.saturating_sub(1))));
    }
    Ok(Event { at_s: at.value, vehicle: named.map(|(_, index)| index), change })
}

impl Event {
    /// Whether it can happen to these vehicles.
    ///
    /// # Errors
    /// A value out of its range, no vehicle, one that nobody can drive, or nothing to switch.
    pub fn check(&self, Fleet { sensors, is_recorded }: &Fleet) -> Result<(), Error> {
        AT.check(self.at_s)?;
        if let Some(index) = self.vehicle.filter(|index| *index >= sensors.len()) {
            let remedy = format!("give an index from 0 to {}", sensors.len().saturating_sub(1));
            return Err(Error::new(format!("there is no vehicle {index}"), remedy));
        }
        let one = |what: &str| match self.vehicle {
            Some(0) if *is_recorded => Err(Error::new(
                "the leader drives a recording, and nobody can take it over",
                "drive a vehicle behind it",
            )),
            Some(_) => Ok(()),
            None => Err(Error::new(format!("{what} is of no vehicle"), "name one with `vehicle`")),
        };
        match self.change {
            Change::Drive(wanted_mps2) => DRIVE.check(wanted_mps2).and_then(|_| one("what a person drives")),
            Change::Release => one("a release"),
            Change::Links(Radio { delay_mean_s, delay_std_s, loss }) => DELAY_MEAN
                .check(delay_mean_s)
                .and_then(|_| DELAY_STD.check(delay_std_s))
                .and_then(|_| LOSS.check(loss))
                .map(|_| ()),
            Change::Outage(length_s) => OUTAGE.check(length_s).map(|_| ()),
            Change::Switch(Part::RangeSensor, true) => {
                let has_one = |index: usize| sensors.get(index).copied().unwrap_or(false);
                if self.vehicle.map_or(sensors.contains(&true), has_one) {
                    return Ok(());
                }
                let remedy = "give it one in the scenario (`range_sensor = true`), or give `--range-sensors on`";
                Err(Error::new("a range sensor is switched on where none is fitted", remedy))
            }
            Change::Switch(..) => Ok(()),
        }
    }

    /// Whether it is about the vehicle with this index.
    #[must_use]
    pub fn is_of(&self, index: usize) -> bool {
        self.vehicle.is_none_or(|vehicle| vehicle == index)
    }

    /// Its section in a scenario file. Numbers have all their digits, so reading gives the same event.
    #[must_use]
    pub fn toml(&self) -> String {
        let mut text = format!("[[event]]\nat_s = {:?}\n", self.at_s);
        if let Some(vehicle) = self.vehicle {
            let _ = writeln!(text, "vehicle = {vehicle}"); // writing to a String cannot fail
        }
        let _ = match self.change {
            Change::Drive(wanted_mps2) => writeln!(text, "drive_mps2 = {wanted_mps2:?}"),
            Change::Release => writeln!(text, "release = true"),
            Change::Links(Radio { delay_mean_s, delay_std_s, loss }) => {
                writeln!(text, "delay_mean_s = {delay_mean_s:?}\ndelay_std_s = {delay_std_s:?}\nloss = {loss:?}")
            }
            Change::Outage(length_s) => writeln!(text, "outage_s = {length_s:?}"),
            Change::Switch(part, on) => writeln!(text, "{} = {on}", part.key()),
        };
        text
    }
}
