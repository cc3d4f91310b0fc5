//! A horizon between its knots: a start and [`Knots`] enter, way and speed at any time leave; and the other way round, a
//! predicted path enters and the knots that rebuild it leave.
//!
//! Between two knots the way is the quintic through position, speed and acceleration of both, plus the bow, which lifts
//! it midway and leaves both ends alone: `64·b·s³(1-s)³`. A vehicle that stops or moves off between two knots has a kink
//! there, which no polynomial follows; so such a stretch is cut at the kinks ([`Segment::new`]).
//!
//! How well it does, as measured over 20,000 leaders and followers with gains, lags and limits over their whole range,
//! half of them behind a vehicle that brakes, stops and moves off at random (`tests/core/wire_horizon.rs`):
//!
//! | horizon | median | 99 of 100 | worst |
//! |---|---|---|---|
//! | 2 s | 0.5 mm | 0.6 mm | 2.3 mm |
//! | 4 s | 0.5 mm | 2.2 mm | 9.5 mm |
//! | 6 s | 0.9 mm | 3.6 mm | 50 mm |
//!
//! The worst are vehicles that stop and move off again within one stretch. Without the cuts the worst at 4 s is 28 mm,
//! without the bow 15 mm. The shares were found by dynamic programming over all pairs of 40 candidates.

use super::horizon::{KNOTS, KNOTS_PER_MILLE, Knot, Knots};
use crate::fixed::{FractionFormat, mul_hi_fraction, quotient, saturate_i32, shl_saturating};
use crate::time::Duration;
use crate::units::{Acceleration, Distance, Speed};

mod walk;

/// A stretch on which the way is one polynomial of degree 6 in `s`, the share of its length that has passed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Piece {
    micros: i64,
    /// Way at its start.
    origin: Distance,
    /// Coefficients of `s` to `s⁶`, as distances.
    way: [i32; 6],
    /// Coefficients of 1 to `s⁵`, as speeds with [`SPEED_SHIFT`] bits less.
    speed: [i32; 6],
}

/// Speed coefficients can exceed the speeds that they add up to; 2 bits less make it ±1024 m/s by 0.5 µm/s.
const SPEED_SHIFT: u32 = 2;
/// A seventh of 32 bits: no sum of six, each times a share, overflows. Coefficients of the way over 292 m within one
/// stretch and of the speed over 146 m/s are cut down to this; no vehicle has either.
const COEFFICIENT: i64 = i32::MAX as i64 / 7;
const SHARE_BITS: u32 = FractionFormat::FRAC_NBITS;
/// The shortest stretch.
const SHORTEST: i64 = 1000;
const MICROS_PER_S: i64 = 1_000_000;

/// `word · t`, `t` in microseconds; words of at most 38 bits.
const fn over(word: i64, micros: i64) -> i64 {
    quotient(word.saturating_mul(micros), MICROS_PER_S)
}

/// A product, saturating; a call, because it stands in many places that are seldom come to.
#[cfg_attr(not(target_pointer_width = "64"), inline(never))]
const fn times(a: i64, b: i64) -> i64 {
    a.saturating_mul(b)
}

/// A state in the words of the number formats.
#[derive(Clone, Copy)]
struct State {
    way: i64,
    speed: i64,
    acceleration: i64,
}

impl State {
    fn of(knot: &Knot) -> Self {
        let at_rest = knot.speed.to_bits() <= 0;
        let acceleration = i64::from(knot.acceleration.to_bits());
        Self {
            way: i64::from(knot.displacement.to_bits()),
            speed: i64::from(knot.speed.to_bits()).max(0),
            acceleration: if at_rest { acceleration.max(0) } else { acceleration },
        }
    }
}

impl Piece {
    const NOTHING: Self = Self { micros: 0, origin: Distance::ZERO, way: [0; 6], speed: [0; 6] };

    /// Makes it a rest.
    fn rest(&mut self, way: i64, micros: i64) {
        *self = Self { micros, origin: Distance::from_bits(saturate_i32(way)), ..Self::NOTHING };
    }

    /// Makes it the quintic from one state to the other in this time (at least [`SHORTEST`]). Pieces are made where they lie, because
    /// copies of them would cost as much as making them.
    fn quintic(&mut self, from: State, to: State, micros: i64, bow: i64) {
        let micros = micros.max(SHORTEST);
        let by_speed = |speed: i64| over(speed, micros) >> 3; // F23 to F20
        let by_acceleration = |acceleration: i64| over(over(acceleration, micros), micros) >> 5; // F25 to F20
        let first = by_speed(from.speed);
        let second = by_acceleration(from.acceleration) >> 1;
        // what is left of way, speed and acceleration at the end, each as a way
        let d = to.way.saturating_sub(from.way).saturating_sub(first).saturating_sub(second);
        let e = by_speed(to.speed.saturating_sub(from.speed)).saturating_sub(second.saturating_mul(2));
        let f = by_acceleration(to.acceleration.saturating_sub(from.acceleration));
        // Words of 32 bits over at most 2³¹ µs make ways below 2⁴⁵, so that nothing here can overflow.
        let sum = |d_times: i64, e_times: i64, half_f_times: i64, bow_times: i64| {
            d.wrapping_mul(d_times)
                .wrapping_add(e.wrapping_mul(e_times))
                .wrapping_add(f.wrapping_mul(half_f_times) >> 1)
                .wrapping_add(bow.wrapping_mul(bow_times))
        };
        let coefficients =
            [first, second, sum(10, -4, 1, 64), sum(-15, 7, -2, -192), sum(6, -3, 1, 192), sum(0, 0, 0, -64)];
        (self.micros, self.origin) = (micros, Distance::from_bits(saturate_i32(from.way)));
        let mut power = 0i64;
        for ((way, speed), coefficient) in self.way.iter_mut().zip(&mut self.speed).zip(coefficients) {
            *way = saturate_i32(coefficient.clamp(-COEFFICIENT, COEFFICIENT));
            power = power.wrapping_add(1); // up to 6, which is 23 bits of microseconds
            let per_second = (i64::from(*way) << (3 - SPEED_SHIFT)).wrapping_mul(power.wrapping_mul(MICROS_PER_S));
            *speed = saturate_i32(quotient(per_second, micros).clamp(-COEFFICIENT, COEFFICIENT));
        }
    }

    #[cfg_attr(not(target_pointer_width = "64"), inline(never))]
    fn share_of(&self, micros: i64) -> i32 {
        let share = micros.min(self.micros).max(0) << SHARE_BITS;
        saturate_i32(quotient(share, self.micros))
    }

    /// Way and speed at a share from 0 to 1: 11 multiplications. The speed is never negative.
    #[inline(always)]
    fn at_fraction(&self, share: i32) -> (Distance, Speed) {
        let [w1, w2, w3, w4, w5, w6] = self.way;
        let [v0, v1, v2, v3, v4, v5] = self.speed;
        let times = |sum: i32| mul_hi_fraction(sum, share).wrapping_shl(2); // at most the sum, which COEFFICIENT keeps small
        let up = |sum: i32, coefficient: i32| coefficient.wrapping_add(times(sum));
        let way = times(up(up(up(up(up(w6, w5), w4), w3), w2), w1));
        let speed = up(up(up(up(up(v5, v4), v3), v2), v1), v0);
        let speed = if speed < 0 { 0 } else { shl_saturating::<SPEED_SHIFT>(speed) };
        (self.origin.plus(Distance::from_bits(way)), Speed::from_bits(speed))
    }

    /// The state at this time after its start, limited to its ends.
    fn at(&self, micros: i64) -> Knot {
        let share = self.share_of(micros);
        let (displacement, speed) = self.at_fraction(share);
        Knot { displacement, speed, acceleration: self.acceleration_at(share), bow: Distance::ZERO }
    }

    fn acceleration_at(&self, share: i32) -> Acceleration {
        let [_, v1, v2, v3, v4, v5] = self.speed.map(i64::from);
        let up = |sum: i64, power: i64, coefficient: i64| {
            coefficient.saturating_mul(power).saturating_add(sum.saturating_mul(i64::from(share)) >> SHARE_BITS)
        };
        let sum = up(up(up(up(v5.saturating_mul(5), 4, v4), 3, v3), 2, v2), 1, v1);
        let per_second = quotient((sum << (2 + SPEED_SHIFT)).saturating_mul(MICROS_PER_S), self.micros);
        Acceleration::from_bits(saturate_i32(per_second))
    }
}

/// What lies between two knots: up to three pieces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Segment {
    pieces: [Piece; 3],
}

impl Segment {
    /// The stretch from one knot to the next, which is this much later.
    ///
    /// - At rest at the end: it brakes, comes to rest with the acceleration `b` that the knot tells, and stands. It comes to
    ///   rest when the quintic has no fifth power, `t = 12·D / (3·v + √(9·v² + 12·(a - b)·D))`.
    /// - Moving at the end but at rest in between, which shows as braking first, accelerating last, and enough time for
    ///   both: it brakes to rest evenly, stands, and moves off with a constant jerk.
    /// - Else one quintic.
    #[must_use]
    pub fn new(from: &Knot, to: &Knot, length: Duration) -> Self {
        let mut segment = Self::NOTHING;
        segment.make(from, to, length);
        segment
    }

    const NOTHING: Self = Self { pieces: [Piece::NOTHING; 3] };

    /// Makes it that stretch.
    fn make(&mut self, from: &Knot, to: &Knot, length: Duration) {
        self.pieces.iter_mut().for_each(|piece| piece.micros = 0);
        let length = length.as_micros().clamp(SHORTEST, Duration::MAX.as_micros() >> 32);
        let bow = i64::from(to.bow.to_bits());
        let (a, b) = (State::of(from), State::of(to));
        let way = b.way.saturating_sub(a.way).max(0);
        if b.speed == 0 && a.speed > 0 {
            let last = i64::from(to.acceleration.to_bits()).min(0);
            let braking = time_to_rest(way, a.speed, a.acceleration.saturating_sub(last), [12, 3, 9, 12]).min(length);
            let rest = State { way: a.way.saturating_add(way), speed: 0, acceleration: last };
            let [stop, standing, _] = &mut self.pieces;
            stop.quintic(a, rest, braking, bow);
            standing.rest(rest.way, length.saturating_sub(stop.micros));
        } else if self.rest_between(a, b, length, bow).is_none() {
            let [whole, ..] = &mut self.pieces;
            whole.quintic(a, b, length, bow);
        }
    }

    /// With a rest in between; `None` if there is none, and then nothing is made.
    fn rest_between(&mut self, a: State, b: State, length: i64, bow: i64) -> Option<()> {
        let brakes_or_stands = a.acceleration < 0 || a.speed == 0;
        if !(brakes_or_stands && b.speed > 0 && b.acceleration > 0) {
            return None;
        }
        // constant jerk from rest: v = a·t/2, way = v·t/3
        let moving_off = times(b.speed, 8 * MICROS_PER_S).checked_div(b.acceleration)?; // F25/F23 and 2
        let way_off = over(b.speed, moving_off).checked_div(3)? >> 3;
        let slack = i64::from(Distance::from_mm(2).to_bits());
        let way = b.way.saturating_sub(a.way).saturating_sub(way_off);
        if way < slack.saturating_neg() {
            return None;
        }
        // from rest, what the constant jerk leaves over is left to the quintic that moves it off
        let (way, braking) = match a.speed {
            0 if way > way_off => return None,
            0 => (0, 0),
            speed => (way.max(0), time_to_rest(way.max(0), speed, a.acceleration, [6, 2, 4, 6])),
        };
        if braking.saturating_add(moving_off) > length || (a.speed == 0 && a.acceleration > 0) {
            return None;
        }
        // evenly changing acceleration: its end follows from 0 = v + (a + end)/2·t
        let end = times(a.speed, -8 * MICROS_PER_S).checked_div(braking.max(1))?.saturating_sub(a.acceleration);
        let rest = State { way: a.way.saturating_add(way), speed: 0, acceleration: i64::from(saturate_i32(end)) };
        let [stop, standing, off] = &mut self.pieces;
        if braking != 0 {
            stop.quintic(a, rest, braking, bow);
        }
        off.quintic(State { acceleration: 0, ..rest }, b, moving_off, 0);
        standing.rest(rest.way, length.saturating_sub(stop.micros).saturating_sub(off.micros).max(0));
        Some(())
    }

    /// Its pieces, each with its start.
    fn pieces(&self) -> impl Iterator<Item = (i64, &Piece)> {
        self.pieces.iter().filter(|piece| piece.micros > 0).scan(0i64, |end, piece| {
            let start = *end;
            *end = end.saturating_add(piece.micros);
            Some((start, piece))
        })
    }

    /// The state so much later than the segment's start, limited to its ends.
    #[must_use]
    pub fn at(&self, after: Duration) -> Knot {
        let after = after.as_micros();
        let found = self.pieces().filter(|(start, _)| *start <= after.max(0)).last();
        found.map_or(Knot::default(), |(start, piece)| piece.at(after.saturating_sub(start)))
    }
}

/// When a vehicle comes to rest that has this way left, as the positive root of a quadratic:
/// `n·D / (p·v + √(q·v² + r·a·D))`, in microseconds, at least [`SHORTEST`]. Words in, computed in millionths.
fn time_to_rest(way: i64, speed: i64, acceleration: i64, [n, p, q, r]: [i64; 4]) -> i64 {
    let way = times(way, MICROS_PER_S) >> 20;
    let speed = times(speed, MICROS_PER_S) >> 23;
    let acceleration = times(acceleration, MICROS_PER_S) >> 25;
    let squared = times(times(speed, speed), q);
    let under = squared.saturating_add(times(times(acceleration, way), r)).max(0);
    let root = i64::try_from(under.unsigned_abs().isqrt()).unwrap_or(i64::MAX);
    let below = times(speed, p).saturating_add(root);
    quotient(times(times(way, n), MICROS_PER_S), below).max(SHORTEST)
}

/// A whole horizon between its knots.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Curve {
    /// The start and the knots.
    states: [Knot; KNOTS + 1],
    length: Duration,
}

impl Curve {
    /// From the start ([`Knot::start`] of the motion message with the same tag) over the knots; the horizon is so long.
    #[must_use]
    pub fn new(start: Knot, knots: &Knots, length: Duration) -> Self {
        let [a, b, c, d, e] = knots.knots;
        Self { states: [start, a, b, c, d, e], length }
    }

    /// The state so long after the motion's stamp; before it the start, after the horizon its end.
    #[must_use]
    pub fn at(&self, after: Duration) -> Knot {
        let micros = after.as_micros().max(0);
        let (mut pieces, mut found) = (self.pieces(), Knot::default());
        while let Some((start, piece)) = pieces.advance() {
            if start > micros {
                break;
            }
            found = piece.at(micros.saturating_sub(start));
        }
        found
    }
}

#[cfg_attr(not(target_pointer_width = "64"), inline(never))]
const fn share_of(length: Duration, per_mille: u16) -> i64 {
    quotient(length.as_micros().saturating_mul(per_mille as i64), 1000)
}

impl Knots {
    /// The knots that rebuild a predicted path, given as way and speed so long after the motion's stamp, the way counted from the position
    /// in the motion message, and as the acceleration, which is asked for at the knots alone. Start and tag are that message's; the start
    /// has to be [`Knot::rounded`], so that the sender sees it as the receiver will.
    #[must_use]
    pub fn through(
        tag: u8,
        start: Knot,
        length: Duration,
        mut path: impl FnMut(Duration) -> (Distance, Speed),
        mut acceleration: impl FnMut(Duration) -> Acceleration,
    ) -> Self {
        let mut from = (0, start);
        let knots = KNOTS_PER_MILLE.map(|per_mille| {
            let (time, before) = from;
            let end = share_of(length, per_mille);
            let after = Duration::from_micros(end);
            let (displacement, speed) = path(after);
            let mut knot =
                Knot { displacement, speed, acceleration: acceleration(after), bow: Distance::ZERO }.rounded();
            if knot.speed == Speed::ZERO {
                knot.acceleration = if before.speed > Speed::ZERO {
                    braking_to_rest(
                        &before,
                        knot.displacement.minus(before.displacement),
                        rest_time(time, end, &mut path).saturating_sub(time),
                    )
                } else {
                    Acceleration::ZERO
                };
                knot = knot.rounded();
            }
            let segment = Segment::new(&before, &knot, Duration::from_micros(end.saturating_sub(time)));
            let [first, ..] = segment.pieces;
            if first.micros > 0 {
                let midway = first.micros / 2;
                let (truth, _) = path(Duration::from_micros(time.saturating_add(midway)));
                knot.bow = truth.minus(first.at(midway).displacement);
            }
            knot = knot.rounded();
            from = (end, knot);
            knot
        });
        Self { tag: tag & 3, knots }
    }
}

/// When the vehicle came to rest between these times, at which it moves and stands; bisected to 1 ms.
fn rest_time(moving: i64, standing: i64, path: &mut impl FnMut(Duration) -> (Distance, Speed)) -> i64 {
    let (mut moving, mut standing) = (moving, standing);
    while standing.saturating_sub(moving) > SHORTEST {
        let middle = moving.saturating_add(standing) / 2;
        let (_, speed) = path(Duration::from_micros(middle));
        if (Knot { speed, ..Knot::default() }).rounded().speed > Speed::ZERO {
            moving = middle;
        } else {
            standing = middle;
        }
    }
    standing
}

/// The acceleration at the end with which a vehicle of this state comes to rest in this time on this way: the inverse of
/// [`time_to_rest`], `a + (6·v·t - 12·D)/t²`; not positive.
fn braking_to_rest(from: &Knot, way: Distance, micros: i64) -> Acceleration {
    let from = State::of(from);
    let left =
        over(from.speed, micros.saturating_mul(6)).saturating_sub(i64::from(way.to_bits()).saturating_mul(12 << 3));
    let per_time = |word: i64| quotient(word.saturating_mul(MICROS_PER_S), micros);
    let last = from.acceleration.saturating_add(per_time(per_time(left.saturating_mul(4)))); // F23 to F25
    Acceleration::from_bits(saturate_i32(last.min(0)))
}
