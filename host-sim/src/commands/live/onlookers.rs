//! Those who look at the world of a string: it enters at every tick; what there is to see of it leaves. Nothing that looks changes what
//! happens: the trajectories are those of `run`.

use std::io;

use super::bus_view::{BusView, Row};
use super::scene::{Ghost, Pulse, Scene, Seen, links, rounded};
use crate::input::scenario::Scenario;
use crate::measure::baseline::Baseline;
use crate::measure::baseline::freeze::Freeze;
use crate::measure::baseline::paper::Paper;
use crate::measure::figures::mode_name;
use crate::measure::metrics::SETTLED_FROM_S;
use crate::measure::observer::Tap;
use crate::sim::world::{Measured, Tick, Trace, World};

/// Those who look at a world.
pub struct Onlookers {
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

impl Onlookers {
    /// On a world at its start, before it has warmed up.
    #[must_use]
    pub fn of(world: &World<'_>, scenario: &Scenario) -> Self {
        let watcher = |by: usize| Watcher {
            tap: Tap::between(world, Measured { vehicle: by - 1, by }),
            paper: Paper::new(by - 1, scenario.step_s),
            newest: Freeze::new(by - 1),
            paper_m: None,
            newest_m: None,
        };
        let watchers = (1..world.vehicles().len()).map(watcher).collect();
        let buses = world.vehicles().iter().map(BusView::of).collect();
        Self { watchers, buses, trace: world.trace().of_at_most(2), largest_error_m: [None; 2] }
    }

    /// The same on a copy of their world.
    #[must_use]
    pub fn on(&self, copy: &World<'_>) -> Self {
        let vehicles = copy.vehicles();
        let watcher = |(place, watcher): (usize, &Watcher)| Watcher {
            tap: watcher.tap.on(&vehicles[place + 1]),
            paper: watcher.paper.clone(),
            newest: watcher.newest.clone(),
            ..*watcher
        };
        let trace = Trace { latest: self.trace.latest.clone(), ..copy.trace().of_at_most(2) };
        Self {
            watchers: self.watchers.iter().enumerate().map(watcher).collect(),
            buses: self.buses.iter().zip(vehicles).map(|(bus, vehicle)| bus.on(vehicle)).collect(),
            trace,
            ..*self
        }
    }

    /// They see the world at a tick.
    ///
    /// # Errors
    /// Errors of the buses.
    pub fn see(&mut self, world: &World<'_>, at_s: f64) -> io::Result<()> {
        let Self { watchers, buses, trace, .. } = self;
        world.note(at_s, trace);
        watchers.iter_mut().try_for_each(|watcher| watcher.watch(world, at_s))?;
        buses.iter_mut().zip(world.vehicles()).try_for_each(|(bus, vehicle)| bus.listen(vehicle, at_s))?;
        if at_s >= SETTLED_FROM_S {
            self.judge(world.measured());
        }
        Ok(())
    }

    /// The latest tick of every vehicle.
    #[must_use]
    pub fn latest(&self) -> &[Tick] {
        &self.trace.latest
    }

    /// Where the literal paper's method puts the measured vehicle.
    #[must_use]
    pub fn paper_m(&self, Measured { by, .. }: Measured) -> Option<f64> {
        by.checked_sub(1).and_then(|place| self.watchers.get(place)?.paper_m)
    }

    /// The newest frames on the bus of a vehicle.
    #[must_use]
    pub fn frames(&self, vehicle: usize) -> Option<Vec<Row>> {
        Some(self.buses.get(vehicle)?.rows())
    }

    /// What there is to see of the latest tick.
    #[must_use]
    pub fn scene(&self, world: &World<'_>, scenario: &Scenario, at_s: f64, pulse: &Pulse) -> Scene {
        let vehicles: Vec<Seen> =
            (0..self.trace.latest.len()).map(|index| self.seen(world, scenario, index, at_s)).collect();
        let hits = vehicles.iter().filter(|seen| seen.gap_m.is_some_and(|gap_m| gap_m < 0.0));
        Scene {
            at_s: rounded(at_s),
            pulse: pulse.clone(),
            largest_error_m: self.largest_error_m.map(|error| error.map(rounded)),
            hits: hits.map(|seen| [seen.id - 1, seen.id]).collect(),
            links: links(world.radios()),
            vehicles,
        }
    }

    fn judge(&mut self, Measured { vehicle, by }: Measured) {
        let (Some(truth), Some(seen)) = (self.trace.latest.get(vehicle), self.trace.latest.get(by)) else { return };
        let ours = seen.target.map(|target| target.position_m);
        let papers = self.paper_m(Measured { vehicle, by });
        for (largest, estimate) in self.largest_error_m.iter_mut().zip([ours, papers]) {
            let error = estimate.map(|estimate_m| (estimate_m - truth.position_m).abs());
            *largest = error.map_or(*largest, |error| Some(largest.map_or(error, |before| before.max(error))));
        }
    }

    fn seen(&self, world: &World<'_>, scenario: &Scenario, index: usize, at_s: f64) -> Seen {
        let tick = &self.trace.latest[index];
        let vehicle = &world.vehicles()[index];
        let ahead = index.checked_sub(1).map(|ahead| (&self.trace.latest[ahead], world.vehicles()[ahead].length_m));
        let watcher = index.checked_sub(1).map(|place| &self.watchers[place]);
        let ghost = |belief| ahead.map(|(ahead, _)| Ghost::of(&belief, index - 1, ahead.position_m));
        Seen {
            id: index,
            position_m: rounded(tick.position_m),
            speed_mps: rounded(tick.speed_mps),
            acceleration_mps2: rounded(tick.acceleration_mps2),
            command_mps2: rounded(tick.command_mps2),
            mode: mode_name(tick.mode),
            is_limited: tick.limited,
            is_driven: vehicle.is_driven(),
            is_plain: vehicle.is_plain(),
            has_envelope: vehicle.unit.config().envelope.is_some(),
            sees: vehicle.sees() && scenario.vehicles[index].range_sensor.is_some(),
            is_silent: world.is_in_silence(index, at_s),
            gap_m: ahead.map(|(ahead, length_m)| rounded(ahead.position_m - length_m - tick.position_m)),
            load: rounded(self.buses[index].load()),
            target: tick.target.and_then(ghost),
            paper_m: watcher.and_then(|watcher| watcher.paper_m).map(rounded),
            newest_m: watcher.and_then(|watcher| watcher.newest_m).map(rounded),
            way: None,
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
