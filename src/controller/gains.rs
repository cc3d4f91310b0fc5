//! The law's gains, eq. 6: own speed, target speed and headway at the moment of association enter, `{k, γ}` leave.
//!
//! A table holds `k` over the three, and `γ` follows from `k` by a curve, along which string stability and the stability
//! margin were proved; so they hold for every mean of cells too. There are two tables, for the law without feed-forward and for that with
//! it. `holdover-sim gains` makes and proves both. Between cells the look-up interpolates, beyond the last ones it takes the last.
//!
//! Gains stay what they are for as long as the association lasts, so the loop is linear in all that time. They are whole
//! thousandths, which is what `PeerDrivingParameters` says of them: others predict the vehicle with the very gains that it drives by.
//! With the next association they may jump, and the demand does not, because the limit on its jerk holds across it.

use super::gain_table::{FED, HEADWAY_FIRST_MM, HEADWAY_STEP_MM, HEADWAYS, PLAIN, POINTS, SPEED_STEP_MM_PER_S, SPEEDS};
use crate::config::Law;
use crate::fixed::quotient;
use crate::units::{Distance, Fraction, Gain, Seconds, Speed};

/// The gains of one association.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Gains {
    /// `k`.
    pub gain: Gain,
    /// `γ`.
    pub damping: Seconds,
}

/// A table: the gain over both speeds and the headway, and the damping over the gain.
pub(super) struct Table {
    /// The first `k` of the curve, in 1/(1000 s²).
    pub first_milli: u16,
    /// Its steps.
    pub step_milli: u16,
    /// `γ` over `k`, in ms.
    pub curve: [u16; POINTS],
    /// `k` in steps of 5/(1000 s²) by own speed, target's speed and headway.
    pub gains: [[[u8; HEADWAYS]; SPEEDS]; SPEEDS],
}

/// Parts of a cell, between which the look-up tells no difference.
const PARTS: i64 = 256;

/// Steps of `k` in the table, in thousandths.
const GAIN_STEP_MILLI: i64 = 5;

impl Gains {
    /// `{k, γ} = f(v_i(0), v_j(0), r_j(0) - r_i(0))`, in whole thousandths; or as configured, if the configuration says so.
    #[must_use]
    pub fn look_up(law: &Law, own: Speed, target: Speed, headway: Distance) -> Self {
        if !law.table {
            return Self { gain: law.gain, damping: law.damping };
        }
        let speed = |speed: Speed| place(speed.to_mm_per_s(), 0, SPEED_STEP_MM_PER_S, SPEEDS);
        let headway = place(headway.to_mm(), HEADWAY_FIRST_MM, HEADWAY_STEP_MM, HEADWAYS);
        let table = if law.feed_forward == Fraction::ZERO { &PLAIN } else { &FED };
        table.at(speed(own), speed(target), headway)
    }
}

impl Table {
    /// At a place of the table in parts of a cell.
    // Thousandths of a few units, parts up to 2²⁴, and a few points.
    #[allow(clippy::arithmetic_side_effects, clippy::cast_possible_truncation, clippy::cast_possible_wrap)]
    fn at(&self, own: i64, target: i64, headway: i64) -> Gains {
        let along = |own, target| between(headway, |cell| self.gain(own, target, cell));
        let across = |own| between(target, |cell| along(own, cell));
        let weighed = between(own, across) * GAIN_STEP_MILLI;
        let milli = (weighed + (PARTS * PARTS * PARTS) / 2) / (PARTS * PARTS * PARTS);
        let on_curve = (milli - i64::from(self.first_milli)).max(0) * PARTS;
        let place = quotient(on_curve, i64::from(self.step_milli)).min((POINTS as i64 - 1) * PARTS);
        let damping = between(place, |cell| self.curve.get(cell).map_or(0, |milli| i64::from(*milli)));
        let damping_milli = (damping + PARTS / 2) / PARTS;
        Gains { gain: Gain::from_milli(milli as i32), damping: Seconds::from_millis(damping_milli as i32) }
    }

    /// `k` of a cell in steps of the table.
    fn gain(&self, own: usize, target: usize, headway: usize) -> i64 {
        let gain = self.gains.get(own).and_then(|row| row.get(target)).and_then(|row| row.get(headway));
        gain.map_or(0, |gain| i64::from(*gain))
    }
}

/// Where a value is on an axis of so many points, in parts of a cell.
#[allow(clippy::arithmetic_side_effects, clippy::cast_possible_wrap)] // a few thousand metres in millimetres times 256; a few points
fn place(value: i32, first: i32, step: i32, points: usize) -> i64 {
    let parts = quotient((i64::from(value) - i64::from(first)) * PARTS, i64::from(step));
    parts.clamp(0, (points as i64 - 1) * PARTS)
}

/// The mean of the two points around a place, each weighed by its parts: so many times the value.
#[allow(clippy::arithmetic_side_effects, clippy::cast_sign_loss, clippy::cast_possible_truncation)]
// places are within the axis, and weights come to 256
fn between(place: i64, at: impl Fn(usize) -> i64) -> i64 {
    let (cell, part) = ((place / PARTS) as usize, place % PARTS);
    let next = if part > 0 { at(cell + 1) * part } else { 0 };
    at(cell) * (PARTS - part) + next
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::Config;
    use crate::wire::StationHash;

    /// The laws with a table of their own, and that table.
    fn laws() -> [(Law, &'static Table); 2] {
        let law = Config::car(StationHash(1)).law;
        [(law, &PLAIN), (Law { feed_forward: crate::parameters::FEED_FORWARD, ..law }, &FED)]
    }

    fn look_up(law: &Law, own: i32, target: i32, headway: i32) -> (i32, i32) {
        let (own, target) = (Speed::from_mm_per_s(own), Speed::from_mm_per_s(target));
        let gains = Gains::look_up(law, own, target, Distance::from_mm(headway));
        (gains.gain.to_milli(), gains.damping.to_millis())
    }

    #[test]
    fn at_its_points_the_table_is_what_it_says() {
        for (law, table) in laws() {
            for (own, rows) in (0..).zip(&table.gains) {
                for (target, row) in (0..).zip(rows) {
                    for (headway, gain) in (0..).zip(row) {
                        let at = HEADWAY_FIRST_MM + headway * HEADWAY_STEP_MM;
                        let (milli, _) = look_up(&law, own * SPEED_STEP_MM_PER_S, target * SPEED_STEP_MM_PER_S, at);
                        assert_eq!(milli, i32::from(*gain) * 5, "{own} {target} {headway}");
                    }
                }
            }
        }
    }

    #[test]
    fn between_points_it_is_between_them_and_beyond_the_last_it_is_the_last() {
        for (law, _) in &laws() {
            let (low, high) = (look_up(law, 8_000, 8_000, 8_000).0, look_up(law, 8_000, 8_000, 24_000).0);
            let middle = look_up(law, 8_000, 8_000, 16_000).0;
            assert!((2 * middle - low - high).abs() <= 1, "{low} {middle} {high}");
            assert_eq!(look_up(law, 65_000, 8_000, 24_000), look_up(law, 28_000, 8_000, 24_000));
            assert_eq!(look_up(law, 8_000, 8_000, 1_000_000), look_up(law, 8_000, 8_000, 120_000));
            assert_eq!(look_up(law, 8_000, 8_000, -5_000), look_up(law, 8_000, 8_000, 8_000));
        }
    }

    #[test]
    fn the_gains_are_on_the_curve_and_as_the_wire_says_them() {
        for (law, table) in &laws() {
            let exact = |milli: i32| (f64::from(milli) - f64::from(table.first_milli)) / f64::from(table.step_milli);
            let steepest =
                table.curve.windows(2).map(|pair| f64::from(pair[0]) - f64::from(pair[1])).fold(0.0, f64::max);
            for own in (0..=70_000).step_by(1_370) {
                for target in (0..=40_000).step_by(2_310) {
                    for headway in (0..=140_000).step_by(4_570) {
                        let (gain, damping) = look_up(law, own, target, headway);
                        let at = exact(gain);
                        assert!((0.0..=(POINTS - 1) as f64).contains(&at), "{gain}");
                        let cell = (at as usize).min(POINTS - 2);
                        let share = at - cell as f64;
                        let on_curve =
                            f64::from(table.curve[cell]) * (1.0 - share) + f64::from(table.curve[cell + 1]) * share;
                        // Rounding, and a part of the steepest cell of the curve.
                        let off = (f64::from(damping) - on_curve).abs();
                        assert!(off <= 0.5 + steepest / 256.0, "{gain} {damping} {on_curve}");
                        assert_eq!(Gain::from_milli(gain).to_milli(), gain);
                    }
                }
            }
        }
    }

    #[test]
    fn constant_gains_are_what_the_configuration_says() {
        for (law, _) in laws() {
            let law = Law { table: false, gain: Gain::from_milli(321), damping: Seconds::from_millis(2_345), ..law };
            let gains = Gains::look_up(&law, Speed::from_mm_per_s(7_000), Speed::ZERO, Distance::from_mm(30_000));
            assert_eq!((gains.gain, gains.damping), (law.gain, law.damping));
        }
    }
}
