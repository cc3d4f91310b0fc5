//! What the keys of the envelope and of the sensors mean, and what is said of ones that cannot be.

use holdover::config::Envelope;
use holdover_sim::input::scenario::{Faults, Overrides, RangeSensor, Scenario, SensorShare, Switch};
use std::path::Path;

fn parse(text: &str) -> Result<Scenario, String> {
    Scenario::parse(Path::new("s.toml"), text, &Overrides::default()).map_err(|error| error.to_string())
}

#[test]
fn the_envelope_is_a_cars_and_engaged_unless_said_otherwise() {
    assert_eq!(parse("").unwrap().envelope.limits(), Some(Envelope::CAR));
    assert_eq!(parse("[envelope]\nengaged = false").unwrap().envelope.limits(), None);
    for (engaged, said, limits) in [(false, Switch::On, Some(Envelope::CAR)), (true, Switch::Off, None)] {
        let overrides = Overrides { envelope: Some(said), ..Overrides::default() };
        let text = format!("[envelope]\nengaged = {engaged}");
        let scenario = Scenario::parse(Path::new("s.toml"), &text, &overrides).unwrap();
        assert_eq!(scenario.envelope.limits(), limits, "the command line has the last word");
    }
}

#[test]
fn its_limits_are_taken_to_the_thousandth() {
    let text = "[envelope]\nengaged = true\nacceleration_mps2 = 1.2345\nbraking_mps2 = 7\njerk_mps3 = 12.5\n\
                speed_mps = 30\nmargin_m = 0.75\n";
    let limits = parse(text).unwrap().envelope.limits().unwrap();
    assert_eq!(limits.acceleration.to_mm_per_s2(), 1235);
    assert_eq!((limits.braking.to_mm_per_s2(), limits.jerk.to_mm_per_s3()), (7000, 12_500));
    assert_eq!((limits.speed.to_mm_per_s(), limits.margin.to_mm()), (30_000, 750));
}

#[test]
fn accuracies_are_those_of_good_positioning_and_of_a_recording_those_of_what_recorded_it() {
    let accuracy = |scenario: &Scenario, index: usize| {
        let accuracy = scenario.vehicles[index].accuracy;
        (accuracy.position_m, accuracy.speed_mps)
    };
    let given = parse("[[vehicle]]\n[[vehicle]]\nposition_accuracy_m = 1.5\nspeed_accuracy_mps = 0.1\n").unwrap();
    assert_eq!((accuracy(&given, 0), accuracy(&given, 1)), ((0.05, 0.02), (1.5, 0.1)));
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("drive.csv"), "t_s,position_m,speed_mps\n0,0,3\n30,90,3\n").unwrap();
    let file = folder.path().join("s.toml");
    let recorded = |vehicle: &str| {
        let text = format!("[leader]\nmotion = \"drive.csv\"\n[[vehicle]]\n{vehicle}\n[[vehicle]]\n");
        Scenario::parse(&file, &text, &Overrides::default()).unwrap()
    };
    assert_eq!((accuracy(&recorded(""), 0), accuracy(&recorded(""), 1)), ((0.5, 0.3), (0.05, 0.02)));
    assert_eq!(accuracy(&recorded("position_accuracy_m = 0.1"), 0), (0.1, 0.3));
}

#[test]
fn everybody_who_follows_has_a_range_sensor_unless_said_otherwise() {
    let sensors = |text: &str| -> Vec<Option<RangeSensor>> {
        parse(text).unwrap().vehicles.iter().map(|vehicle| vehicle.range_sensor).collect()
    };
    let given = "[[vehicle]]\n[[vehicle]]\n[[vehicle]]\nrange_sensor = true\n\
                 range_accuracy_m = 0.5\nrange_speed_accuracy_mps = 0.3\n[[vehicle]]\nrange_sensor = false\n";
    let (sees_up_to_m, faults) = (200.0, Faults::NONE);
    let sensor = |distance_m, speed_mps| Some(RangeSensor { distance_m, speed_mps, sees_up_to_m, faults });
    assert_eq!(sensors(given), [None, sensor(0.25, 0.1), sensor(0.5, 0.3), None]);
    for (said, follower) in [(SensorShare::ALL, sensor(0.25, 0.1)), (SensorShare::NONE, None)] {
        let overrides = Overrides { range_sensors: Some(said), ..Overrides::default() };
        let scenario =
            Scenario::parse(Path::new("s.toml"), "[[vehicle]]\n[[vehicle]]\nrange_sensor = false", &overrides);
        assert_eq!(scenario.unwrap().vehicles[1].range_sensor, follower, "the command line has the last word");
    }
}

#[test]
fn keys_that_cannot_be_are_refused_with_file_line_cause_and_remedy() {
    let cases = [
        ("envelope = true", "s.toml:1: `envelope` is true; give [envelope]"),
        ("[envelope]\nengaged = 1", "s.toml:2: `engaged` is 1; give true or false"),
        ("[envelope]\nengage = true", "s.toml:2: unknown key \"engage\" in [envelope]; write `engaged`"),
        ("[envelope]\nacceleration_mps2 = 0", "s.toml:2: `acceleration_mps2` is 0; give m/s² from 0.1 to 20.46"),
        ("[envelope]\nbraking_mps2 = 8.1", "s.toml:2: `braking_mps2` is 8.1; give m/s² from 0.5 to 8"),
        ("[envelope]\nbraking_mps2 = -8", "s.toml:2: `braking_mps2` is -8; give m/s² from 0.5 to 8"),
        ("[envelope]\n\njerk_mps3 = inf", "s.toml:3: `jerk_mps3` is inf; give m/s³ from 1 to 51.15"),
        ("[envelope]\nspeed_mps = 66", "s.toml:2: `speed_mps` is 66; give m/s from 1 to 65.534"),
        ("[envelope]\nmargin_m = nan", "s.toml:2: `margin_m` is NaN; give metres from 0 to 10"),
        (
            "[[vehicle]]\nposition_accuracy_m = 6.4\n[[vehicle]]",
            "s.toml:2: `position_accuracy_m` is 6.4; give metres from 0 to 6.3",
        ),
        (
            "[[vehicle]]\n[[vehicle]]\nspeed_accuracy_mps = 2",
            "s.toml:3: `speed_accuracy_mps` is 2; give m/s from 0 to 1.24",
        ),
        (
            "[[vehicle]]\nrange_sensor = true\n[[vehicle]]",
            "s.toml:2: the leader (vehicle 0) has a `range_sensor`, and nobody is ahead of it; remove it",
        ),
        ("[[vehicle]]\n[[vehicle]]\nrange_sensor = \"yes\"", "s.toml:3: `range_sensor` is \"yes\"; give true or false"),
        (
            "[[vehicle]]\n[[vehicle]]\nrange_sensor = true\nrange_accuracy_m = 1.6",
            "s.toml:4: `range_accuracy_m` is 1.6; give metres from 0 to 1.55",
        ),
        (
            "[[vehicle]]\n[[vehicle]]\nrange_sensor = false\nrange_speed_accuracy_mps = 0.2",
            "s.toml:4: a vehicle without a range sensor has an accuracy of it; give it `range_sensor = true`, or remove \
             its accuracies",
        ),
    ];
    for (text, message) in cases {
        assert_eq!(parse(text).unwrap_err(), message, "{text:?}");
    }
}
