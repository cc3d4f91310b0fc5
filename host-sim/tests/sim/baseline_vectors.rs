//! The baselines against vectors that `tests/vectors/generate.py` computed independently: by matrix exponentials, by
//! whole matrices, and by integer time.

use holdover_sim::measure::baseline::{
    Baseline, constant_acceleration::ConstantAcceleration, kalman::Kalman, paper::Paper, singer::Singer,
};
use holdover_sim::measure::heard::{Heard, HeardParameters};
use serde::Deserialize;
use serde::de::DeserializeOwned;

/// The vehicle that the vectors are about; 0, 1 and 2 are ahead of it, 7 is none of its business.
const TARGET: usize = 3;

fn rows<Row: DeserializeOwned>(name: &str) -> Vec<Row> {
    let path = format!("{}/tests/vectors/{name}", env!("CARGO_MANIFEST_DIR"));
    csv::Reader::from_path(path).unwrap().into_deserialize().collect::<Result<_, _>>().unwrap()
}

#[derive(Deserialize)]
struct Message {
    at_us: i64,
    stamp_us: i64,
    vehicle: usize,
    position_m: f64,
    speed_mps: f64,
    acceleration_mps2: f64,
    length_m: Option<f64>,
    target_speed_mps: Option<f64>,
    time_gap_s: Option<f64>,
    gain: Option<f64>,
    damping_s: Option<f64>,
    predecessor: Option<usize>,
}

impl Message {
    /// The standstill distance, the lag and the limits are not in the vectors, because no baseline may use them.
    fn heard(&self) -> Heard {
        let parameters = self.length_m.map(|length_m| HeardParameters {
            length_m,
            standstill_m: 2.0,
            leads: self.predecessor.is_none(),
            predecessor: self.predecessor,
            target_speed_mps: self.target_speed_mps.unwrap(),
            catch_up: 0.2,
            time_gap_s: self.time_gap_s.unwrap(),
            gain: self.gain.unwrap(),
            damping_s: self.damping_s.unwrap(),
            feed_forward: 0.0,
            lag_s: 0.3,
            acceleration_mps2: 1.0,
            braking_mps2: 1.0,
            jerk_mps3: 1.0,
        });
        Heard {
            at_s: seconds(self.at_us),
            stamp_s: seconds(self.stamp_us),
            vehicle: self.vehicle,
            position_m: self.position_m,
            speed_mps: self.speed_mps,
            acceleration_mps2: self.acceleration_mps2,
            demand_mps2: self.acceleration_mps2,
            parameters,
        }
    }
}

#[derive(Deserialize)]
struct Expected {
    step_us: Option<i64>,
    now_us: i64,
    position_m: Option<f64>,
    speed_mps: Option<f64>,
}

fn seconds(micros: i64) -> f64 {
    micros as f64 / 1e6
}

fn near(actual: f64, expected: f64, tolerance: f64, what: &str) {
    assert!((actual - expected).abs() <= tolerance, "{what}: {actual} is not within {tolerance} of {expected}");
}

/// Plays the messages into the baseline and compares it at each instant; returns how many estimates were compared.
fn follows<'a>(
    mut baseline: impl Baseline,
    messages: &[Message],
    expected: impl IntoIterator<Item = &'a Expected>,
    tolerance: f64,
) -> usize {
    let mut coming = messages.iter().peekable();
    let mut compared = 0;
    for row in expected {
        while let Some(message) = coming.next_if(|message| message.at_us <= row.now_us) {
            baseline.hear(&message.heard());
        }
        let what = format!("{} at {} us", baseline.name(), row.now_us);
        match (baseline.estimate(seconds(row.now_us)), row.position_m, row.speed_mps) {
            (Some(estimate), Some(position_m), Some(speed_mps)) => {
                near(estimate.position_m, position_m, tolerance, &what);
                near(estimate.speed_mps, speed_mps, tolerance, &what);
                compared += 1;
            }
            (estimate, position_m, _) => assert_eq!(estimate.map(|known| known.position_m), position_m, "{what}"),
        }
    }
    compared
}

#[test]
fn the_paper_is_its_independent_transcription_at_every_step_size() {
    let (messages, expected) = (rows::<Message>("messages.csv"), rows::<Expected>("paper.csv"));
    let mut compared = 0;
    for step_us in [10_000, 100_000, 1_000_000] {
        let rows = expected.iter().filter(|row| row.step_us == Some(step_us));
        compared += follows(Paper::new(TARGET, seconds(step_us)), &messages, rows, 1e-9);
    }
    assert!(compared > 700, "{compared}");
}

#[test]
fn kalman_is_the_filter_with_whole_matrices() {
    let (messages, expected) = (rows::<Message>("messages.csv"), rows::<Expected>("kalman.csv"));
    let compared = follows(Kalman::new(TARGET), &messages, &expected, 1e-8);
    assert!(compared > 240, "{compared}");
}

#[derive(Deserialize)]
struct Motion {
    speed_mps: f64,
    acceleration_mps2: f64,
    age_s: f64,
    constant_position_m: f64,
    constant_speed_mps: f64,
    singer_position_m: f64,
    singer_speed_mps: f64,
}

#[test]
fn constant_acceleration_and_singer_are_their_differential_equations() {
    for row in rows::<Motion>("motion.csv") {
        let heard = Heard {
            at_s: 0.0,
            stamp_s: 0.0,
            vehicle: 0,
            position_m: 0.0,
            speed_mps: row.speed_mps,
            acceleration_mps2: row.acceleration_mps2,
            demand_mps2: row.acceleration_mps2,
            parameters: None,
        };
        let estimate = |mut baseline: Box<dyn Baseline>| {
            baseline.hear(&heard);
            baseline.estimate(row.age_s).unwrap()
        };
        let what = format!("{} m/s, {} m/s², {} s", row.speed_mps, row.acceleration_mps2, row.age_s);
        let constant = estimate(Box::new(ConstantAcceleration::new(0)));
        near(constant.position_m, row.constant_position_m, 1e-9, &what);
        near(constant.speed_mps, row.constant_speed_mps, 1e-9, &what);
        let singer = estimate(Box::new(Singer::new(0)));
        near(singer.position_m, row.singer_position_m, 1e-9, &what);
        near(singer.speed_mps, row.singer_speed_mps, 1e-9, &what);
    }
}
