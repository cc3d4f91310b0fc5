//! The most traffic that the busiest intersection of a corridor can serve: a description enters; bounds leave that times in the conflict
//! area and headways give. `docs/CORRIDOR.md` has the formulas.
//!
//! They are for vehicles that pass at the target speed, one at a time, and never wait for one another longer than they have to. Real
//! arrivals are random, and vehicles that stopped set off slowly, so no rule comes up to them.

use holdover::coordination::UNSEEN;
use holdover::passes::{Rules, Slack};
use holdover::time::Duration;
use holdover::units::Distance;
use serde::Serialize;

use super::description::Corridor;
use super::network::{Junction, Network};
use crate::input::kind::Kind;

/// The bounds of the busiest intersection.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Capacity {
    /// Its name.
    pub intersection: String,
    /// Share of all vehicles that pass it.
    pub share: f64,
    /// So many vehicles pass it at once, if vehicles whose ways do not cross always pass together: its load over that of the busiest legs
    /// of which each crosses all others. All the bounds then grow by this factor.
    pub abreast: f64,
    /// Time that a vehicle has the conflict area for, from its front's entry until the next one may enter.
    pub conflict_s: f64,
    /// The same with what a unit claims before and after.
    pub claimed_s: f64,
    /// Time between two vehicles of crossing legs that follow one another.
    pub headway_s: f64,
    /// Vehicles a minute on all roads together, if vehicles of crossing legs alternate.
    pub alternating_per_min: f64,
    /// The same, if each vehicle also has all the time that it claims.
    pub claimed_per_min: f64,
    /// The same, if each vehicle follows the one before it, which comes by a crossing leg, at its headway.
    pub following_per_min: f64,
}

impl Capacity {
    /// The bounds of a corridor. `None` if no vehicles come by roads that cross.
    #[must_use]
    pub fn of(corridor: &Corridor, network: &Network) -> Option<Self> {
        let all = corridor.vehicles_per_min();
        let traffic = &corridor.traffic;
        let (speed_mps, length_m) = (traffic.target_speed_mps, mean_length_m(corridor));
        let apart_s = seconds(Rules::UNIT.clocks) + seconds(Rules::UNIT.clearance);
        let slack = Slack::of(Distance::from_mm((length_m * 1e3).round() as i32));
        let slack_s = seconds(slack.before) + seconds(slack.after);
        let at = |index: usize, junction: &Junction| {
            let rate = |leg: usize| corridor.roads[junction.legs[leg].road].vehicles_per_min;
            let load: f64 = (0..junction.legs.len()).map(rate).sum();
            let crossing = most_that_cross(junction, rate)?;
            let conflict_s = (2.0 * junction.half_m + length_m) / speed_mps + apart_s;
            let standstill_m = (traffic.standstill_m + UNSEEN.get().to_num::<f64>()).max(2.0 * junction.half_m);
            let headway_s = traffic.time_gap_s + (standstill_m + length_m) / speed_mps;
            let most = |each_s: f64| 60.0 / each_s * all / load;
            Some(Self {
                intersection: corridor.intersections[index].name.clone(),
                share: load / all,
                abreast: load / crossing,
                conflict_s,
                claimed_s: conflict_s + slack_s,
                headway_s,
                alternating_per_min: most(conflict_s),
                claimed_per_min: most(conflict_s + slack_s),
                following_per_min: most(headway_s),
            })
        };
        let all = network.junctions.iter().enumerate().filter_map(|(index, junction)| at(index, junction));
        all.min_by(|a, b| a.alternating_per_min.total_cmp(&b.alternating_per_min))
    }
}

/// Vehicles a minute by the busiest legs of which each crosses all others; there are at least two of them. `None` if no vehicles come by
/// any.
fn most_that_cross(junction: &Junction, rate: impl Fn(usize) -> f64) -> Option<f64> {
    let legs = junction.legs.len();
    let sets = (0..1_usize << legs).map(|set| (0..legs).filter(|leg| set >> leg & 1 == 1).collect::<Vec<usize>>());
    let all_cross = |set: &Vec<usize>| {
        set.iter().enumerate().all(|(index, a)| set[..index].iter().all(|b| junction.conflict(*a, *b)))
    };
    let loads = sets.filter(|set| set.len() > 1 && all_cross(set)).map(|set| set.iter().map(|leg| rate(*leg)).sum());
    loads.reduce(f64::max).filter(|load| *load > 0.0)
}

fn mean_length_m(corridor: &Corridor) -> f64 {
    let (vans, buses) = (corridor.traffic.vans, corridor.traffic.buses);
    let shares = [(Kind::Car, 1.0 - vans - buses), (Kind::Van, vans), (Kind::Bus, buses)];
    shares.into_iter().map(|(kind, share)| share * kind.length_m()).sum()
}

fn seconds(duration: Duration) -> f64 {
    duration.as_micros() as f64 * 1e-6
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::roads::example;

    fn of(text: &str) -> Capacity {
        let corridor = example::of(text);
        Capacity::of(&corridor, &Network::of(&corridor)).unwrap()
    }

    #[test]
    fn the_busiest_intersection_serves_one_vehicle_in_each_conflict_time_or_headway() {
        let capacity = of(example::TEXT);
        // Cars, vans and buses are 5.7 m long on average. 11.4 of 30 vehicles pass each intersection that has four legs.
        assert!((capacity.conflict_s - (12.7 / 11.0 + 0.2)).abs() < 1e-9, "{capacity:?}");
        assert!((capacity.claimed_s - capacity.conflict_s - 1.46).abs() < 1e-9);
        assert!((capacity.headway_s - (1.0 + 15.7 / 11.0)).abs() < 1e-9);
        assert!((capacity.share - 11.4 / 30.0).abs() < 1e-9 && (capacity.abreast - 2.0).abs() < 1e-9);
        for (each_s, per_min) in [
            (capacity.conflict_s, capacity.alternating_per_min),
            (capacity.claimed_s, capacity.claimed_per_min),
            (capacity.headway_s, capacity.following_per_min),
        ] {
            assert!((per_min * 11.4 / 30.0 * each_s - 60.0).abs() < 1e-9, "{per_min}");
        }
    }

    #[test]
    fn a_bound_does_not_depend_on_how_many_vehicles_come() {
        let (corridor, capacity) = (example::corridor(), of(example::TEXT));
        let denser = corridor.demanding(90.0);
        let other = Capacity::of(&denser, &Network::of(&denser)).unwrap();
        assert!((other.following_per_min - capacity.following_per_min).abs() < 1e-9);
    }

    #[test]
    fn where_one_leg_is_busier_than_the_other_of_its_street_fewer_pass_abreast() {
        let text = example::TEXT.replacen("vehicles_per_min = 2.0", "vehicles_per_min = 6.0", 1);
        // 15.4 a minute, and 9.7 by the two busiest legs that cross.
        assert!((of(&text).abreast - 15.4 / 9.7).abs() < 1e-9);
    }

    #[test]
    fn without_vehicles_there_is_no_bound() {
        let corridor = example::of(&example::TEXT.replace("vehicles_per_min = ", "vehicles_per_min = 0 # "));
        assert_eq!(Capacity::of(&corridor, &Network::of(&corridor)), None);
    }
}
