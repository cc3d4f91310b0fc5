//! Time as an argument: instants of the unit's own clock, durations, GNSS time, and the rule that unwraps V2X stamps.
//!
//! The sums are not inlined where words have 32 bits: they saturate in 64 bits, stand in hundreds of places, and would be a tenth
//! of an ECU's image. Where words have 64 bits, each is an instruction or two.
//!
//! Nothing here reads a clock. [`Instant`] and [`GnssTime`] are microseconds in 64 bits and never wrap in practice;
//! a [`Stamp`] is GNSS time modulo 2¹⁷ · 0.1 ms = 13.1072 s, and is unwrapped to the only instant inside
//! `(reference - 12.0072 s, reference + 1.1 s]` ([`Stamp::unwrap_near`]). A modem must therefore drop what is older than
//! 12 s; the unit refuses what is older than its own limit, which is less.

use crate::fixed::{FineSecondsFormat, SecondsFormat, divide, per_million, quotient, saturate_i32};
use crate::units::{FineSeconds, Seconds};

/// A span of time in microseconds, signed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Duration(i64);

impl Duration {
    /// No time.
    pub const ZERO: Self = Self(0);
    /// The longest span.
    pub const MAX: Self = Self(i64::MAX);

    /// From microseconds.
    #[must_use]
    pub const fn from_micros(micros: i64) -> Self {
        Self(micros)
    }

    /// From milliseconds, saturating.
    #[must_use]
    pub const fn from_millis(millis: i64) -> Self {
        Self(millis.saturating_mul(1000))
    }

    /// Of a factor for accelerations, such as a lag, rounded to nearest.
    #[must_use]
    pub const fn of_fine_seconds(time: FineSeconds) -> Self {
        Self(time.to_multiple_of(1_000_000))
    }

    /// In microseconds.
    #[must_use]
    pub const fn as_micros(self) -> i64 {
        self.0
    }

    /// In whole milliseconds, towards zero.
    #[must_use]
    #[cfg_attr(not(target_pointer_width = "64"), inline(never))]
    pub const fn as_millis(self) -> i64 {
        quotient(self.0, 1000)
    }

    /// Sum, saturating.
    #[must_use]
    #[cfg_attr(not(target_pointer_width = "64"), inline(never))]
    pub const fn plus(self, other: Self) -> Self {
        Self(self.0.saturating_add(other.0))
    }

    /// Difference, saturating.
    #[must_use]
    #[cfg_attr(not(target_pointer_width = "64"), inline(never))]
    pub const fn minus(self, other: Self) -> Self {
        Self(self.0.saturating_sub(other.0))
    }

    /// A multiple, saturating.
    #[must_use]
    #[cfg_attr(not(target_pointer_width = "64"), inline(never))]
    pub const fn times(self, factor: i64) -> Self {
        Self(self.0.saturating_mul(factor))
    }

    /// Half of it, rounded down to a microsecond.
    #[must_use]
    pub const fn halved(self) -> Self {
        Self(self.0 >> 1)
    }

    /// As a factor for speeds, saturating at ±4 s.
    #[must_use]
    #[cfg_attr(not(target_pointer_width = "64"), inline(never))]
    pub const fn seconds(self) -> Seconds {
        Seconds::from_bits(word(self.0, SecondsFormat::FRAC_NBITS))
    }

    /// As a factor for accelerations, saturating at ±2 s.
    #[must_use]
    #[cfg_attr(not(target_pointer_width = "64"), inline(never))]
    pub const fn fine_seconds(self) -> FineSeconds {
        FineSeconds::from_bits(word(self.0, FineSecondsFormat::FRAC_NBITS))
    }
}

/// Microseconds as a word of seconds with so many fraction bits (at most 30), to nearest, ties away from zero, saturating.
const fn word(micros: i64, fraction: u32) -> i32 {
    // An hour is beyond the end of every word, and its own word within 2⁶² millionths.
    let magnitude = micros.unsigned_abs();
    let magnitude = if magnitude > u32::MAX as u64 { u32::MAX as u64 } else { magnitude };
    let word = per_million(magnitude.wrapping_shl(fraction).wrapping_add(500_000)).cast_signed();
    saturate_i32(if micros < 0 { word.wrapping_neg() } else { word })
}

/// An instant of the unit's own monotonic clock, in microseconds since it started. One before the start is negative: what
/// reaches a unit in its first seconds was sent before it ran.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Instant(i64);

impl Instant {
    /// The start of the clock.
    pub const ZERO: Self = Self(0);

    /// From microseconds since the clock's start, saturating at 2⁶³ - 1, which is after 292,000 years.
    #[must_use]
    #[allow(clippy::cast_possible_wrap)] // checked
    pub const fn from_micros(micros: u64) -> Self {
        Self(if micros > i64::MAX as u64 { i64::MAX } else { micros as i64 })
    }

    /// Microseconds since the clock's start; 0 for what was before it. [`since`](Self::since) tells how long before.
    #[must_use]
    #[allow(clippy::cast_sign_loss)] // checked
    pub const fn as_micros(self) -> u64 {
        if self.0 < 0 { 0 } else { self.0 as u64 }
    }

    /// That much later (earlier if negative), saturating.
    #[must_use]
    #[cfg_attr(not(target_pointer_width = "64"), inline(never))]
    pub const fn plus(self, duration: Duration) -> Self {
        Self(self.0.saturating_add(duration.0))
    }

    /// That much earlier, saturating.
    #[must_use]
    #[cfg_attr(not(target_pointer_width = "64"), inline(never))]
    pub const fn minus(self, duration: Duration) -> Self {
        Self(self.0.saturating_sub(duration.0))
    }

    /// How much later this instant is than the other (negative if it is earlier), saturating.
    #[must_use]
    #[cfg_attr(not(target_pointer_width = "64"), inline(never))]
    pub const fn since(self, earlier: Self) -> Duration {
        Duration(self.0.saturating_sub(earlier.0))
    }
}

/// GNSS time in microseconds since its epoch: the common clock of all stations.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct GnssTime(u64);

impl GnssTime {
    /// From microseconds since the epoch.
    #[must_use]
    pub const fn from_micros(micros: u64) -> Self {
        Self(micros)
    }

    /// Microseconds since the epoch.
    #[must_use]
    pub const fn as_micros(self) -> u64 {
        self.0
    }

    /// That much later (earlier if negative), saturating.
    #[must_use]
    pub const fn plus(self, duration: Duration) -> Self {
        Self(self.0.saturating_add_signed(duration.0))
    }

    /// The stamp that a message of this time carries: rounded to nearest 0.1 ms, modulo the stamp's range.
    #[must_use]
    #[allow(clippy::cast_possible_truncation)] // the modulo is below 2¹⁷
    pub const fn stamp(self) -> Stamp {
        Stamp((divide(self.0.saturating_add(50), Stamp::MICROS) % Stamp::MODULUS) as u32)
    }
}

/// GNSS time modulo 13.1072 s in steps of 0.1 ms, as it stands in a message.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Stamp(u32);

impl Stamp {
    /// Bits on the wire.
    pub const BITS: u32 = 17;
    const MODULUS: u64 = 1 << Self::BITS;
    const MICROS: u64 = 100;
    /// The span after which a stamp repeats.
    pub const PERIOD: Duration = Duration(13_107_200);
    /// How far after the reference an unwrapped stamp may lie.
    pub const FUTURE: Duration = Duration(1_100_000);

    /// From the raw field, taken modulo 2¹⁷.
    #[must_use]
    pub const fn from_raw(raw: u32) -> Self {
        Self(raw & ((1 << Self::BITS) - 1))
    }

    /// The raw field.
    #[must_use]
    pub const fn raw(self) -> u32 {
        self.0
    }

    /// Whether this stamp is later than the other, of which it is less than half of [`PERIOD`](Self::PERIOD) away.
    #[must_use]
    pub const fn is_after(self, other: Self) -> bool {
        let ahead = Self::from_raw(self.0.wrapping_sub(other.0)).0;
        ahead > 0 && ahead < 1 << (Self::BITS - 1)
    }

    /// The only GNSS time with this stamp inside `(reference + 1.1 s - 13.1072 s, reference + 1.1 s]`; the time itself,
    /// not before the epoch.
    #[must_use]
    #[allow(clippy::arithmetic_side_effects)] // constants, and a remainder that is below the modulus
    pub const fn unwrap_near(self, reference: GnssTime) -> GnssTime {
        let latest = reference.0.saturating_add(Self::FUTURE.0.unsigned_abs());
        let ticks = divide(latest, Self::MICROS);
        let back = (ticks % Self::MODULUS + Self::MODULUS - self.0 as u64) % Self::MODULUS;
        GnssTime(ticks.saturating_sub(back) * Self::MICROS)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stamp_unwraps_to_its_time_everywhere_in_the_window() {
        let reference = GnssTime::from_micros(1_800_000_000_000_000);
        for offset in (-12_000_000..=1_099_900i64).step_by(9_700) {
            let time = GnssTime::from_micros(reference.as_micros().saturating_add_signed(offset));
            let back = time.stamp().unwrap_near(reference).as_micros();
            assert!(back.abs_diff(time.as_micros()) <= 50, "{offset}");
        }
    }

    #[test]
    fn of_two_stamps_the_later_is_told_across_their_turn() {
        let after = |a, b| Stamp::from_raw(a).is_after(Stamp::from_raw(b));
        assert!(after(1, 0) && after(5, (1 << 17) - 5) && !after((1 << 17) - 5, 5) && !after(7, 7));
    }

    #[test]
    fn one_period_older_is_taken_for_new_which_is_why_the_modem_drops_it() {
        let reference = GnssTime::from_micros(100_000_000);
        let old = GnssTime::from_micros(100_000_000 - 13_107_200);
        assert_eq!(old.stamp().unwrap_near(reference), reference);
    }

    #[test]
    fn differences_of_instants_saturate_and_keep_their_sign() {
        let (a, b) = (Instant::from_micros(5), Instant::from_micros(u64::MAX));
        assert_eq!(b.since(a), Duration::from_micros(i64::MAX - 5));
        assert_eq!(a.since(b), Duration::from_micros(5 - i64::MAX));
        let before = a.minus(Duration::MAX).minus(Duration::MAX);
        assert_eq!((b.since(before), before.since(b)), (Duration::MAX, Duration::from_micros(i64::MIN)));
        assert_eq!(b.plus(Duration::MAX), b);
    }

    #[test]
    fn an_instant_before_the_start_is_as_far_away_as_it_is() {
        let (start, span) = (Instant::ZERO, Duration::from_micros(10));
        let before = start.minus(span);
        assert!(before < start);
        assert_eq!((start.since(before), before.since(start)), (span, Duration::from_micros(-10)));
        assert_eq!((before.plus(span), before.as_micros()), (start, 0));
        assert_eq!(start.plus(Duration::from_micros(-10)), before);
    }
}
