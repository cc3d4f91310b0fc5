//! How far the device is from its twin: what the two said in a tick and how well the time of that tick is known enter; the
//! largest differences leave, and how many of them the time does not explain.
//!
//! *What explains a difference in real time:* the device ticked at some moment between its command before and this one, so
//! by up to that long before its twin; and a frame that came in between was known to the twin only. In that time the target
//! makes way, news moves the estimate by what it corrects, and commands move by their jerk. Differences within what those
//! make up are explained by the time stamps. In lock step there is nothing to explain: everything has to be the same.

use holdover::time::Duration;
use holdover::units::{Acceleration, Speed};
use holdover::wire::command::Command;
use holdover::wire::estimate::TargetEstimate;

use super::said::Said;

/// What the wire rounds to, and what the clocks' error of half a millisecond makes up, in metres.
const POSITION_ROUNDING_M: f64 = 0.01;
/// The same of speed, in m/s.
const SPEED_ROUNDING_MPS: f64 = 0.01;
/// The same of the command, in m/s².
const COMMAND_ROUNDING_MPS2: f64 = 0.02;
/// Hardest change of a speed that news may correct within one period's age, in m/s².
const HARDEST_MPS2: f64 = 8.0;
/// Hardest change of a command: that of the law, in m/s³.
const JERK_MPS3: f64 = 5.0;

/// The differences so far.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Deviation {
    /// Ticks that were compared.
    pub ticks: u64,
    /// Ticks in which both said the same, bit for bit.
    pub same: u64,
    /// Ticks in which their modes differed.
    pub modes: u64,
    /// Largest difference of the estimated position.
    pub position_m: f64,
    /// Largest difference of the estimated speed.
    pub speed_mps: f64,
    /// Largest difference of the command.
    pub command_mps2: f64,
    /// Times of the run at which a difference is not explained, in seconds.
    pub unexplained_s: Vec<f64>,
    /// What the twin said last.
    last: Option<Said>,
    /// In how many ticks the modes have differed in a row.
    modes_in_a_row: u32,
}

impl Deviation {
    /// A command of the device, and what its twin said in that tick. `window`: how long before the twin the device may
    /// have ticked.
    pub fn command(&mut self, at_s: f64, device: &Command, twin: &Said, window: Duration) {
        self.ticks += 1;
        self.same += u64::from(same(device, &twin.command));
        let difference = (mps2(device.acceleration) - mps2(twin.command.acceleration)).abs();
        self.command_mps2 = self.command_mps2.max(difference);
        let moved =
            self.last.map_or(0.0, |last| (mps2(last.command.acceleration) - mps2(twin.command.acceleration)).abs());
        let allowed = COMMAND_ROUNDING_MPS2 + moved + JERK_MPS3 * seconds(window);
        let is_other = device.mode != twin.command.mode;
        self.modes += u64::from(is_other);
        // One of them may hear of a change a tick before the other.
        self.modes_in_a_row = if is_other { self.modes_in_a_row + 1 } else { 0 };
        if difference > allowed || self.modes_in_a_row > 2 {
            self.unexplained_s.push(at_s);
        }
        self.last = Some(*twin);
    }

    /// An estimate of the device, and its twin's of the same tick.
    pub fn estimate(&mut self, at_s: f64, device: &TargetEstimate, twin: &TargetEstimate, window: Duration) {
        let position = apart_m(device, twin);
        let speed = (mps(device.speed) - mps(twin.speed)).abs();
        self.position_m = self.position_m.max(position);
        self.speed_mps = self.speed_mps.max(speed);
        // A sample of another age: one of the two has news that the other has not, and news corrects.
        let is_other = (device.age.as_micros() - twin.age.as_micros()).unsigned_abs() > 2 * 10_000;
        let corrected_s = if is_other { seconds(device.age.max(twin.age)) } else { 0.0 };
        let window_s = seconds(window) + 0.001;
        let allowed_m = POSITION_ROUNDING_M + mps(twin.speed) * window_s + HARDEST_MPS2 * corrected_s.powi(2);
        let allowed_mps = SPEED_ROUNDING_MPS + HARDEST_MPS2 * (window_s + corrected_s);
        if position > allowed_m || speed > allowed_mps {
            self.unexplained_s.push(at_s);
        }
    }
}

/// Everything but the count of periods, which begins with the power.
fn same(device: &Command, twin: &Command) -> bool {
    Command { tick: 0, ..*device } == Command { tick: 0, ..*twin }
}

/// The distance between two estimated positions, which stand on the wire modulo 2^25 mm.
fn apart_m(a: &TargetEstimate, b: &TargetEstimate) -> f64 {
    const TURN_MM: i64 = 1 << 25;
    let apart_mm = (i64::from(a.position.mm()) - i64::from(b.position.mm()) + TURN_MM / 2).rem_euclid(TURN_MM);
    #[allow(clippy::cast_precision_loss)] // 25 bits
    let apart_mm = (apart_mm - TURN_MM / 2).abs() as f64;
    apart_mm * 1e-3
}

fn mps2(acceleration: Acceleration) -> f64 {
    acceleration.get().to_num()
}

fn mps(speed: Speed) -> f64 {
    speed.get().to_num()
}

#[allow(clippy::cast_precision_loss)] // seconds
fn seconds(duration: Duration) -> f64 {
    duration.as_micros() as f64 * 1e-6
}
