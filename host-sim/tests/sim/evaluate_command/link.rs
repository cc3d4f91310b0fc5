//! Over a recorded link: what is sent, when it arrives, which ticks count, and the figures that come of it.

use super::bench::{BASELINES, Bench, close, column, number, of, p99, rms};
use serde_json::Value;

/// A vehicle that speeds up and brakes, sampled every 50 ms; all numbers are whole steps of the wire.
fn winding(until_s: f64) -> Vec<(f64, f64, f64)> {
    let mut position_mm = 0.0;
    let sample = |n: usize| {
        let t = n as f64 * 0.05;
        let speed = ((12.0 + 3.0 * (0.7 * t).sin()) * 500.0_f64).round() / 500.0;
        position_mm += (speed * 50.0_f64).round();
        ((n as f64 * 50.0).round() / 1000.0, position_mm / 1000.0, speed)
    };
    (0..=(until_s / 0.05).round() as usize).map(sample).collect()
}

/// Every 80 ms, delays of 10 to 330 ms in a fixed disorder, every seventh lost.
fn disorderly(until_s: f64) -> Vec<(f64, Option<f64>)> {
    let message = |n: usize| {
        let delay = (10 + (n * 37) % 320) as f64 / 1000.0;
        ((n * 80) as f64 / 1000.0, (n % 7 != 3).then_some(delay))
    };
    (0..=(until_s / 0.08) as usize).map(message).collect()
}

/// One tick, computed from the files alone, in whole microseconds.
struct Expected {
    at_s: f64,
    age_s: f64,
    truth: (f64, f64),
    sample: (f64, f64),
    acceleration: f64,
}

/// What the contract says, written down a second time: `step_us` between ticks, `end_us` the end of the run.
fn expected(drive: &[(f64, f64, f64)], link: &[(f64, Option<f64>)], step_us: i64, end_us: i64) -> Vec<Expected> {
    let us = |t: f64| (t * 1e6).round() as i64;
    let mut deliveries: Vec<(i64, usize)> = Vec::new();
    for (sent, delay) in link.iter().filter(|(sent, _)| us(*sent) <= end_us) {
        let sample = drive.iter().rposition(|row| us(row.0) <= us(*sent));
        deliveries.extend(delay.zip(sample).map(|(delay, sample)| (us(*sent) + us(delay), sample)));
    }
    let mut ticks = Vec::new();
    for now in (0..).map(|k| k * step_us).take_while(|now| *now <= end_us) {
        let Some(newest) = deliveries.iter().filter(|(at, _)| *at <= now).map(|(_, sample)| *sample).max() else {
            continue;
        };
        let after = drive.iter().position(|row| us(row.0) > now);
        let truth = match after {
            None => (drive[drive.len() - 1].1, drive[drive.len() - 1].2),
            Some(after) => {
                let (low, high) = (drive[after - 1], drive[after]);
                let share = (now - us(low.0)) as f64 / (us(high.0) - us(low.0)) as f64;
                (low.1 + share * (high.1 - low.1), low.2 + share * (high.2 - low.2))
            }
        };
        let window: Vec<_> = drive[..=newest].iter().filter(|row| us(row.0) >= us(drive[newest].0) - 500_000).collect();
        ticks.push(Expected {
            at_s: now as f64 / 1e6,
            age_s: (now - us(drive[newest].0)) as f64 / 1e6,
            truth,
            sample: (drive[newest].1, drive[newest].2),
            acceleration: slope(&window),
        });
    }
    ticks
}

/// By the normal equations, and rounded to the wire's 0.02 m/s².
fn slope(rows: &[&(f64, f64, f64)]) -> f64 {
    if rows.len() < 3 {
        return 0.0;
    }
    let n = rows.len() as f64;
    let (mut t, mut v, mut tt, mut tv) = (0.0, 0.0, 0.0, 0.0);
    for row in rows {
        let at = row.0 - rows[0].0;
        (t, v, tt, tv) = (t + at, v + row.2, tt + at * at, tv + at * row.2);
    }
    ((n * tv - t * v) / (n * tt - t * t) * 50.0).round() / 50.0
}

/// What the simple baselines believe, written down a second time: `(position, speed)`.
fn believed(method: &str, tick: &Expected) -> (f64, f64) {
    let ((r, v), a, h) = (tick.sample, tick.acceleration, tick.age_s);
    match method {
        "freeze" => (r, 0.0),
        "constant_speed" => (r + v * h, v),
        "constant_acceleration" => {
            assert!(v + a * h > 0.0, "this vehicle does not stop");
            (r + v * h + a * h * h / 2.0, v + a * h)
        }
        "singer" => {
            let left = (-h / 1.5_f64).exp();
            (r + v * h + a * 1.5 * (h - 1.5 * (1.0 - left)), v + a * 1.5 * (1.0 - left))
        }
        _ => unreachable!(),
    }
}

const CLASSES: [(f64, f64); 6] = [(0.0, 0.1), (0.1, 0.5), (0.5, 1.0), (1.0, 2.0), (2.0, 5.0), (5.0, f64::INFINITY)];

#[test]
fn the_figures_of_the_baselines_are_those_computed_from_the_files() {
    let (drive, link) = (winding(20.0), disorderly(18.0));
    let bench = Bench::new();
    bench.drive("m.csv", drive.iter().copied()).link("c.csv", link.iter().copied());
    let results = bench.results("--motion m.csv --channel c.csv");
    let ticks = expected(&drive, &link, 10_000, 18_000_000);
    assert_eq!(results["ticks"], ticks.len());
    assert_eq!(results["messages_sent"], link.len());
    assert_eq!(results["messages_delivered"], link.iter().filter(|(_, delay)| delay.is_some()).count());
    for method in ["freeze", "constant_speed", "constant_acceleration", "singer"] {
        let figures = of(&results, method);
        let errors: Vec<f64> = ticks.iter().map(|tick| believed(method, tick).0 - tick.truth.0).collect();
        let speeds: Vec<f64> = ticks.iter().map(|tick| believed(method, tick).1 - tick.truth.1).collect();
        close(number(figures, "rms_position_m"), rms(&errors), 1e-6, method);
        close(number(figures, "p99_position_m"), p99(&errors), 1e-6, method);
        let largest = errors.iter().fold(0.0, |largest: f64, error| largest.max(error.abs()));
        close(number(figures, "max_position_m"), largest, 1e-6, method);
        close(number(figures, "rms_speed_mps"), rms(&speeds), 1e-6, method);
        for (class, (from, to)) in figures["by_age"].as_array().unwrap().iter().zip(CLASSES) {
            let inside = |(tick, _): &(&Expected, &f64)| (from..to).contains(&tick.age_s);
            let errors: Vec<f64> = ticks.iter().zip(&errors).filter(inside).map(|(_, error)| *error).collect();
            assert_eq!(class["from_s"], from);
            assert_eq!(class["to_s"].as_f64(), to.is_finite().then_some(to));
            assert_eq!(class["count"], errors.len());
            if !errors.is_empty() {
                close(number(class, "rms_position_m"), rms(&errors), 1e-6, method);
            }
        }
    }
    // The fading model of the core is Singer's with 2 s in place of 1.5 s.
    let ours: Vec<f64> = ticks
        .iter()
        .map(|tick| {
            let (h, g) = (tick.age_s, tick.acceleration * 2.0);
            tick.sample.0 + tick.sample.1 * h + g * (h - 2.0 * (1.0 - (-h / 2.0).exp())) - tick.truth.0
        })
        .collect();
    close(number(&results["ours"], "rms_position_m"), rms(&ours), 1e-3, "ours");
}

/// A vehicle at constant speed that is heard once, at 0.
fn heard_once(bench: &Bench, until_s: f64, delay_s: f64) {
    bench.drive("m.csv", (0..=(until_s * 10.0) as usize).map(|n| (n as f64 / 10.0, n as f64, 10.0)));
    let sends = (0..=(until_s * 2.0) as usize).map(|n| (n as f64 / 2.0, (n == 0).then_some(delay_s)));
    bench.link("c.csv", sends);
}

fn counts(results: &Value, method: &str) -> Vec<u64> {
    column(of(results, method), "by_age", "count").iter().map(|count| count.as_u64().unwrap()).collect()
}

#[test]
fn the_bounds_of_the_age_classes_are_exact() {
    let bench = Bench::new();
    heard_once(&bench, 6.0, 0.0);
    let results = bench.results("--motion m.csv --channel c.csv");
    for method in ["ours"].iter().chain(&BASELINES) {
        assert_eq!(counts(&results, method), [10, 40, 50, 100, 300, 101], "{method}");
    }
    for (step, expected) in
        [("0.1", [1, 4, 5, 10, 30, 11]), ("0.05", [2, 8, 10, 20, 60, 21]), ("1", [1, 0, 0, 1, 3, 2])]
    {
        let results = bench.results(&format!("--motion m.csv --channel c.csv --step {step}"));
        assert_eq!(counts(&results, "ours"), expected, "{step}");
        assert_eq!(results["ticks"], expected.iter().sum::<u64>());
    }
}

#[test]
fn ticks_before_the_first_delivery_do_not_count_and_the_tick_of_the_delivery_does() {
    let bench = Bench::new();
    // 0.11 + 0.02 is above 0.13 in binary; it is the same time all the same.
    bench.drive("m.csv", (0..=20).map(|n| (n as f64 / 10.0, n as f64, 10.0)));
    bench.link("c.csv", [(0.0, None), (0.11, Some(0.02)), (1.0, None)]);
    let results = bench.results("--motion m.csv --channel c.csv");
    assert_eq!(results["ticks"], 100 - 13 + 1);
    assert_eq!((&results["messages_sent"], &results["messages_delivered"]), (&3.into(), &1.into()));
    // The message carries the sample of 0.1 s.
    assert_eq!(counts(&results, "ours"), [7, 40, 41, 0, 0, 0]);
}

#[test]
fn the_run_ends_with_the_last_sample_or_the_last_send() {
    let bench = Bench::new();
    let drive = |until: usize| (0..=until * 10).map(|n| (n as f64 / 10.0, n as f64, 10.0));
    let link = |until: usize| (0..=until * 10).map(|n| (n as f64 / 10.0, Some(0.0)));
    bench.drive("m2.csv", drive(2)).drive("m3.csv", drive(3)).link("c2.csv", link(2)).link("c3.csv", link(3));
    for (motion, channel, end) in [(2, 3, 2), (3, 2, 2), (3, 3, 3)] {
        let results = bench.results(&format!("--motion m{motion}.csv --channel c{channel}.csv"));
        assert_eq!(results["ticks"], end * 100 + 1, "{motion} {channel}");
        assert_eq!(results["messages_sent"], end * 10 + 1, "{motion} {channel}");
    }
}

#[test]
fn a_sample_that_is_sent_twice_counts_as_two_messages_and_changes_nothing() {
    let bench = Bench::new();
    bench.drive("m.csv", (0..=20).map(|n| (n as f64 / 5.0, 2.0 * n as f64, 10.0)));
    bench.link("once.csv", (0..=20).map(|n| (n as f64 / 5.0, Some(0.0))));
    bench.link("twice.csv", (0..=40).map(|n| (n as f64 / 10.0, Some(0.0))));
    let (once, twice) =
        (bench.results("--motion m.csv --channel once.csv"), bench.results("--motion m.csv --channel twice.csv"));
    assert_eq!((&once["messages_sent"], &twice["messages_sent"]), (&21.into(), &41.into()));
    assert_eq!(twice["messages_delivered"], 41);
    assert_eq!(once["ours"], twice["ours"]);
    assert_eq!(once["baselines"], twice["baselines"]);
}

#[test]
fn messages_that_come_out_of_order_leave_the_newest_sample_in_force() {
    let bench = Bench::new();
    bench.drive("m.csv", (0..=30).map(|n| (n as f64 / 10.0, n as f64, 10.0)));
    // Sent at 0.5 and arrived at 1.5, after what was sent at 1.0.
    bench.link("c.csv", [(0.0, Some(0.0)), (0.5, Some(1.0)), (1.0, Some(0.0)), (3.0, None)]);
    let results = bench.results("--motion m.csv --channel c.csv");
    assert_eq!(counts(&results, "ours"), [20, 80, 100, 100, 1, 0]);
    assert!(number(&results["ours"], "max_position_m") < 1e-3);
}

#[test]
fn where_nothing_is_delivered_every_figure_is_null() {
    let bench = Bench::new();
    bench.drive("m.csv", (0..=10).map(|n| (n as f64 / 10.0, n as f64, 10.0)));
    bench.link("c.csv", (0..=10).map(|n| (n as f64 / 10.0, None)));
    let results = bench.results_of(1, "--motion m.csv --channel c.csv");
    assert_eq!((&results["ticks"], &results["messages_delivered"]), (&0.into(), &0.into()));
    for method in ["ours"].iter().chain(&BASELINES) {
        let figures = of(&results, method);
        for key in ["rms_position_m", "p99_position_m", "max_position_m", "rms_speed_mps"] {
            assert!(figures[key].is_null(), "{method} {key}");
        }
        assert!(figures["by_age"].as_array().unwrap().iter().all(|class| class["count"] == 0
            && class["rms_position_m"].is_null()
            && class["max_position_m"].is_null()));
    }
    let text = bench.run("--motion m.csv --channel c.csv --no-report");
    assert_eq!(text.status.code(), Some(1));
}

#[test]
fn a_message_older_than_ten_seconds_is_not_delivered() {
    let bench = Bench::new();
    bench.drive("m.csv", (0..=300).map(|n| (n as f64 / 10.0, n as f64, 10.0)));
    for (delay, delivered) in [(9.9, 1), (10.0, 1), (10.001, 0), (13.2, 0)] {
        bench.link("c.csv", [(0.0, Some(delay)), (30.0, None)]);
        let results = bench.results_of(1 - delivered, "--motion m.csv --channel c.csv");
        assert_eq!(results["messages_delivered"], delivered, "{delay}");
        let from_tick = (delay * 100.0).round() as u64;
        assert_eq!(results["ticks"], if delivered == 1 { 3001 - from_tick } else { 0 }, "{delay}");
    }
}

#[test]
fn neither_the_place_nor_the_hour_matters() {
    let bench = Bench::new();
    let (drive, link) = (winding(10.0), disorderly(9.0));
    bench.drive("m.csv", drive.iter().copied()).link("c.csv", link.iter().copied());
    // Beyond the wire's range of 33.5 km, below 0, and at a time of day.
    for (place, hour) in [(1e6, 0.0), (-5e5, 0.0), (16_770.0, 0.0), (0.0, 40_000.0)] {
        bench.drive("m2.csv", drive.iter().map(|(t, r, v)| (t + hour, r + place, *v)));
        bench.link("c2.csv", link.iter().map(|(t, delay)| (t + hour, *delay)));
        let (here, there) =
            (bench.results("--motion m.csv --channel c.csv"), bench.results("--motion m2.csv --channel c2.csv"));
        assert_eq!(here["ticks"], there["ticks"]);
        for method in ["ours"].iter().chain(&BASELINES) {
            for key in ["rms_position_m", "p99_position_m", "max_position_m", "rms_speed_mps"] {
                let (here, there) = (number(of(&here, method), key), number(of(&there, method), key));
                close(there, here, 2e-4, &format!("{method} {key} at {place} m, {hour} s"));
            }
        }
    }
}

#[test]
fn several_drives_are_pooled() {
    let bench = Bench::new();
    bench.drive("a.csv", winding(10.0)).drive("b.csv", winding(30.0)).link("c.csv", disorderly(20.0));
    let [a, b] = ["a", "b"].map(|name| bench.results(&format!("--motion {name}.csv --channel c.csv")));
    let both = bench.results("--motion a.csv b.csv --channel c.csv");
    let timeless = |mut results: Value| {
        results["timing"] = Value::Null;
        results
    };
    assert_eq!(timeless(both.clone()), timeless(bench.results("--motion a.csv --motion b.csv --channel c.csv")));
    for key in ["ticks", "messages_sent", "messages_delivered"] {
        assert_eq!(number(&both, key), number(&a, key) + number(&b, key), "{key}");
    }
    let squares = |results: &Value| number(&results["ours"], "rms_position_m").powi(2) * number(results, "ticks");
    let pooled = ((squares(&a) + squares(&b)) / number(&both, "ticks")).sqrt();
    close(number(&both["ours"], "rms_position_m"), pooled, 1e-12, "rms");
}

#[test]
fn the_trace_holds_every_tick_that_counts() {
    let bench = Bench::new();
    let (drive, link) = (winding(10.0), disorderly(9.0));
    bench.drive("m.csv", drive.iter().copied()).link("c.csv", link.iter().copied());
    let results = bench.results("--motion m.csv --channel c.csv --trace t.csv");
    let trace = std::fs::read_to_string(bench.file("t.csv")).unwrap();
    let mut lines = trace.lines();
    let header: Vec<&str> = lines.next().unwrap().split(',').collect();
    let column = |name: &str| header.iter().position(|column| *column == name).unwrap();
    let rows: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
    assert_eq!(results["ticks"], rows.len());
    let field = |row: &[&str], name: &str| row[column(name)].parse::<f64>().unwrap();
    for (row, tick) in rows.iter().zip(expected(&drive, &link, 10_000, 8_960_000)) {
        close(field(row, "t_s"), tick.at_s, 1e-6, "t_s");
        close(field(row, "age_s"), tick.age_s, 1e-6, "age_s");
        close(field(row, "true_position_m"), tick.truth.0, 1e-6, "true_position_m");
        close(field(row, "true_speed_mps"), tick.truth.1, 1e-6, "true_speed_mps");
    }
    for (method, name) in
        [("ours", "estimated_position_m"), ("kalman", "kalman_position_m"), ("paper", "paper_position_m")]
    {
        let errors: Vec<f64> = rows.iter().map(|row| field(row, name) - field(row, "true_position_m")).collect();
        close(number(of(&results, method), "rms_position_m"), rms(&errors), 1e-5, method);
    }
}

#[test]
fn a_recorded_acceleration_is_what_is_sent() {
    let bench = Bench::new();
    // At constant speed, but with an acceleration column that says otherwise.
    let rows: String = (0..=20).map(|n| format!("{},{n},10,1\n", n as f64 / 10.0)).collect();
    bench.write("m.csv", format!("t_s,position_m,speed_mps,acceleration_mps2\n{rows}"));
    bench.link("c.csv", [(0.0, Some(0.0)), (2.0, None)]);
    let results = bench.results("--motion m.csv --channel c.csv");
    close(number(of(&results, "constant_acceleration"), "max_position_m"), 2.0, 1e-9, "a t²/2");
    close(number(&results["ours"], "max_position_m"), 2.0 * (2.0 - 2.0 * (1.0 - (-1.0_f64).exp())), 1e-3, "faded");
}
