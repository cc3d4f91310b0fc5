//! The assumptions of use that a drive may break, one at a time: a scenario that keeps all of them enters, the same
//! with one broken leaves.

use serde::{Deserialize, Serialize};

use crate::random::Random;
use crate::scenario::{Event, Family, Scenario, What};

/// The assumption that is broken.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Assumption {
    PeerBraking,
    PeerAccuracy,
    EgoAccuracy,
    RangeAccuracy,
    PeerClock,
    SyncError,
    Lag,
    Road,
    MissedTicks,
    EgoGaps,
    OwnAcceleration,
    SlotReuse,
    Forged,
    ForgedCopies,
    Length,
    Unseen,
    OldMessages,
}

impl Assumption {
    /// All assumptions.
    pub const ALL: [Self; 17] = [
        Self::PeerBraking,
        Self::PeerAccuracy,
        Self::EgoAccuracy,
        Self::RangeAccuracy,
        Self::PeerClock,
        Self::SyncError,
        Self::Lag,
        Self::Road,
        Self::MissedTicks,
        Self::EgoGaps,
        Self::OwnAcceleration,
        Self::SlotReuse,
        Self::Forged,
        Self::ForgedCopies,
        Self::Length,
        Self::Unseen,
        Self::OldMessages,
    ];

    /// The violation, as text for a row of the table.
    pub const fn says(self) -> &'static str {
        match self {
            Self::PeerBraking => "a peer brakes 20 to 100 % harder than it publishes",
            Self::PeerAccuracy => "a peer is off by 2 to 10 times its accuracy",
            Self::EgoAccuracy => "own position and speed are off by 2 to 10 times their accuracy",
            Self::RangeAccuracy => "the range sensor is off by 2 to 10 times its accuracy",
            Self::PeerClock => "a peer's clock is off by 5 to 300 ms",
            Self::SyncError => "synchronisations are received 1 to 5 ms late",
            Self::Lag => "the actuators lag by 30 to 100 % more than configured",
            Self::Road => "the road allows 40 to 90 % of the configured braking",
            Self::MissedTicks => "10 to 100 ticks in a row are missed, again and again",
            Self::EgoGaps => "EgoMotion has gaps of 0.6 to 3 s, again and again",
            Self::OwnAcceleration => "the own acceleration is told 2 to 5 m/s² too low",
            Self::SlotReuse => "another station gets the target's slot at once",
            Self::Forged => "forged samples, 5 to 40 in a row, consistent with one another",
            Self::ForgedCopies => "one forged sample, and 5 to 40 copies of it",
            Self::Length => "the target is 1 to 10 m longer than it publishes",
            Self::Unseen => "a vehicle without V2X cuts in, and no sensor sees it",
            Self::OldMessages => "the modem passes on messages that are 12 to 14 s old",
        }
    }

    /// Changes a scenario that keeps all assumptions so that it breaks this one.
    pub fn apply(self, scenario: &mut Scenario, random: &mut Random) {
        scenario.broken = Some(self);
        let again = |scenario: &mut Scenario, every: f64, what: &mut dyn FnMut() -> What| {
            let mut at = scenario.ego.engages + 3.0;
            while at < scenario.length {
                scenario.event.push(Event { at, what: what() });
                at += every;
            }
        };
        scenario.amount = match self {
            Self::PeerBraking => random.between(1.2, 2.0),
            Self::PeerAccuracy | Self::EgoAccuracy | Self::RangeAccuracy => random.between(2.0, 10.0),
            Self::PeerClock => random.between(0.005, 0.3) * random.one_of(&[-1.0, 1.0]),
            Self::SyncError => random.between(0.001, 0.005),
            Self::Lag => random.between(1.3, 2.0),
            Self::Road => random.between(0.4, 0.9),
            Self::MissedTicks => random.between(10.0, 100.0),
            Self::EgoGaps => random.between(0.6, 3.0),
            Self::OwnAcceleration => random.between(-5.0, -2.0),
            Self::Forged | Self::ForgedCopies | Self::SlotReuse => random.between(5.0, 40.0),
            Self::Length => random.between(1.0, 10.0),
            Self::Unseen => 0.0,
            Self::OldMessages => random.between(12.0, 14.0),
        };
        let amount = scenario.amount;
        match self {
            Self::Lag => scenario.ego.lag_factor = amount,
            Self::Road => scenario.ego.road = 8.0 * amount,
            Self::OwnAcceleration => scenario.ego.acceleration_off = amount,
            Self::PeerClock => scenario.peer.iter_mut().for_each(|peer| peer.clock = amount * 1e6),
            Self::OldMessages => (scenario.radio.tails, scenario.radio.tail) = (0.2, amount),
            Self::RangeAccuracy => scenario.range.fitted = true,
            Self::MissedTicks => again(scenario, 4.0, &mut || What::Missed { ticks: amount as u32 }),
            Self::EgoGaps => again(scenario, 6.0, &mut || What::NoEgo { seconds: amount }),
            Self::Forged => {
                let off = random.between(-100.0, 100.0);
                again(scenario, 8.0, &mut || What::Forged { peer: 0, count: amount as u32, off });
            }
            Self::ForgedCopies => {
                let off = random.between(-100.0, 100.0);
                again(scenario, 8.0, &mut || What::Copies { peer: 0, count: amount as u32, off });
            }
            Self::SlotReuse => {
                again(scenario, 8.0, &mut || What::Intruder { peer: 0, station: 77, count: amount as u32 })
            }
            Self::Length => scenario.peer.iter_mut().for_each(|peer| peer.length += amount),
            Self::Unseen => {
                scenario.range.fitted = false;
                let mut stranger = scenario.peer[0];
                (stranger.station, stranger.on_lane, stranger.ahead, stranger.length) = (0, false, 12.0, 4.8);
                let peer = scenario.peer.len();
                scenario.peer.push(stranger);
                let at = random.between(scenario.ego.engages, scenario.length * 0.6);
                scenario.event.push(Event { at, what: What::CutIn { peer } });
                scenario.event.push(Event { at: at + 2.0, what: What::Drive { peer, demand: -4.0 } });
            }
            _ => {}
        }
        scenario.event.sort_by(|a, b| a.at.total_cmp(&b.at));
    }
}

impl Assumption {
    /// A family in which this assumption matters: one of the `wanted` families, if any of them fits.
    pub fn family(self, wanted: &[Family], turn: u64) -> Family {
        let fits: &[Family] = match self {
            Self::RangeAccuracy => &[Family::Stranger, Family::CutIn],
            Self::Unseen => &[Family::Following],
            _ => &[Family::Following, Family::Closing, Family::Lorry, Family::Silence],
        };
        let both: Vec<Family> = fits.iter().copied().filter(|family| wanted.contains(family)).collect();
        let from = if both.is_empty() { fits } else { &both };
        from[(turn % from.len() as u64) as usize]
    }
}
