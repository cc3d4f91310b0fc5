//! The vehicle ahead has the ego's own 8-bit station hash: it is followed, and minded when it falls silent and brakes.

use crate::rig;
use crate::rig::EGO;
use crate::rig::road::{ALL_BUT_RANGE, Road, Senses};
use holdover::config::Envelope;
use holdover::controller::Mode;
use holdover::wire::{Predecessor, Said};

#[test]
fn a_vehicle_ahead_with_the_ego_s_own_name_is_followed_and_minded() {
    for silent_from in [0, 200, 10_000] {
        let mut config = rig::config();
        config.envelope = Some(Envelope::CAR);
        let mut road = Road::new(&config, 15.0, 25.0);
        road.predecessor = Predecessor::Station(EGO);
        road.power_up();
        road.senses = Senses { v2x: false, ..ALL_BUT_RANGE };
        let mut least = road.gap();
        for period in 0..2_000 {
            let (now, target, a) = (road.now, road.target, road.acceleration);
            if period % 10 == 0 && !(300..).contains(&(period - silent_from)) {
                let motion = road.rig.motion(EGO, now, target.position, target.speed, a, a, Some((0.05, 0.02)));
                let parameters = rig::parameters(2.5, 8.0);
                let _ = road.rig.target(now, Said::DrivingParameters(parameters));
                let _ = road.rig.target(now, Said::Motion(motion));
            }
            if period == 400 {
                road.acceleration = -4.0;
            }
            let mode = road.step().answer.mode;
            assert!(period != 280 || mode == Mode::Cooperative, "{mode:?}");
            least = least.min(road.gap());
        }
        assert!(least > 0.0, "{silent_from}: {least}");
    }
}
