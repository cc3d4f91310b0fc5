//! A sensor that says how far it sees nobody, which is less far than the conflict area, does not see who is in there.

use crate::rig::config;
use crate::rig::junction::{CROSSING, Driver, Junction, WIDTH, is_on_point};
use holdover::Config;

fn with_sensor(station: u8, way: usize, at: f64, speed: f64) -> Driver {
    Driver::of(Config { range_sensor: true, ..config() }, station, way, at, speed, true)
}

/// Whether both were where the streets cross, when the ego's sensor sees so far. The other one makes an emergency stop there, within its
/// pass, and its radio dies.
fn meets(range: f64, speed: f64) -> bool {
    let mut ego = with_sensor(3, 0, 30.0, speed);
    ego.body.position = CROSSING - 17.0 * speed;
    let mut junction = Junction::new(vec![ego, with_sensor(2, 1, CROSSING - 140.0, 10.0)]);
    let mut both = false;
    junction.run(40.0, |junction| {
        let now = junction.now;
        let [ego, other] = &mut junction.drivers[..] else { panic!("two") };
        if other.body.position > CROSSING - 1.0 {
            (other.speaks, other.hears) = (false, false);
        }
        if !other.speaks {
            let is_at_rest = other.body.speed <= 0.1 || other.body.position > CROSSING + 2.0;
            (other.body.speed, other.body.acceleration) =
                if is_at_rest { (0.0, 0.0) } else { (other.body.speed, -8.0) };
        }
        if now % 20_000 == 0 {
            let gap = CROSSING - WIDTH / 2.0 - ego.body.position;
            let _ = if is_on_point(&other.body) && (0.0..range).contains(&gap) {
                ego.rig.range(now, gap, -ego.body.speed, 0)
            } else {
                ego.rig.nobody(now, range, 0)
            };
            let _ = other.rig.nobody(now, 100.0, 0);
        }
        both |= is_on_point(&ego.body) && is_on_point(&other.body);
    });
    both
}

#[test]
fn what_is_farther_than_the_sensor_sees_is_not_taken_to_be_free() {
    for speed in [8.0, 10.0, 13.0] {
        for range in [80.0, 40.0, 30.0, 25.0, 20.0, 15.0, 12.0, 8.0, 4.0] {
            assert!(!meets(range, speed), "{speed} m/s, {range} m");
        }
    }
}
