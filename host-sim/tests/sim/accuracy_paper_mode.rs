//! The core in paper mode against the literal paper in float64 on the same frames: a string of three enters, with and
//! without delay, and a silence; where the core believes its members are stays within what fixed point and the
//! stated differences of reading account for.
//!
//! With one delay for all messages and samples alike between steps, these are the same readings of the paper. Two
//! differences remain: the core's steps are on one grid for all vehicles, so that a sample is moved by half a step at most;
//! and its delay is a running mean, where the paper's is that of the last message.

use holdover::config::Model;
use holdover::time::{Duration, Instant};
use holdover::units::{Acceleration, Distance, FineSeconds, Fraction, Gain, Jerk, Position, Seconds, Speed};
use holdover::wire::driving_parameters::{DrivingParameters, Limits};
use holdover::wire::motion::{Motion, WirePosition};
use holdover::wire::sync::{FollowUp, Sync};
use holdover::wire::{Identifiers, Message, Predecessor, Said, Sender, Slot, StationHash};
use holdover::{Config, OnboardUnit};
use holdover_sim::measure::baseline::Baseline;
use holdover_sim::measure::baseline::paper::Paper;
use holdover_sim::measure::observer::Observer;
use holdover_sim::sim::quantities::{metres, speed};
use holdover_sim::sim::station::station;
use holdover_sim::sim::time::gnss;

const VEHICLES: usize = 3;
const TICKS: i64 = 900;
/// From here to the end there is silence.
const SILENT_FROM: i64 = 400;

/// Paper's horizon of 5 s: the sample and 500 steps.
type Unit = OnboardUnit<4, 4, 501>;

struct Scene {
    unit: Unit,
    sender: Sender<4>,
    observer: Observer,
    papers: Vec<Paper>,
}

impl Scene {
    fn new() -> Self {
        let mut config = Config::car(StationHash(200));
        config.prediction.model = Model::PAPER;
        config.prediction.step = Duration::from_millis(10);
        config.prediction.horizon = Duration::from_millis(4_990);
        Self {
            unit: Unit::new(&config).expect("the configuration is sound"),
            sender: Sender::new(Identifiers::DEFAULT),
            observer: Observer::new(Identifiers::DEFAULT),
            papers: (0..VEHICLES).map(|target| Paper::new(target, 0.01)).collect(),
        }
    }

    fn say(&mut self, at_us: i64, message: &Message) {
        let (unit, observer, papers) = (&mut self.unit, &mut self.observer, &mut self.papers);
        let emit = &mut |frame: holdover::wire::Frame| {
            let _ = unit.receive(instant(at_us), &frame); // the first of each identifier is not trusted yet
            if let Some(heard) = observer.observe(at_us as f64 * 1e-6, &(&frame).into(), Position::ZERO) {
                papers.iter_mut().for_each(|paper| paper.hear(&heard));
            }
        };
        self.sender.send(message, emit).expect("the catalogue has a line for it");
    }

    fn synchronise(&mut self, at_us: i64, sequence: u8) {
        let micros = gnss(at_us as f64 * 1e-6).as_micros();
        let (seconds, micros) = ((micros / 1_000_000) as u32, (micros % 1_000_000) as u32);
        self.say(at_us, &Message::Sync(Sync { sequence, seconds }));
        self.say(at_us, &Message::FollowUp(FollowUp { sequence, micros }));
    }
}

fn instant(at_us: i64) -> Instant {
    Instant::from_micros(50_000_000u64.saturating_add_signed(at_us))
}

/// Everybody swings around 10 m/s, each in its own time.
fn motion(vehicle: usize, stamp_us: i64) -> Motion {
    let (t, phase) = (stamp_us as f64 * 1e-6, 1.3 * vehicle as f64);
    let position_m = 50.0 - 20.0 * vehicle as f64 + 10.0 * t + 1.5 * (0.8 * t + phase).sin();
    Motion {
        tag: stamp_us.div_euclid(100_000).rem_euclid(4) as u8,
        position: WirePosition::from_position(metres(position_m)),
        speed: speed(10.0 + 1.2 * (0.8 * t + phase).cos()),
        acceleration: Acceleration::from_mm_per_s2(-1_700), // which the paper has no use for
        demand: Acceleration::from_mm_per_s2(2_300),
        stamp: gnss(t).stamp(),
        position_accuracy: None,
        speed_accuracy: None,
        station: station(vehicle),
    }
}

fn parameters(vehicle: usize) -> DrivingParameters {
    DrivingParameters {
        length: Distance::from_mm(4_800 + 700 * vehicle as i32),
        standstill: Distance::from_mm(2_000),
        predecessor: vehicle.checked_sub(1).map_or(Predecessor::None, |ahead| Predecessor::Station(station(ahead))),
        target_speed: Speed::from_mm_per_s(12_000),
        catch_up: Fraction::from_milli(200),
        time_gap: Seconds::from_millis(1_000 + 200 * vehicle as i32),
        gain: Gain::from_milli(500),
        damping: Seconds::from_millis(2_000),
        feed_forward: Fraction::ZERO,
        lag: FineSeconds::from_millis(300),
        limits: Limits {
            acceleration: Acceleration::from_mm_per_s2(1_000),
            braking: Acceleration::from_mm_per_s2(1_000),
            jerk: Jerk::from_mm_per_s3(1_000),
            emergency_braking: Acceleration::from_mm_per_s2(8_000),
        },
        horizon_tenths: 0,
    }
}

/// The largest difference between the core and the paper of each vehicle's position, with everybody's messages that
/// long on their way, and stamped that long before a step.
fn differences(delay_us: i64, before_us: [i64; VEHICLES]) -> [f64; VEHICLES] {
    let mut scene = Scene::new();
    for (at_us, sequence) in [(-900_000, 1), (-400_000, 2)] {
        scene.synchronise(at_us, sequence);
    }
    for vehicle in (0..VEHICLES).chain(0..VEHICLES) {
        scene.say(-200_000, &Message::Peer(Slot(vehicle as u8), Said::DrivingParameters(parameters(vehicle))));
        scene.say(-200_000, &Message::Peer(Slot(vehicle as u8), Said::Motion(motion(vehicle, -200_000 - delay_us))));
    }
    // The first tick puts the grid on the multiples of the step, and lies before all messages that count.
    scene.unit.tick(instant(-100_000));
    let mut worst = [0.0f64; VEHICLES];
    let mut pending = std::collections::VecDeque::new();
    for tick in 0..TICKS {
        let now_us = tick * 10_000;
        if tick % 50 == 0 {
            scene.synchronise(now_us, (tick / 50 % 13 + 3) as u8);
        }
        if tick % 10 == 0 && tick < SILENT_FROM {
            pending.extend((0..VEHICLES).map(|vehicle| {
                let stamp_us = now_us - before_us[vehicle];
                (stamp_us + delay_us, vehicle, motion(vehicle, stamp_us))
            }));
        }
        while let Some((at_us, vehicle, motion)) = pending.pop_front_if(|(at_us, ..)| *at_us <= now_us) {
            scene.say(at_us, &Message::Peer(Slot(vehicle as u8), Said::Motion(motion)));
        }
        scene.unit.tick(instant(now_us));
        for (vehicle, worst) in worst.iter_mut().enumerate() {
            let paper = scene.papers[vehicle].estimate(now_us as f64 * 1e-6);
            let core = scene.unit.estimator().read(vehicle, instant(now_us));
            if tick < 50 {
                continue; // what came before the first tick is not on the same terms
            }
            let (paper, core) = (paper.expect("heard"), core.expect("heard"));
            *worst = worst.max((core.position.get().to_num::<f64>() - paper.position_m).abs());
        }
    }
    worst
}

#[test]
fn the_core_in_paper_mode_is_the_literal_paper_to_the_micrometre() {
    for delay_us in [0, 4_000, 12_000, 40_000, 43_000, 120_000, 300_000] {
        let differences = differences(delay_us, [0; VEHICLES]);
        assert!(differences.iter().all(|difference| *difference < 5e-6), "{delay_us} us: {differences:?} m");
    }
}

#[test]
fn with_samples_between_one_another_s_steps_they_differ_by_a_step_s_way_per_vehicle_ahead() {
    // Both read the nearest step, but the core's steps are its unit's and the paper's begin at each sample. As long as all
    // samples lie alike between the steps, that is the same.
    let alike = differences(14_000, [3_000; VEHICLES]);
    assert!(alike.iter().all(|difference| *difference < 5e-6), "{alike:?} m");
    for (delay_us, before_us) in [(40_000, [4_900, 8_800, 0]), (43_000, [0, 2_000, 9_900])] {
        let step_m = 0.01 * 11.2;
        let differences = differences(delay_us, before_us);
        for (vehicle, difference) in differences.into_iter().enumerate() {
            assert!(difference < 5e-6 + vehicle as f64 * step_m, "{vehicle}: {difference} m");
        }
    }
}
