//! Three vehicles of which two on one leg arrived in the other order than they stand in: somebody has to drive.

use crate::rig::junction::{Driver, Junction};

#[test]
fn who_stands_behind_on_the_leg_but_arrived_first_does_not_block_everybody() {
    // All set out at once, so that the smaller station comes first: 2, 3, 4. But 4 is ahead of 2 on their leg.
    let at = [(2, 1, 60.0), (3, 0, 100.0), (4, 1, 110.0)];
    let drivers = at.map(|(station, way, at)| Driver::new(station, way, at, 10.0, true));
    let mut junction = Junction::new(drivers.into());
    junction.run(120.0, |_| {});
    for driver in &junction.drivers {
        assert!(driver.body.position > 210.0, "{} follows {:?}", driver.body.position, driver.follows());
    }
}
