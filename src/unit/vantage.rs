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

/// A peer that the ego might follow, as it is estimated at that instant.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    pub index: usize,
    /// Its front bumper and its speed.
    pub reading: Reading,
    pub rear: Position,
    /// The standstill distance behind it.
    pub standstill: Distance,
}

impl<const PEERS: usize, const SAMPLES: usize, const STEPS: usize> Vantage<'_, PEERS, SAMPLES, STEPS> {
    /// A peer inside what is certain of it; `None` where it is not known.
    pub fn candidate(&self, index: usize) -> Option<Candidate> {
        let (reading, rear) = self.scene.rear(index, self.at)?;
        Some(Candidate { index, reading, rear, standstill: self.scene.standstill_at(self.next, index) })
    }

    /// Whether the ego may follow a peer. The gate minds the peer all the same. A vehicle that was far ahead when it was heard last has
    /// got out of reach, and no vehicle is ahead then as far as it matters. This also holds if that vehicle is estimated to have stopped
    /// since, behind a vehicle that is not heard any more. A vehicle that is estimated in an area which the ego sees to be empty is not
    /// there.
    pub fn is_heeded(&self, peer: &Candidate) -> bool {
        let choice = self.scene.coordination.choice();
        let is_elsewhere = || choice.lost.contains(peer.index) || choice.missed.contains(peer.index);
        self.scene.is_in_reach(peer.index, self.at) || !is_elsewhere() && !self.is_far_ahead(peer)
    }

    fn is_far_ahead(&self, peer: &Candidate) -> bool {
        let way = self.speed.over(HEEDED_TIME);
        peer.rear > self.front.ahead(HEEDED).ahead(way).ahead(way)
    }

    /// Of the vehicles that the ego lets pass first and may follow, the one behind which the law asks for the smallest acceleration, with
    /// its `q_j`. They may drive at once where their ways do not conflict, so the last of them in the order is not always behind.
    pub fn nearest(&self, best: Option<(Candidate, Position)>, other: Candidate) -> Option<(Candidate, Position)> {
        let asks = self.asks(&other);
        let is_no_nearer = best.is_some_and(|(_, least)| least <= asks);
        if is_no_nearer || !self.is_heeded(&other) { best } else { Some((other, asks)) }
    }

    /// Of a vehicle that the ego lets pass first and the vehicle just ahead on the leg, the one that asks for more caution, if it is so near
    /// that the ego follows it. `followed` is the one that it follows.
    pub fn choose(
        &self,
        order: Option<(Candidate, Position)>,
        lane: Option<Candidate>,
        followed: Option<usize>,
    ) -> Option<Candidate> {
        let lane = lane.map(|ahead| (ahead, self.asks(&ahead)));
        let (target, asks) = match (order, lane) {
            (Some(first), Some(ahead)) if self.is_more_careful(first, ahead.1) => first,
            (order, lane) => lane.or(order)?,
        };
        self.is_in_the_way(asks, followed == Some(target.index)).then_some(target)
    }

    /// Whether a vehicle that the ego lets pass first asks for more caution than the one just ahead on the leg.
    ///
    /// The vehicle with the smaller `q_j = r_j - l_j - s_0 + γ v_j` asks for the smaller acceleration in eq. 5,
    /// `k (q_j - r - (t_g + γ) v)`, because everything else in the law is the ego's own. If the ego brakes gently for the vehicle ahead in
    /// the order, it brakes with no more than `b`. So that vehicle asks for no less than `r + (t_g + γ) v - b/k`.
    fn is_more_careful(&self, (first, asks): (Candidate, Position), asks_ahead: Position) -> bool {
        if asks > asks_ahead {
            return false;
        }
        let law = &self.scene.config.law;
        let coasts = self.front.ahead(self.speed.over(self.scene.time_gap())).ahead(self.speed.over(law.damping));
        // Where the ego need not brake for the vehicle on the lane, no limit matters. To compute it takes two divisions.
        coasts <= asks_ahead || {
            let gentle = self.comfort(Some(first.index)).limit(Acceleration::MAX);
            gentle == Acceleration::MAX || coasts.ahead(braked_over(gentle, law.gain)) <= asks_ahead
        }
    }

    /// Whether a vehicle ahead with this `q_j` is so near that the ego follows it. At the speed `v_∞` that the ego wants on a free road, eq.
    /// 5 asks for braking from `q_j - r = (t_g + γ) v_∞` on. Behind a vehicle that is farther ahead, the ego drives as on a free road; to
    /// follow would only make it hurry. A vehicle that the ego already follows may get farther ahead by [`APART`].
    fn is_in_the_way(&self, asks: Position, is_followed: bool) -> bool {
        let (wanted, law) = (self.scene.target_speed(), &self.scene.config.law);
        let apart = if is_followed { APART } else { Distance::ZERO };
        let free = wanted.over(self.scene.time_gap()).plus(wanted.over(law.damping)).plus(apart);
        asks < self.front.ahead(free)
    }

    /// `q_j` of a vehicle ahead.
    fn asks(&self, peer: &Candidate) -> Position {
        let damped = peer.reading.speed.over(self.scene.config.law.damping);
        peer.rear.ahead(damped).ahead(peer.standstill.negated())
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
