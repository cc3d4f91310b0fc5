//! A hand-back on a way through intersections: nobody is hit, and the others get on their way when the request is back.

mod rig;

use rig::junction::{CROSSING, Driver, HALF, Junction};

const LENGTH: f64 = 4.8;

/// Whether the vehicle is in the conflict area of the first intersection.
fn is_inside(driver: &Driver) -> bool {
    driver.body.position > CROSSING - HALF && driver.body.position - LENGTH < CROSSING + HALF
}

/// The first vehicle's desk is silent from `lost` to `back`. Least gap on a leg, whether two crossing ones were in the area at once, and
/// the least position at the end.
fn drive(envelope: bool, mute: usize, lost: f64, back: f64) -> (f64, bool, f64) {
    let drivers = vec![
        Driver::new(0, 0, 90.0, 12.0, envelope),
        Driver::new(1, 0, 60.0, 12.0, envelope),
        Driver::new(2, 1, 85.0, 12.0, envelope),
        Driver::new(3, 1, 50.0, 12.0, envelope),
    ];
    let mut junction = Junction::new(drivers);
    let (mut least, mut both) = (f64::MAX, false);
    junction.run(90.0, |junction| {
        let seconds = junction.now as f64 * 1e-6;
        junction.drivers[mute].asks = !(lost..back).contains(&seconds);
        for (front, rear) in [(0, 1), (2, 3)] {
            least = least.min(junction.drivers[front].body.position - LENGTH - junction.drivers[rear].body.position);
        }
        both |= (0..2)
            .any(|one| (2..4).any(|other| is_inside(&junction.drivers[one]) && is_inside(&junction.drivers[other])));
    });
    let last = junction.drivers.iter().map(|driver| driver.body.position).fold(f64::MAX, f64::min);
    (least, both, last)
}

#[test]
fn nobody_is_hit_and_everybody_gets_through_in_the_end() {
    let mut bad = Vec::new();
    for envelope in [true, false] {
        for mute in 0..4 {
            for lost in [2.0, 5.0, 8.0, 9.0, 10.0, 12.0, 15.0] {
                let (least, both, last) = drive(envelope, mute, lost, lost + 20.0);
                if least <= 0.0 || both || last < CROSSING + 40.0 {
                    bad.push((envelope, mute, lost, least, both, last));
                }
            }
        }
    }
    assert!(bad.is_empty(), "{bad:#?}");
}
