//! Path data: points in pixels enter; SVG path data that look the same with far fewer points leave.
//!
//! A line keeps the first, lowest, highest and last point of each column of a quarter of a pixel, so that no spike is lost however long
//! the series is. Then points within a twentieth of a pixel of the straight line between their neighbours are dropped. So there is more
//! to see when a page is zoomed.

use super::svg::{fine, pixel};

/// A point in pixels.
pub(super) type Point = (f64, f64);

const TOLERANCE: f64 = 0.05;
/// Columns in a pixel.
const COLUMNS: f64 = 4.0;

/// An open line through each run of points; `None` separates runs. A run of one point becomes a dot.
pub(super) fn line(points: impl IntoIterator<Item = Option<Point>>) -> String {
    let mut data = String::new();
    for run in runs(points) {
        append(&mut data, &run);
        if run.len() == 1 {
            data.push_str("h0");
        }
    }
    data
}

/// Closed areas between the lower and the upper edge of each run of `(x, lower, upper)`.
pub(super) fn band(points: impl IntoIterator<Item = Option<(f64, f64, f64)>>) -> String {
    let mut data = String::new();
    let mut lower = Vec::new();
    let mut upper = Vec::new();
    for point in points.into_iter().chain([None]) {
        if let Some((x, low, high)) = point {
            lower.push((x, low));
            upper.push((x, high));
        } else if !lower.is_empty() {
            let mut outline = straighten(&columns(&lower));
            let back = straighten(&columns(&upper));
            outline.extend(back.into_iter().rev());
            append(&mut data, &outline);
            data.push('Z');
            lower.clear();
            upper.clear();
        }
    }
    data
}

/// A dot at each point, on a coarse grid, so that many points still make a short path.
pub(super) fn dots(points: impl IntoIterator<Item = Point>) -> String {
    let points: Vec<Point> = points.into_iter().collect();
    let grid = if points.len() > 8000 { 2.0 } else { 0.5 };
    let snap = |value: f64| (value / grid).round() as i64;
    let mut cells: Vec<(i64, i64)> = points.iter().map(|&(x, y)| (snap(x), snap(y))).collect();
    cells.sort_unstable();
    cells.dedup();
    cells.iter().map(|&(x, y)| format!("M{},{}h0", pixel(x as f64 * grid), pixel(y as f64 * grid))).collect()
}

fn runs(points: impl IntoIterator<Item = Option<Point>>) -> Vec<Vec<Point>> {
    let mut runs = vec![Vec::new()];
    for point in points {
        match (point, runs.last_mut()) {
            (Some(point), Some(run)) => run.push(point),
            _ => runs.push(Vec::new()),
        }
    }
    runs.retain(|run| !run.is_empty());
    runs.iter().map(|run| straighten(&columns(run))).collect()
}

fn append(data: &mut String, points: &[Point]) {
    for (index, &(x, y)) in points.iter().enumerate() {
        data.push(match index {
            0 => 'M',
            1 => 'L',
            _ => ' ',
        });
        data.push_str(&fine(x));
        data.push(',');
        data.push_str(&fine(y));
    }
}

/// The first, lowest, highest and last point of each stay in a column, in their order.
fn columns(points: &[Point]) -> Vec<Point> {
    let mut kept = Vec::new();
    for column in points.chunk_by(|a, b| (a.0 * COLUMNS).floor() == (b.0 * COLUMNS).floor()) {
        let indices = 0..column.len();
        let lowest = indices.clone().min_by(|&a, &b| column[a].1.total_cmp(&column[b].1)).unwrap_or(0);
        let highest = indices.max_by(|&a, &b| column[a].1.total_cmp(&column[b].1)).unwrap_or(0);
        let mut keep = [0, lowest, highest, column.len() - 1];
        keep.sort_unstable();
        let mut previous = None;
        for index in keep {
            if previous != Some(index) {
                kept.push(column[index]);
            }
            previous = Some(index);
        }
    }
    kept
}

/// Ramer, Douglas and Peucker's reduction.
fn straighten(points: &[Point]) -> Vec<Point> {
    let mut keep = vec![false; points.len()];
    let mut open = vec![(0, points.len().saturating_sub(1))];
    while let Some((first, last)) = open.pop() {
        let Some(inner) = points.get(first + 1..last) else { continue };
        let farthest = inner
            .iter()
            .map(|&point| distance(point, points[first], points[last]))
            .enumerate()
            .max_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((index, _)) = farthest.filter(|farthest| farthest.1 > TOLERANCE) {
            let middle = first + 1 + index;
            keep[middle] = true;
            open.extend([(first, middle), (middle, last)]);
        }
    }
    if let (Some(first), true) = (keep.first_mut(), !points.is_empty()) {
        *first = true;
    }
    if let Some(last) = keep.last_mut() {
        *last = true;
    }
    points.iter().zip(keep).filter(|(_, keep)| *keep).map(|(point, _)| *point).collect()
}

/// Distance of `point` from the segment between `a` and `b`.
fn distance(point: Point, a: Point, b: Point) -> f64 {
    let (along_x, along_y) = (b.0 - a.0, b.1 - a.1);
    let (x, y) = (point.0 - a.0, point.1 - a.1);
    let square = along_x * along_x + along_y * along_y;
    let share = if square > 0.0 { ((x * along_x + y * along_y) / square).clamp(0.0, 1.0) } else { 0.0 };
    (x - share * along_x).hypot(y - share * along_y)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_straight_line_needs_two_points() {
        let points = (0..1000).map(|k| Some((f64::from(k) * 0.5, f64::from(k) * 0.2)));
        assert_eq!(line(points), "M0,0L499.5,199.8");
    }

    #[test]
    fn no_spike_is_lost() {
        let spike = |k: u32| if k == 61_234 { 5.0 } else { 100.0 };
        let data = line((0..100_000).map(|k| Some((f64::from(k) * 0.007, spike(k)))));
        assert!(data.contains(",5 "), "{data}");
        assert!(data.len() < 100);
    }

    #[test]
    fn noise_stays_bounded() {
        let noise = |k: u64| (k.wrapping_mul(6_364_136_223_846_793_005) >> 40) as f64 / 1e5;
        let data = line((0..200_000).map(|k| Some((k as f64 * 0.003_4, noise(k)))));
        assert!(data.len() < 160_000, "{}", data.len());
    }

    #[test]
    fn a_missing_point_parts_the_line() {
        assert_eq!(line([Some((0.0, 0.0)), Some((9.0, 9.0)), None, Some((20.0, 1.0)), None, None]), "M0,0L9,9M20,1h0");
        assert_eq!(line([None, None]), "");
        assert_eq!(line([]), "");
    }

    #[test]
    fn a_band_is_closed() {
        let edges = [Some((0.0, 5.0, 1.0)), Some((9.0, 6.0, 0.0)), None];
        assert_eq!(band(edges), "M0,5L9,6 9,0 0,1Z");
        assert_eq!(band([None]), "");
    }

    #[test]
    fn equal_dots_are_drawn_once() {
        assert_eq!(dots([(1.0, 2.0), (1.1, 2.1), (3.0, 4.0)]), "M1,2h0M3,4h0");
    }
}
