//! On a way through intersections, another station gets the slot of a silent one ahead on the own leg. The modem is not to do that
//! (A11): with it the ego runs into who was ahead.

use crate::rig::junction::{Driver, Junction};
use crate::rig::plant::Body;
use holdover::wire::{Message, Said, Slot, StationHash};

#[test]
#[ignore = "outside of A11, which asks that the nearest ahead keeps its slot: shows what breaks first"]
fn who_is_ahead_on_the_leg_is_minded_when_its_slot_is_another_ones() {
    for reuse in [false, true] {
        let ahead = Driver::new(1, 0, 60.0, 12.0, true);
        let mut ego = Driver::new(2, 0, 20.0, 12.0, true);
        ego.target_speed = 13.0;
        // It comes from the east.
        let mut other = Driver::new(3, 1, 0.0, 5.0, true);
        let mut junction = Junction::new(vec![ahead, ego]);
        junction.run(3.0, |_| {});
        let silent_since = junction.now;
        junction.drivers[0].speaks = false;
        // It brakes with all that it has.
        let mut stands = Body { position: junction.drivers[0].body.position, speed: junction.drivers[0].body.speed };
        let mut least = f64::MAX;
        for _ in 0..3000 {
            junction.run(0.01, |_| {});
            stands = stands.after(-8.0, 0.01);
            // The world moves it, not its unit.
            junction.drivers[0].body.position = stands.position;
            junction.drivers[0].body.speed = stands.speed;
            let now = junction.now;
            if reuse && now - silent_since > 2_200_000 && now % 100_000 == 0 {
                let station = StationHash(3);
                let at = other.body.position + other.axis;
                let motion = other.rig.motion(station, now, at, 5.0, 0.0, 0.0, Some((0.05, 0.02)));
                let geo = other.geo(now);
                let rig = &mut junction.drivers[1].rig;
                rig.put(now + 500, &Message::Peer(Slot(0), Said::Motion(motion))).ok();
                rig.put(now + 600, &Message::Peer(Slot(0), Said::Geo(geo))).ok();
            }
            let gap = stands.position - 4.8 - junction.drivers[1].body.position;
            least = least.min(gap);
        }
        assert!(least > 0.0, "{reuse}: {least}");
    }
}
