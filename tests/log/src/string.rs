//! The log of a string of vehicles: the bus of the ego in the scenario, behind faults of the bus, with the unit's ticks.

use std::error::Error;
use std::path::Path;

use embedded_can::{Frame as _, Id};
use holdover::time::{Duration, Instant};
use holdover::wire::catalogue::{Content, Speaker};
use holdover_replay::{Event, Head};
use holdover_sim::bus::Bus;
use holdover_sim::bus::fault::{FaultModel, Faults};
use holdover_sim::bus::memory::MemoryBus;
use holdover_sim::input::scenario::{Overrides, Scenario};
use holdover_sim::sim::world::{self, World};

use crate::life::Life;
use crate::{Log, START, heard, instant, is_of_the_unit, line};

/// Records it. The unit has to pass through every mode, and to have something to refuse, or the log shows little.
pub fn record() -> Result<(Log, Life), Box<dyn Error>> {
    let file = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/string.toml"));
    let scenario = Scenario::read(Some(file), &Overrides::default()).map_err(|error| error.to_string())?;
    let head = Head { config: world::config(&scenario, scenario.ego), itinerary: None };
    let log = Log { events: events(&scenario, head.config.period)?, head };
    let life = Life::through(&log)?;
    if life.modes.len() < 5 || life.refused == 0 {
        return Err(format!("the log does not lead through all modes, or nothing in it is refused: {life}").into());
    }
    Ok((log, life))
}

fn events(scenario: &Scenario, period: Duration) -> Result<Vec<(Instant, Event)>, Box<dyn Error>> {
    let world = World::new(scenario, scenario.seed, Some(scenario.ego))?;
    let trace = world.run(|_| ())?;
    let bus = MemoryBus::new();
    let (mut sender, receiver) = (bus.node(), bus.node());
    let model = FaultModel {
        drop: 0.01,
        corrupt: 0.01,
        duplicate: 0.01,
        delay: 0.02,
        longest_delay: Duration::from_millis(30),
    };
    let mut receiver = Faults::new(receiver, model, scenario.seed, 0);
    let mut last = START;
    for (at_s, frame) in &trace.log {
        last = last.max(instant(*at_s));
        if !is_of_the_unit(frame.id()) && !is_silenced(*at_s, frame.id()) {
            sender.send(instant(*at_s), *frame)?;
        }
    }
    let mut events = Vec::new();
    let mut now = START.minus(Duration::from_millis(1_000));
    while now <= last {
        // A tick begins some microseconds after its period, never the same.
        now = now.plus(period);
        let jitter = Duration::from_micros((now.as_micros() / 10_000 % 7) as i64);
        while let Some((at, frame)) = receiver.receive(now.plus(jitter))? {
            events.push((at, heard(&frame)));
        }
        events.push((now.plus(jitter), Event::Tick));
    }
    Ok(events)
}

/// For a while the ego's own motion is missing.
fn is_silenced(at_s: f64, id: Id) -> bool {
    let is_own = line(id).is_some_and(|line| matches!(line.content, Content::Said(Speaker::Ego, _)));
    is_own && (50.0..50.4).contains(&at_s)
}
