//! What the range sensors on the roads see: the bodies of all vehicles enter; for an ego the nearest body on its own
//! way leaves, as the gap to it and its speed along that way.
//!
//! The way of a vehicle is a strip as wide as the widest vehicle along the middle of its lane. A vehicle on the same
//! road is on it from its rear bumper on. A vehicle on a road that crosses at an intersection is on it while a part of
//! its body is inside the strip, and from where that part begins. While a part of it is in the conflict area beside the
//! strip, it is seen as if it were in the strip. Near a crossing both roads are taken as straight.
//! Where roads cross without an intersection one passes over the other, and they do not see one another. A sensor sees
//! vehicles without V2X, and vehicles that have left, as any others.

use super::lane::{Lane, Leg, Stop, WIDTH_M};
use super::movements::along;
use super::network::Network;
use crate::sim::globe::Shift;

/// Distance between the places at which ways that turn are compared, in metres.
const EVERY_M: f64 = 0.25;

/// Sine of the angle from which on two ways cross; below it they touch.
const LEAST_SINE: f64 = 0.3;

/// A vehicle on the roads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body {
    /// Its road.
    pub road: usize,
    /// Distance of its front bumper along its road.
    pub front_m: f64,
    /// Length, bumper to bumper.
    pub length_m: f64,
    /// Its speed.
    pub speed_mps: f64,
}

/// What is seen of a vehicle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// Distance from the own front bumper to where its body begins on the own way; at least 0.
    pub gap_m: f64,
    /// Its speed along the own way; below 0 if it comes towards the ego.
    pub speed_mps: f64,
}

/// The place where another road crosses an own one.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Crossing {
    /// The other road.
    other: usize,
    /// Distance to the place along the own road, and along the other one.
    at_m: [f64; 2],
    /// Where the conflict area of the other road begins and ends along it.
    area_m: [f64; 2],
    /// Sine and cosine of the angle from the own direction of travel to the other one.
    angle: (f64, f64),
}

/// The places where roads cross.
#[derive(Clone, Debug, PartialEq)]
pub struct Sights {
    /// For each road.
    crossings: Vec<Vec<Crossing>>,
}

impl Sights {
    /// The places of a network.
    #[must_use]
    pub fn of(network: &Network) -> Self {
        let of_stop = |lane: &Lane, stop: &Stop| {
            let junction = &network.junctions[stop.intersection];
            let own = &junction.legs[stop.leg];
            let legs = junction.legs.iter().enumerate().filter(|(leg, _)| junction.conflict(stop.leg, *leg));
            // A vehicle that joins is on the own way where the roads are one.
            let crossing_ones = legs.filter(|(_, leg)| leg.movement.exit != own.movement.exit);
            crossing_ones
                .map(|(_, leg)| {
                    if own.is_straight() && leg.is_straight() {
                        crossing(network, lane, own, leg, junction.half_m)
                    } else {
                        bent_crossing(network, lane, own, leg, junction.half_m)
                    }
                })
                .collect::<Vec<_>>()
        };
        let of_lane = |lane: &Lane| lane.stops.iter().flat_map(|stop| of_stop(lane, stop)).collect();
        Self { crossings: network.lanes.iter().map(of_lane).collect() }
    }

    /// What a sensor at the front of `own` sees of the nearest of `all` on its way, within `range_m`.
    #[must_use]
    pub fn nearest(&self, network: &Network, own: &Body, all: &[Body], range_m: f64) -> Option<Seen> {
        let along = all.iter().filter(|other| *other != own).filter_map(|other| {
            let [rear_m, front_m] = network.on_road(own.road, other.road, other.front_m, other.length_m)?;
            let seen = Seen { gap_m: (rear_m - own.front_m).max(0.0), speed_mps: other.speed_mps };
            (front_m > own.front_m).then_some(seen)
        });
        let is_near =
            |place: &&Crossing| (own.front_m - WIDTH_M..=own.front_m + 2.0 * range_m).contains(&place.at_m[0]);
        let across = self.crossings[own.road].iter().filter(is_near).flat_map(|place| {
            let others = all.iter().filter(|other| other.road == place.other);
            others.filter_map(|other| place.seen(own, other))
        });
        along.chain(across).filter(|seen| seen.gap_m <= range_m).min_by(|a, b| a.gap_m.total_cmp(&b.gap_m))
    }
}

/// The place where the lanes of two legs of an intersection cross. A leg knows where its lane is nearest to the middle
/// of the intersection, and lanes lie beside the middle.
fn crossing(network: &Network, lane: &Lane, own: &Leg, other: &Leg, half_m: f64) -> Crossing {
    let own_point = lane.road.at(own.at_m).0;
    let between = Shift::between(own_point, network.lanes[other.road].road.at(other.at_m).0);
    let (sine, cosine) = (other.heading_deg - own.heading_deg).to_radians().sin_cos();
    let (ahead_m, right_m) = (between.along(along(own.heading_deg)), between.along(along(own.heading_deg).right()));
    // From its place on, the other lane is at `right + t sin` to the right of the own one: on it at `t = -right / sin`.
    let t_m = -right_m / sine;
    let at_m = [own.at_m + ahead_m + t_m * cosine, other.at_m + t_m];
    let area_m = [other.at_m - half_m, other.at_m + half_m];
    Crossing { other: other.road, at_m, area_m, angle: (sine, cosine) }
}

/// The same where one of them turns: where they are nearest to one another in the conflict area.
fn bent_crossing(network: &Network, lane: &Lane, own: &Leg, other: &Leg, half_m: f64) -> Crossing {
    let road = &network.lanes[other.road].road;
    let steps = |leg: &Leg| {
        let from_m = leg.at_m - half_m;
        (0..=(2.0 * half_m / EVERY_M) as u32).map(move |step| from_m + f64::from(step) * EVERY_M)
    };
    let pairs = steps(own).flat_map(|own_m| steps(other).map(move |other_m| [own_m, other_m]));
    let apart_m = |[own_m, other_m]: &[f64; 2]| Shift::between(lane.road.at(*own_m).0, road.at(*other_m).0).length_m();
    let at_m = pairs.min_by(|a, b| apart_m(a).total_cmp(&apart_m(b))).unwrap_or([own.at_m, other.at_m]);
    let angle = (road.at(at_m[1]).1 - lane.road.at(at_m[0]).1).to_radians().sin_cos();
    Crossing { other: other.road, at_m, area_m: [other.at_m - half_m, other.at_m + half_m], angle }
}

impl Crossing {
    /// What `own` sees of `other`, if a part of the other's body is on the own way and ahead.
    fn seen(&self, own: &Body, other: &Body) -> Option<Seen> {
        let front_m = other.front_m - self.at_m[1];
        let is_in_area = other.front_m > self.area_m[0] && other.front_m - other.length_m < self.area_m[1];
        let (begins_m, ends_m) = if self.angle.0.abs() < LEAST_SINE {
            Some((-WIDTH_M, WIDTH_M)).filter(|_| is_in_area)
        } else {
            let beside = || self.covered(-WIDTH_M, WIDTH_M).filter(|_| is_in_area);
            self.covered(front_m - other.length_m, front_m).or_else(beside)
        }?;
        let gap_m = self.at_m[0] + begins_m - own.front_m;
        let is_ahead = self.at_m[0] + ends_m > own.front_m;
        is_ahead.then(|| Seen { gap_m: gap_m.max(0.0), speed_mps: other.speed_mps * self.angle.1 })
    }

    /// The part of the own way, from the crossing on, that a body covers from `rear_m` to `front_m` along its own.
    fn covered(&self, rear_m: f64, front_m: f64) -> Option<(f64, f64)> {
        let (sine, cosine) = self.angle;
        let half_m = 0.5 * WIDTH_M;
        // A point of the body is at `s cos - w sin` ahead and `s sin + w cos` to the right. For each edge of the body
        // (`w`) the part that is in the strip is an interval of `s`; ends of the body (`s`) likewise have one of `w`.
        let mut ahead: Option<(f64, f64)> = None;
        let mut add = |s: f64, w: f64| {
            let at = s * cosine - w * sine;
            let (least, most) = ahead.unwrap_or((at, at));
            ahead = Some((least.min(at), most.max(at)));
        };
        for w in [-half_m, half_m] {
            let limits = [-half_m, half_m].map(|right_m| (right_m - w * cosine) / sine);
            let (low, high) = (limits[0].min(limits[1]).max(rear_m), limits[0].max(limits[1]).min(front_m));
            if low <= high {
                add(low, w);
                add(high, w);
            }
        }
        for s in [rear_m, front_m] {
            if cosine.abs() < 1e-9 {
                if (s * sine).abs() <= half_m {
                    add(s, -half_m);
                    add(s, half_m);
                }
                continue;
            }
            let limits = [-half_m, half_m].map(|right_m| (right_m - s * sine) / cosine);
            let (low, high) = (limits[0].min(limits[1]).max(-half_m), limits[0].max(limits[1]).min(half_m));
            if low <= high {
                add(s, low);
                add(s, high);
            }
        }
        ahead
    }
}

#[cfg(test)]
mod tests;
