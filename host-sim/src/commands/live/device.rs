//! A world with a device in it: what the pages ask for and every tick of the run enter; scenes leave. The device drives the ego in real
//! time, so time is its own: it neither stops nor goes back. The run itself is that of `hil`.

use std::collections::VecDeque;
use std::io;
use std::sync::Arc;
use std::sync::mpsc::Receiver;

use tokio::sync::watch;

use super::engine::{Ask, text};
use super::onlookers::Onlookers;
use super::order::Order;
use super::scene::Pulse;
use crate::commands::hil::session::Onlooker;
use crate::commands::interruption::Interruption;
use crate::commands::mcap_file::McapFile;
use crate::error::Error;
use crate::input::scenario::{Change, Event, Fleet, Part, Scenario};
use crate::sim::world::World;

/// A scene so often, in ticks of 10 ms.
const SCENE_EVERY: u64 = 3;
/// Orders of a tick. More wait for the next one, because the device does not wait.
const MOST_ORDERS: usize = 4;

/// The desk before a device.
pub struct Device<'a> {
    scenario: &'a Scenario,
    fleet: Fleet,
    asks: Receiver<Ask>,
    scenes: watch::Sender<Arc<str>>,
    end: &'a Interruption,
    onlookers: Option<Onlookers>,
    mcap: Option<McapFile>,
    events: Vec<Event>,
    ticks: u64,
}

impl<'a> Device<'a> {
    /// A desk before a run that has not begun.
    #[must_use]
    pub fn new(
        scenario: &'a Scenario,
        asks: Receiver<Ask>,
        scenes: watch::Sender<Arc<str>>,
        end: &'a Interruption,
        mcap: Option<McapFile>,
    ) -> Self {
        let (fleet, events) = (scenario.fleet(), scenario.events.clone());
        Self { scenario, fleet, asks, scenes, end, onlookers: None, mcap, events, ticks: 0 }
    }

    /// The file of all ticks, as far as it is written.
    #[must_use]
    pub fn into_mcap(self) -> Option<McapFile> {
        self.mcap
    }

    fn answer(&mut self, world: &mut World<'_>, ask: Ask) {
        // A page that has gone does not wait for its answer.
        match ask {
            Ask::Journal(to) => {
                let _ = to.send((self.events.clone(), self.ticks));
            }
            Ask::Frames(vehicle, to) => {
                let rows = self.onlookers.as_ref().and_then(|onlookers| onlookers.frames(vehicle));
                let _ = to.send(rows.and_then(|rows| serde_json::to_string(&rows).ok()));
            }
            Ask::Do(order, to) => {
                let events = self.events_of(order);
                for event in events.iter().flatten() {
                    world.add(*event);
                    self.events.retain(|other| other.at_s <= event.at_s);
                    self.events.push(*event);
                }
                let _ = to.send(events.map(|_| ()));
            }
        }
    }

    /// The events that an order is. Estimate and envelope of the ego are in the device, so what is switched of all is switched of the
    /// others.
    fn events_of(&self, order: Order) -> Result<Vec<Event>, Error> {
        let ego = self.scenario.ego;
        let refused = |cause: String, remedy: &str| Err(Error::new(cause, remedy));
        let Some(event) = order.event(self.ticks as f64 * self.scenario.period_s) else {
            let cause =
                "time is the device's: it neither stops nor goes back, because nobody can rewind a device".into();
            return refused(cause, "do without it, or start `live` without --bus");
        };
        event.check(&self.fleet)?;
        match (event.change, event.vehicle) {
            (Change::Switch(Part::Envelope | Part::Holdover, _), Some(vehicle)) if vehicle == ego => {
                let cause = format!("vehicle {ego} drives by the device's own estimate and envelope");
                refused(cause, "choose another vehicle, or configure the device")
            }
            (Change::Switch(Part::Envelope | Part::Holdover, _), None) => {
                let others = (0..self.scenario.vehicles.len()).filter(|vehicle| *vehicle != ego);
                Ok(others.map(|vehicle| Event { vehicle: Some(vehicle), ..event }).collect())
            }
            _ => Ok(vec![event]),
        }
    }
}

impl Onlooker for Device<'_> {
    fn begin(&mut self, world: &mut World<'_>) -> io::Result<()> {
        world.fit_twins().map_err(io::Error::other)?;
        self.onlookers = Some(Onlookers::of(world, self.scenario));
        Ok(())
    }

    fn see(&mut self, world: &mut World<'_>, at_s: f64) -> io::Result<bool> {
        self.ticks += 1;
        if let Some(onlookers) = &mut self.onlookers {
            onlookers.see(world, at_s)?;
            let paper_m = onlookers.paper_m(world.measured());
            self.mcap.iter_mut().for_each(|mcap| mcap.note(at_s, onlookers.latest(), paper_m));
        }
        let asks: VecDeque<Ask> = self.asks.try_iter().take(MOST_ORDERS).collect();
        asks.into_iter().for_each(|ask| self.answer(world, ask));
        if let Some(onlookers) = self.onlookers.as_ref().filter(|_| self.ticks.is_multiple_of(SCENE_EVERY)) {
            let events = [self.events.len(); 2];
            let pulse = Pulse { ticks: self.ticks, is_playing: true, pace: 1.0, rate: 1.0, events };
            text(&onlookers.scene(world, self.scenario, at_s, &pulse))
                .into_iter()
                .for_each(|text| drop(self.scenes.send_replace(text)));
        }
        Ok(!self.end.is_asked())
    }

    fn judges(&self) -> bool {
        false
    }
}
