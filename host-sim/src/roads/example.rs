//! What the tests of a corridor begin with: nothing, or a file's text, enters; the corridor that comes with the program, or the
//! text's, and a plain sighting of a vehicle, leave.

use std::path::Path;

use super::description::Corridor;
use super::read;
use super::watch::Sighting;
use crate::sim::station::station;

/// The file that comes with the program.
pub const TEXT: &str = include_str!("../../scenarios/corridor.toml");

/// The corridor of a file.
pub fn of(text: &str) -> Corridor {
    read::corridor(Path::new("corridor.toml"), text, &Default::default()).expect("a corridor")
}

/// The one that comes with the program.
pub fn corridor() -> Corridor {
    of(TEXT)
}

/// A car there at 10 m/s that follows nobody.
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
