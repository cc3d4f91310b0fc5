//! A hand-back on a way through intersections: nobody is hit, and the others get on their way when the request is back.

use crate::rig::junction::{CROSSING, Driver, Junction};

/// The first vehicle's desk is silent from `lost` to `back`. Least gap on a leg, whether two crossing ones were in the area at once, and
/// the least position at the end.
fn drive(envelope: bool, mute: usize, lost: f64, back: f64) -> (f64, bool, f64) {
    let drivers = vec![
        Driver::new(0, 0, 90.0, 12.0, envelope),
        Driver::new(1, 0, 60.0, 12.0, envelope),
        Driver::new(2, 1, 85.0, 12.0, envelope),
        Driver::new(3, 1, 50.0, 12.0, envelope),
    ];
    Junction::new(drivers).watch(90.0, |junction| {
        let seconds = junction.now as f64 * 1e-6;
        junction.drivers[mute].asks = !(lost..back).contains(&seconds);
    })
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
