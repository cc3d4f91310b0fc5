//! The physical quantities of the core: one newtype each, with unit, range and rounding; integers in milli-units go
//! in and out exactly.
//!
//! Arithmetic saturates at the ends of the format; nothing wraps except [`RingPosition`], which says so.

use crate::fixed::{
    AccelerationFormat, DistanceFormat, FineSecondsFormat, FractionFormat, GainFormat, PositionFormat, Rest,
    SecondsFormat, SpeedFormat, mul_hi, mul_shl, quotient, ratio, saturate_i32, sum_around, unratio,
};

macro_rules! quantity {
    ($(#[$doc:meta])* $name:ident, $format:ty, $milli:ident, $to_milli:ident, $unit:literal) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
        pub struct $name($format);

        #[cfg(feature = "defmt")]
        impl defmt::Format for $name {
            fn format(&self, f: defmt::Formatter) {
                defmt::write!(f, "{}e-3 {}", self.$to_milli(), $unit);
            }
        }

        impl $name {
            /// Zero.
            pub const ZERO: Self = Self(<$format>::ZERO);
            /// The largest value of the format.
            pub const MAX: Self = Self(<$format>::MAX);
            /// The smallest value of the format.
            pub const MIN: Self = Self(<$format>::MIN);

            #[doc = concat!("From thousandths of ", $unit, ", rounded to nearest, saturating.")]
            #[must_use]
            pub const fn $milli(thousandths: i32) -> Self {
                Self::from_ratio(thousandths as i64, 1000)
            }

            #[doc = concat!("In thousandths of ", $unit, ", rounded to nearest.")]
            #[must_use]
            pub const fn $to_milli(self) -> i32 {
                saturate_i32(self.to_multiple_of(1000))
            }

            #[doc = concat!("`numerator / denominator` ", $unit, ", rounded to nearest, saturating.")]
            #[must_use]
            pub const fn from_ratio(numerator: i64, denominator: i64) -> Self {
                Self(<$format>::from_bits(saturate_i32(ratio(numerator, denominator, <$format>::FRAC_NBITS))))
            }

            #[doc = concat!("How many `1/denominator` ", $unit, " it is, rounded to nearest.")]
            #[must_use]
            pub const fn to_multiple_of(self, denominator: i64) -> i64 {
                unratio(self.0.to_bits() as i64, denominator, <$format>::FRAC_NBITS)
            }

            /// From the raw word of the format.
            #[inline(always)]
            #[must_use]
            pub const fn from_bits(bits: i32) -> Self {
                Self(<$format>::from_bits(bits))
            }

            /// The raw word of the format.
            #[inline(always)]
            #[must_use]
            pub const fn to_bits(self) -> i32 {
                self.0.to_bits()
            }

            /// The number in its format.
            #[inline(always)]
            #[must_use]
            pub const fn get(self) -> $format {
                self.0
            }

            /// Sum, saturating.
            #[inline(always)]
            #[must_use]
            pub const fn plus(self, other: Self) -> Self {
                Self(self.0.saturating_add(other.0))
            }

            /// Difference, saturating.
            #[inline(always)]
            #[must_use]
            pub const fn minus(self, other: Self) -> Self {
                Self(self.0.saturating_sub(other.0))
            }

            /// The opposite, saturating.
            #[inline(always)]
            #[must_use]
            pub const fn negated(self) -> Self {
                Self(self.0.saturating_neg())
            }

            /// Magnitude, saturating.
            #[must_use]
            pub const fn magnitude(self) -> Self {
                Self(self.0.saturating_abs())
            }

            /// The nearest value inside `low..=high`; `low` if the range is empty.
            #[inline(always)]
            #[must_use]
            pub const fn limited(self, low: Self, high: Self) -> Self {
                let bits = if self.0.to_bits() > high.0.to_bits() { high } else { self };
                if bits.0.to_bits() < low.0.to_bits() { low } else { bits }
            }

            /// That fraction of it.
            #[inline(always)]
            #[must_use]
            pub const fn fraction(self, fraction: Fraction) -> Self {
                Self::from_bits(mul_shl::<2>(self.to_bits(), fraction.to_bits()))
            }
        }
    };
}

quantity!(
    /// A distance, gap or length in metres: ±2048 m by 0.95 µm.
    Distance, DistanceFormat, from_mm, to_mm, "m"
);
quantity!(
    /// A speed in m/s: ±256 m/s by 0.12 µm/s.
    Speed, SpeedFormat, from_mm_per_s, to_mm_per_s, "m/s"
);
quantity!(
    /// An acceleration in m/s²: ±64 m/s² by 0.03 µm/s².
    Acceleration, AccelerationFormat, from_mm_per_s2, to_mm_per_s2, "m/s²"
);
quantity!(
    /// A jerk in m/s³: ±64 m/s³.
    Jerk, AccelerationFormat, from_mm_per_s3, to_mm_per_s3, "m/s³"
);
quantity!(
    /// A time that multiplies speeds (time gap `t_g`, damping `γ`, a step), in seconds: ±4 s by 1.9 ns.
    Seconds, SecondsFormat, from_millis, to_millis, "s"
);
quantity!(
    /// A time that multiplies accelerations, in seconds: ±2 s by 0.93 ns.
    FineSeconds, FineSecondsFormat, from_millis, to_millis, "s"
);
quantity!(
    /// The gain `k` of the consensus law in 1/s²: ±4 /s² by 1.9e-9.
    Gain, GainFormat, from_milli, to_milli, "1/s²"
);
quantity!(
    /// A share from 0 to 1, such as `e^(-δt/T)`: by 9.3e-10.
    Fraction, FractionFormat, from_milli, to_milli, "(of 1)"
);

impl Speed {
    /// The way at this speed for that time.
    #[inline(always)]
    #[must_use]
    pub const fn over(self, time: Seconds) -> Distance {
        Distance::from_bits(mul_hi(self.to_bits(), time.to_bits()))
    }
}

impl Acceleration {
    /// A change of speed over so many microseconds, saturating; zero over none.
    #[must_use]
    #[cfg_attr(not(target_pointer_width = "64"), inline(never))]
    pub const fn of_change(change: Speed, micros: i64) -> Self {
        // 23 to 25 fraction bits is a factor of 4; per second instead of per microsecond one of 1e6.
        let change = (change.to_bits() as i64).saturating_mul(4_000_000);
        Self::from_bits(saturate_i32(quotient(change, micros)))
    }

    /// The acceleration that changes the speed by this much in a second, saturating.
    #[must_use]
    pub const fn in_a_second(change: Speed) -> Self {
        // 23 to 25 fraction bits is a factor of 4.
        Self::from_bits(saturate_i32((change.to_bits() as i64).saturating_mul(4)))
    }

    /// The gain in speed at this acceleration for that time.
    #[inline(always)]
    #[must_use]
    pub const fn over(self, time: FineSeconds) -> Speed {
        Speed::from_bits(mul_hi(self.to_bits(), time.to_bits()))
    }
}

impl Fraction {
    /// All of it.
    pub const ONE: Self = Self::from_bits(1 << FractionFormat::FRAC_NBITS);
}

impl Jerk {
    /// The change of acceleration at this jerk for that time, saturating.
    #[must_use]
    pub const fn over(self, time: FineSeconds) -> Acceleration {
        Acceleration::from_bits(mul_shl::<2>(self.to_bits(), time.to_bits()))
    }
}

/// A position along the (virtual) lane in metres, increasing in the direction of travel: ±8.8e12 m by 0.95 µm. It is
/// the position of the vehicle's front bumper.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Position(PositionFormat);

#[cfg(feature = "defmt")]
impl defmt::Format for Position {
    fn format(&self, f: defmt::Formatter) {
        defmt::write!(f, "{} mm", self.to_mm());
    }
}

impl Position {
    /// The origin of the lane.
    pub const ZERO: Self = Self(PositionFormat::ZERO);

    /// From millimetres, rounded to nearest, saturating.
    #[must_use]
    pub const fn from_mm(mm: i64) -> Self {
        Self(PositionFormat::from_bits(ratio(mm, 1000, PositionFormat::FRAC_NBITS)))
    }

    /// In millimetres, rounded to nearest.
    #[must_use]
    pub const fn to_mm(self) -> i64 {
        unratio(self.0.to_bits(), 1000, PositionFormat::FRAC_NBITS)
    }

    /// From the raw word of the format.
    #[must_use]
    pub const fn from_bits(bits: i64) -> Self {
        Self(PositionFormat::from_bits(bits))
    }

    /// The raw word of the format.
    #[must_use]
    pub const fn to_bits(self) -> i64 {
        self.0.to_bits()
    }

    /// The number in its format.
    #[must_use]
    pub const fn get(self) -> PositionFormat {
        self.0
    }

    /// The position that far ahead, saturating.
    #[must_use]
    #[cfg_attr(not(target_pointer_width = "64"), inline(never))] // as in `time`
    pub const fn ahead(self, distance: Distance) -> Self {
        Self::from_bits(self.to_bits().saturating_add(distance.to_bits() as i64))
    }

    /// How far this position is ahead of the other, saturating at ±2048 m.
    #[must_use]
    #[cfg_attr(not(target_pointer_width = "64"), inline(never))] // as in `time`
    pub const fn ahead_of(self, other: Self) -> Distance {
        Distance::from_bits(saturate_i32(self.to_bits().saturating_sub(other.to_bits())))
    }

    /// The same position modulo 4096 m.
    #[must_use]
    #[allow(clippy::cast_possible_truncation)] // truncation is the modulo
    pub const fn ring(self) -> RingPosition {
        RingPosition(self.to_bits() as i32)
    }
}

/// A position modulo 4096 m, which is what a horizon stores: differences of two of them are exact while the two are
/// within 2048 m of one another. Wrapping is its rule, not an accident.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct RingPosition(i32);

impl RingPosition {
    /// The position that far ahead.
    #[inline(always)]
    #[must_use]
    pub const fn ahead(self, distance: Distance) -> Self {
        Self(self.0.wrapping_add(distance.to_bits()))
    }

    /// How far this position is ahead of the other, exact within ±2048 m.
    #[inline(always)]
    #[must_use]
    pub const fn ahead_of(self, other: Self) -> Distance {
        Distance::from_bits(self.0.wrapping_sub(other.0))
    }

    /// The position and its rest, that far ahead; the way is a sum of products in the format of distances.
    #[inline(always)]
    #[must_use]
    pub const fn along(self, rest: Rest, products: i64) -> (Self, Rest) {
        let (word, rest) = sum_around(self.0, rest, products);
        (Self(word), rest)
    }
}
