//! The trips of a run: a description and a seed enter; every vehicle leaves, with its random properties. All runs of
//! one seed have the same trips, whatever their links and differences.

use rand_chacha::ChaCha8Rng;

use super::description::{Corridor, Radio};
use super::lane::Lane;
use super::network::Network;
use crate::input::impairment::Window;
use crate::input::kind::Kind;
use crate::streams::{Purpose, stream, unit};

/// One vehicle's way through the corridor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trip {
    /// The road of the vehicle.
    pub road: usize,
    /// Time at which it arrives at the start of its way.
    pub at_s: f64,
    /// Speed at which it arrives.
    pub speed_mps: f64,
    /// Kind of vehicle.
    pub kind: Kind,
    /// Time from when it appears on the road until it falls silent. It may have to wait for room before it appears.
    pub dark_after_s: f64,
    /// Its odometer at the beginning of the road.
    pub odometer_m: f64,
}

impl Trip {
    /// The time in which its radio is silent, if it appears at `appears_s`.
    #[must_use]
    pub fn dark(&self, appears_s: f64, radio: &Radio) -> Window {
        let from_s = appears_s + self.dark_after_s;
        Window { from_s, to_s: from_s + radio.dark_s }
    }
}

/// A vehicle that appears has been on the road and on the air before. So its silence begins at the earliest after this
/// time, in seconds.
pub const HEARD_S: f64 = 2.0;

/// The trips, in the order of their arrival.
#[must_use]
pub fn trips(corridor: &Corridor, network: &Network, seed: u64) -> Vec<Trip> {
    let mut trips = Vec::new();
    for (road, (plan, lane)) in corridor.roads.iter().zip(&network.lanes).enumerate() {
        let mut generator = stream(seed, Purpose::Arrivals(u32::try_from(road).unwrap_or(u32::MAX)));
        let mut at_s = next_s(corridor, plan.vehicles_per_min, 0.0, &mut generator);
        while at_s < corridor.duration_s {
            // Every number is drawn for every vehicle, so that no draw depends on the result of another.
            let [pace, sort, dark, odometer] = [(); 4].map(|()| unit(&mut generator));
            let span = corridor.traffic.entry_speed_mps;
            trips.push(Trip {
                road,
                at_s,
                speed_mps: span.low + (span.high - span.low) * pace,
                kind: kind(corridor, sort),
                dark_after_s: moment_s(corridor, lane, HEARD_S, dark),
                odometer_m: 10_000.0 * odometer,
            });
            at_s = next_s(corridor, plan.vehicles_per_min, at_s, &mut generator);
        }
    }
    trips.sort_by(|a, b| a.at_s.total_cmp(&b.at_s).then(a.road.cmp(&b.road)));
    trips
}

/// A moment on a vehicle's way, in seconds since it appeared: not before `first_s`, and uniform from there to the end
/// of the way at the target speed. `draw` is uniform in [0, 1).
pub fn moment_s(corridor: &Corridor, lane: &Lane, first_s: f64, draw: f64) -> f64 {
    let nominal_s = (lane.exit_m - lane.entry_m) / corridor.traffic.target_speed_mps;
    first_s + draw * (nominal_s - first_s).max(0.0)
}

/// The next arrival; infinite if there are none. Arrivals have no memory, except for the least headway. The mean rate
/// is the given one.
fn next_s(corridor: &Corridor, vehicles_per_min: f64, last_s: f64, generator: &mut ChaCha8Rng) -> f64 {
    if vehicles_per_min <= 0.0 {
        return f64::INFINITY;
    }
    let least_s = corridor.traffic.headway_s;
    last_s + least_s - (60.0 / vehicles_per_min - least_s) * (1.0 - unit(generator)).ln()
}

fn kind(corridor: &Corridor, share: f64) -> Kind {
    let (vans, buses) = (corridor.traffic.vans, corridor.traffic.buses);
    if share < vans {
        Kind::Van
    } else if share < vans + buses {
        Kind::Bus
    } else {
        Kind::Car
    }
}
