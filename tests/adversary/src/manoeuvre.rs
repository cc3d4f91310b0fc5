//! The events of a drive: a scenario enters, and leaves with events that keep the assumptions of use.

use crate::random::Random;
use crate::scenario::{Event, Scenario, What};

/// Demand that stands for the hardest braking that is allowed.
const HARDEST: f64 = -99.0;

/// The vehicle drives: it brakes as hard as it may, brakes gently, pulls away, holds its speed. The mean time between
/// two such events is about 4/`often` seconds.
pub fn drive(scenario: &mut Scenario, random: &mut Random, peer: usize, often: f64) {
    let mut at = scenario.ego.engages + 1.5 + random.exponential(4.0);
    while at < scenario.length {
        let demand = match random.below(6) {
            0 | 1 => HARDEST,
            2 => random.between(-4.0, 0.0),
            3 => random.between(0.0, 3.0),
            4 => 99.0,
            _ => 0.0,
        };
        scenario.event.push(Event { at, what: What::Drive { peer, demand } });
        if demand == HARDEST && random.chance(0.3) {
            // Just when no unit hears it.
            let seconds = random.between(1.0, 12.0);
            scenario.event.push(Event { at: at - random.between(0.0, 0.3), what: What::Mute { peer, seconds } });
        }
        // After hard braking the vehicle often pulls away again.
        let next = random.exponential(4.0 / often) + 0.2;
        if demand == HARDEST && random.chance(0.6) {
            let pulls = at + random.between(0.3, 6.0);
            scenario.event.push(Event { at: pulls, what: What::Drive { peer, demand: random.between(0.5, 3.0) } });
            at = pulls;
        }
        at += next;
    }
}

/// Adds up to `most` other events that are within the assumptions.
pub fn disturb(scenario: &mut Scenario, random: &mut Random, peer: usize, most: usize) {
    for _ in 0..random.below(most + 1) {
        let at = random.between(scenario.ego.engages + 0.5, scenario.length);
        let seconds = random.exponential(1.5) + 0.1;
        let what = match random.below(14) {
            0 | 1 => What::Limits { peer, braking: random.between(2.0, 12.0), pulling: random.between(0.5, 5.0) },
            // A sensor that sees the rear computes the front from the published length.
            2 if !scenario.range.fitted => {
                What::Length { peer, published: scenario.peer[peer].length + random.between(0.0, 5.0) }
            }
            3 => What::Mute { peer, seconds },
            4 => What::Deaf { seconds },
            5 if scenario.radio.tail < 1.8 => What::NoTime { seconds: random.between(0.5, 12.0) },
            6 => What::Torn { peer, half: random.below(2) as u8, messages: random.one_of(&[3, 7, 1, 2]) },
            7 => What::Copies { peer, count: 1 + random.below(10) as u32, off: 0.0 },
            8 => What::Garbage { count: 1 + random.below(20) as u32 },
            9 => What::Missed { ticks: 1 + random.below(3) as u32 },
            10 => What::NoEgo { seconds: random.between(0.01, 0.4) },
            11 => What::Overtaken { peer, half: random.below(2) as u8 },
            12 => What::Wanted { speed: random.between(3.0, 30.0) },
            // A vehicle that a sensor has seen driving is seen again within a second.
            _ => What::Blind { seconds: seconds.min(0.9) },
        };
        scenario.event.push(Event { at, what });
    }
}
