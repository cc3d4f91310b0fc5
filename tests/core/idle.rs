//! A unit before it is started, and one that is started again.

use embedded_can::Frame as _;
use holdover::time::Instant;
use holdover::wire::{Frame, Identifiers, StationHash};
use holdover::{Config, ConfigError, OnboardUnit, Reception};

type Unit = OnboardUnit<2, 2, 400>;

fn frames_of_the_first_second(unit: &mut Unit) -> Vec<Frame> {
    (0..100).flat_map(|tick| unit.tick(Instant::from_micros(tick * 10_000)).frames).collect()
}

#[test]
fn a_unit_that_is_not_started_hears_nothing_and_says_nothing() {
    let mut unit = Unit::idle();
    for id in (0..0x800).map(|id| embedded_can::StandardId::new(id).unwrap()) {
        let frame = Frame::new(id, &[0; 8]).unwrap();
        assert_eq!(unit.receive(Instant::ZERO, &frame), Ok(Reception::Foreign));
    }
    assert_eq!(unit.health().total(), 0);
    assert!(frames_of_the_first_second(&mut unit).is_empty());
}

#[test]
fn a_unit_started_in_place_says_what_one_made_by_value_says_and_so_does_one_started_again() {
    let config = Config::car(StationHash(7));
    let expected = frames_of_the_first_second(&mut Unit::new(&config).unwrap());
    assert!(expected.iter().any(|frame| Identifiers::DEFAULT.offset_of(frame.id).is_some()));
    let mut unit = Unit::idle();
    for _ in 0..2 {
        unit.start(&config).unwrap();
        assert_eq!(frames_of_the_first_second(&mut unit), expected);
    }
}

#[test]
fn a_configuration_that_is_refused_changes_nothing() {
    let mut config = Config::car(StationHash(7));
    let mut unit = Unit::new(&config).unwrap();
    config.period = holdover::time::Duration::ZERO;
    assert_eq!(unit.start(&config), Err(ConfigError::Period));
    assert_eq!(unit.config(), &Config::car(StationHash(7)));
}
