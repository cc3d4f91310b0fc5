//! Two vehicles with the same 8-bit station hash at an intersection: nobody is hit, and everybody gets through.

use crate::rig::junction::{CROSSING, Driver, Junction};

/// Two to the north, two to the east with these stations. Least gap on a leg, whether two crossing ones were in the area at once, and the
/// least position at the end.
fn drive(envelope: bool, stations: [u8; 4], starts: [f64; 4], mute: Option<(usize, f64)>) -> (f64, bool, f64) {
    let way = |index: usize| index / 2;
    let drivers = (0..4).map(|index| Driver::new(stations[index], way(index), starts[index], 12.0, envelope)).collect();
    Junction::new(drivers).watch(80.0, |junction| {
        let seconds = junction.now as f64 * 1e-6;
        if let Some((index, from)) = mute {
            junction.drivers[index].speaks = !(from..from + 6.0).contains(&seconds);
        }
    })
}

#[test]
fn nobody_is_hit_and_everybody_gets_through() {
    let mut bad = Vec::new();
    for envelope in [true, false] {
        for stations in [[1, 2, 1, 3], [1, 2, 3, 1], [1, 1, 2, 3], [2, 1, 3, 1], [1, 2, 2, 1], [1, 2, 3, 4]] {
            for starts in [[90.0, 60.0, 90.0, 60.0], [90.0, 60.0, 75.0, 45.0], [80.0, 50.0, 90.0, 55.0]] {
                for mute in [None, Some((0, 4.0)), Some((2, 6.0))] {
                    let (least, both, last) = drive(envelope, stations, starts, mute);
                    if least <= 0.0 || both || last < CROSSING + 40.0 {
                        bad.push(format!("{envelope} {stations:?} {starts:?} {mute:?}: {least} {both} {last}"));
                    }
                }
            }
        }
    }
    assert!(bad.is_empty(), "{bad:#?}");
}
