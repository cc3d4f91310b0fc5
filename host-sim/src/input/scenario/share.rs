//! What the command line says of range sensors: `on`, `off` or a share enters; which vehicles have one leaves.

use std::fmt;
use std::str::FromStr;

/// The share of the vehicles that have a range sensor, of those that follow another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorShare(f64);

impl SensorShare {
    /// Every vehicle.
    pub const ALL: Self = Self(1.0);
    /// None.
    pub const NONE: Self = Self(0.0);

    /// The share, from 0 to 1.
    #[must_use]
    pub fn share(self) -> f64 {
        self.0
    }

    /// Whether every vehicle has one.
    #[must_use]
    pub fn is_all(self) -> bool {
        self == Self::ALL
    }

    /// Whether the follower with this number has one; the first is 1. They are spread evenly along the string, and the first has one
    /// unless none has.
    #[must_use]
    pub fn has(self, follower: usize) -> bool {
        // A share is a decimal, and a product of it a hair off the whole number that is meant.
        let upto = |follower: usize| (follower as f64 * self.0 - 1e-9).ceil().max(0.0);
        follower > 0 && upto(follower) > upto(follower - 1)
    }
}

impl FromStr for SensorShare {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let share = match text {
            "on" => Some(1.0),
            "off" => Some(0.0),
            _ => text.parse().ok().filter(|share| (0.0..=1.0).contains(share)),
        };
        share
            .map(|share: f64| Self(share + 0.0)) // no -0
            .ok_or_else(|| "give on, off or a share from 0 to 1".into())
    }
}

impl fmt::Display for SensorShare {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            0.0 => f.write_str("off"),
            1.0 => f.write_str("on"),
            share => write!(f, "{share}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn so_many_of_ten_have_one_evenly() {
        for (text, fitted) in [
            ("off", vec![]),
            ("0", vec![]),
            ("0.05", vec![1]),
            ("0.3", vec![1, 4, 7]),
            ("0.5", vec![1, 3, 5, 7, 9]),
            ("0.7", vec![1, 2, 3, 5, 6, 8, 9]),
            ("on", (1..=10).collect()),
            ("1", (1..=10).collect()),
        ] {
            let share: SensorShare = text.parse().unwrap();
            assert_eq!((0..=10).filter(|follower| share.has(*follower)).collect::<Vec<_>>(), fitted, "{text}");
        }
    }

    #[test]
    fn it_is_spelled_as_it_is_read_and_anything_else_is_refused() {
        for (typed, spelled) in [("on", "on"), ("1.0", "on"), ("0", "off"), ("-0", "off"), ("0.25", "0.25")] {
            assert_eq!(typed.parse::<SensorShare>().unwrap().to_string(), spelled);
        }
        for wrong in ["", "On", "1.01", "-0.1", "NaN", "half", "50%"] {
            assert!(wrong.parse::<SensorShare>().is_err(), "{wrong}");
        }
    }
}
