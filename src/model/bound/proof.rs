//! Proof of the bound's arithmetic: that neither of the fixed-point ends is ever on the wrong side of the true vehicle.
//!
//! # What is proved
//!
//! Let a vehicle be at least at `p` and at least as fast as `v >= 0`, and let it never brake harder than `b`. Its slowest motion is to
//! brake with `b` until it stands. No admissible motion is behind this one or slower, because position and speed are monotone in the
//! start and in the acceleration at each moment. After `t` this motion has come to `p + s(v, b, t)`.
//!
//! 1. **Near end.** `End::braked` is at or behind `p + s(v, b, t)`, and not faster than that motion. It lags by at most `1 + t/2` µm (`t`
//!    in seconds).
//! 2. **Far end.** Take any motion that began not ahead and not faster, accelerates with at most `a`, and never exceeds the top speed.
//!    `End::accelerated` is at or ahead of it, and not slower. It leads by at most `3 + t/2` µm.
//! 3. **Point of rest.** Braking for a while and then to rest never ends ahead of braking to rest at once: the nearest stop does not move
//!    forward while nothing is heard.
//! 4. **Overflow.** No product needs more than 63 bits, and no position saturates within ±560,000 km.
//! 5. **Any number of steps.** 1 and 2 ask of the start only that it is on the right side of the true vehicle. Their result is such a
//!    start again. So, however a time is split into steps, the end stays on the right side. Words are rounded outward. The greater of two
//!    near ends is a near end again, and the lesser of two far ends is a far end again.
//!
//! # How
//!
//! 1, 2 and 3 hold for **all** integers. Each is a polynomial identity between the inputs, the results of the code, and the remainders of
//! its divisions, in which no remainder and no coefficient is negative ([`crate::polynomial`]). The program expands both sides and
//! compares them. Divisions are exact to the remainder for all operands. For those by a million and by 5⁶ this rests on the assertion
//! beside `crate::fixed::per_15_625`, for the others on the processor. 4 is the product of the largest factors.
//!
//! The link from the identities to the code is **sampled**. At each point of a lattice that is dense around rest, the top speed and the
//! ends of every range, the code's result is the one in the identity. Theorem 5 is also tested on random motions, in exact rational
//! arithmetic, through the public functions.
//!
//! # What is assumed
//!
//! Braking and acceleration are words of 1 µm/s² to 64 m/s². Times are at most an hour; for longer times the code itself gives up the
//! far end, and the near end stands. Speeds are words of at most 256 m/s, or the sum of two such words.

mod motions;

use super::*;
use crate::polynomial::{Certificate, Polynomial, Ring};

/// The fastest near end: the largest word. The far end may have the largest uncertainty added to it.
const NEAR_SPEED: i64 = 256_000_000;
const FAR_SPEED: i64 = 2 * NEAR_SPEED;
const HARDEST: i64 = 64_000_000;

fn million<R: Ring>() -> R {
    R::from(MICRO)
}

fn twice<R: Ring>(x: R) -> R {
    R::from(2) * x
}

/// `End::braked` before rest. `lost = ⌈b t / M⌉` leaves `r3`; `(2v - lost) t` per M leaves `r2`, and half of that leaves `r1`.
/// `slower = v - lost` is not negative.
struct Braked<R> {
    /// `2M² (s - way)`.
    way: Certificate<R>,
    /// `M` times by how much the true vehicle is faster.
    speed: Certificate<R>,
    /// `M² 2b (v²/2b - way - way from there to rest)`; the last way leaves `r4`.
    rest: Certificate<R>,
}

fn braked<R: Ring>([slower, lost, b, t, way, then, r1, r2, r3, r4]: [R; 10]) -> Braked<R> {
    let m = million::<R>;
    let v = slower.clone() + lost.clone();
    let loses = m() * lost.clone() - b.clone() * t.clone() - r3.clone();
    let both = v.clone() + slower.clone();
    let goes = both.clone() * t.clone() - m() * (twice(way.clone()) + r1.clone()) - r2.clone();
    let remainders = slower.clone() * slower.clone() - twice(b.clone() * then.clone()) - r4.clone();
    let rounded = m() * r1 + r2;
    let truth = (twice(m() * v.clone()) - b.clone() * t.clone()) * t.clone();
    Braked {
        way: Certificate {
            claim: truth - twice(m() * m() * way.clone()),
            premises: vec![(m(), goes.clone()), (t.clone(), loses.clone())],
            rest: m() * rounded.clone() + r3.clone() * t.clone(),
        },
        speed: Certificate {
            claim: m() * v.clone() - b.clone() * t - m() * slower,
            premises: vec![(R::from(1), loses.clone())],
            rest: r3.clone(),
        },
        rest: Certificate {
            claim: m() * m() * (v.clone() * v - twice(b.clone() * (way + then))),
            premises: vec![(m() * m(), remainders), (b.clone() * m(), goes), (m() * both.clone(), loses)],
            rest: m() * both * r3 + b * m() * rounded + m() * m() * r4,
        },
    }
}

/// `End::accelerated` while it rises for `t`: `gained = ⌈a t / M⌉` is too large by `r3`, `(2v + gained) t` per M by `r2`, and half of
/// that by `r1`. The claims: `2M²` times the lead, and `M` times by how much the true vehicle is slower.
fn rising<R: Ring>([v, a, t, gained, way, r1, r2, r3]: [R; 8]) -> [Certificate<R>; 2] {
    let m = million::<R>;
    let gains = a.clone() * t.clone() + r3.clone() - m() * gained.clone();
    let goes =
        (twice(v.clone()) + gained.clone()) * t.clone() + m() * r1.clone() + r2.clone() - twice(m() * way.clone());
    let truth = (twice(m() * v.clone()) + a.clone() * t.clone()) * t.clone();
    let minus = |x: R| R::from(0) - x;
    [
        Certificate {
            claim: twice(m() * m() * way) - truth,
            premises: vec![(minus(m()), goes), (minus(t.clone()), gains.clone())],
            rest: m() * (m() * r1 + r2) + r3.clone() * t.clone(),
        },
        Certificate {
            claim: m() * (v.clone() + gained) - (m() * v + a * t),
            premises: vec![(minus(R::from(1)), gains)],
            rest: r3,
        },
    ]
}

/// `End::accelerated` at the top speed. At the start it lacked `lacking` of the top speed. It rises for `up = ⌈lacking M / a⌉`, which
/// is too long by `r4/a`, and then holds the top speed for `held`, whose way is too large by `r5`. The lead of `rising` is `lead`. The true
/// vehicle rises for `lacking M / a`; its way is that of the top speed all the time, less a triangle. The claim: `2 a M²` times the lead.
fn topped<R: Ring>([v, lacking, a, up, held, way, rest, lead, r4, r5]: [R; 10]) -> Certificate<R> {
    let m = million::<R>;
    let top = v.clone() + lacking.clone();
    let reaches = a.clone() * up.clone() - m() * lacking.clone() - r4.clone();
    let rises = twice(m() * m() * way.clone()) - (twice(m() * v) + a.clone() * up.clone()) * up.clone() - lead.clone();
    let holds = top.clone() * held.clone() + r5.clone() - m() * rest.clone();
    let truth = twice(a.clone() * m() * top) * (up.clone() + held) - m() * m() * lacking.clone() * lacking.clone();
    let minus = |x: R| R::from(0) - x;
    Certificate {
        claim: twice(a.clone() * m() * m() * (way + rest)) - truth,
        premises: vec![
            (a.clone(), rises),
            (minus(twice(a.clone() * m())), holds),
            (a.clone() * up - m() * lacking + r4.clone(), reaches),
        ],
        rest: a.clone() * lead + r4.clone() * r4 + twice(a * m() * r5),
    }
}

#[test]
fn the_near_end_is_never_ahead_of_the_truth_and_the_far_end_never_behind_it() {
    let Braked { way, speed, rest } = braked(Polynomial::variables());
    assert!(way.holds() && speed.holds() && rest.holds());
    assert!(rising(Polynomial::variables()).into_iter().all(Certificate::holds));
    assert!(topped(Polynomial::variables()).holds());
}

/// The quotient rounded down, and its remainder.
fn down(dividend: i128, divisor: i128) -> (i128, i128) {
    (dividend.div_euclid(divisor), dividend.rem_euclid(divisor))
}

/// The quotient rounded up, and by how much it is too large.
fn up(dividend: i128, divisor: i128) -> (i128, i128) {
    (-(-dividend).div_euclid(divisor), (-dividend).rem_euclid(divisor))
}

/// The result of the code in 128 bits, and its remainders, put into the identities. Panics if the identities do not match the code.
fn compare_near(v: i64, b: i64, t: i64) {
    let found = End { position: 0, speed: v }.braked(t, micros(b));
    let m = i128::from(MICRO);
    let [v, b, t] = [v, b, t].map(i128::from);
    if b * t >= v * m {
        let (way, left) = down(v * v, 2 * b);
        assert_eq!((i128::from(found.position), found.speed), (way, 0), "{v} {b} {t}");
        assert!(left >= 0 && 2 * b * way <= v * v);
        return;
    }
    let (lost, r3) = up(b * t, m);
    let (millionth, r2) = down((2 * v - lost) * t, m);
    let (way, r1) = down(millionth, 2);
    let (then, r4) = down((v - lost) * (v - lost), 2 * b);
    assert_eq!((i128::from(found.position), i128::from(found.speed)), (way, v - lost), "{v} {b} {t}");
    let proved = braked([v - lost, lost, b, t, way, then, r1, r2, r3, r4]);
    assert!(v >= lost && [&proved.way, &proved.speed, &proved.rest].into_iter().all(Certificate::applies));
    // At most 1 + t/2 µm behind.
    assert!((0..=2 * m * m + t * m).contains(&proved.way.claim), "{v} {b} {t}");
    assert!((0..m).contains(&proved.speed.claim) && proved.rest.claim >= 0);
}

fn compare_far(v: i64, a: i64, t: i64) {
    let found = End { position: 0, speed: v }.accelerated(t, micros(a));
    let (m, top) = (i128::from(MICRO), i128::from(TOP_SPEED));
    let [v, a, t] = [v, a, t].map(i128::from);
    let lacking = (top - v).max(0);
    let (to_top, r4) = up(lacking * m, a);
    let rise = t.min(to_top);
    let (gained, r3) = up(a * rise, m);
    let (millionth, r2) = up((2 * v + gained) * rise, m);
    let (way, r1) = up(millionth, 2);
    let speed = (v + gained).min(top.max(v));
    let (rest, r5) = up(speed * (t - rise), m);
    assert_eq!((i128::from(found.position), i128::from(found.speed)), (way + rest, speed), "{v} {a} {t}");
    let [lead, faster] = rising([v, a, rise, gained, way, r1, r2, r3]);
    assert!(lead.applies() && faster.applies() && (0..=2 * m * m + rise * m).contains(&lead.claim));
    assert!((0..m).contains(&faster.claim));
    if rise < t && v <= top {
        let proved = topped([v, lacking, a, rise, t - rise, way, rest, lead.claim, r4, r5]);
        assert!(proved.applies(), "{v} {a} {t}");
        // At most 3 + t/2 µm ahead.
        assert!((0..=2 * a * m * m * 3 + a * t * m).contains(&proved.claim), "{v} {a} {t}");
    }
}

/// The smallest word that is this many µm/s².
fn micros(per_s2: i64) -> Acceleration {
    let word = (i128::from(per_s2 - 1) << 25).div_euclid(i128::from(MICRO)) + 1;
    let found = Acceleration::from_bits(i32::try_from(word).unwrap());
    assert_eq!(micro_up(found.to_bits(), 25), per_s2);
    found
}

/// The values around each of these points, within the range.
fn around(points: &[i64], reach: i64, range: std::ops::RangeInclusive<i64>) -> Vec<i64> {
    let mut all: Vec<i64> =
        points.iter().flat_map(|point| point - reach..=point + reach).filter(|x| range.contains(x)).collect();
    all.sort_unstable();
    all.dedup();
    all
}

#[test]
fn the_code_computes_both_sides_of_each_identity() {
    let speeds = [0, 2_000, 499_999, 8_000_000, 13_400_000, 39_999_999, TOP_SPEED, 1 << 26, NEAR_SPEED, FAR_SPEED - 1];
    let rates = [1, 997, 100_000, 1_000_000, 2_500_000, 7_999_999, 12_000_000, 20_460_000, HARDEST];
    let mut points = 0;
    for rate in around(&rates, 1, 1..=HARDEST) {
        for speed in around(&speeds, 2, 0..=FAR_SPEED) {
            let rest = (i128::from(speed) * i128::from(MICRO) / i128::from(rate)).min(LONGEST.into()) as i64;
            let top =
                ((TOP_SPEED - speed).max(0) as i128 * i128::from(MICRO) / i128::from(rate)).min(LONGEST.into()) as i64;
            let times =
                [0, 10_000, 63_000, 100_000, 1_000_000, 3_999_999, 60_000_000, LONGEST, rest, top, rest / 2, top / 2];
            for time in around(&times, 3, 0..=LONGEST) {
                compare_far(speed, rate, time);
                if speed <= NEAR_SPEED {
                    compare_near(speed, rate, time);
                }
                points += 1;
            }
        }
    }
    assert!(points > 50_000, "{points}");
    let mut random = motions::Random(1);
    for _ in 0..400_000 {
        let (rate, time) = (random.scaled(HARDEST - 1) + 1, random.scaled(LONGEST));
        compare_near(random.scaled(NEAR_SPEED), rate, time);
        compare_far(random.scaled(FAR_SPEED), rate, time);
    }
}

#[test]
fn no_product_leaves_63_bits() {
    // The gain is what is lacking of the top speed, and less than what two microseconds add to that.
    let gained = TOP_SPEED + 2 * HARDEST / MICRO;
    let fastest = FAR_SPEED + gained;
    for factors in [
        [HARDEST, LONGEST],
        [NEAR_SPEED, MICRO],
        [NEAR_SPEED, NEAR_SPEED],
        [2 * NEAR_SPEED, LONGEST],
        [TOP_SPEED, MICRO],
        [2 * FAR_SPEED + gained, LONGEST],
        [fastest, LONGEST],
    ] {
        let product: i128 = factors.map(i128::from).into_iter().product();
        assert!(product < 1 << 62, "{factors:?}");
    }
    // Every word of a speed and of an acceleration is in these ranges.
    assert!(micro_up(i32::MAX, 23) <= NEAR_SPEED && micro_up(i32::MAX, 25) <= HARDEST);
    let furthest = 560_000_000_000_000i64; // µm
    let word = (furthest / MICRO) << 20;
    assert_eq!(micro_position(Position::from_bits(word)), (furthest, furthest));
    assert_eq!(micro_position(Position::from_bits(-word)), (-furthest, -furthest));
    assert_eq!((floor_shifted(furthest, 20), floor_shifted(-furthest, 20)), (word, -word));
}

#[test]
fn an_hour_brings_every_published_braking_to_rest() {
    let least = micro_up(Acceleration::from_mm_per_s2(100).to_bits(), 25);
    assert!(i128::from(least) * i128::from(LONGEST) >= i128::from(NEAR_SPEED) * i128::from(MICRO));
}
