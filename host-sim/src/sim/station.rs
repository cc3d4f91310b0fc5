//! Station identities: the index of a vehicle enters, its station and its driver's request leave.

use holdover::wire::driver_request::DriverRequest;
use holdover::wire::{Predecessor, StationHash};

use super::quantities::{seconds, speed};

/// Number of different stations.
pub const STATIONS: usize = 255;

/// The station of the vehicle with this index. Stations repeat after 255 vehicles, when the first of them is long gone.
#[must_use]
pub const fn station(index: usize) -> StationHash {
    StationHash((index % STATIONS) as u8 + 1)
}

/// The vehicle with this station, in a run of up to 255 vehicles.
#[must_use]
pub const fn index_of(station: StationHash) -> Option<usize> {
    (station.0 as usize).checked_sub(1)
}

/// The request of the driver of a follower, or of a leader.
#[must_use]
pub fn request(ahead: Option<usize>, engaged: bool, target_speed_mps: f64, time_gap_s: f64) -> DriverRequest {
    DriverRequest {
        engaged,
        predecessor: ahead.map_or(Predecessor::None, |ahead| Predecessor::Station(station(ahead))),
        target_speed: speed(target_speed_mps),
        time_gap: Some(seconds(time_gap_s)),
    }
}
