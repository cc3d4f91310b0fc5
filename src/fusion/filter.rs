//! A Kalman filter of one vehicle's motion. Measurements enter in the order of when they were taken; position, speed and acceleration
//! leave.
//!
//! The acceleration fades out with the time constant [`FADE`], as that of a vehicle of which nothing is known, and white noise changes it.
//! Over a step `h`, with `φ = 1 - h/T`,
//!
//! ```text
//! r' = r + v h + a h²/2      v' = v + a h      a' = φ a      P' = F P Fᵀ + q Q(h)
//! ```
//!
//! A vehicle that keeps its speed is tracked with little noise (`WANDER`). One that accelerates or brakes will end that, and the density of
//! the noise grows with the square of the acceleration, `q = WANDER + min(a²/32, 1/2)`. Who brakes changes the acceleration at once. A
//! speed that differs from the expected one by more than three standard deviations says so. Then the acceleration may have changed by
//! `MANOEUVRE` within the last step, and the filter follows within a few views.
//!
//! The variances have 25 fraction bits: up to 64 m², by 3e-8 m². The measured quantities are taken in one after the other, so that each
//! needs the quotients of one number only.

use crate::fixed::{quotient, saturate_i32};
use crate::parameters::FADE;
use crate::time::{Duration, Instant};
use crate::units::{Acceleration, Distance, Position, Speed};

/// Fraction bits of variances, gains and innovations.
const BITS: u32 = 25;
const ONE: i32 = 1 << BITS;

/// Spectral density of the change of acceleration, in (m/s³)²/Hz: an acceleration that wanders by 0.03 m/s² in a second. More of it makes
/// a string behind a steady leader less steady.
const WANDER: i32 = ONE / 1_024;

/// Variance of a sudden change of acceleration: a standard deviation of 5 m/s².
const MANOEUVRE: i32 = 25 * ONE;

/// Squared, how many standard deviations an innovation of the speed is beyond what the errors explain.
const UNEXPECTED: i64 = 9;

/// Steps of prediction are no longer than this.
const LONGEST_STEP: Duration = Duration::from_millis(250);

/// No standard deviation is taken to be smaller than 5 mm or 5 mm/s: roundings on the wire, and times, are no better.
const LEAST_VARIANCE: i32 = ONE / 40_000;

/// Position and speed at an instant, with the standard deviations of their errors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Measured {
    /// When they were true.
    pub at: Instant,
    /// The front bumper.
    pub position: Position,
    /// The speed, not negative.
    pub speed: Speed,
    /// One standard deviation of the position.
    pub position_error: Distance,
    /// One standard deviation of the speed.
    pub speed_error: Speed,
}

/// The motion of a vehicle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Motion {
    /// When it was true.
    pub at: Instant,
    /// The front bumper.
    pub position: Position,
    /// The speed.
    pub speed: Speed,
    /// The acceleration.
    pub acceleration: Acceleration,
}

/// The covariances of position `r`, speed `v` and acceleration `a`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Covariances {
    rr: i32,
    rv: i32,
    ra: i32,
    vv: i32,
    va: i32,
    aa: i32,
}

/// A motion, and how well it is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Filter {
    motion: Motion,
    covariances: Covariances,
    /// The last step of prediction.
    step: i32,
}

impl Filter {
    /// Begins with a measurement, and an acceleration with its standard deviation.
    #[must_use]
    pub fn begin(measured: &Measured, acceleration: Acceleration, deviation: Acceleration) -> Self {
        let Measured { at, position, speed, position_error, speed_error } = *measured;
        let (rr, vv) = (variance_of_position(position_error), variance_of_speed(speed_error));
        let covariances = Covariances { rr, rv: 0, ra: 0, vv, va: 0, aa: variance_of_acceleration(deviation) };
        Self { motion: Motion { at, position, speed, acceleration }, covariances, step: 0 }
    }

    /// The motion as it is estimated.
    #[must_use]
    pub const fn motion(&self) -> &Motion {
        &self.motion
    }

    /// Moves the place, because the axis of the vehicle moved.
    pub const fn shift(&mut self, way: Distance) {
        self.motion.position = self.motion.position.ahead(way);
    }

    /// Predicts the motion at a later instant.
    pub fn predict(&mut self, at: Instant) {
        self.step = 0;
        while self.motion.at < at {
            let step = at.since(self.motion.at).min(LONGEST_STEP);
            self.take_step(step);
        }
    }

    fn take_step(&mut self, step: Duration) {
        let Motion { at, position, speed, acceleration } = self.motion;
        let gained = acceleration.over(step.fine_seconds());
        let mean = speed.plus(Speed::from_bits(gained.to_bits() / 2));
        let h = saturate_i32(quotient(step.as_micros().saturating_mul(ONE.into()), 1_000_000));
        let keep =
            ONE.saturating_sub(saturate_i32(quotient(step.as_micros().saturating_mul(ONE.into()), FADE.as_micros())));
        self.motion = Motion {
            at: at.plus(step),
            position: position.ahead(mean.over(step.seconds())),
            speed: speed.plus(gained),
            acceleration: Acceleration::from_bits(product(acceleration.to_bits(), keep)),
        };
        let density =
            WANDER.saturating_add((product(acceleration.to_bits(), acceleration.to_bits()) / 32).min(ONE / 2));
        self.covariances = self.covariances.after(h, keep).and(&Covariances::of_change(product(density, h), h));
        self.step = h;
    }

    /// Takes in what was measured at the instant of the last prediction: the position, and then the speed.
    pub fn correct(&mut self, measured: &Measured) {
        let noise = variance_of_speed(measured.speed_error);
        let off = i64::from(measured.speed.minus(self.motion.speed).to_bits()).saturating_mul(4);
        let spread = i64::from(self.covariances.vv.saturating_add(noise));
        let is_unexpected = off.saturating_mul(off) >> BITS > spread.saturating_mul(UNEXPECTED);
        if is_unexpected && self.covariances.aa < MANOEUVRE {
            self.covariances = self.covariances.and(&Covariances::of_jump(MANOEUVRE, self.step));
        }
        let Covariances { rr, rv, ra, .. } = self.covariances;
        let off = measured.position.ahead_of(self.motion.position).to_bits();
        let off = saturate_i32(i64::from(off).saturating_mul(32)); // from 20 to 25 fraction bits
        self.take_in(off, rr, variance_of_position(measured.position_error), [rr, rv, ra]);
        let Covariances { rv, vv, va, .. } = self.covariances;
        let off = measured.speed.minus(self.motion.speed).to_bits().saturating_mul(4); // from 23
        self.take_in(off, vv, noise, [rv, vv, va]);
    }

    /// Takes in an acceleration, with its standard deviation.
    pub fn correct_acceleration(&mut self, acceleration: Acceleration, deviation: Acceleration) {
        let Covariances { ra, va, aa, .. } = self.covariances;
        let off = acceleration.minus(self.motion.acceleration).to_bits(); // it has 25
        self.take_in(off, aa, variance_of_acceleration(deviation), [ra, va, aa]);
    }

    /// Takes in one quantity that is off by so much, with the quantity's variance, that of the measurement, and the covariances of
    /// position, speed and acceleration with the quantity.
    fn take_in(&mut self, off: i32, variance: i32, noise: i32, with: [i32; 3]) {
        let spread = i64::from(variance).saturating_add(i64::from(noise)).max(1);
        // A divisor below 2²⁴ is quick.
        let is_wide = spread >= 1 << 23;
        let gain = |covariance: i32| match is_wide {
            true => quotient(i64::from(covariance) << (BITS - 8), spread >> 8),
            false => quotient(i64::from(covariance) << BITS, spread),
        };
        let [r, v, a] = with;
        let (of_r, of_v, of_a) = (gain(r), gain(v), gain(a));
        let Motion { at, position, speed, acceleration } = self.motion;
        self.motion = Motion {
            at,
            position: position.ahead(Distance::from_bits(scaled(of_r, off) >> 5)),
            speed: speed.plus(Speed::from_bits(scaled(of_v, off) >> 2)).max(Speed::ZERO),
            acceleration: acceleration.plus(Acceleration::from_bits(scaled(of_a, off))),
        };
        let Covariances { rr, rv, ra, vv, va, aa } = self.covariances;
        self.covariances = Covariances {
            rr: rr.saturating_sub(scaled(of_r, r)).max(0),
            rv: rv.saturating_sub(scaled(of_r, v)),
            ra: ra.saturating_sub(scaled(of_r, a)),
            vv: vv.saturating_sub(scaled(of_v, v)).max(0),
            va: va.saturating_sub(scaled(of_v, a)),
            aa: aa.saturating_sub(scaled(of_a, a)).max(0),
        };
    }
}

impl Covariances {
    /// `F P Fᵀ`.
    fn after(&self, h: i32, keep: i32) -> Self {
        let Self { rr, rv, ra, vv, va, aa } = *self;
        let half = product(h, h) / 2;
        let sum = |terms: [i32; 3]| terms.iter().fold(0i32, |sum, term| sum.saturating_add(*term));
        // Covariances of the new position and the new speed with the old quantities, and with the acceleration before it fades.
        let rv_old = sum([rv, product(h, vv), product(half, va)]);
        let rr_old = sum([rr, product(h, rv), product(half, ra)]);
        let ra_new = sum([ra, product(h, va), product(half, aa)]);
        let va_new = va.saturating_add(product(h, aa));
        Self {
            rr: sum([rr_old, product(h, rv_old), product(half, ra_new)]),
            rv: rv_old.saturating_add(product(h, ra_new)),
            ra: product(keep, ra_new),
            vv: sum([vv, product(h, va), product(h, va_new)]),
            va: product(keep, va_new),
            aa: product(keep, product(keep, aa)),
        }
    }

    /// What white noise adds over a step that changes the acceleration by this variance.
    fn of_change(change: i32, h: i32) -> Self {
        let half = product(h, h) / 2;
        let (va, third) = (product(change, h) / 2, product(change, product(h, h)) / 3);
        Self {
            rr: product(third, half).saturating_mul(3) / 10,
            rv: product(va, half) / 2,
            ra: product(change, half) / 3,
            vv: third,
            va,
            aa: change,
        }
    }

    /// What a sudden change of the acceleration adds, at any moment of the last step.
    fn of_jump(change: i32, h: i32) -> Self {
        Self { rr: 0, rv: 0, ra: 0, vv: product(change, product(h, h)) / 3, va: product(change, h) / 2, aa: change }
    }

    fn and(&self, other: &Self) -> Self {
        Self {
            rr: self.rr.saturating_add(other.rr),
            rv: self.rv.saturating_add(other.rv),
            ra: self.ra.saturating_add(other.ra),
            vv: self.vv.saturating_add(other.vv),
            va: self.va.saturating_add(other.va),
            aa: self.aa.saturating_add(other.aa),
        }
    }
}

/// A product, rounded to nearest, saturating.
fn product(a: i32, b: i32) -> i32 {
    // Below 2⁶³: nothing wraps.
    saturate_i32(i64::from(a).wrapping_mul(b.into()).wrapping_add(1 << (BITS - 1)) >> BITS)
}

/// The product with a gain, which may be beyond a word: an acceleration follows from a speed within milliseconds.
fn scaled(gain: i64, word: i32) -> i32 {
    match i32::try_from(gain) {
        Ok(gain) => product(gain, word),
        Err(_) => scaled_far(gain, word),
    }
}

#[inline(never)] // seldom
fn scaled_far(gain: i64, word: i32) -> i32 {
    saturate_i32(gain.saturating_mul(word.into()).saturating_add(1 << (BITS - 1)) >> BITS)
}

/// The square of a word with so many fraction bits.
fn variance(word: i32, bits: u32) -> i32 {
    let square = i64::from(word).saturating_mul(i64::from(word));
    saturate_i32(square >> bits.saturating_mul(2).saturating_sub(BITS)).max(LEAST_VARIANCE)
}

fn variance_of_position(deviation: Distance) -> i32 {
    variance(deviation.to_bits(), 20)
}

fn variance_of_speed(deviation: Speed) -> i32 {
    variance(deviation.to_bits(), 23)
}

fn variance_of_acceleration(deviation: Acceleration) -> i32 {
    variance(deviation.to_bits(), 25)
}
