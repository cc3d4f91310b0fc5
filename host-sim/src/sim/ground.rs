//! Paths over ground: points on the globe enter; the prepared segments that the core projects positions with leave. The
//! other way round, a distance along such a path enters, and the position on the globe leaves.
//!
//! The globe is the ellipsoid of WGS 84. Its two radii of curvature at a segment's middle latitude give the length of a
//! step of 1e-7°.

use holdover::coordination::{Path, Scale, Segment};
use holdover::units::Position;

/// Semi-major axis in metres, and the square of the eccentricity.
const WGS84: (f64, f64) = (6_378_137.0, 6.694_379_990_141_3e-3);

/// The longest segment, in metres.
const LONGEST_M: f64 = 500.0;

/// A position on the globe, in degrees north and east.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Degrees north.
    pub latitude: f64,
    /// Degrees east.
    pub longitude: f64,
}

impl Point {
    fn steps(self) -> (i32, i32) {
        let steps = |degrees: f64| (degrees * 1e7).round() as i32;
        (steps(self.latitude), steps(self.longitude))
    }

    fn between(self, other: Self, share: f64) -> Self {
        let mix = |a: f64, b: f64| a + (b - a) * share;
        Self { latitude: mix(self.latitude, other.latitude), longitude: mix(self.longitude, other.longitude) }
    }
}

/// Length of a step of 1e-7° in metres, to the north and to the east.
#[must_use]
pub fn step_m(latitude_deg: f64) -> (f64, f64) {
    let (axis, e2) = WGS84;
    let step = 1e-7_f64.to_radians();
    let (sine, cosine) = latitude_deg.to_radians().sin_cos();
    let w = (1.0 - e2 * sine * sine).sqrt();
    (axis * (1.0 - e2) / w.powi(3) * step, axis / w * cosine * step)
}

/// The segments through these points, in this order. A segment is at most 500 m long; longer pieces are divided.
#[must_use]
pub fn segments(points: &[Point]) -> Vec<Segment> {
    let mut segments = Vec::new();
    let mut begins_m = 0.0;
    for leg in points.windows(2) {
        let (from, to) = (leg[0], leg[1]);
        let pieces = (length_m(from, to) / LONGEST_M).ceil().max(1.0);
        let at = |piece: f64| from.between(to, piece / pieces);
        let mut piece = 0.0;
        while piece < pieces {
            let (segment, length_m) = segment(at(piece), at(piece + 1.0), begins_m);
            segments.push(segment);
            begins_m += length_m;
            piece += 1.0;
        }
    }
    segments
}

fn length_m(from: Point, to: Point) -> f64 {
    segment(from, to, 0.0).1
}

fn segment(from: Point, to: Point, begins_m: f64) -> (Segment, f64) {
    let ((latitude, longitude), (to_latitude, to_longitude)) = (from.steps(), to.steps());
    let (north_m, east_m) = step_m((from.latitude + to.latitude) / 2.0);
    let north = f64::from(to_latitude - latitude) * north_m;
    let east = f64::from(to_longitude - longitude) * east_m;
    let length = north.hypot(east);
    let (along_north, along_east) = (north / length, east / length);
    let scale = |metres: f64| (metres * f64::from(1 << 18) * f64::from(1 << 18)).round() as i32;
    let segment = Segment {
        latitude,
        longitude,
        begins: Position::from_bits((begins_m * f64::from(1 << 20)).round() as i64),
        length: crate::sim::quantities::distance(length),
        along: Scale { north: scale(along_north * north_m), east: scale(along_east * east_m) },
        across: Scale { north: scale(-along_east * north_m), east: scale(along_north * east_m) },
        heading: (east.atan2(north).to_degrees().rem_euclid(360.0) * 80.0).round() as u16 % 28_800,
    };
    (segment, length)
}

/// A path that lives as long as the program, because the core takes its map as `'static`.
#[must_use]
pub fn path(points: &[Point]) -> &'static Path {
    Box::leak(Box::new(Path { segments: Box::leak(segments(points).into_boxed_slice()) }))
}

/// The length of a path in metres.
#[must_use]
pub fn path_length_m(path: &Path) -> f64 {
    path.segments.last().map_or(0.0, |last| metres(last.begins) + metres(Position::ZERO.ahead(last.length)))
}

/// The position on the globe, and the heading in degrees, at a distance along a path. Beyond its ends the path goes
/// straight on.
#[must_use]
pub fn point_at(path: &Path, along_m: f64) -> Option<(Point, f64)> {
    let is_there = |segment: &&Segment| metres(segment.begins) <= along_m;
    let segment = path.segments.iter().rfind(is_there).or_else(|| path.segments.first())?;
    let way = along_m - metres(segment.begins);
    let unit = |scale: i32| f64::from(scale) / f64::from(1 << 18) / f64::from(1 << 18);
    // The two rows of scales are the lengths of a step, rotated. Their determinant undoes that.
    let (a, b) = (unit(segment.along.north), unit(segment.along.east));
    let (c, d) = (unit(segment.across.north), unit(segment.across.east));
    let determinant = a * d - b * c;
    let (north, east) = (way * d / determinant, -way * c / determinant);
    let point = Point {
        latitude: (f64::from(segment.latitude) + north) * 1e-7,
        longitude: (f64::from(segment.longitude) + east) * 1e-7,
    };
    Some((point, f64::from(segment.heading) / 80.0))
}

fn metres(position: Position) -> f64 {
    position.get().to_num::<f64>()
}
