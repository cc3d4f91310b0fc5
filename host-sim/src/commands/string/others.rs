//! The same string without holdover: a leader's drive and a channel enter, speeds leave. Each vehicle drives by the same law on the newest
//! message of the vehicle ahead, as it is or moved on by its age times its speed, as in platoon simulators; or by the controller of
//! Ploeg et al., whose vehicles have a sensor without errors, and which uses the messages, or none.

use holdover::model::Body;
use holdover::units::Acceleration;

use super::amplification::Speeds;
use super::ploeg::{Own, Ploeg, View};
use crate::input::impairment::Link;
use crate::input::scenario::Scenario;
use crate::sim::channel::Channel;
use crate::sim::plain::{Sample, desired, limited};
use crate::sim::plant::Plant;
use crate::sim::quantities::speed;
use crate::sim::world::{config, machine};

/// What every vehicle of a string drives by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Other {
    /// The law of eq. 5, on the position in the newest message as it is.
    AsItStands,
    /// The same, and age times speed is added to the position.
    AgeTimesSpeed,
    /// The cooperative controller of Ploeg et al.
    Cacc,
    /// The same without messages.
    DegradedCacc,
}

/// A follower. The leader, which is driven by hand, tells its acceleration as its demand.
struct Follower {
    plant: Plant,
    demand_mps2: f64,
    ploeg: Ploeg,
    newest: Option<Sample>,
    coming: Vec<(f64, Sample)>,
}

/// Drives the string of a scenario whose leader has a motion. Each vehicle hears only the vehicle ahead of it.
#[must_use]
pub fn run(scenario: &Scenario, seed: u64, other: Other) -> Speeds {
    let period_s = scenario.period_s;
    let Some(motion) = &scenario.leader.motion else { return Speeds { period_s, vehicles: Vec::new() } };
    let mut channel = Channel::new(&scenario.channel, seed);
    let starts = scenario.initial_states(seed);
    let mut followers: Vec<Follower> = starts
        .iter()
        .enumerate()
        .skip(1)
        .map(|(index, start)| Follower {
            plant: Plant::cruising(machine(scenario, index), start.position_m, start.speed_mps),
            demand_mps2: 0.0,
            ploeg: Ploeg::new(scenario.vehicles[index].time_gap_s, scenario.vehicles[index].standstill_m, period_s),
            newest: None,
            coming: Vec::new(),
        })
        .collect();
    let origin_m = starts[0].position_m - motion.at(0.0).position_m;
    let (ticks, every) = (
        (scenario.duration_s / period_s).round() as usize,
        (1.0 / scenario.message_rate_hz / period_s).round().max(1.0) as usize,
    );
    let mut vehicles = vec![Vec::with_capacity(ticks); starts.len()];
    for tick in 0..ticks {
        let at_s = tick as f64 * period_s;
        let leader = motion.at(at_s);
        let mut ahead = Sample {
            at_s,
            position_m: origin_m + leader.position_m,
            speed_mps: leader.speed_mps,
            demand_mps2: leader.acceleration_mps2,
        };
        vehicles[0].push(ahead.speed_mps);
        for (index, follower) in (1..).zip(&mut followers) {
            if tick % every == 0 {
                let arrivals = channel.send(Link { from: index - 1, to: index }, at_s);
                follower.coming.extend(arrivals.into_iter().map(|arrives_s| (arrives_s, ahead)));
            }
            follower.hear(at_s);
            let seen = ahead;
            ahead = Sample {
                at_s,
                position_m: follower.plant.position_m,
                speed_mps: follower.plant.speed_mps,
                demand_mps2: follower.demand_mps2,
            };
            vehicles[index].push(ahead.speed_mps);
            follower.drive(scenario, index, &seen, other);
        }
    }
    Speeds { period_s, vehicles }
}

impl Follower {
    fn hear(&mut self, at_s: f64) {
        let arrived = self.coming.iter().filter(|(arrives_s, _)| *arrives_s <= at_s).map(|(_, sample)| *sample);
        self.newest = arrived.chain(self.newest).max_by(|a, b| a.at_s.total_cmp(&b.at_s));
        self.coming.retain(|(arrives_s, _)| *arrives_s > at_s);
    }

    /// Within the same limits as those of the units. `seen` is the vehicle ahead at this time.
    fn drive(&mut self, scenario: &Scenario, index: usize, seen: &Sample, other: Other) {
        let config = config(scenario, index);
        let length_m = scenario.vehicles[index - 1].length_m;
        let Plant { position_m, speed_mps, acceleration_mps2, .. } = self.plant;
        let moved = |sample: Sample| Sample {
            position_m: sample.position_m + sample.speed_mps * (seen.at_s - sample.at_s),
            ..sample
        };
        let by_law = |newest| desired(&config, length_m, (position_m, speed_mps), newest);
        let mut by_ploeg = |told_mps2| {
            let view = View { gap_m: seen.position_m - length_m - position_m, speed_mps: seen.speed_mps };
            self.ploeg.drive(&Own { position_m, speed_mps, acceleration_mps2 }, &view, told_mps2)
        };
        let desired_mps2 = match other {
            Other::AsItStands => by_law(self.newest),
            Other::AgeTimesSpeed => by_law(self.newest.map(moved)),
            Other::Cacc => by_ploeg(self.newest.map(|sample| sample.demand_mps2)),
            Other::DegradedCacc => by_ploeg(None),
        };
        self.demand_mps2 = limited(&config, desired_mps2, self.demand_mps2, scenario.period_s);
        self.ploeg.set(self.demand_mps2);
        let demand = Acceleration::from_bits((self.demand_mps2 * f64::from(1 << 25)).round() as i32);
        let body: Body = config.body;
        self.plant.drive(body.effort(demand, speed(speed_mps)), scenario.period_s);
    }
}
