//! A missed period is an incident, with the length of the gap.

#[path = "../src/board/periods.rs"]
mod periods;

use holdover::health::{Cause, Incident};
use holdover::time::Instant;
use holdover::wire::StationHash;
use holdover::wire::{Identifiers, Message, Received, Receiver, Role};
use holdover::{Config, OnboardUnit};
use periods::Periods;

/// How many are missed by ticks at these times, in microseconds.
fn missed(ticks: &[u64]) -> u32 {
    let mut periods = Periods::new();
    ticks.iter().for_each(|&at| periods.tick(Instant::from_micros(at)));
    let missed = periods.missed();
    assert_eq!(periods.missed(), 0, "each is told once");
    missed
}

#[test]
fn a_tick_in_each_period_misses_none_however_late_in_it() {
    assert_eq!(missed(&[10_003, 20_003, 30_003]), 0);
    assert_eq!(missed(&[10_003, 28_900, 30_003, 49_999, 50_000]), 0);
}

#[test]
fn a_gap_counts_every_period_in_it() {
    assert_eq!(missed(&[10_003, 30_003]), 1);
    assert_eq!(missed(&[10_003, 1_010_003, 1_020_003]), 99);
    assert_eq!(missed(&[40_003]), 3, "before the first tick, too");
    assert_eq!(missed(&[10_003, u64::MAX]), u32::MAX);
}

#[test]
fn a_gap_of_35_ms_stands_in_health_and_on_the_bus() {
    let mut unit = OnboardUnit::<1, 2, 400>::new(&Config::car(StationHash(1))).unwrap();
    let mut bus = Receiver::<0>::new(Identifiers::DEFAULT, Role::Modem);
    let mut periods = Periods::new();
    let mut told = None;
    for at in (1..500).filter(|number| !(100..103).contains(number)).map(|number| number * 10_000 + 3) {
        let now = Instant::from_micros(at);
        periods.tick(now);
        unit.note(Incident::MissedPeriod, periods.missed());
        for frame in &unit.tick(now).frames {
            if let Ok(Received::Whole(Message::Status(status))) = bus.receive(now, frame)
                && status.cause == Cause::MissedPeriod
            {
                told = Some(status.count);
            }
        }
    }
    assert_eq!((unit.health().of(Cause::MissedPeriod), told), (3, Some(3)));
}
