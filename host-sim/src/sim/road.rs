//! A road: the points of its line enter; the path in the units' maps leaves, and the position on the globe of a vehicle
//! at a distance along it.

use holdover::coordination::Path;
use holdover::time::Stamp;
use holdover::wire::geo::GeoPosition;

use super::globe::Shift;
use crate::sim::ground::{Point, path, path_length_m, point_at};

/// One lane of traffic in one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Road {
    /// The path, prepared for the core. It lives as long as the program, because the core takes its map as `'static`.
    pub path: &'static Path,
}

/// The road of a vehicle, and its start on that road.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ground {
    /// Its road.
    pub road: Road,
    /// The vehicle's odometer where the road begins.
    pub odometer_m: f64,
}

impl Road {
    /// A lane that lies `right_m` to the right of a line through `points`. There are at least two points, all
    /// different. Its corners have the radius `corner_m`. The lane begins `before_m` before the first point and ends
    /// `beyond_m` beyond the last.
    #[must_use]
    pub fn new(line: &[Point], right_m: f64, corner_m: f64, [before_m, beyond_m]: [f64; 2]) -> Self {
        let mut corners = offset(line, right_m);
        let last = corners.len() - 1;
        let [begin, end] = [(1, 0, before_m), (last - 1, last, beyond_m)].map(|(from, to, by_m)| {
            let way = Shift::between(corners[from], corners[to]);
            way.times(by_m / way.length_m()).from(corners[to])
        });
        (corners[0], corners[last]) = (begin, end);
        Self { path: path(&rounded(&corners, corner_m)) }
    }

    /// Length from end to end.
    #[must_use]
    pub fn length_m(&self) -> f64 {
        path_length_m(self.path)
    }

    /// The position at a distance along the road, and the direction of travel there, clockwise from north.
    #[must_use]
    pub fn at(&self, way_m: f64) -> (Point, f64) {
        point_at(self.path, way_m).unwrap_or((Point { latitude: 0.0, longitude: 0.0 }, 0.0))
    }

    /// The distance along the road at which it passes nearest to a point, and the distance between the two there.
    #[must_use]
    pub fn nearest(&self, point: Point) -> (f64, f64) {
        let ways = self.path.segments.iter().map(|segment| {
            let begins_m = segment.begins.get().to_num::<f64>();
            let length_m = segment.length.get().to_num::<f64>();
            let (from, to) = (self.at(begins_m).0, self.at(begins_m + length_m - 1e-6).0);
            let piece = Shift::between(from, to);
            let along_m = Shift::between(from, point).along(piece).clamp(0.0, length_m);
            let foot = piece.times(along_m / piece.length_m()).from(from);
            (begins_m + along_m, Shift::between(foot, point).length_m())
        });
        ways.min_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((0.0, f64::INFINITY))
    }

    /// The position at a distance along the road, as a positioning system reports it.
    #[must_use]
    pub fn said(&self, way_m: f64, tag: u8, stamp: Stamp) -> GeoPosition {
        let (point, heading_deg) = self.at(way_m);
        let steps = |degrees: f64| (degrees * 1e7).round() as i32;
        let heading = (heading_deg.rem_euclid(360.0) * 80.0).round() as u16 % 28_800;
        GeoPosition { tag, latitude: steps(point.latitude), longitude: steps(point.longitude), heading, stamp }
    }
}

/// The line with its corners rounded to arcs of this radius, in pieces that turn by 10° at most. An arc takes no more than half of
/// the way to the next corner.
fn rounded(line: &[Point], radius_m: f64) -> Vec<Point> {
    const PIECE: f64 = std::f64::consts::PI / 18.0;
    let mut round = vec![line[0]];
    for corner in line.windows(3) {
        let [back, on] = [corner[0], corner[2]].map(|next| Shift::between(corner[1], next));
        let across = (back.along(on) / back.length_m()).clamp(-1.0, 1.0).acos();
        let turn = std::f64::consts::PI - across;
        let most_m = 0.5 * back.length_m().min(on.length_m());
        let tangent_m = (radius_m * (0.5 * turn).tan()).min(most_m);
        if tangent_m < 0.1 {
            round.push(corner[1]);
            continue;
        }
        let [begin, end] = [back, on].map(|way| way.times(tangent_m / way.length_m()));
        let radius_m = tangent_m / (0.5 * turn).tan();
        let right = if back.right().along(on) < 0.0 { 1.0 } else { -1.0 };
        let inward = back.times(-right * radius_m / back.length_m()).right();
        let pieces = (turn / PIECE).ceil().max(1.0) as u32;
        let begin_point = begin.from(corner[1]);
        for piece in 0..pieces {
            let (sine, cosine) = (turn * f64::from(piece) / f64::from(pieces)).sin_cos();
            // From the beginning of the arc: on along the way so far, and inward.
            let way = begin.times(-radius_m * sine / tangent_m);
            let aside = inward.times(1.0 - cosine);
            let shift = Shift { north_m: way.north_m + aside.north_m, east_m: way.east_m + aside.east_m };
            round.push(shift.from(begin_point));
        }
        round.push(end.from(corner[1]));
    }
    round.push(line[line.len() - 1]);
    round
}

/// The line, moved to the right. Each corner moves along the bisector.
fn offset(line: &[Point], right_m: f64) -> Vec<Point> {
    let unit = |from: Point, to: Point| {
        let way = Shift::between(from, to);
        way.times(1.0 / way.length_m())
    };
    let corner = |index: usize| {
        let before = index.checked_sub(1).map(|before| unit(line[before], line[index]));
        let after = line.get(index + 1).map(|after| unit(line[index], *after));
        let (Some(before), Some(after)) = (before.or(after), after.or(before)) else { return line[index] };
        let sum = Shift { north_m: before.north_m + after.north_m, east_m: before.east_m + after.east_m };
        // The distance along the bisector is longer, so that the lane keeps its distance from the line. A hairpin is
        // cut short.
        let cosine_2 = (0.25 * sum.length_m() * sum.length_m()).max(0.25);
        sum.right().times(0.5 * right_m / cosine_2).from(line[index])
    };
    (0..line.len()).map(corner).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(north_m: f64, east_m: f64) -> Point {
        Shift { north_m, east_m }.from(Point { latitude: 37.785, longitude: -122.396 })
    }

    #[test]
    fn a_lane_lies_beside_its_line_and_reaches_beyond_it() {
        let road = Road::new(&[point(0.0, 0.0), point(600.0, 0.0)], 2.0, 0.0, [100.0, 50.0]);
        assert!((road.length_m() - 750.0).abs() < 0.05, "{}", road.length_m());
        let (place, heading_deg) = road.at(400.0);
        let off_m = Shift::between(point(300.0, 2.0), place).length_m();
        assert!(off_m < 0.05 && heading_deg.min(360.0 - heading_deg) < 0.1, "{off_m} {heading_deg}");
        let (way_m, aside_m) = road.nearest(point(250.0, 7.0));
        assert!((way_m - 350.0).abs() < 0.05 && (aside_m - 5.0).abs() < 0.05, "{way_m} {aside_m}");
    }

    #[test]
    fn a_lane_keeps_its_distance_around_a_corner() {
        let road = Road::new(&[point(0.0, 0.0), point(100.0, 0.0), point(100.0, 100.0)], 3.0, 0.0, [0.0, 0.0]);
        // The lane lies to the right of both pieces, so it cuts the corner.
        assert!((road.length_m() - 194.0).abs() < 0.05, "{}", road.length_m());
        let (_, aside_m) = road.nearest(point(100.0, 50.0));
        assert!((aside_m - 3.0).abs() < 0.05, "{aside_m}");
    }
}
