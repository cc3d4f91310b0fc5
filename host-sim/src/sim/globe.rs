//! Directions on the globe: points in degrees enter, metres to the north and to the east leave, and back.
//!
//! Points as near as the parts of one road lie in a plane. The length of a degree is taken at their middle.

use crate::sim::ground::{Point, step_m};

/// A displacement, in metres to the north and to the east.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shift {
    /// Metres to the north.
    pub north_m: f64,
    /// Metres to the east.
    pub east_m: f64,
}

impl Shift {
    /// The displacement from one point to another.
    #[must_use]
    pub fn between(from: Point, to: Point) -> Self {
        let (north_m, east_m) = step_m(0.5 * (from.latitude + to.latitude));
        Self {
            north_m: (to.latitude - from.latitude) * 1e7 * north_m,
            east_m: (to.longitude - from.longitude) * 1e7 * east_m,
        }
    }

    /// The point that this displacement leads to from `point`.
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

    /// The displacement, multiplied by a factor.
    #[must_use]
    pub fn times(self, factor: f64) -> Self {
        Self { north_m: self.north_m * factor, east_m: self.east_m * factor }
    }

    /// The component along another displacement, in metres.
    #[must_use]
    pub fn along(self, other: Self) -> f64 {
        (self.north_m * other.north_m + self.east_m * other.east_m) / other.length_m()
    }

    /// The displacement, turned to the right by 90°.
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
