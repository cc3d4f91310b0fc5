//! The reference against strings of eight vehicles that `tests/vectors/generate.py` stepped independently.

use holdover_sim::measure::reference::horizon::chain;
use holdover_sim::measure::reference::{Parameters, PositionRule, State};
use serde::Deserialize;
use std::collections::BTreeMap;

#[derive(Deserialize)]
struct Row {
    string: usize,
    place: usize,
    step_s: f64,
    steps: usize,
    position_m: f64,
    speed_mps: f64,
    acceleration_mps2: f64,
    demand_mps2: f64,
    length_m: f64,
    standstill_m: f64,
    target_speed_mps: f64,
    time_gap_s: f64,
    gain: f64,
    damping_s: f64,
    lag_s: f64,
    limit_acceleration_mps2: f64,
    limit_braking_mps2: f64,
    limit_jerk_mps3: f64,
    end_position_m: f64,
    end_speed_mps: f64,
    end_acceleration_mps2: f64,
    end_demand_mps2: f64,
}

impl Row {
    fn vehicle(&self) -> (State, Parameters) {
        let state = State {
            position_m: self.position_m,
            speed_mps: self.speed_mps,
            acceleration_mps2: self.acceleration_mps2,
            demand_mps2: self.demand_mps2,
        };
        let law = Parameters {
            length_m: self.length_m,
            standstill_m: self.standstill_m,
            target_speed_mps: self.target_speed_mps,
            catch_up_mps: f64::INFINITY,
            time_gap_s: self.time_gap_s,
            gain: self.gain,
            damping_s: self.damping_s,
            feed_forward: 0.0,
            lag_s: self.lag_s,
            acceleration_mps2: self.limit_acceleration_mps2,
            braking_mps2: self.limit_braking_mps2,
            jerk_mps3: self.limit_jerk_mps3,
        };
        (state, law)
    }
}

#[test]
fn strings_of_eight_with_random_laws_are_their_independent_transcription() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/vectors/strings.csv");
    let mut strings: BTreeMap<usize, Vec<Row>> = BTreeMap::new();
    for row in csv::Reader::from_path(path).unwrap().into_deserialize::<Row>() {
        let row = row.unwrap();
        strings.entry(row.string).or_default().push(row);
    }
    assert_eq!(strings.len(), 6);
    for (number, rows) in strings {
        let vehicles: BTreeMap<_, _> = rows.iter().map(|row| (row.place, row.vehicle())).collect();
        let vehicles: Vec<_> = vehicles.into_values().collect();
        assert_eq!(vehicles.len(), 8);
        let steps = rows.iter().map(|row| row.steps).max().unwrap();
        let horizons = chain(&vehicles, rows[0].step_s, steps, PositionRule::Trapezoid);
        for row in &rows {
            let end = horizons[row.place][row.steps];
            for (actual, expected) in [
                (end.position_m, row.end_position_m),
                (end.speed_mps, row.end_speed_mps),
                (end.acceleration_mps2, row.end_acceleration_mps2),
                (end.demand_mps2, row.end_demand_mps2),
            ] {
                let place = row.place;
                assert!((actual - expected).abs() < 1e-9, "string {number} place {place}: {actual} {expected}");
            }
        }
    }
}
