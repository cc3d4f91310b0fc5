//! What is played, and the stage that it is played on: events enter; a world that goes on tick by tick leaves, and what there is to see of
//! it. Nothing that looks changes what happens: the trajectories are those of `run`.

use std::io;

use super::bus_view::Row;
use super::onlookers::Onlookers;
use super::scene::{Pulse, Scene};
use crate::error::Error;
use crate::input::scenario::{Event, Scenario};
use crate::sim::stages::Stages;
use crate::sim::world::{Tick, World};

/// What is played: a scenario.
pub trait Play {
    /// Its stage.
    type Stage<'a>: Stage
    where
        Self: 'a;

    /// The stage at the start, with these events to come. Every unit has a twin with the other envelope, so that a switch shows at once.
    ///
    /// # Errors
    /// A configuration that the units refuse, and errors of the buses.
    fn begin(&self, events: &[Event]) -> io::Result<Self::Stage<'_>>;

    /// The events of the scenario's file.
    fn events(&self) -> &[Event];

    /// Period of the ticks.
    fn period_s(&self) -> f64;

    /// Whether an event can happen in it.
    ///
    /// # Errors
    /// Why not.
    fn check(&self, event: &Event) -> Result<(), Error>;
}

/// A world that goes on, and those who look at it. A copy goes on in the same way.
pub trait Stage: Clone {
    /// Number of ticks so far.
    fn ticks(&self) -> u64;

    /// The time of the next tick.
    fn next_s(&self) -> f64;

    /// Whether there is nothing more to come.
    fn is_over(&self) -> bool;

    /// Whether the vehicle is there.
    fn has(&self, vehicle: usize) -> bool;

    /// Adds an event that is due at the next tick, in the place of all that were to happen later.
    fn add(&mut self, event: Event);

    /// From now on these events happen, the first of which are those that have happened.
    fn expect(&mut self, events: &[Event]);

    /// One tick.
    ///
    /// # Errors
    /// Errors of the buses.
    fn step(&mut self) -> io::Result<()>;

    /// The newest frames on the bus of a vehicle.
    fn frames(&self, vehicle: usize) -> Option<Vec<Row>>;

    /// What there is to see.
    fn scene(&self, pulse: &Pulse) -> Scene;
}

impl Play for Scenario {
    type Stage<'a> = StringStage<'a>;

    fn begin(&self, events: &[Event]) -> io::Result<StringStage<'_>> {
        let refused = |cause: holdover::ConfigError| io::Error::new(io::ErrorKind::InvalidInput, cause.to_string());
        let mut world = World::new(self, self.seed, None).map_err(refused)?.unrecorded();
        world.expect(events);
        world.fit_twins().map_err(refused)?;
        let onlookers = Onlookers::of(&world, self);
        world.warm_up()?;
        Ok(StringStage { scenario: self, world, ticks: 0, onlookers })
    }

    fn events(&self) -> &[Event] {
        &self.events
    }

    fn period_s(&self) -> f64 {
        self.period_s
    }

    fn check(&self, event: &Event) -> Result<(), Error> {
        event.check(&self.fleet())
    }
}

/// The world of a string on its stage.
pub struct StringStage<'a> {
    scenario: &'a Scenario,
    world: World<'a>,
    ticks: u64,
    onlookers: Onlookers,
}

impl StringStage<'_> {
    /// The latest tick of every vehicle.
    #[must_use]
    pub fn latest(&self) -> &[Tick] {
        self.onlookers.latest()
    }
}

impl Clone for StringStage<'_> {
    fn clone(&self) -> Self {
        let world = self.world.clone();
        Self { onlookers: self.onlookers.on(&world), world, ..*self }
    }
}

impl Stage for StringStage<'_> {
    fn ticks(&self) -> u64 {
        self.ticks
    }

    fn next_s(&self) -> f64 {
        self.ticks as f64 * self.scenario.period_s
    }

    fn is_over(&self) -> bool {
        self.scenario.leader.motion.is_some() && self.ticks as usize >= self.world.ticks()
    }

    fn has(&self, vehicle: usize) -> bool {
        vehicle < self.world.vehicles().len()
    }

    fn add(&mut self, event: Event) {
        self.world.add(event);
    }

    fn expect(&mut self, events: &[Event]) {
        self.world.expect(events);
    }

    fn step(&mut self) -> io::Result<()> {
        let at_s = self.next_s();
        let Self { world, onlookers, .. } = self;
        world.tick(at_s, |world| onlookers.see(world, at_s))?;
        self.ticks += 1;
        Ok(())
    }

    fn frames(&self, vehicle: usize) -> Option<Vec<Row>> {
        self.onlookers.frames(vehicle)
    }

    fn scene(&self, pulse: &Pulse) -> Scene {
        let at_s = self.ticks.saturating_sub(1) as f64 * self.scenario.period_s;
        self.onlookers.scene(&self.world, self.scenario, at_s, pulse)
    }
}
