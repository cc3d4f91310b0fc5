//! Which vehicle the ego follows. The ego at an instant, now or later, enters; how it would choose among the vehicles ahead leaves.
//!
//! The review of the order and the own horizon ask the same rules: the review for now, the own horizon for instants to come.

use super::scene::Scene;
use crate::coordination::{ComfortBraking, PeerApproach};
use crate::fixed::{quotient, saturate_i32};
use crate::model::Reading;
use crate::time::Instant;
use crate::units::{Acceleration, Distance, Gain, Position, Seconds, Speed};

/// The ego does not follow a vehicle that has been silent for longer than a holdover lasts, if its rear is farther ahead than this and
/// twice the way in [`HEEDED_TIME`]. Behind a standing vehicle the law of eq. 5 asks for braking from `l + s_0 + (t_g + γ) v` on, which
/// is less for any gains that are shipped.
const HEEDED: Distance = Distance::from_mm(20_000);
/// Half of the time, because the whole of it is beyond the format's 4 s.
const HEEDED_TIME: Seconds = Seconds::from_millis(3_990);

/// By how much more the ego goes on following a vehicle that gets away from it, so that the choice does not alternate.
const APART: Distance = Distance::from_mm(3_000);

/// A position farther ahead than any vehicle.
const NOWHERE: Position = Position::from_bits(i64::MAX);

/// The ego at an instant, and the scene.
#[derive(Clone, Copy)]
pub(super) struct Vantage<'a, const PEERS: usize, const SAMPLES: usize, const STEPS: usize> {
    pub scene: &'a Scene<PEERS, SAMPLES, STEPS>,
    pub at: Instant,
    /// The crossing that comes next.
    pub next: usize,
    /// The ego's front bumper.
    pub front: Position,
    pub speed: Speed,
}

impl<const PEERS: usize, const SAMPLES: usize, const STEPS: usize> Vantage<'_, PEERS, SAMPLES, STEPS> {
    /// Whether the ego may follow a peer. The gate minds the peer all the same. A vehicle that was far ahead when it was heard last has
    /// got out of reach, and no vehicle is ahead then as far as it matters. This also holds if that vehicle is estimated to have stopped
    /// since, behind a vehicle that is not heard any more.
    pub fn is_heeded(&self, index: usize) -> bool {
        self.scene.is_in_reach(index, self.at)
            || !self.scene.coordination.choice().lost.contains(index) && !self.is_far_ahead(index)
    }

    fn is_far_ahead(&self, index: usize) -> bool {
        let way = self.speed.over(HEEDED_TIME);
        let heeded = self.front.ahead(HEEDED).ahead(way).ahead(way);
        self.scene.rear(index, self.at).is_none_or(|(_, rear)| rear > heeded)
    }

    /// Of the vehicle just ahead in the order and the vehicle just ahead on the leg, the one that asks for more caution.
    ///
    /// The vehicle with the smaller `q_j = r_j - l_j - s_0 + γ v_j` asks for the smaller acceleration in eq. 5,
    /// `k (q_j - r - (t_g + γ) v)`, because everything else in the law is the ego's own. If the ego brakes gently for the vehicle ahead in
    /// the order, it brakes with no more than `b`. So that vehicle asks for no less than `r + (t_g + γ) v - b/k`.
    pub fn more_careful(&self, order: Option<usize>, lane: Option<usize>) -> Option<usize> {
        let (Some(first), Some(ahead)) = (order, lane) else { return order.or(lane) };
        let law = &self.scene.config.law;
        let gentle = self.comfort(order).limit(Acceleration::MAX);
        let least = self
            .front
            .ahead(self.speed.over(self.scene.time_gap()))
            .ahead(self.speed.over(law.damping))
            .ahead(braked_over(gentle, law.gain));
        let asks_first = if gentle == Acceleration::MAX { self.asks(first) } else { self.asks(first).max(least) };
        Some(if asks_first <= self.asks(ahead) { first } else { ahead })
    }

    /// Whether a vehicle ahead is so near that the ego follows it. At the speed `v_∞` that the ego wants on a free road, eq. 5 asks for
    /// braking from `q_j - r = (t_g + γ) v_∞` on. Behind a vehicle that is farther ahead, the ego drives as on a free road; to follow
    /// would only make it hurry. A vehicle that the ego already follows may get farther ahead by [`APART`].
    pub fn is_in_the_way(&self, index: usize, followed: Option<usize>) -> bool {
        let wanted = self.scene.target_speed();
        let free =
            self.front.ahead(wanted.over(self.scene.time_gap())).ahead(wanted.over(self.scene.config.law.damping));
        let apart = if followed == Some(index) { APART } else { Distance::ZERO };
        self.asks(index) < free.ahead(apart)
    }

    /// `q_j` of a vehicle ahead.
    fn asks(&self, index: usize) -> Position {
        self.scene.rear(index, self.at).map_or(NOWHERE, |(reading, rear)| {
            let damped = reading.speed.over(self.scene.config.law.damping);
            rear.ahead(damped).ahead(self.scene.standstill_at(self.next, index).negated())
        })
    }

    /// How gently the ego may brake for a peer that it follows.
    pub fn comfort(&self, index: Option<usize>) -> ComfortBraking {
        let coordination = &self.scene.coordination;
        let approach = index.and_then(|index| coordination.approach(index));
        approach
            .map_or(ComfortBraking::NONE, |approach| coordination.comfort(approach, self.next, self.front, self.speed))
    }

    /// Whether the ego may follow this peer, if it is ahead in the order: see [`crate::coordination`].
    pub fn is_announced(&self, approach: &PeerApproach) -> bool {
        self.scene.coordination.is_announced(approach, self.at, self.next, self.front, self.speed)
    }

    /// Whether a peer on the virtual lane is as far behind the ego's front bumper as it must be to follow the ego over the crossing.
    pub fn is_far_behind(&self, peer: &Reading) -> bool {
        let Some(crossing) = self.scene.coordination.crossing() else { return false };
        let (config, half) = (&self.scene.config, crossing.intersection.half);
        let needs = config.length.plus(half).plus(half).plus(config.law.standstill);
        self.front.ahead_of(peer.position) >= needs.plus(peer.speed.over(self.scene.time_gap()))
    }
}

/// `-b/k`, to the millimetre.
fn braked_over(braking: Acceleration, gain: Gain) -> Distance {
    let mm = quotient(i64::from(braking.to_mm_per_s2()).saturating_mul(1_000), i64::from(gain.to_milli()).max(1));
    Distance::from_mm(saturate_i32(mm)).negated()
}
