//! What the page is told of a corridor: the vehicles at a tick enter; each leaves with its leg, its place in the order, and the vehicle
//! that it follows as its unit believes it to be. The roads leave once.

use holdover::coordination::Entry;

use super::methods::Places;
use super::road::{RoadPlay, Sights};
use super::scene::{Ghost, Map, Pulse, Role, Scene, Seen, Square, Street, Way, links, rounded};
use crate::input::kind::Kind;
use crate::measure::figures::mode_name;
use crate::roads::beliefs::on_axis;
use crate::roads::network::Network;
use crate::roads::traffic::{Traffic, Traveller};
use crate::roads::watch::Sighting;
use crate::sim::globe::Shift;

/// The scene. `beside` tells of a vehicle where the other methods put the one ahead, and the load of its bus.
pub fn of(
    play: &RoadPlay,
    traffic: &Traffic<'_>,
    seen: &Sights,
    at_s: f64,
    pulse: &Pulse,
    beside: impl Fn(usize) -> (Places, f64),
) -> Scene {
    let all: Vec<&Sighting> = seen.on_way.iter().chain(&seen.beyond).collect();
    let entries = entries(traffic);
    let vehicles = traffic.travellers().filter_map(|traveller| {
        let own = all.iter().find(|own| own.trip == traveller.trip)?;
        let look = Look { play, traffic, all: &all, at_s };
        let (places, load) = beside(traveller.trip);
        Some(look.seen(traveller, own, places, load, place(&entries, own.trip)))
    });
    Scene {
        at_s: rounded(at_s),
        pulse: pulse.clone(),
        largest_error_m: [None; 2],
        hits: seen.hits(&play.experiment.network),
        links: links(traffic.radios()),
        vehicles: vehicles.collect(),
    }
}

/// The vehicles that have arrived at an intersection: the intersection, the trip, and what the vehicle tells.
fn entries(traffic: &Traffic<'_>) -> Vec<(usize, usize, Entry)> {
    let entry = |traveller: &Traveller| {
        let coordination = traveller.vehicle.unit.coordination();
        let entry = Entry {
            station: traveller.vehicle.unit.config().station,
            arrival: Some(coordination.registration()?.arrival),
            claim: coordination.claim(),
            leg: coordination.leg(),
        };
        Some((usize::from(coordination.crossing()?.intersection.id), traveller.trip, entry))
    };
    traffic.travellers().filter(|traveller| !traveller.has_left()).filter_map(entry).collect()
}

/// The place of a vehicle in the order at its intersection, from 1 on.
fn place(entries: &[(usize, usize, Entry)], trip: usize) -> Option<usize> {
    let (next, _, own) = entries.iter().find(|(_, other, _)| *other == trip)?;
    Some(1 + entries.iter().filter(|(at, _, other)| at == next && other.is_before(own)).count())
}

/// What is looked at.
struct Look<'a> {
    play: &'a RoadPlay,
    traffic: &'a Traffic<'a>,
    all: &'a [&'a Sighting],
    at_s: f64,
}

impl Look<'_> {
    fn seen(&self, traveller: &Traveller, own: &Sighting, places: Places, load: f64, place: Option<usize>) -> Seen {
        let (network, vehicle) = (&self.play.experiment.network, &traveller.vehicle);
        let target = own.followed.and_then(|station| self.all.iter().find(|other| other.station == station));
        // Where the target truly is on the own way. What is said of it on the own odometer is carried to its own road.
        let ahead = target.and_then(|target| Some((*target, on_axis(network, own, target)?)));
        let carried = |position_m: f64| ahead.map(|(target, at_m)| position_m - own.odometer_m - at_m + target.way_m);
        let ghost = |(target, at_m): (&Sighting, f64)| {
            let belief = own.belief?.behind(own.odometer_m + at_m - target.way_m);
            Some(Ghost::of(&belief, target.trip, target.way_m))
        };
        let heard_of = target.map_or(own.trip, |target| target.trip);
        Seen {
            id: own.trip,
            position_m: rounded(own.way_m),
            speed_mps: rounded(own.speed_mps),
            acceleration_mps2: rounded(own.acceleration_mps2),
            command_mps2: rounded(own.command_mps2),
            mode: mode_name(own.mode),
            is_limited: own.limited,
            is_driven: vehicle.is_driven(),
            is_plain: vehicle.is_plain(),
            has_envelope: vehicle.unit.config().envelope.is_some(),
            sees: vehicle.sees() && traveller.sees,
            is_silent: self.traffic.is_cut_off(heard_of, own.trip, self.at_s),
            gap_m: ahead.map(|(target, at_m)| rounded(at_m - target.length_m - own.way_m)),
            load: rounded(load),
            target: ahead.and_then(ghost),
            paper_m: places.paper_m.and_then(carried).map(rounded),
            newest_m: places.newest_m.and_then(carried).map(rounded),
            way: Some(Way {
                road: own.road,
                kind: self.play.trips[own.trip].kind.name(),
                has_left: traveller.has_left(),
                next: own.next.filter(|_| !traveller.has_left()),
                place,
                to_m: crossing_m(network, own).map(rounded),
                follows: target.map(|target| target.trip),
            }),
        }
    }
}

/// The distance to the crossing point of the intersection that the unit takes for the next one.
fn crossing_m(network: &Network, own: &Sighting) -> Option<f64> {
    let stop = network.lanes[own.road].stops.iter().find(|stop| Some(stop.intersection) == own.next)?;
    Some(stop.at_m - own.way_m)
}

/// The roads.
#[must_use]
pub fn map(play: &RoadPlay) -> Map {
    let (network, corridor) = (&play.experiment.network, &play.experiment.corridor);
    let origin = network.lanes.first().map(|lane| lane.road.at(0.0).0);
    let roads = network.lanes.iter().zip(&corridor.roads).map(|(lane, plan)| {
        let mut ways_m: Vec<f64> = lane.road.path.segments.iter().map(|one| one.begins.get().to_num()).collect();
        ways_m.push(lane.road.length_m() - 1e-6);
        let corner = |way_m: f64| {
            let shift = origin.map(|origin| Shift::between(origin, lane.road.at(way_m).0));
            let (east_m, north_m) = shift.map_or((0.0, 0.0), |shift| (shift.east_m, shift.north_m));
            [way_m, east_m, north_m].map(rounded)
        };
        let points = ways_m.into_iter().map(corner).collect();
        Street { name: plan.name.clone(), points, ends_m: [lane.entry_m, lane.exit_m].map(rounded) }
    });
    let intersections = network.junctions.iter().zip(&corridor.intersections).map(|(junction, plan)| Square {
        name: plan.name.clone(),
        half_m: junction.half_m,
        legs: junction.legs.iter().map(|leg| (leg.road, rounded(leg.at_m))).collect(),
    });
    let kinds = Kind::ALL.map(|kind| {
        let limits = kind.limits();
        let role = Role {
            name: kind.name().into(),
            length_m: kind.length_m(),
            has_sensor: corridor.sensors.share > 0.0,
            most_mps2: limits.acceleration.get().to_num(),
            braking_mps2: limits.emergency_braking.get().to_num(),
        };
        (kind.name(), role)
    });
    Map { roads: roads.collect(), intersections: intersections.collect(), kinds: kinds.into_iter().collect() }
}
