//! What is said of a recording that tells of what cannot be, and of what nothing is said.

use holdover_sim::error::Error;
use holdover_sim::input::recording::{ChannelTrace, Motion};
use std::path::Path;

fn said(findings: &[Error]) -> Vec<String> {
    findings.iter().map(Error::to_string).collect()
}

/// The findings of `(time, position, speed)` rows; the header is line 1.
fn drive(rows: impl IntoIterator<Item = (f64, f64, f64)>) -> Vec<String> {
    let rows: String = rows.into_iter().map(|(t, r, v)| format!("{t},{r},{v}\n")).collect();
    said(Motion::parse(Path::new("m.csv"), format!("t_s,position_m,speed_mps\n{rows}").as_bytes()).unwrap().findings())
}

/// The findings of `(time, delay)` rows.
fn link(rows: impl IntoIterator<Item = (f64, Option<f64>)>) -> Vec<String> {
    let row = |(t, delay): (f64, Option<f64>)| format!("{t},{}\n", delay.map_or(String::new(), |d| d.to_string()));
    let rows: String = rows.into_iter().map(row).collect();
    said(ChannelTrace::parse(Path::new("c.csv"), format!("t_s,delay_s\n{rows}").as_bytes()).unwrap().findings())
}

/// A minute at 10 m/s and 10 Hz: the time of a sample, and its position.
fn minute() -> impl Iterator<Item = (f64, f64)> {
    (0..=600).map(|n| (f64::from(n) / 10.0, f64::from(n)))
}

/// The only finding, which has to begin like that.
fn only(findings: &[String], begins: &str) {
    assert!(findings.len() == 1 && findings[0].starts_with(begins), "{begins}: {findings:#?}");
}

#[test]
fn of_honest_recordings_nothing_is_said() {
    assert_eq!(drive(minute().map(|(t, r)| (t, r, 10.0))), [""; 0]);
    // Noise of a receiver for positions, and of a speed sensor.
    let noise = |t: f64| (t * 97.0).sin();
    assert_eq!(drive(minute().map(|(t, r)| (t, r + 0.3 * noise(t), 10.0 + 0.2 * noise(t + 0.5)))), [""; 0]);
    // Full braking from 30 m/s, at 50 Hz.
    let braking = |n: i32| {
        let t = f64::from(n) / 50.0;
        (t, 30.0 * t - 4.5 * t * t, 30.0 - 9.0 * t)
    };
    assert_eq!(drive((0..150).map(braking)), [""; 0]);
    // A drive at 1 Hz with a sample missing, and one that stands.
    assert_eq!(drive((0..60).filter(|n| *n != 30).map(|n| (f64::from(n), 10.0 * f64::from(n), 10.0))), [""; 0]);
    assert_eq!(drive(minute().map(|(t, _)| (t, 5.0, 0.0))), [""; 0]);
    assert_eq!(link(minute().map(|(t, _)| (t, (!(20.0..=24.0).contains(&t)).then_some(0.03)))), [""; 0]);
}

#[test]
fn a_hole_is_named_with_the_line_after_it() {
    let holed = minute().filter(|(t, _)| !(12.05..42.0).contains(t)).map(|(t, r)| (t, r, 10.0));
    only(&drive(holed), "m.csv:123: no sample for 30 s from 12 s on, and what is between is drawn straight; split");
    let silent = minute().filter(|(t, _)| !(12.05..42.0).contains(t)).map(|(t, _)| (t, Some(0.02)));
    only(&link(silent), "c.csv:123: no message is sent for 30 s from 12 s on; give every message");
}

#[test]
fn speeds_that_positions_contradict_are_named() {
    only(
        &drive(minute().map(|(t, r)| (t, 1.5 * r, 3.0))),
        "m.csv:2: the positions move at 15 m/s in the mean where the speeds say 3 m/s; check the units of",
    );
    let for_a_while = |(t, r): (f64, f64)| (t, r, if (20.0..25.0).contains(&t) { 6.5 } else { 10.0 });
    let smooth = |(t, r): (f64, f64)| {
        let (_, _, v) = for_a_while((t, r));
        (t, r, v)
    };
    let findings = drive(minute().map(smooth));
    assert!(
        findings.iter().any(|line| line.contains(" s on the positions move at 10 m/s where the speed is 6.5 m/s")),
        "{findings:#?}"
    );
}

#[test]
fn a_jump_is_named_with_its_line() {
    let jumps = minute().map(|(t, r)| (t, if t > 30.0 { r + 40.0 } else { r }, 10.0));
    only(&drive(jumps), "m.csv:303: the position jumps by 40 m from one sample to the next; correct");
}

#[test]
fn a_slope_that_no_vehicle_has_is_named_with_the_worst_place() {
    let brakes = minute().map(|(t, r)| (t, r, if t == 30.0 { 3.1 } else { 10.0 }));
    let line = "m.csv:303: the speed changes at 69 m/s² (the worst of 2 such places), and no road vehicle brakes";
    let back = "m.csv:302: the speed changes at -69 m/s² (the worst of 2 such places), and no road vehicle brakes";
    let findings = drive(brakes);
    assert!(findings.len() == 1 && (findings[0].starts_with(line) || findings[0].starts_with(back)), "{findings:#?}");
    // Too hard for a second, at 50 Hz, where no single step is beyond noise.
    let hard = |n: i32| {
        let t = f64::from(n) / 50.0;
        (t, 30.0 * t - 9.0 * t * t, 30.0 - 18.0 * t)
    };
    assert!(drive((0..75).map(hard))[0].contains("the speed changes at -18 m/s²"));
}

#[test]
fn units_that_are_not_those_of_the_columns_are_named() {
    only(&drive(minute().map(|(t, r)| (1000.0 * t, r, 10.0))), "m.csv:2: the positions move at 0.01 m/s in the mean");
    assert!(
        drive(minute().map(|(t, r)| (1000.0 * t, r, 10.0)))[0]
            .contains("as if the times were milliseconds; give `t_s`")
    );
    assert!(
        drive(minute().map(|(t, r)| (t, r, 36.0)))[0].contains("as if the speeds were km/h; divide the speeds by 3.6")
    );
    assert!(drive(minute().map(|(t, r)| (t, 1000.0 * r, 10.0)))[0].contains("as if the positions were millimetres"));
    assert!(drive(minute().map(|(t, r)| (t, -r, 10.0)))[0].contains("so they fall while it drives"));
    only(
        &link(minute().map(|(t, _)| (1000.0 * t, Some(0.02)))),
        "c.csv:2: messages are 100 s apart in the median, as if the times were milliseconds",
    );
    only(
        &link(minute().map(|(t, _)| (t, Some(19.0)))),
        "c.csv:2: a message takes 19 s in the median, as if delays were milliseconds; give `delay_s` in seconds",
    );
}

#[test]
fn a_recorded_acceleration_beyond_a_vehicle_is_named() {
    let text = "t_s,position_m,speed_mps,acceleration_mps2\n0,0,10,0\n0.1,1,10,-30\n0.2,2,10,0\n";
    let motion = Motion::parse(Path::new("m.csv"), text.as_bytes()).unwrap();
    only(&said(motion.findings()), "m.csv:3: `acceleration_mps2` is -30, which no road vehicle is capable of");
}

#[test]
fn a_link_without_a_delivery_is_named() {
    only(&link(minute().map(|(t, _)| (t, None))), "c.csv:2: no message arrives; give a recording with a message");
}
