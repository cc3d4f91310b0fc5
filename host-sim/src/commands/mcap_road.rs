//! The file of a run on roads for Foxglove, Lichtblick and other readers of MCAP: the sightings of every tick enter; a file leaves.
//!
//! | topic | schema | what |
//! |---|---|---|
//! | `/station/N` | `holdover.RoadVehicle` | motion on the own road, command, mode, next intersection, and the estimate of the vehicle ahead |
//! | `/station/N/fix` | `foxglove.LocationFix` | its place on the map |
//!
//! Vehicles come and go, and a number of a station is used again a minute after its vehicle has vanished. So there are at most 255 of
//! them, however long the run is; `trip` says which vehicle it is. Positions are along the own road. Those of the estimate are on the same
//! axis, as in `--trajectories`.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Serialize;

use super::mcap_writer::{FIX, McapWriter, fix, location_fix, properties};
use crate::error::Error;
use crate::measure::figures::mode_name;
use crate::roads::beliefs::on_axis;
use crate::roads::network::Network;
use crate::roads::watch::{Sighting, Watch};

/// The file, as far as it is written.
pub struct RoadMcap<'a> {
    network: &'a Network,
    writer: McapWriter,
    /// For each station its state, and its place on the map.
    channels: BTreeMap<u8, (u16, u16)>,
}

/// A tick of a vehicle.
#[derive(Serialize)]
struct State {
    t_s: f64,
    trip: usize,
    road: usize,
    position_m: f64,
    speed_mps: f64,
    acceleration_mps2: f64,
    command_mps2: f64,
    mode: &'static str,
    limited: bool,
    next: Option<usize>,
    target: Option<usize>,
    target_position_m: Option<f64>,
    target_speed_mps: Option<f64>,
    target_error_m: Option<f64>,
    age_s: Option<f64>,
    lowest_position_m: Option<f64>,
    highest_position_m: Option<f64>,
}

const STATE: [&str; 17] = [
    "t_s",
    "trip",
    "road",
    "position_m",
    "speed_mps",
    "acceleration_mps2",
    "command_mps2",
    "mode",
    "limited",
    "next",
    "target",
    "target_position_m",
    "target_speed_mps",
    "target_error_m",
    "age_s",
    "lowest_position_m",
    "highest_position_m",
];

impl<'a> RoadMcap<'a> {
    /// An empty file.
    ///
    /// # Errors
    /// A file that cannot be created.
    pub fn of(file: &Path, network: &'a Network) -> Result<Self, Error> {
        Ok(Self { network, writer: McapWriter::of(file)?, channels: BTreeMap::new() })
    }

    /// Ends the file.
    ///
    /// # Errors
    /// A file that could not be written.
    pub fn finish(self) -> Result<(), Error> {
        self.writer.finish()
    }
}

impl Watch for RoadMcap<'_> {
    fn tick(&mut self, at_s: f64, sightings: &[Sighting]) {
        let Self { network, writer, channels } = self;
        for own in sightings {
            let number = own.station.0;
            let (state, place) = *channels.entry(number).or_insert_with(|| {
                let topic = format!("/station/{number}");
                let state = writer.channel("holdover.RoadVehicle", &properties(&STATE), &topic);
                (state, writer.channel(FIX, &location_fix(), &format!("{topic}/fix")))
            });
            let target = own.followed.and_then(|station| sightings.iter().find(|other| other.station == station));
            writer.write(state, at_s, &state_of(network, at_s, own, target));
            let point = network.lanes[own.road].road.at(own.way_m).0;
            writer.write(place, at_s, &fix(at_s, point.latitude, point.longitude));
        }
        writer.next();
    }

    fn left(&mut self, _: f64, _: usize) {}
}

fn state_of(network: &Network, at_s: f64, own: &Sighting, target: Option<&Sighting>) -> State {
    let belief = own.belief.map(|belief| belief.behind(own.odometer_m));
    let bound = belief.and_then(|belief| belief.bound);
    let truth_m = target.and_then(|target| on_axis(network, own, target));
    State {
        t_s: at_s,
        trip: own.trip,
        road: own.road,
        position_m: own.way_m,
        speed_mps: own.speed_mps,
        acceleration_mps2: own.acceleration_mps2,
        command_mps2: own.command_mps2,
        mode: mode_name(own.mode),
        limited: own.limited,
        next: own.next,
        target: target.map(|target| target.trip),
        target_position_m: belief.map(|belief| belief.position_m),
        target_speed_mps: belief.map(|belief| belief.speed_mps),
        target_error_m: belief.zip(truth_m).map(|(belief, truth_m)| belief.position_m - truth_m),
        age_s: belief.map(|belief| belief.age_s),
        lowest_position_m: bound.map(|bound| bound.lowest_position_m),
        highest_position_m: bound.map(|bound| bound.highest_position_m),
    }
}
