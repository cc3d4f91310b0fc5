//! Inputs of the tests of a corridor: the corridor that comes with the program, the corridor of a text, and a plain
//! sighting of a vehicle.

use std::path::Path;

use super::description::Corridor;
use super::read;
use super::watch::Sighting;
use crate::sim::station::station;

/// The scenario file that comes with the program.
pub const TEXT: &str = include_str!("../../scenarios/corridor.toml");

/// The corridor of a scenario text.
pub fn of(text: &str) -> Corridor {
    read::corridor(Path::new("corridor.toml"), text, &Default::default()).expect("a corridor")
}

/// The corridor that comes with the program.
pub fn corridor() -> Corridor {
    of(TEXT)
}

/// A car at `way_m` on a road, at 10 m/s, without a target.
pub fn sighting(trip: usize, road: usize, way_m: f64) -> Sighting {
    Sighting {
        trip,
        station: station(trip),
        road,
        way_m,
        length_m: 4.8,
        speed_mps: 10.0,
        odometer_m: 0.0,
        next: None,
        followed: None,
        belief: None,
        limited: false,
        dark: false,
    }
}
