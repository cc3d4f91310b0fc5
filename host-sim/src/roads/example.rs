//! Inputs of the tests of a corridor: the corridor that comes with the program, the corridor of a text, a plain trip,
//! and a plain sighting of a vehicle.

use std::path::Path;

use super::description::Corridor;
use super::read;
use super::trips::Trip;
use super::watch::Sighting;
use crate::input::kind::Kind;
use crate::sim::station::station;
use holdover::wire::command::ModeCode;

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

/// A car that arrives by a road at time 0, at 10 m/s, and is silent only after a minute.
pub fn trip(road: usize) -> Trip {
    Trip { road, at_s: 0.0, speed_mps: 10.0, kind: Kind::Car, dark_after_s: 60.0, odometer_m: 0.0 }
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
        acceleration_mps2: 0.0,
        command_mps2: 0.0,
        mode: ModeCode::Cooperative,
        odometer_m: 0.0,
        next: None,
        followed: None,
        belief: None,
        foreseen_entry_s: None,
        limited: false,
        dark: false,
        mistakes_time: false,
    }
}
