//! With the vehicle ahead: what it is worth behind a law, and that it does no harm behind a driver.

use super::bench::{Bench, number};

/// A vehicle ahead that slows down and speeds up, and one that follows it with `acceleration(gap, own speed, speed
/// ahead)`, both at 20 Hz for 60 s.
fn pair(bench: &Bench, acceleration: impl Fn(f64, f64, f64) -> f64) {
    let (mut ahead, mut own) = ((30.0, 12.0), (30.0 - 4.8 - 2.0 - 12.0, 12.0));
    let (mut first, mut second) = (Vec::new(), Vec::new());
    for n in 0..=6000 {
        let t = f64::from(n) * 0.01;
        if n % 5 == 0 {
            first.push((f64::from(n / 5) / 20.0, ahead.0, ahead.1));
            second.push((f64::from(n / 5) / 20.0, own.0, own.1));
        }
        let a: f64 = acceleration(ahead.0 - 4.8 - own.0, own.1, ahead.1).clamp(-4.0, 2.5);
        let faster = (own.1 + a * 0.01).max(0.0);
        own = (own.0 + 0.005 * (own.1 + faster), faster);
        let faster: f64 = ahead.1 + 1.2 * (0.5 * t).sin() * 0.01;
        ahead = (ahead.0 + 0.005 * (ahead.1 + faster), faster);
    }
    bench.drive("ahead.csv", first).drive("own.csv", second);
}

fn errors(bench: &Bench) -> [f64; 2] {
    ["", "--predecessor ahead.csv"].map(|ahead| {
        let results = bench.results(&format!("--motion own.csv {ahead} --outage 2"));
        number(&results["ours"], "rms_position_m")
    })
}

#[test]
fn a_vehicle_that_follows_its_law_is_better_known_with_the_one_ahead() {
    let bench = Bench::new();
    pair(&bench, |gap, own, ahead| 0.5 * (gap - 2.0 - own + 2.0 * (ahead - own)));
    let [alone, with] = errors(&bench);
    assert!(with < 0.7 * alone, "{with} with, {alone} without");
}

#[test]
fn a_driver_who_keeps_another_distance_is_not_taken_for_a_law() {
    let bench = Bench::new();
    // Keeps half as much again, and reacts softly.
    pair(&bench, |gap, own, ahead| 0.15 * (gap - 6.0 - 2.0 * own) + 0.4 * (ahead - own));
    let [alone, with] = errors(&bench);
    assert!(with < 1.1 * alone, "{with} with, {alone} without");
}

#[test]
fn the_one_ahead_adds_no_messages_to_the_count() {
    let bench = Bench::new();
    pair(&bench, |_, _, _| 0.0);
    bench.link("c.csv", (0..=100).map(|n| (f64::from(n) / 10.0, (n % 3 > 0).then_some(0.05))));
    let [alone, with] = ["", "--predecessor ahead.csv"]
        .map(|ahead| bench.results(&format!("--motion own.csv {ahead} --channel c.csv")));
    for key in ["ticks", "messages_sent", "messages_delivered"] {
        assert_eq!(alone[key], with[key], "{key}");
    }
    assert_eq!(alone["baselines"]["kalman"], with["baselines"]["kalman"]);
}
