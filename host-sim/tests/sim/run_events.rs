//! `[[event]]` in a scenario: what is driven and changed during a run.

use std::path::Path;

use holdover::wire::command::ModeCode;
use holdover_sim::input::scenario::{Change, Event, Overrides, Part, Radio, Scenario};
use holdover_sim::measure::simulate::simulate;
use holdover_sim::sim::world::Trace;

const CALM: &str = "duration_s = 20\n[channel]\napplies_to = \"all\"\nloss = 0\noutages = []\n";

fn scenario(text: &str) -> Scenario {
    Scenario::parse(Path::new("live.toml"), text, &Overrides::default()).unwrap()
}

fn trace(text: &str) -> Trace {
    simulate(&scenario(text), 1, None, |_| {}).unwrap().0
}

fn refusal(events: &str) -> String {
    Scenario::parse(Path::new("live.toml"), events, &Overrides::default()).unwrap_err().to_string()
}

/// The largest of some figure of the ticks of a vehicle in a span of time.
fn largest(
    trace: &Trace,
    vehicle: usize,
    span_s: (f64, f64),
    of: impl Fn(&holdover_sim::sim::world::Tick) -> f64,
) -> f64 {
    let ticks =
        trace.times_s.iter().zip(&trace.vehicles[vehicle]).filter(|(at_s, _)| (span_s.0..span_s.1).contains(*at_s));
    ticks.map(|(_, tick)| of(tick)).fold(f64::NEG_INFINITY, f64::max)
}

fn age(tick: &holdover_sim::sim::world::Tick) -> f64 {
    tick.target.map_or(f64::INFINITY, |target| target.age_s)
}

fn width(tick: &holdover_sim::sim::world::Tick) -> f64 {
    tick.target.and_then(|target| target.bound).map_or(f64::INFINITY, |bound| bound.width_m())
}

#[test]
fn an_event_is_written_as_it_is_read() {
    let radio = Radio { delay_mean_s: 0.1 + 0.2, delay_std_s: 1.0 / 3.0, loss: 0.07 };
    let changes = [
        (Some(2), Change::Drive(-1.0 / 3.0)),
        (Some(2), Change::Release),
        (None, Change::Links(radio)),
        (Some(1), Change::Outage(4.0)),
        (None, Change::Switch(Part::Holdover, false)),
        (Some(3), Change::Switch(Part::Envelope, false)),
        (None, Change::Switch(Part::RangeSensor, true)),
    ];
    let event = |(place, (vehicle, change)): (usize, &(Option<usize>, Change))| Event {
        at_s: place as f64 * 0.1 + 0.7,
        vehicle: *vehicle,
        change: *change,
    };
    let events: Vec<Event> = changes.iter().enumerate().map(event).collect();
    let text: String = events.iter().map(Event::toml).collect();
    assert_eq!(scenario(&text).events, events);
}

#[test]
fn what_cannot_happen_is_refused_in_its_line() {
    for (events, wanted) in [
        ("[[event]]\nat_s = 1\n", "live.toml:1: an event has 0 changes; "),
        ("[[event]]\nat_s = 1\nrelease = true\noutage_s = 3\n", "live.toml:1: an event has 2 changes; "),
        (
            "[[event]]\nat_s = 1\nvehicle = 5\noutage_s = 3\n",
            "live.toml:3: an event is of vehicle 5, and there is none; ",
        ),
        ("[[event]]\nat_s = 1\ndrive_mps2 = 1\n", "live.toml:1: what a person drives is of no vehicle; "),
        ("[[event]]\nat_s = 1\nloss = 1.5\n", "live.toml:3: `loss` is 1.5; "),
        ("[[event]]\nat_s = 1\nspeed = 1\n", "live.toml:3: unknown key \"speed\" in [[event]]; "),
        (
            "[[event]]\nat_s = 2\noutage_s = 1\n[[event]]\nat_s = 1\noutage_s = 1\n",
            "live.toml:4: an event at 1 s stands after a later one; ",
        ),
        (
            "[[event]]\nat_s = 2\nvehicle = 0\nrange_sensor = true\n",
            "live.toml:1: a range sensor is switched on where none is fitted; ",
        ),
    ] {
        let said = refusal(events);
        assert!(said.starts_with(wanted), "{said}");
    }
}

#[test]
fn an_outage_makes_age_and_bound_grow_and_come_back() {
    let events = "[[event]]\nat_s = 0\nrange_sensor = false\n[[event]]\nat_s = 8\nvehicle = 1\noutage_s = 4\n";
    let text = format!("{CALM}[envelope]\nengaged = false\n{events}");
    let trace = trace(&text);
    for follower in [1, 2] {
        let [before, during, after] = [(2.0, 8.0), (11.0, 12.0), (13.0, 20.0)];
        assert!(largest(&trace, follower, before, age) < 0.4, "{follower}");
        assert!(largest(&trace, follower, during, age) > 3.5, "{follower}");
        assert!(largest(&trace, follower, after, age) < 0.4, "{follower}");
        let widths = [before, during, after].map(|span| largest(&trace, follower, span, width));
        assert!(widths[1] > 3.0 * widths[0] && widths[2] < 1.5 * widths[0], "{widths:?}");
    }
    // Vehicle 3 follows vehicle 2, and neither of their links is that of vehicle 1.
    assert!(largest(&trace, 3, (2.0, 20.0), age) < 0.4);
}

#[test]
fn links_that_are_changed_are_late_and_lossy_from_then_on() {
    let text = format!("{CALM}[[event]]\nat_s = 8\nvehicle = 1\ndelay_mean_s = 0.5\ndelay_std_s = 0\nloss = 0.2\n");
    let trace = trace(&text);
    assert!(largest(&trace, 1, (2.0, 8.0), age) < 0.4);
    let later = largest(&trace, 1, (10.0, 20.0), age);
    assert!((0.6..1.5).contains(&later), "{later}");
    assert!(largest(&trace, 3, (10.0, 20.0), age) < 0.4);
}

#[test]
fn a_person_drives_nobody_knows_it_beforehand_and_the_unit_takes_over_again() {
    let drive =
        "[[event]]\nat_s = 8\nvehicle = 0\ndrive_mps2 = -3\n[[event]]\nat_s = 10\nvehicle = 0\nrelease = true\n";
    let trace = trace(&format!("{CALM}{drive}"));
    let speed = |vehicle: usize, at_s: f64| largest(&trace, vehicle, (at_s, at_s + 0.011), |tick| tick.speed_mps);
    let modes = |span| largest(&trace, 0, span, |tick| f64::from(u8::from(tick.mode == ModeCode::Standby)));
    assert!((speed(0, 8.0) - 11.0).abs() < 0.5, "{}", speed(0, 8.0));
    assert!((4.0..7.5).contains(&speed(0, 10.0)), "{}", speed(0, 10.0));
    assert!(speed(1, 10.5) < 8.5, "its follower brakes: {}", speed(1, 10.5));
    assert!(modes((8.2, 9.9)) == 1.0 && modes((10.3, 20.0)) == 0.0);
    assert!(speed(0, 19.0) > speed(0, 10.0) + 2.0, "{}", speed(0, 18.0));
    // Taking over and letting go, the vehicle changes its acceleration no faster than its actuators do.
    let accelerations: Vec<f64> = trace.vehicles[0].iter().map(|tick| tick.acceleration_mps2).collect();
    let jerk = accelerations.windows(2).map(|pair| (pair[1] - pair[0]).abs() / 0.01).fold(0.0, f64::max);
    assert!(jerk < 12.0, "{jerk}");
    let after: Vec<f64> = accelerations[1000..1050].to_vec();
    assert!(after.iter().all(|a| *a > -3.3), "no harder braking while the unit takes over");
}

#[test]
fn without_holdover_a_vehicle_stops_behind_the_newest_message() {
    let silence = "[[event]]\nat_s = 8\noutage_s = 4\n";
    let without = format!("{CALM}[[event]]\nat_s = 7\nholdover = false\n{silence}");
    let slowest = |trace: &Trace| -largest(trace, 1, (8.0, 13.0), |tick| -tick.speed_mps);
    let (with, without) = (trace(&format!("{CALM}{silence}")), trace(&without));
    assert!(slowest(&with) > 9.5, "{}", slowest(&with));
    assert!(slowest(&without) < 3.0, "{}", slowest(&without));
    let speeds =
        |trace: &Trace| trace.vehicles[1][..700].iter().map(|tick| tick.speed_mps.to_bits()).collect::<Vec<_>>();
    assert_eq!(speeds(&with), speeds(&without), "until it is switched off nothing differs");
}

#[test]
fn the_envelope_is_switched_at_once_and_back() {
    let sensors = "[[event]]\nat_s = 0\nrange_sensor = false\n";
    let silence = "[[event]]\nat_s = 6\noutage_s = 5\n";
    let off = "[[event]]\nat_s = 5.5\nenvelope = false\n";
    let on = "[[event]]\nat_s = 9\nenvelope = true\n";
    let limited = |trace: &Trace, span| largest(trace, 1, span, |tick| f64::from(u8::from(tick.limited)));
    let engaged = trace(&format!("{CALM}{sensors}{silence}"));
    assert_eq!(limited(&engaged, (6.0, 11.0)), 1.0, "blind and in silence, the envelope limits");
    let without = trace(&format!("{CALM}{sensors}{off}{silence}"));
    assert_eq!(limited(&without, (5.5, 11.0)), 0.0);
    let again = trace(&format!("{CALM}{sensors}{off}{silence}{on}"));
    assert_eq!((limited(&again, (5.5, 9.0)), limited(&again, (9.0, 11.0))), (0.0, 1.0));
}

#[test]
fn whom_a_person_always_drives_an_event_drives_until_it_lets_go() {
    let vehicles = "[[vehicle]]\n[[vehicle]]\ndriver = \"person\"\n[[vehicle]]\n";
    let calm = format!("ego = 2\n{CALM}{vehicles}");
    let brakes =
        "[[event]]\nat_s = 8\nvehicle = 1\ndrive_mps2 = -2\n[[event]]\nat_s = 10\nvehicle = 1\nrelease = true\n";
    let (undisturbed, braked) = (trace(&calm), trace(&format!("{calm}{brakes}")));
    let braking = |tick: &holdover_sim::sim::world::Tick| -tick.acceleration_mps2;
    assert!(largest(&undisturbed, 1, (8.5, 10.0), braking) < 1.0);
    assert!(largest(&braked, 1, (8.5, 10.0), braking) > 1.5, "the event brakes");
    let forward = |tick: &holdover_sim::sim::world::Tick| tick.acceleration_mps2;
    assert!(largest(&braked, 1, (10.0, 14.0), forward) > 0.5, "the person drives on, behind a gap that has grown");
    for run in [&undisturbed, &braked] {
        assert!(run.vehicles[1].iter().all(|tick| tick.mode == ModeCode::Standby), "its unit never drives");
    }
}

#[test]
fn people_drive_followers_that_are_not_the_ego() {
    for (text, wanted) in [
        ("[[vehicle]]\ndriver = \"unit\"\n[[vehicle]]\n", "live.toml:2: the leader (vehicle 0) has a `driver`, and "),
        (
            "ego = 1\n[[vehicle]]\n[[vehicle]]\ndriver = \"person\"\n",
            "live.toml:1: vehicle 1 is the ego, and a person drives it; ",
        ),
        (
            "[[vehicle]]\n[[vehicle]]\ndriver = \"robot\"\n",
            "live.toml:3: `driver` is \"robot\"; give \"unit\", \"person\" or \"unequipped\"",
        ),
    ] {
        let said = refusal(text);
        assert!(said.starts_with(wanted), "{said}");
    }
}
