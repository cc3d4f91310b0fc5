//! The trajectories of a corridor's vehicles: the sightings of a tick enter, each beside that of its target; the rows of the file leave.

use super::beliefs;
use super::network::Network;
use super::watch::{Sighting, Watch};
use crate::error::Error;
use crate::measure::trajectories::{Moves, Seen, Trajectories, Wanted};
use crate::sim::globe::Shift;

/// The file, and the roads.
pub struct Records<'a> {
    network: &'a Network,
    file: Trajectories,
}

impl<'a> Records<'a> {
    /// An empty file.
    ///
    /// # Errors
    /// A file that cannot be created.
    pub fn of(wanted: &Wanted, network: &'a Network) -> Result<Self, Error> {
        Ok(Self { network, file: Trajectories::of(wanted)? })
    }

    /// Ends the file.
    ///
    /// # Errors
    /// A file that could not be written.
    pub fn finish(self) -> Result<(), Error> {
        self.file.finish()
    }
}

impl Watch for Records<'_> {
    fn tick(&mut self, at_s: f64, sightings: &[Sighting]) {
        let Self { network, file } = self;
        let origin = network.lanes.first().map(|lane| lane.road.at(0.0).0);
        let seen = |own: &Sighting| {
            let (place, heading_deg) = network.lanes[own.road].road.at(own.way_m);
            let shift = origin.map(|origin| Shift::between(origin, place));
            let target = own.followed.and_then(|station| sightings.iter().find(|other| other.station == station));
            let moves = |target: &Sighting| {
                let position_m = beliefs::on_axis(network, own, target)?;
                Some((target.trip, Moves { position_m, speed_mps: target.speed_mps }))
            };
            Seen {
                vehicle: own.trip,
                road: own.road,
                place_m: shift.map_or((0.0, 0.0), |shift| (shift.east_m, shift.north_m)),
                heading_deg,
                moves: Moves { position_m: own.way_m, speed_mps: own.speed_mps },
                acceleration_mps2: own.acceleration_mps2,
                command_mps2: own.command_mps2,
                mode: own.mode,
                limited: own.limited,
                target: target.and_then(moves),
                belief: own.belief.map(|belief| belief.behind(own.odometer_m)),
            }
        };
        file.note(at_s, sightings.iter().map(seen));
    }

    fn left(&mut self, _: f64, _: usize) {}
}
