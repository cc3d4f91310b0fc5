//! Random motions within random limits, in exact rational arithmetic, and the results of the bound's public functions for them: a sample
//! anywhere in its uncertainty, any number of steps, two bounds joined. Every true state is inside.

use super::super::*;
use super::{down, up};

/// 2⁻¹² · 10⁻¹² µm: in this unit, every word, and half of every product of a rate and two times, is a whole number.
const PER_MICROMETRE: i128 = 1_000_000_000_000 << 12;
/// 2⁻¹¹ · 10⁻⁶ µm/s.
const PER_MICROMETRE_PER_SECOND: i128 = 1_000_000 << 11;

/// A word of a position and a word of a speed in these units, exactly.
const PER_POSITION_WORD: i128 = (PER_MICROMETRE * 15_625) >> 14;
const PER_SPEED_WORD: i128 = (PER_MICROMETRE_PER_SECOND * 15_625) >> 17;
/// The word of 0.1 m/s².
const LEAST: i64 = (1 << 25) / 10;

/// A generator of its own, so that it shares nothing with the core.
pub struct Random(pub u64);

impl Random {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let x = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let x = (x ^ (x >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        x ^ (x >> 31)
    }

    /// A value from 0 to `most`, of any order of magnitude.
    pub fn scaled(&mut self, most: i64) -> i64 {
        let most = most.min((1 << (self.bits() % 62 + 1)) - 1);
        (self.bits() >> 1).cast_signed() % (most + 1)
    }

    /// A value from `low` to `high`; as often as not it is one of the two.
    fn within(&mut self, low: i64, high: i64) -> i64 {
        match self.bits() % 4 {
            0 => low,
            1 => high,
            _ => low + (self.bits() >> 1).cast_signed() % (high - low + 1),
        }
    }
}

/// A vehicle: its speed, and two positions that its position is between. Two are needed because a vehicle comes to rest at moments that
/// are no whole numbers.
#[derive(Clone, Copy)]
struct Body {
    position: (i128, i128),
    speed: i128,
}

impl Body {
    fn from_words(position: i64, speed: i32) -> Self {
        let position = i128::from(position) * PER_POSITION_WORD;
        Self { position: (position, position), speed: i128::from(speed) * PER_SPEED_WORD }
    }

    /// The vehicle after this many µs at this rate in µm/s². It does not exceed the top speed and does not move backwards.
    fn after(self, rate: i64, micros: i64) -> Self {
        let (a, t) = (i128::from(rate) << 11, i128::from(micros));
        let top = i128::from(TOP_SPEED) * PER_MICROMETRE_PER_SECOND;
        let speed = self.speed + a * t;
        if speed > top {
            return self.after(0, micros);
        }
        let way = if speed < 0 {
            // v²/2b, which is 2⁻¹¹ less in these units.
            let square = self.speed * self.speed;
            (down(square, -a).0, up(square, -a).0)
        } else {
            let way = 2 * self.speed * t + a * t * t;
            (way, way)
        };
        Self { position: (self.position.0 + way.0, self.position.1 + way.1), speed: speed.max(0) }
    }

    fn is_inside(&self, bound: &Bound) -> bool {
        let place = |position: Position| Self::from_words(position.to_bits(), 0).position.0;
        let pace = |speed: Speed| Self::from_words(0, speed.to_bits()).speed;
        let ends = bound.near.position as i128 * PER_MICROMETRE <= self.position.1
            && bound.far.position as i128 * PER_MICROMETRE >= self.position.0;
        let words = place(bound.lowest_position()) <= self.position.1
            && place(bound.highest_position()) >= self.position.0
            && pace(bound.lowest_speed()) <= self.speed
            && pace(bound.highest_speed()) >= self.speed;
        ends && words
    }
}

/// A motion in pieces, each with its rate and its duration.
struct Motion {
    limits: (i64, i64),
    now: i64,
    body: Body,
}

impl Motion {
    fn goes_on(&mut self, random: &mut Random, until: i64) {
        while self.now < until {
            let lasts = random.scaled(20_000_000).min(until - self.now);
            let rate = random.within(-self.limits.0, self.limits.1);
            self.body = self.body.after(rate, lasts);
            self.now += lasts;
        }
    }

    /// A sample with an error of anything up to its uncertainty, of an instant that is off by anything up to its uncertainty.
    fn sample(&mut self, random: &mut Random, reach: &AccelerationRange) -> Bound {
        let [earlier, later] = [random.scaled(2_000_000), random.scaled(2_000_000)];
        let at = self.now + random.within(-later, earlier);
        let (off, faster) = (random.scaled(13 << 20), random.scaled(3 << 23));
        // The word of the true value, and a word more of uncertainty for what is lost by rounding.
        let position = down(self.body.position.0, PER_POSITION_WORD).0 as i64 + random.within(-off, off);
        let speed = down(self.body.speed, PER_SPEED_WORD).0 as i64;
        let speed = (speed + random.within(-faster, faster)).max(0);
        let uncertainty = Uncertainty {
            position: Distance::from_bits(off as i32 + 1),
            speed: Speed::from_bits(faster as i32 + 1),
            earlier: Duration::from_micros(earlier),
            later: Duration::from_micros(later),
        };
        let at = Instant::from_micros(at.cast_unsigned());
        Bound::around(at, Position::from_bits(position), Speed::from_bits(speed as i32), &uncertainty, reach)
    }
}

fn drive(seed: u64) {
    let mut random = Random(seed);
    let reach = AccelerationRange {
        acceleration: Acceleration::from_bits(random.within(LEAST, i32::MAX.into()) as i32),
        braking: Acceleration::from_bits(random.within(LEAST, i32::MAX.into()) as i32),
    };
    // A limit in whole µm/s² is no more than its word says.
    let whole = |limit: Acceleration| micro_down_64(limit.to_bits().into(), 25);
    let start = Body::from_words(random.within(-560_000 << 20, 8_000_000 << 20), random.within(0, 65 << 23) as i32);
    let limits = (whole(reach.braking), whole(reach.acceleration));
    let mut truth = Motion { limits, now: 10_000_000, body: start };
    let mut bound = truth.sample(&mut random, &reach);
    let mut whole_way = bound;
    for step in 0..12 {
        let until = bound.at().as_micros().cast_signed().max(truth.now) + random.scaled(30_000_000);
        truth.goes_on(&mut random, until);
        let now = Instant::from_micros(until.cast_unsigned());
        // In steps, and in a single step.
        bound = bound.after(now, &reach);
        for of in [bound, whole_way.after(now, &reach)] {
            assert!(truth.body.is_inside(&of), "seed {seed}, step {step}: {of:?}");
            let stop = of.nearest_stop(&reach);
            let ahead = Body::from_words(stop.to_bits(), 0).position.0;
            let remainders = truth.body.after(-truth.limits.0, 3_600_000_000);
            assert!(ahead <= remainders.position.1, "seed {seed}, step {step}: {stop:?}");
        }
        if step % 3 == 2 {
            let news = truth.sample(&mut random, &reach);
            let both = bound.and(&news, &reach);
            assert!(both.is_some(), "seed {seed}, step {step}: honest samples contradict one another");
            bound = both.unwrap_or(news);
            whole_way = news;
        }
    }
}

#[test]
fn every_motion_within_the_limits_stays_inside() {
    (0..20_000).for_each(drive);
}
