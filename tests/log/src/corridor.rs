//! The log of a vehicle in the corridor: the bus of the ego on its whole way through the intersections, with the ticks of `replay`.
//!
//! The units of the simulation are those of the ECU, so the unit on the ECU has to send what the one in the simulation sent.

use std::collections::BTreeMap;
use std::error::Error;

use embedded_can::{Frame as _, Id};
use holdover_replay::{Event, Head, RECORD, decode};
use holdover_sim::bus::Frame;
use holdover_sim::commands::replay::timeline::Timeline;
use holdover_sim::input::library;
use holdover_sim::input::scenario::Overrides;
use holdover_sim::roads::conditions::Conditions;
use holdover_sim::roads::experiment::Experiment;
use holdover_sim::roads::journal::Journal;
use holdover_sim::roads::{Corridor, read};

use crate::life::Life;
use crate::{Log, heard, instant, is_of_the_unit};

/// Which run it is.
const SEED: u64 = 1;
/// Vehicles arrive for so long, and from this time on the ego: there is traffic before it and behind it.
const ARRIVALS_S: f64 = 100.0;
const EGO_AFTER_S: f64 = 40.0;

/// Records it. It has to show what it is for, or it is refused.
pub fn record() -> Result<(Log, Life), Box<dyn Error>> {
    let experiment = Experiment::new(corridor().map_err(|error| error.to_string())?);
    let corridor = &experiment.corridor;
    let (_, ego) = experiment.trips(SEED);
    let (config, itinerary) = experiment.ego_unit(SEED, corridor.step_s).ok_or("no vehicle is the ego")?;
    let mut journal = Journal::new(ego);
    experiment.run(SEED, Conditions::of(corridor), Some(&mut journal)).map_err(|error| error.to_string())?;
    let mut timeline = Timeline::new(config.period);
    let mut events = Vec::new();
    for (at_s, frame) in &journal.log {
        timeline.read(instant(*at_s)).map_err(|error| error.to_string())?;
        events.extend(std::iter::from_fn(|| timeline.due()).map(|tick| (tick, Event::Tick)));
        if !is_of_the_unit(frame.id()) {
            events.push((instant(*at_s), heard(frame)));
        }
    }
    let log = Log { head: Head { config, itinerary: Some(itinerary) }, events };
    let life = Life::through(&log)?;
    let way: Vec<u8> = itinerary.crossings.iter().map(|crossing| crossing.intersection.id).collect();
    for (is_shown, what) in [
        (config.envelope.is_some() && life.limited > 0, "an envelope at work"),
        (config.range_sensor, "a range sensor"),
        (way.len() >= 4 && life.passed == way, "all intersections of the way"),
        (life.own_passes > 0, "passes of the unit"),
        (life.peer_passes > 0, "passes of other vehicles"),
        (repeats(&life.sent, &journal.log), "the frames that the unit sent in the simulation"),
    ] {
        if !is_shown {
            return Err(format!("the log of the corridor does not show {what}: {life}").into());
        }
    }
    Ok((log, life))
}

/// The corridor of the library, with an ego that comes early.
fn corridor() -> Result<Corridor, holdover_sim::error::Error> {
    let (file, text) = library::text("corridor".as_ref())?;
    let overrides = Overrides { seed: Some(SEED), ..Overrides::default() };
    let corridor = read::corridor(&file, &text, &overrides)?;
    Ok(Corridor { duration_s: ARRIVALS_S, ego_after_s: EGO_AFTER_S, ..corridor })
}

/// Whether these records are of what the unit sent in this log, identifier by identifier: on the bus, frames of several identifiers change
/// places.
fn repeats(records: &[u8], log: &[(f64, Frame)]) -> bool {
    let before = by_identifier(log.iter().map(|(_, frame)| heard(frame)));
    let again = by_identifier(records.chunks(RECORD).filter_map(|record| Some(decode(record.try_into().ok()?)?.1)));
    !before.is_empty() && before.iter().all(|(id, first)| again.get(id).is_some_and(|again| again.starts_with(first)))
}

/// What the unit sent among these events.
fn by_identifier(events: impl Iterator<Item = Event>) -> BTreeMap<Id, Vec<Event>> {
    let mut by_identifier = BTreeMap::<_, Vec<Event>>::new();
    for event in events {
        if let Event::Frame(frame) = event
            && is_of_the_unit(frame.id)
        {
            by_identifier.entry(frame.id).or_default().push(event);
        }
    }
    by_identifier
}
