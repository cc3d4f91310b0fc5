//! The world on a stage: a scenario with its events enters; it goes on tick by tick, and what there is to see of it leaves. Nothing that
//! looks changes what happens: the trajectories are those of `run`.

use std::io;

use super::bus_view::{BusView, Row};
use super::scene::{Ghost, Scene, Seen, rounded};
use crate::input::scenario::{Event, Scenario};
use crate::measure::baseline::Baseline;
use crate::measure::baseline::freeze::Freeze;
use crate::measure::baseline::paper::Paper;
use crate::measure::figures::mode_name;
use crate::measure::metrics::SETTLED_FROM_S;
use crate::measure::observer::Tap;
use crate::sim::stages::Stages;
use crate::sim::world::{Measured, Tick, Trace, World};

/// The world, and those who look at it.
pub struct Stage<'a> {
    scenario: &'a Scenario,
    world: World<'a>,
    ticks: u64,
    /// For every vehicle but the first.
    watchers: Vec<Watcher>,
    buses: Vec<BusView>,
    trace: Trace,
    /// Since the link has settled: of the units, and of the literal paper.
    largest_error_m: [Option<f64>; 2],
}

/// The other methods on the bus of a vehicle.
struct Watcher {
    tap: Tap,
    paper: Paper,
    newest: Freeze,
    paper_m: Option<f64>,
    newest_m: Option<f64>,
}

impl<'a> Stage<'a> {
    /// The world at its start.
    ///
    /// # Errors
    /// A configuration that the units refuse, and errors of the buses.
    pub fn new(scenario: &'a Scenario) -> io::Result<Self> {
        let mut world = World::new(scenario, scenario.seed, None)
            .map_err(|cause| io::Error::new(io::ErrorKind::InvalidInput, cause.to_string()))?;
        let watcher = |by: usize| Watcher {
            tap: Tap::between(&world, Measured { vehicle: by - 1, by }),
            paper: Paper::new(by - 1, scenario.step_s),
            newest: Freeze::new(by - 1),
            paper_m: None,
            newest_m: None,
        };
        let watchers = (1..world.vehicles().len()).map(watcher).collect();
        let buses = world.vehicles().iter().map(BusView::of).collect();
        world.warm_up()?;
        let trace = world.trace().of_at_most(2);
        Ok(Self { scenario, world, ticks: 0, watchers, buses, trace, largest_error_m: [None; 2] })
    }

    /// The time of the next tick.
    #[must_use]
    pub fn next_s(&self) -> f64 {
        self.ticks as f64 * self.scenario.period_s
    }

    /// Number of ticks so far.
    #[must_use]
    pub fn ticks(&self) -> u64 {
        self.ticks
    }

    /// Whether the recording that the leader drives is over.
    #[must_use]
    pub fn is_over(&self) -> bool {
        self.scenario.leader.motion.is_some() && self.ticks as usize >= self.world.ticks()
    }

    /// Adds an event that is due at the next tick, in the place of all that were to happen later.
    pub fn add(&mut self, event: Event) {
        self.world.add(event);
    }

    /// Whether the envelopes can be switched without a new start.
    #[must_use]
    pub fn has_twins(&self) -> bool {
        self.world.has_twins()
    }

    /// One tick.
    ///
    /// # Errors
    /// Errors of the buses.
    pub fn step(&mut self) -> io::Result<()> {
        let at_s = self.next_s();
        let Self { world, watchers, buses, trace, .. } = self;
        world.tick(at_s, |world| {
            world.note(at_s, trace);
            watchers.iter_mut().try_for_each(|watcher| watcher.watch(world, at_s))?;
            buses.iter_mut().zip(world.vehicles()).try_for_each(|(bus, vehicle)| bus.listen(vehicle, at_s))
        })?;
        self.ticks += 1;
        if at_s >= SETTLED_FROM_S {
            self.judge();
        }
        Ok(())
    }

    /// The latest tick of every vehicle.
    #[must_use]
    pub fn latest(&self) -> &[Tick] {
        &self.trace.latest
    }

    /// The newest frames on the bus of a vehicle.
    #[must_use]
    pub fn frames(&self, vehicle: usize) -> Option<Vec<&Row>> {
        Some(self.buses.get(vehicle)?.rows())
    }

    /// What there is to see. Time and pace are the engine's.
    #[must_use]
    pub fn scene(&self, is_playing: bool, [pace, rate]: [f64; 2], events: [usize; 2]) -> Scene {
        let at_s = self.ticks.saturating_sub(1) as f64 * self.scenario.period_s;
        Scene {
            at_s: rounded(at_s),
            ticks: self.ticks,
            is_playing,
            pace,
            rate: rounded(rate),
            events,
            largest_error_m: self.largest_error_m.map(|error| error.map(rounded)),
            vehicles: (0..self.trace.latest.len()).map(|index| self.seen(index, at_s)).collect(),
        }
    }

    fn judge(&mut self) {
        let Measured { vehicle, by } = self.world.measured();
        let (Some(truth), Some(seen)) = (self.trace.latest.get(vehicle), self.trace.latest.get(by)) else { return };
        let ours = seen.target.map(|target| target.position_m);
        let papers = by.checked_sub(1).and_then(|place| self.watchers.get(place)?.paper_m);
        for (largest, estimate) in self.largest_error_m.iter_mut().zip([ours, papers]) {
            let error = estimate.map(|estimate_m| (estimate_m - truth.position_m).abs());
            *largest = error.map_or(*largest, |error| Some(largest.map_or(error, |before| before.max(error))));
        }
    }

    fn seen(&self, index: usize, at_s: f64) -> Seen {
        let tick = &self.trace.latest[index];
        let vehicle = &self.world.vehicles()[index];
        let ahead =
            index.checked_sub(1).map(|ahead| (&self.trace.latest[ahead], self.world.vehicles()[ahead].length_m));
        let watcher = index.checked_sub(1).map(|place| &self.watchers[place]);
        Seen {
            position_m: rounded(tick.position_m),
            speed_mps: rounded(tick.speed_mps),
            acceleration_mps2: rounded(tick.acceleration_mps2),
            command_mps2: rounded(tick.command_mps2),
            mode: mode_name(tick.mode),
            is_limited: tick.limited,
            is_driven: vehicle.is_driven(),
            is_plain: vehicle.is_plain(),
            has_envelope: vehicle.unit.config().envelope.is_some(),
            sees: vehicle.sees() && self.scenario.vehicles[index].range_sensor.is_some(),
            is_silent: self.world.is_in_silence(index, at_s),
            gap_m: ahead.map(|(ahead, length_m)| rounded(ahead.position_m - length_m - tick.position_m)),
            load: rounded(self.buses[index].load()),
            target: ahead.and_then(|(ahead, _)| tick.target.map(|belief| Ghost::of(&belief, ahead.position_m))),
            paper_m: watcher.and_then(|watcher| watcher.paper_m).map(rounded),
            newest_m: watcher.and_then(|watcher| watcher.newest_m).map(rounded),
        }
    }
}

impl Watcher {
    fn watch(&mut self, world: &World<'_>, at_s: f64) -> io::Result<()> {
        let Self { tap, paper, newest, .. } = self;
        tap.hear(world, at_s, |heard| {
            paper.hear(&heard);
            newest.hear(&heard);
        })?;
        let position = |estimate: crate::measure::baseline::Estimate| estimate.position_m;
        self.paper_m = self.paper.estimate(at_s).map(position);
        self.newest_m = self.newest.estimate(at_s).map(position);
        Ok(())
    }
}
