//! The core's projection of positions on the globe, against geodesics on the ellipsoid by another implementation (float64).

use geographiclib_rs::{DirectGeodesic, Geodesic, InverseGeodesic};
use holdover::coordination::Path;
use holdover::time::Stamp;
use holdover::wire::geo::GeoPosition;
use holdover_sim::sim::ground::{Point, path, point_at};

/// What a receiver would send: 1e-7°.
fn geo(latitude: f64, longitude: f64, heading_deg: f64) -> GeoPosition {
    GeoPosition {
        tag: 0,
        latitude: (latitude * 1e7).round() as i32,
        longitude: (longitude * 1e7).round() as i32,
        heading: (heading_deg.rem_euclid(360.0) * 80.0).round() as u16 % 28_800,
        stamp: Stamp::from_raw(0),
    }
}

fn placed(path: &Path, geo: &GeoPosition) -> (f64, f64) {
    let place = path.place(geo).unwrap_or_else(|| panic!("{geo:?} is on the path"));
    (place.along.get().to_num(), place.across.get().to_num())
}

/// Points along a geodesic, with their true way from its start and their azimuth.
fn line(latitude: f64, longitude: f64, azimuth: f64, length_m: f64, every_m: f64) -> Vec<(f64, f64, f64, f64)> {
    let globe = Geodesic::wgs84();
    let mut points = Vec::new();
    let mut way = 0.0;
    while way <= length_m {
        let (lat, lon, heading): (f64, f64, f64) = globe.direct(latitude, longitude, azimuth, way);
        points.push((way, lat, lon, heading));
        way += every_m;
    }
    points
}

#[test]
fn over_5_km_the_way_along_a_geodesic_is_within_5_cm_in_every_direction() {
    let mut worst: f64 = 0.0;
    for latitude in [-50.0, 0.0, 37.784, 60.0] {
        for azimuth in (0..360).step_by(15) {
            let points = line(latitude, -122.4, f64::from(azimuth), 5_000.0, 7.3);
            let last = points.last().unwrap();
            let ends = [(points[0].1, points[0].2), (last.1, last.2)];
            let path = path(&ends.map(|(latitude, longitude)| Point { latitude, longitude }));
            for (way, lat, lon, heading) in &points {
                let (along, _) = placed(path, &geo(*lat, *lon, *heading));
                worst = worst.max((along - way).abs());
            }
        }
    }
    assert!(worst < 0.05, "{worst}");
}

#[test]
fn around_the_bends_of_a_street_the_way_is_the_sum_of_its_geodesics() {
    // A street of five legs with bends of up to 40°, 5 km in all; vertices as a map has them.
    let globe = Geodesic::wgs84();
    let mut vertices = vec![Point { latitude: 37.787_012_3, longitude: -122.396_987_6 }];
    for (azimuth, length) in [(45.0, 830.0), (80.0, 1_210.0), (50.0, 460.0), (10.0, 1_500.0), (350.0, 1_000.0)] {
        let last = vertices[vertices.len() - 1];
        let (latitude, longitude): (f64, f64) = globe.direct(last.latitude, last.longitude, azimuth, length);
        vertices.push(Point { latitude, longitude });
    }
    let path = path(&vertices);
    let (mut sum, mut worst) = (0.0, 0.0_f64);
    for leg in vertices.windows(2) {
        let (length, azimuth, ..): (f64, f64, f64, f64) =
            globe.inverse(leg[0].latitude, leg[0].longitude, leg[1].latitude, leg[1].longitude);
        for (way, lat, lon, heading) in line(leg[0].latitude, leg[0].longitude, azimuth, length, 3.1) {
            let (along, across) = placed(path, &geo(lat, lon, heading));
            worst = worst.max((along - sum - way).abs()).max(across.abs());
        }
        sum += length;
    }
    assert!((sum - 5_000.0).abs() < 1e-3 && worst < 0.05, "{sum} {worst}");
}

#[test]
fn a_point_along_a_path_projects_to_where_it_is() {
    let path = path(&[
        Point { latitude: 37.787, longitude: -122.397 },
        Point { latitude: 37.784, longitude: -122.393 },
        Point { latitude: 37.781, longitude: -122.393 },
    ]);
    for decimetre in (-50..8_200).step_by(13) {
        let way = f64::from(decimetre) * 0.1;
        let (point, heading) = point_at(path, way).unwrap();
        let (along, across) = placed(path, &geo(point.latitude, point.longitude, heading));
        assert!((along - way).abs() < 0.01 && across.abs() < 0.01, "{way} {along} {across}");
    }
}
