//! The range sensor on the way through intersections: what it sees is not taken for a vehicle that may be behind the ego.

mod rig;

use rig::junction::{Driver, Junction};
use rig::m_of;

/// The vehicle behind did not hear the ego, and drives on by its own horizon; then it is silent, and stops in time.
#[test]
fn a_vehicle_behind_that_is_estimated_to_have_driven_on_is_not_the_one_that_the_sensor_sees() {
    let mut ego = Driver::new(1, 0, 60.0, 2.0, true);
    ego.sees = true;
    let mut stranger = Driver::new(2, 0, 100.0, 0.0, false);
    stranger.speaks = false;
    let mut behind = Driver::new(3, 0, 5.0, 9.0, false);
    behind.hears = false;
    let mut junction = Junction::new(vec![ego, stranger, behind]);
    let mut checked = 0;
    junction.run(20.0, |junction| {
        let now = junction.now;
        let [ego, stranger, behind] = &mut junction.drivers[..] else { panic!("three") };
        stranger.body.speed = 0.0;
        stranger.body.position = 100.0;
        behind.speaks = now < 2_000_000;
        if now > 2_000_000 {
            behind.body.speed = (behind.body.speed - 0.05).max(0.0);
            behind.body.acceleration = 0.0;
        }
        assert!(ego.body.position - 4.8 > behind.body.position, "it stops in time");
        let track = ego.rig.unit.peers().get(2).expect("a slot");
        let Some(bound) = track.certainty().bound() else { return };
        let bound = bound.after(rig::instant(now), &track.reach());
        let truth = behind.body.position + ego.axis;
        let (low, high) = (m_of(bound.lowest_position()), m_of(bound.highest_position()));
        assert!((low..high).contains(&truth), "{:.2} s: {low:.2} <= {truth:.2} <= {high:.2}", now as f64 * 1e-6);
        checked += 1;
    });
    assert!(checked > 1_500, "{checked}");
}
