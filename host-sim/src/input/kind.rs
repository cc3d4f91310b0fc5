//! Kinds of vehicles: a name enters; the figures of such a vehicle leave, those of its unit's configuration and those
//! of its body; and the ways in which a vehicle can differ from them.
//!
//! The figures are round ones of vehicles on European roads. Drag is `½ ρ c_w A` with ρ = 1.2 kg/m³: 0.30 · 2.2 m² for a
//! car, 0.34 · 4.7 m² for a high van, 0.60 · 8.5 m² for a city bus. Rolling resistance is `c_rr m g`, with 0.010 for car
//! tyres, 0.011 for a van's and 0.008 for a bus's. Brake force per torque is one over the radius of the wheels.
//! Standing passengers decide what a bus may do: 1.2 m/s² and 2.5 m/s³, and 3 m/s² of braking in normal driving.

use holdover::Config;
use holdover::model::Body;
use holdover::parameters::FEED_FORWARD;
use holdover::units::{Acceleration, Jerk};
use holdover::wire::StationHash;
use holdover::wire::driving_parameters::Limits;

/// A kind of vehicle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum Kind {
    /// A car of 1.5 t with 100 kW.
    #[default]
    Car,
    /// A delivery van of 2.8 t with 110 kW.
    Van,
    /// A city bus of 12.5 t, half full, with 210 kW.
    Bus,
}

impl Kind {
    /// All kinds.
    pub const ALL: [Self; 3] = [Self::Car, Self::Van, Self::Bus];

    /// The name in scenario files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Car => "car",
            Self::Van => "van",
            Self::Bus => "bus",
        }
    }

    /// The kind with this name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.name() == name)
    }

    /// The parameters of eqs 1 to 3.
    #[must_use]
    pub const fn body(self) -> Body {
        match self {
            Self::Car => Body::CAR,
            Self::Van => Body::VAN,
            Self::Bus => Body::BUS,
        }
    }

    /// The published limits.
    #[must_use]
    pub const fn limits(self) -> Limits {
        let (acceleration, braking, jerk, emergency) = match self {
            Self::Car => return Config::car(StationHash(0)).limits,
            Self::Van => (2_000, 3_500, 4_000, 7_500),
            Self::Bus => (1_200, 3_000, 2_500, 6_000),
        };
        Limits {
            acceleration: Acceleration::from_mm_per_s2(acceleration),
            braking: Acceleration::from_mm_per_s2(braking),
            jerk: Jerk::from_mm_per_s3(jerk),
            emergency_braking: Acceleration::from_mm_per_s2(emergency),
        }
    }

    /// Length, bumper to bumper.
    #[must_use]
    pub const fn length_m(self) -> f64 {
        match self {
            Self::Car => 4.8,
            Self::Van => 6.0,
            Self::Bus => 12.0,
        }
    }

    /// Time constant of its actuators: a bus has air brakes and a large engine.
    #[must_use]
    pub const fn lag_s(self) -> f64 {
        match self {
            Self::Car => 0.3,
            Self::Van => 0.4,
            Self::Bus => 0.5,
        }
    }

    /// The share of the acceleration ahead that its unit feeds forward in a string, with a range sensor or without. A bus feeds nothing
    /// forward: its jerk is limited to half of a car's, so when the vehicle ahead stops braking, it is late to let go of what it has added.
    #[must_use]
    pub fn feed_forward(self, has_sensor: bool) -> f64 {
        if has_sensor && self != Self::Bus { FEED_FORWARD.get().to_num() } else { 0.0 }
    }

    /// Largest force of its engine, from standstill on: 4, 3 and 1.6 m/s².
    #[must_use]
    pub const fn engine_force_n(self) -> f64 {
        match self {
            Self::Car => 6_000.0,
            Self::Van => 8_400.0,
            Self::Bus => 20_000.0,
        }
    }

    /// Largest power of its engine.
    #[must_use]
    pub const fn engine_power_w(self) -> f64 {
        match self {
            Self::Car => 100_000.0,
            Self::Van => 110_000.0,
            Self::Bus => 210_000.0,
        }
    }

    /// Largest torque of its brakes: a tenth more than emergency braking needs.
    #[must_use]
    pub const fn brake_limit_nm(self) -> f64 {
        match self {
            Self::Car => 4_100.0,
            Self::Van => 8_000.0,
            Self::Bus => 39_000.0,
        }
    }
}

/// Differences of the real vehicle and its road from what its unit assumes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// Factor on the mass; 0.5 to 2.
    pub mass_scale: f64,
    /// Grade of the road, rise per distance; -0.15 to 0.15.
    pub grade: f64,
    /// Head wind; -30 to 30 m/s.
    pub headwind_mps: f64,
    /// Available fraction of the engine's force; 0.05 to 1.
    pub throttle: f64,
}

impl Difference {
    /// No difference: the vehicle is as its unit assumes, on a level road without wind.
    pub const NONE: Self = Self { mass_scale: 1.0, grade: 0.0, headwind_mps: 0.0, throttle: 1.0 };
}
