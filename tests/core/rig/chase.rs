//! The gate alone behind one vehicle, in float64: what is true of both and what of it the gate is told enters; the least gap
//! leaves. Every demand is full acceleration.

use super::plant::{Body, Plant};
use super::random::Random;
use super::{mps, mps2, mps2_of, place};
use holdover::config::Envelope;
use holdover::envelope::{self, Ego, Obstacle, Situation};
use holdover::time::Duration;
use holdover::units::{Acceleration, Distance, FineSeconds};

pub const PERIOD: Duration = Duration::from_millis(10);
const H: f64 = 0.01;

/// What the vehicle ahead does: so much acceleration until then, in order; the last one for good.
pub type Profile = Vec<(f64, f64)>;

#[derive(Clone, Debug)]
pub struct Chase {
    pub limits: Envelope,
    /// As configured, in s.
    pub lag: f64,
    /// How many times as long the real one is.
    pub lag_factor: f64,
    /// Share of a braking command that the road allows beyond which nothing is to be had, of `limits.braking`.
    pub grip: f64,
    /// Added to the acceleration that the gate is told.
    pub acceleration_off: f64,
    /// A command comes into force so many ticks late.
    pub late: usize,
    /// From this tick on so many are missed.
    pub missed: (usize, usize),
    /// Speed, acceleration and command of the ego at the beginning.
    pub own: (f64, f64, f64),
    /// Speed of the vehicle ahead at the beginning, and how hard it can brake.
    pub ahead: (f64, f64),
    pub profile: Profile,
}

impl Chase {
    /// Everything as configured, both at their speeds, and the vehicle ahead at its worst from the beginning.
    pub fn new(limits: &Envelope, lag: f64, own: f64, ahead: (f64, f64)) -> Self {
        Self {
            limits: *limits,
            lag,
            lag_factor: 1.0,
            grip: 1.0,
            acceleration_off: 0.0,
            late: 0,
            missed: (0, 0),
            own: (own, 0.0, 0.0),
            ahead,
            profile: vec![(f64::MAX, -ahead.1)],
        }
    }

    /// A profile of random pieces that ends in the worst.
    pub fn random_profile(&self, random: &mut Random) -> Profile {
        let mut until = 0.0;
        let mut profile: Profile = (0..random.below(5))
            .map(|_| {
                until += random.between(0.05, 3.0);
                (until, random.extreme(-self.ahead.1, 2.5))
            })
            .collect();
        profile.push((f64::MAX, -self.ahead.1));
        profile
    }

    fn told(&self, plant: &Plant, last: Acceleration) -> Ego {
        Ego {
            position: place(plant.position).ahead(Distance::from_bits(1)),
            speed: mps(plant.speed),
            acceleration: mps2(plant.acceleration + self.acceleration_off),
            last,
            lag: FineSeconds::from_millis((self.lag * 1e3).round() as i32),
        }
    }

    fn rear(&self, ahead: &Body) -> Obstacle {
        let position = place(ahead.position).ahead(Distance::from_bits(-1));
        Obstacle { position, speed: mps(ahead.speed), braking: mps2(self.ahead.1) }
    }

    fn begins(&self, gap: f64) -> (Plant, Body) {
        let lag = self.lag * self.lag_factor;
        let plant = Plant { position: 0.0, speed: self.own.0, acceleration: self.own.1, lag };
        (plant, Body { position: gap, speed: self.ahead.0 })
    }

    /// Whether the gate's own predicate calls the beginning safe.
    pub fn is_safe(&self, gap: f64) -> bool {
        let (plant, ahead) = self.begins(gap);
        envelope::is_safe(&self.limits, &self.told(&plant, mps2(self.own.2)), &self.rear(&ahead), PERIOD)
    }

    /// The least gap that is safe to begin with, to within a millimetre; `None` beyond 1 km.
    pub fn nearest_safe(&self) -> Option<f64> {
        let (mut unsafe_at, mut safe_at) = (0.0, 1_000.0);
        if !self.is_safe(safe_at) {
            return None;
        }
        while safe_at - unsafe_at > 1e-3 {
            let middle = 0.5 * (unsafe_at + safe_at);
            *(if self.is_safe(middle) { &mut safe_at } else { &mut unsafe_at }) = middle;
        }
        Some(safe_at)
    }

    fn acceleration_at(&self, time: f64) -> f64 {
        let piece = self.profile.iter().find(|(until, _)| time < *until);
        piece.map_or(0.0, |(_, acceleration)| *acceleration)
    }

    /// The least gap on the way from there to rest; less than 0 is a collision.
    pub fn run(&self, gap: f64) -> f64 {
        let (mut plant, mut ahead) = self.begins(gap);
        let (mut last, mut since) = (mps2(self.own.2), Duration::ZERO);
        let mut under_way = std::collections::VecDeque::from(vec![last; self.late]);
        let (mut least, mut still) = (gap, 0);
        for tick in 0..12_000 {
            let is_missed = (self.missed.0..self.missed.0 + self.missed.1).contains(&tick);
            since = since.plus(PERIOD);
            if !is_missed {
                let ego = self.told(&plant, last);
                let spare = envelope::spare(&self.limits, &ego, &self.rear(&ahead));
                let situation = Situation { is_fresh: true, spare };
                last = envelope::gate(&self.limits, Acceleration::MAX, &ego, &situation, PERIOD, since);
                since = Duration::ZERO;
            }
            under_way.push_back(last);
            let command = under_way.pop_front().unwrap_or(last);
            // In halves of a tick, since the least gap may be between two.
            for half in 0..2 {
                let a = self.acceleration_at((tick as f64 + 0.5 * f64::from(half)) * H);
                ahead = ahead.after(a, 0.5 * H);
                plant.drive(mps2_of(command).max(-self.grip * mps2_of(self.limits.braking)), 0.5 * H);
                least = least.min(ahead.position - plant.position);
            }
            still = if ahead.speed == 0.0 && plant.speed == 0.0 && last <= Acceleration::ZERO { still + 1 } else { 0 };
            if least < 0.0 || still > 20 {
                break;
            }
        }
        least
    }
}
