//! Two vehicles on a road: the ego, driven by its unit through real frames, and its target, which does what the test says.
//! Switches enter; the ego's motion, its commands and the gap leave.

use super::plant::{Body, Plant};
use super::{Heard, LENGTH, Rig, TARGET, mps, mps2_of, parameters};
use holdover::Config;
use holdover::wire::driving_parameters::DrivingParameters;
use holdover::wire::{Predecessor, Said};

/// What of the traffic gets through.
#[derive(Clone, Copy, Debug)]
pub struct Senses {
    pub ego: bool,
    pub v2x: bool,
    pub range: bool,
    pub clock: bool,
    /// The driver's request.
    pub desk: bool,
}

pub const ALL_BUT_RANGE: Senses = Senses { ego: true, v2x: true, range: false, clock: true, desk: true };

pub struct Road {
    pub rig: Rig,
    pub ego: Plant,
    pub target: Body,
    /// Of the target.
    pub acceleration: f64,
    pub senses: Senses,
    pub engaged: bool,
    pub predecessor: Predecessor,
    /// Added to what the target says of itself: position, speed.
    pub lie: (f64, f64),
    /// Added to what the range sensor says.
    pub wrong: f64,
    /// Added to what the ego's sensors say of its acceleration.
    pub acceleration_off: f64,
    /// A command comes into force so many periods late.
    pub late: usize,
    /// Share of the hardest braking, 8 m/s², that the road allows.
    pub grip: f64,
    /// What the target says it can brake with.
    pub braking: f64,
    /// The speed that the target says it wants.
    pub wants: f64,
    pub now: i64,
    pub command: f64,
    pub commands: Vec<f64>,
}

const PERIOD_US: i64 = 10_000;

impl Road {
    /// Both at this speed, so far apart from bumper to bumper; nothing said yet.
    pub fn new(config: &Config, speed: f64, gap: f64) -> Self {
        let lag = config.lag.get().to_num();
        Self {
            rig: Rig::new(config),
            ego: Plant { position: 1000.0, speed, acceleration: 0.0, lag },
            target: Body { position: 1000.0 + gap + LENGTH, speed },
            acceleration: 0.0,
            senses: ALL_BUT_RANGE,
            engaged: true,
            predecessor: Predecessor::Station(TARGET),
            lie: (0.0, 0.0),
            wrong: 0.0,
            acceleration_off: 0.0,
            late: 0,
            grip: 1.0,
            braking: 8.0,
            wants: 30.0,
            now: 0,
            command: 0.0,
            commands: Vec::new(),
        }
    }

    /// Behind a target that keeps its speed and says so, heard and seen for 5 s.
    pub fn steady(config: &Config, speed: f64, gap: f64) -> Self {
        let mut road = Self::new(config, speed, gap);
        road.wants = speed;
        road.senses.range = true;
        road.power_up();
        road.run(5.0);
        road
    }

    pub fn gap(&self) -> f64 {
        self.target.position - LENGTH - self.ego.position
    }

    /// What the vehicle's sensors and its modem say now.
    fn speak(&mut self) {
        let (now, ego) = (self.now, self.ego);
        if self.senses.clock && now % 500_000 == 0 {
            self.rig.synchronise(now, 0);
        }
        if self.senses.ego {
            let _ = self.rig.ego(now, ego.position, ego.speed, ego.acceleration + self.acceleration_off, self.command);
        }
        if self.senses.desk && now % 100_000 == 0 {
            let _ = self.rig.request(now, self.engaged, self.predecessor);
        }
        if self.senses.v2x && now % 500_000 == 0 {
            let parameters = DrivingParameters { target_speed: mps(self.wants), ..parameters(2.5, self.braking) };
            let _ = self.rig.target(now, Said::DrivingParameters(parameters));
        }
        if self.senses.v2x && now % 100_000 == 0 {
            let (position, speed) = (self.target.position + self.lie.0, self.target.speed + self.lie.1);
            let a = self.acceleration;
            let motion = self.rig.motion(TARGET, now, position, speed, a, a, Some((0.05, 0.02)));
            let _ = self.rig.target(now, Said::Motion(motion));
        }
        if self.senses.range && now % 50_000 == 0 {
            let (gap, closing) = (self.gap() + self.wrong, self.target.speed - ego.speed);
            let _ = self.rig.range(now, gap, closing, 0);
        }
    }

    /// One period: what is said, the unit's answer, and both vehicles 10 ms on.
    pub fn step(&mut self) -> Heard {
        self.speak();
        let heard = self.rig.tick(self.now);
        self.command = mps2_of(heard.command.acceleration);
        self.commands.push(self.command);
        self.drive();
        heard
    }

    /// One period whose tick is missed: the command before stays in force.
    pub fn miss(&mut self) {
        self.speak();
        self.commands.push(self.command);
        self.drive();
    }

    /// Both vehicles 10 ms on.
    fn drive(&mut self) {
        let in_force = self.commands.len().checked_sub(1 + self.late).map_or(0.0, |index| self.commands[index]);
        let drives = if self.engaged { in_force.max(-8.0 * self.grip) } else { 0.0 };
        self.ego.drive(drives, 0.01);
        self.target = self.target.after(self.acceleration, 0.01);
        self.now += PERIOD_US;
    }

    /// Lets everything be heard for 2 s while both go on at their speeds, and then engages.
    pub fn power_up(&mut self) {
        self.engaged = false;
        self.run(2.0);
        self.engaged = true;
        self.commands.clear();
    }

    /// So many seconds; the last answer.
    pub fn run(&mut self, seconds: f64) -> Heard {
        let mut heard = self.step();
        for _ in 1..(seconds * 100.0).round() as u64 {
            heard = self.step();
        }
        heard
    }

    /// Until both stand; the least gap on the way.
    pub fn run_to_rest(&mut self) -> f64 {
        let mut least = self.gap();
        for _ in 0..6_000 {
            self.step();
            least = least.min(self.gap());
            if self.ego.speed == 0.0 && self.target.speed == 0.0 && self.command <= 0.0 {
                break;
            }
        }
        least
    }

    /// The fastest change of the command since it was last cleared, in m/s³.
    pub fn steepest(&self) -> (f64, f64) {
        let slopes = self.commands.windows(2).map(|pair| (pair[1] - pair[0]) / 0.01);
        slopes.fold((0.0, 0.0), |(down, up), slope| (f64::min(down, slope), f64::max(up, slope)))
    }
}
