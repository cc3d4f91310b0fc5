//! Directions on the globe: points in degrees enter, metres to the north and to the east leave, and back. What is as near as
//! the pieces of a road is taken as flat, with the worth of a degree at the middle.

use crate::sim::ground::{Point, step_m};

/// Metres to the north and to the east.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shift {
    /// To the north.
    pub north_m: f64,
    /// To the east.
    pub east_m: f64,
}

impl Shift {
    /// The way from one point to another.
    #[must_use]
    pub fn between(from: Point, to: Point) -> Self {
        let (north_m, east_m) = step_m(0.5 * (from.latitude + to.latitude));
        Self {
            north_m: (to.latitude - from.latitude) * 1e7 * north_m,
            east_m: (to.longitude - from.longitude) * 1e7 * east_m,
        }
    }

    /// The point that far from one.
    #[must_use]
    pub fn from(self, point: Point) -> Point {
        let latitude = point.latitude + self.north_m / step_m(point.latitude).0 * 1e-7;
        let (_, east_m) = step_m(0.5 * (point.latitude + latitude));
        Point { latitude, longitude: point.longitude + self.east_m / east_m * 1e-7 }
    }

    /// Its length.
    #[must_use]
    pub fn length_m(self) -> f64 {
        self.north_m.hypot(self.east_m)
    }

    /// So many times as far.
    #[must_use]
    pub fn times(self, factor: f64) -> Self {
        Self { north_m: self.north_m * factor, east_m: self.east_m * factor }
    }

    /// How far it goes in the direction of another one.
    #[must_use]
    pub fn along(self, other: Self) -> f64 {
        (self.north_m * other.north_m + self.east_m * other.east_m) / other.length_m()
    }

    /// Turned to the right by a quarter.
    #[must_use]
    pub fn right(self) -> Self {
        Self { north_m: -self.east_m, east_m: self.north_m }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shift_there_is_the_way_back() {
        let here = Point { latitude: 37.785, longitude: -122.396 };
        let there = Shift { north_m: 150.0, east_m: -200.0 }.from(here);
        let back = Shift::between(there, here);
        assert!((back.north_m + 150.0).abs() < 1e-2 && (back.east_m - 200.0).abs() < 1e-2, "{back:?}");
        assert!((back.length_m() - 250.0).abs() < 1e-2, "{back:?}");
    }
}
