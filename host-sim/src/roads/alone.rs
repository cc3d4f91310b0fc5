//! The reference that drives alone while the link to its target is lost: the vehicles on the roads enter, the
//! acceleration leaves.
//!
//! On its own road the vehicle has an ideal range sensor and an adaptive cruise control: the Intelligent Driver Model
//! with the traffic's time gap. It sees no vehicle on a crossing road. So it stops before the conflict area of the next
//! intersection and waits there until it hears again, unless it can no longer stop there.
//!
//! It watches the links to the vehicles of crossing legs that it lets pass first, and to the one just ahead on its leg,
//! whether it follows them or not. Far behind all of them it follows no vehicle, but it still has to yield to a vehicle
//! that it does not hear.
//!
//! If only the link to the vehicle on its leg is lost, it yields to the crossing vehicle as its unit does. The unit
//! also follows its estimate of the silent vehicle, which can only slow the vehicle down.

use holdover::controller::Mode;
use holdover::coordination::Choice;
use holdover::time::Instant;

use super::description::Traffic;
use super::network::Network;
use super::watch::Sighting;
use crate::input::kind::Kind;
use crate::sim::person::{ACCELERATION_MPS2, EMERGENCY_MPS2, Manner};
use crate::sim::vehicle::Unit;

/// A vehicle that would have to brake harder than this to stop before the conflict area goes on.
const HARDEST_MPS2: f64 = 4.0;
/// How far before the conflict area the stop line is.
const LINE_M: f64 = 1.0;

/// The vehicles to which the link is lost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lost {
    /// The vehicle just ahead on the same leg.
    pub lane: bool,
    /// A vehicle of a crossing leg that it lets pass first.
    pub crossing: bool,
}

impl Lost {
    /// The lost links by what a unit knows; `None` while it hears all of them.
    #[must_use]
    pub fn of(unit: &Unit, now: Instant) -> Option<Self> {
        let (choice, limits) = (unit.coordination().choice(), &unit.config().link);
        let is_off = |slot: u8| unit.peers().get(slot.into()).is_some_and(|track| !track.link().is_on(now, limits));
        let lane = choice.lane.is_some_and(is_off);
        let crossing = (0..u8::MAX).filter(|slot| choice.first.contains(usize::from(*slot))).any(is_off);
        // If another cause keeps the unit from cooperating, it knows nothing of crossing vehicles.
        let crossing = crossing || !lane && unit.mode() != Mode::Cooperative;
        (lane || crossing).then_some(Self { lane, crossing })
    }
}

/// The acceleration that the reference demands by sight on its own leg. It stops at the line if it `waits` for crossing
/// vehicles.
#[must_use]
pub fn demand(own: &Sighting, all: &[Sighting], network: &Network, traffic: &Traffic, waits: bool) -> f64 {
    let manner = Manner {
        wanted_mps: traffic.target_speed_mps,
        time_gap_s: traffic.time_gap_s,
        standstill_m: traffic.standstill_m,
    };
    let mut presses: f64 = 0.0;
    if let Some((ahead, gap_m)) = ahead(own, all, network) {
        presses = presses.max(manner.pressed(own.speed_mps, gap_m, ahead.speed_mps));
    }
    if let Some(gap_m) = to_stop_line(own, network).filter(|_| waits) {
        let line = Manner { standstill_m: 1.0, ..manner };
        presses = presses.max(line.pressed(own.speed_mps, gap_m + 1.0, 0.0));
    }
    (ACCELERATION_MPS2 * (manner.free(own.speed_mps) - presses)).max(-EMERGENCY_MPS2)
}

/// The vehicle just ahead on the own road, and the gap to its rear bumper.
#[must_use]
pub fn ahead<'a>(own: &Sighting, all: &'a [Sighting], network: &Network) -> Option<(&'a Sighting, f64)> {
    let on_road = |other: &Sighting| network.on_road(own.road, other.road, other.way_m, other.length_m);
    let others = all.iter().filter(|other| other.trip != own.trip).filter_map(|other| Some((other, on_road(other)?)));
    let ahead = others.filter(|(_, [_, front_m])| *front_m > own.way_m);
    let ahead = ahead.min_by(|(_, [_, a]), (_, [_, b])| a.total_cmp(b));
    ahead.map(|(ahead, [rear_m, _])| (ahead, rear_m - own.way_m))
}

/// The acceleration of a vehicle that drives by sight. If it hears a crossing vehicle that it yields to, it accelerates
/// no more than its unit demands.
#[must_use]
pub fn still_given_way(lost: Lost, choice: &Choice, by_sight: f64, by_unit: f64) -> f64 {
    let hears_one_that_crosses = !lost.crossing && choice.order.is_some();
    if hears_one_that_crosses { by_sight.min(by_unit) } else { by_sight }
}

/// The acceleration, limited to the vehicle's published limits, by which other vehicles compute its bound.
#[must_use]
pub fn published(wanted_mps2: f64, kind: Kind) -> f64 {
    let [braking, acceleration] =
        [kind.limits().braking, kind.limits().acceleration].map(|limit| limit.get().to_num::<f64>());
    wanted_mps2.clamp(-braking, acceleration)
}

/// The distance to the stop line of the next intersection, if the vehicle can still stop there.
fn to_stop_line(own: &Sighting, network: &Network) -> Option<f64> {
    let lines = network.lanes[own.road]
        .stops
        .iter()
        .map(|stop| stop.at_m - network.junctions[stop.intersection].half_m - LINE_M - own.way_m);
    let gap_m = lines.filter(|gap_m| *gap_m >= 0.0).min_by(f64::total_cmp)?;
    (own.speed_mps * own.speed_mps <= 2.0 * HARDEST_MPS2 * gap_m).then_some(gap_m)
}

#[cfg(test)]
mod tests {
    use super::super::example;
    use super::*;

    #[test]
    fn it_gives_way_to_one_that_crosses_and_is_heard_and_does_not_follow_an_estimate_else() {
        let [lane, crossing, both] =
            [(true, false), (false, true), (true, true)].map(|(lane, crossing)| Lost { lane, crossing });
        let choice = |order, lane| Choice { target: lane, order, lane, ..Choice::default() };
        let wanted = |lost, choice: Choice| still_given_way(lost, &choice, 0.5, -2.0);
        assert_eq!(wanted(lane, choice(Some(1), Some(0))), -2.0);
        assert_eq!(wanted(lane, choice(None, Some(0))), 0.5);
        assert_eq!(wanted(crossing, choice(Some(1), None)), 0.5);
        assert_eq!(wanted(both, choice(Some(1), Some(0))), 0.5);
    }

    #[test]
    fn it_stops_at_the_line_for_those_who_cross_and_for_nobody_else() {
        let corridor = example::corridor();
        let network = Network::of(&corridor);
        let stop = network.lanes[0].stops[0];
        let line_m = stop.at_m - network.junctions[stop.intersection].half_m - LINE_M;
        let own = |before_m: f64| example::sighting(0, 0, line_m - before_m);
        let wanted = |before_m, waits| demand(&own(before_m), &[], &network, &corridor.traffic, waits);
        assert!(wanted(30.0, true) < -1.0 && wanted(30.0, false) > 0.0, "{}", wanted(30.0, true));
        // From 10 m/s, stopping at 4 m/s² takes 12.5 m.
        assert!(wanted(12.6, true) < -3.0);
        assert_eq!(wanted(12.4, true), wanted(12.4, false));
        let ahead = Sighting { way_m: line_m - 10.0, speed_mps: 0.0, trip: 1, ..own(0.0) };
        assert!(demand(&own(30.0), &[ahead], &network, &corridor.traffic, false) < -3.0);
    }
}
