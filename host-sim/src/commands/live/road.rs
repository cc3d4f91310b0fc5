//! A corridor on its stage: its description enters; a world that goes on tick by tick leaves, in which vehicles appear and leave, and what
//! there is to see of it.
//!
//! Vehicles arrive for a day. Up to any time they are those of a run of that length: no arrival depends on later ones.

use std::collections::{BTreeMap, BTreeSet};
use std::io;

use super::bus_view::{BusView, Row};
use super::methods::Methods;
use super::road_scene;
use super::scene::{Pulse, Scene};
use super::stage::{Play, Stage};
use crate::bus::Frame;
use crate::error::Error;
use crate::input::scenario::{Event, Fleet};
use crate::roads::Corridor;
use crate::roads::conditions::Conditions;
use crate::roads::experiment::Experiment;
use crate::roads::network::Network;
use crate::roads::read;
use crate::roads::touching;
use crate::roads::traffic::Traffic;
use crate::roads::trips::Trip;
use crate::roads::watch::{Sighting, Watch};

/// Vehicles arrive for so long, in seconds: as long as a scenario may be.
const ARRIVALS_S: f64 = 86_400.0;

/// A corridor that is played.
pub struct RoadPlay {
    /// The corridor with its map. Its vehicles arrive for a day.
    pub experiment: Experiment,
    /// The vehicles.
    pub trips: Vec<Trip>,
    /// The index of the ego's trip.
    pub ego: Option<usize>,
    fleet: Fleet,
}

impl RoadPlay {
    /// Of a checked description.
    #[must_use]
    pub fn new(corridor: Corridor) -> Self {
        let experiment = Experiment::new(Corridor { duration_s: ARRIVALS_S, ..corridor });
        let (trips, ego) = experiment.trips(experiment.corridor.seed);
        let fleet = read::fleet(&experiment.corridor);
        Self { experiment, trips, ego, fleet }
    }

    /// The world at its start, in which what the scenario says happens.
    #[must_use]
    pub fn traffic(&self) -> Traffic<'_> {
        let Experiment { corridor, network, itineraries } = &self.experiment;
        Traffic::new(corridor, network, itineraries, &self.trips, Conditions::of(corridor), corridor.seed)
    }

    /// The run with these events once more, before these eyes. The bus of the vehicle `logged` is returned as a log.
    ///
    /// # Errors
    /// A configuration that the units refuse, and errors of the buses.
    pub fn again(
        &self,
        events: &[Event],
        ticks: u64,
        logged: Option<usize>,
        watches: &mut [&mut dyn Watch],
    ) -> io::Result<Vec<(f64, Frame)>> {
        let (mut traffic, mut log) = (self.traffic(), Vec::new());
        traffic.expect(events);
        traffic.log(logged);
        while traffic.ticks() < ticks {
            traffic.step(watches, &mut log)?;
        }
        let until_s = traffic.at_s();
        traffic.hand_in(&mut log)?;
        // What is on the bus later depends on what is sent later.
        log.retain(|(at_s, _)| *at_s <= until_s);
        Ok(log)
    }

    /// The frames on the bus of a vehicle up to then, if it has appeared.
    #[must_use]
    pub fn log(&self, events: &[Event], ticks: u64, vehicle: usize) -> Option<Vec<(f64, Frame)>> {
        self.trips.get(vehicle)?;
        self.again(events, ticks, Some(vehicle), &mut []).ok().filter(|log| !log.is_empty())
    }
}

impl Play for RoadPlay {
    type Stage<'a> = RoadStage<'a>;

    fn begin(&self, events: &[Event]) -> io::Result<RoadStage<'_>> {
        let mut traffic = self.traffic();
        traffic.expect(events);
        traffic.fit_twins();
        let seen = Sights::default();
        Ok(RoadStage { play: self, traffic, seen, methods: BTreeMap::new(), buses: BTreeMap::new() })
    }

    fn events(&self) -> &[Event] {
        &self.experiment.corridor.events
    }

    fn period_s(&self) -> f64 {
        self.experiment.corridor.period_s
    }

    fn check(&self, event: &Event) -> Result<(), Error> {
        event.check(&self.fleet)
    }
}

/// What was seen at the latest tick.
#[derive(Clone, Default)]
pub struct Sights {
    /// The vehicles on their way.
    pub on_way: Vec<Sighting>,
    /// Those beyond the end of it.
    pub beyond: Vec<Sighting>,
}

impl Sights {
    /// The pairs of vehicles that run into one another.
    #[must_use]
    pub fn hits(&self, network: &Network) -> Vec<[usize; 2]> {
        let gaps = touching::gaps(network, &self.on_way, &self.beyond).into_iter();
        let on_roads = gaps.filter(|gap| gap.gap_m < 0.0).map(|gap| gap.trips);
        let crossing = touching::crossing(network, &touching::inside(network, &self.on_way));
        let hits: BTreeSet<[usize; 2]> = on_roads.chain(crossing.into_iter().map(|(_, trips)| trips)).collect();
        hits.into_iter().collect()
    }
}

impl Watch for Sights {
    fn beyond(&mut self, sightings: &[Sighting]) {
        self.beyond.clear();
        self.beyond.extend_from_slice(sightings);
    }

    fn tick(&mut self, _: f64, sightings: &[Sighting]) {
        self.on_way.clear();
        self.on_way.extend_from_slice(sightings);
    }

    fn left(&mut self, _: f64, _: usize) {}
}

/// The world of a corridor on its stage.
pub struct RoadStage<'a> {
    play: &'a RoadPlay,
    traffic: Traffic<'a>,
    seen: Sights,
    /// The other methods on the bus of every vehicle, and a listener.
    methods: BTreeMap<usize, Methods>,
    buses: BTreeMap<usize, BusView>,
}

impl RoadStage<'_> {
    /// What was seen at the latest tick.
    #[must_use]
    pub fn seen(&self) -> &Sights {
        &self.seen
    }

    /// For how many vehicles something is kept.
    #[must_use]
    pub fn kept(&self) -> usize {
        self.methods.len().max(self.buses.len())
    }
}

impl Clone for RoadStage<'_> {
    fn clone(&self) -> Self {
        let traffic = self.traffic.clone();
        let on = |(trip, bus): (&usize, &BusView)| Some((*trip, bus.on(&traffic.traveller(*trip)?.vehicle)));
        let buses = self.buses.iter().filter_map(on).collect();
        Self { seen: self.seen.clone(), methods: self.methods.clone(), buses, traffic, ..*self }
    }
}

impl Stage for RoadStage<'_> {
    fn ticks(&self) -> u64 {
        self.traffic.ticks()
    }

    fn next_s(&self) -> f64 {
        self.traffic.at_s()
    }

    fn is_over(&self) -> bool {
        self.traffic.is_over()
    }

    fn has(&self, vehicle: usize) -> bool {
        self.traffic.traveller(vehicle).is_some_and(|traveller| !traveller.has_left())
    }

    fn add(&mut self, event: Event) {
        self.traffic.add(event);
    }

    fn expect(&mut self, events: &[Event]) {
        self.traffic.expect(events);
    }

    fn step(&mut self) -> io::Result<()> {
        let at_s = self.next_s();
        let Self { play, traffic, seen, methods, buses } = self;
        traffic.step(&mut [seen], &mut Vec::new())?;
        methods.retain(|trip, _| traffic.traveller(*trip).is_some());
        buses.retain(|trip, _| traffic.traveller(*trip).is_some());
        for traveller in traffic.travellers() {
            let (trip, vehicle) = (traveller.trip, &traveller.vehicle);
            methods.entry(trip).or_default().look(vehicle, at_s, play.experiment.corridor.step_s);
            buses.entry(trip).or_insert_with(|| BusView::of(vehicle)).listen(vehicle, at_s)?;
        }
        Ok(())
    }

    fn frames(&self, vehicle: usize) -> Option<Vec<Row>> {
        Some(self.buses.get(&vehicle)?.rows())
    }

    fn scene(&self, pulse: &Pulse) -> Scene {
        let Self { play, traffic, seen, methods, buses } = self;
        let at_s = self.ticks().saturating_sub(1) as f64 * self.play.period_s();
        road_scene::of(play, traffic, seen, at_s, pulse, |trip| {
            (methods.get(&trip).map(Methods::places).unwrap_or_default(), buses.get(&trip).map_or(0.0, BusView::load))
        })
    }
}
