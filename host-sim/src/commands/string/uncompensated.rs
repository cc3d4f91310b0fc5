//! The same string without holdover: a leader's drive, a channel and the same law enter, speeds leave. Each vehicle
//! drives by the newest message of the vehicle ahead as it is, or extrapolated by its age times its speed, as in
//! platoon simulators.

use holdover::model::Body;
use holdover::units::Acceleration;

use super::amplification::Speeds;
use crate::input::impairment::Link;
use crate::input::scenario::Scenario;
use crate::sim::channel::Channel;
use crate::sim::plain::{Sample, demand};
use crate::sim::plant::Plant;
use crate::sim::quantities::speed;
use crate::sim::world::{config, machine};

/// How a vehicle uses a message that has some age.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reading {
    /// The position in the message is used as it is.
    AsItStands,
    /// Age times speed is added to the position.
    AgeTimesSpeed,
}

/// A follower.
struct Follower {
    plant: Plant,
    demand_mps2: f64,
    newest: Option<Sample>,
    coming: Vec<(f64, Sample)>,
}

/// Drives the string of a scenario whose leader has a motion. Each vehicle hears only the vehicle ahead of it.
#[must_use]
pub fn run(scenario: &Scenario, seed: u64, reading: Reading) -> Speeds {
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
        let mut ahead = Sample { at_s, position_m: origin_m + leader.position_m, speed_mps: leader.speed_mps };
        vehicles[0].push(ahead.speed_mps);
        for (index, follower) in (1..).zip(&mut followers) {
            if tick % every == 0 {
                let arrivals = channel.send(Link { from: index - 1, to: index }, at_s);
                follower.coming.extend(arrivals.into_iter().map(|arrives_s| (arrives_s, ahead)));
            }
            follower.hear(at_s);
            ahead = Sample { at_s, position_m: follower.plant.position_m, speed_mps: follower.plant.speed_mps };
            vehicles[index].push(ahead.speed_mps);
            follower.drive(scenario, index, at_s, reading);
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

    /// Eq. 5, within the same limits as those of the units.
    fn drive(&mut self, scenario: &Scenario, index: usize, at_s: f64, reading: Reading) {
        let config = config(scenario, index);
        let Plant { position_m, speed_mps, .. } = self.plant;
        let moved = |sample: Sample| match reading {
            Reading::AsItStands => sample,
            Reading::AgeTimesSpeed => {
                Sample { position_m: sample.position_m + sample.speed_mps * (at_s - sample.at_s), ..sample }
            }
        };
        let (length_m, newest) = (scenario.vehicles[index - 1].length_m, self.newest.map(moved));
        let own = (position_m, speed_mps);
        self.demand_mps2 = demand(&config, length_m, own, newest, self.demand_mps2, scenario.period_s);
        let demand = Acceleration::from_bits((self.demand_mps2 * f64::from(1 << 25)).round() as i32);
        let body: Body = config.body;
        self.plant.drive(body.effort(demand, speed(speed_mps)), scenario.period_s);
    }
}
