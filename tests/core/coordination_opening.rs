//! At an intersection the own horizon knows how an opened time gap goes on, also past the changes of target that it foresees.

use crate::rig;
use crate::rig::junction::{Driver, Junction};
use crate::rig::{instant, m_of};
use holdover::time::Duration;
use holdover::units::Seconds;
use holdover::wire::{Message, Said};

/// A vehicle at 11 m/s, without an envelope, that looks 6 s ahead and opens its time gap up to 1.8 s.
fn driver(station: u8, way: usize, at: f64) -> Driver {
    let mut config = rig::config();
    config.law.silent_time_gap = Seconds::from_millis(1_800);
    (config.prediction.step, config.prediction.horizon) = (Duration::from_millis(100), Duration::from_millis(6_000));
    Driver::of(config, station, way, at, 11.0, false)
}

/// Where the vehicle's own horizon says that it will be at an instant, along its street.
fn foreseen(driver: &Driver, at: i64) -> f64 {
    let reading = driver.rig.unit.estimator().read_own(instant(at)).expect("it has a horizon");
    m_of(reading.position) - driver.axis
}

#[test]
fn the_own_horizon_knows_how_the_opened_gap_goes_on() {
    // The ego follows vehicle 2 towards the second intersection, to which vehicle 3 comes on the crossing road.
    let vehicles = [(2, 0, 60.0), (3, 2, 62.0), (1, 0, 36.0)];
    let mut junction = Junction::new(vehicles.map(|(station, way, at)| driver(station, way, at)).into());
    junction.run(2.0, |_| {});
    junction.drivers[2].hears = false;
    // After 5 s of silence the gap opens. When vehicle 2 is too far ahead to be followed it closes, and at last vehicle 3 is followed, just
    // before the holdover ends.
    junction.run(5.2, |_| {});
    let (mut told, mut followed, mut widest) = (Vec::new(), Vec::new(), 0);
    for _ in 0..97 {
        let now = junction.now;
        let ego = &junction.drivers[2];
        followed.push(ego.follows());
        if let Some((_, place)) = told.iter().find(|(due, _)| *due == now) {
            let off: f64 = place - ego.body.position;
            assert!(off.abs() < 0.1, "{} s: {off} m", now as f64 * 1e-6);
        }
        junction.run(0.1, |junction| {
            for message in junction.drivers[2].last.iter().flat_map(|last| &last.all) {
                if let Message::Own(Said::DrivingParameters(parameters)) = message {
                    widest = widest.max(parameters.time_gap.to_millis());
                }
            }
        });
        told.push((now + 4_000_000, foreseen(&junction.drivers[2], now + 4_000_000)));
    }
    followed.dedup();
    assert_eq!(followed, [Some(2), None, Some(3)]);
    assert!(widest >= 1_500, "{widest} ms of 1,000 that are wanted");
}
