//! What the range sensor saw standing is minded for ten seconds after the last view of it, also if a vehicle that drives passed close to
//! it, and if its views and the ego's own place err as far as they may.

use crate::rig;
use crate::rig::plant::Plant;
use crate::rig::{EGO, Rig, metres, mps, mps2_of};
use holdover::Config;
use holdover::config::Envelope;
use holdover::time::Duration;
use holdover::units::Distance;
use holdover::wire::range_sensor::RangeSample;
use holdover::wire::{Message, Predecessor, Said};

/// The ego on a road, alone but for what stands on it, by its sensors.
struct World {
    rig: Rig,
    ego: Plant,
    /// Accuracy of its own position, and the error.
    own: (f64, f64),
    now: i64,
}

impl World {
    fn new(speed: f64, own: f64) -> Self {
        let config = Config { envelope: Some(Envelope::CAR), ..rig::config() };
        let lag = config.lag.get().to_num();
        let mut rig = Rig::new(&config);
        rig.wanted = speed;
        rig.power_up(true, 0);
        Self { rig, ego: Plant { position: 1_000.0, speed, acceleration: 0.0, lag }, own: (own, 0.0), now: 0 }
    }

    /// A view of a rear bumper, with an error.
    fn see(&mut self, rear: f64, speed: f64, accuracy: f64, error: f64) {
        let view = RangeSample {
            distance: metres((rear - self.ego.position + error).max(0.0)),
            speed_difference: mps(speed - self.ego.speed),
            distance_accuracy: metres(accuracy),
            speed_accuracy: mps(0.1),
            age: Duration::ZERO,
            nobody: false,
        };
        assert!(view.distance >= Distance::ZERO);
        let _ = self.rig.put(self.now, &Message::Range(view));
    }

    /// One period, with what the ego sees.
    fn step(&mut self, see: impl FnOnce(&mut Self)) {
        let now = self.now;
        if now % 500_000 == 0 {
            self.rig.synchronise(now, 0);
        }
        let (position, speed) = (self.ego.position + self.own.1, self.ego.speed);
        let motion = self.rig.motion(EGO, now, position, speed, self.ego.acceleration, 0.0, Some((self.own.0, 0.02)));
        let _ = self.rig.put(now, &Message::Ego(Said::Motion(motion)));
        if now % 100_000 == 0 {
            let _ = self.rig.request(now, true, Predecessor::None);
        }
        if now % 20_000 == 0 {
            see(self);
        }
        let command = mps2_of(self.rig.tick(now).command.acceleration);
        self.ego.drive(command.max(-8.0), 0.01);
        self.now += 10_000;
    }
}

/// A vehicle cuts in, drives towards the one that stands, and leaves the path so far before it. Then the sensor is blind.
#[test]
fn one_that_drives_and_leaves_the_path_close_before_it_does_not_take_it_off_the_gates_mind() {
    for (accuracy, own, leaves) in
        [(0.2, 0.05, 2.0), (0.4, 0.1, 2.0), (0.5, 0.2, 3.0), (1.0, 0.3, 5.0), (1.5, 0.5, 9.0)]
    {
        let mut world = World::new(10.0, own);
        let (stands, last_seen) = (world.ego.position + 100.0, 1_000_000);
        let cuts_in = world.ego.position + 40.0;
        while world.now < last_seen + 10_000_000 {
            let passing = cuts_in + 12.0 * (world.now - last_seen) as f64 * 1e-6;
            world.step(|world| {
                if world.now < last_seen {
                    world.see(stands, 0.0, accuracy, 0.0);
                } else if passing < stands - leaves {
                    world.see(passing, 12.0, accuracy, 0.0);
                }
            });
            let gap = stands - world.ego.position;
            assert!(gap > 0.0, "{accuracy} m, {leaves} m: hit at {:.1} m/s", world.ego.speed);
        }
    }
}

/// The views and the own place err one way while the ego comes up, and the other way in the last view. Then the sensor is blind.
#[test]
fn one_just_ahead_has_not_been_passed_as_long_as_it_may_be_ahead() {
    for (accuracy, own) in [(0.5, 0.1), (1.0, 0.5), (1.55, 0.1), (1.55, 1.0)] {
        let mut world = World::new(5.0, own);
        let (stands, last_seen) = (world.ego.position + 60.0, 25_000_000);
        while world.now < last_seen + 10_000_000 {
            let sign = if world.now < last_seen { 1.0 } else { -1.0 };
            world.own.1 = -3.0 * own * if world.now <= last_seen { 1.0 } else { -1.0 };
            world.step(|world| {
                if world.now <= last_seen {
                    world.see(stands, 0.0, accuracy, sign * 3.0 * accuracy);
                }
            });
            let gap = stands - world.ego.position;
            assert!(gap > 0.0, "{accuracy} m, {own} m: hit at {:.1} m/s after {} us", world.ego.speed, world.now);
        }
    }
}
