//! The deviation of the device from its twin: their frames of a tick enter, with the uncertainty of that tick's time.
//! The largest differences leave, and the number of differences that this uncertainty does not explain.
//!
//! *What explains a difference in real time:* the device ticked at some moment within a window before its command was
//! on the bus. The window is a period, or a period and the device's lag, which its count of periods tells (see
//! [`super::monitor::Monitor::lag`]). The twin ticks when the command is on the bus, so it alone knows a frame that
//! came in between. Within the window the target moves, a new message corrects the estimate, and commands change by
//! their jerk and by as much as the twin's own commands did. A difference that is not larger than the sum of these is
//! explained by the time stamps. It stays explained while it does not grow and one of the two commands changes by its jerk: of two
//! that are on their way to the same demand, neither gains on the other. In lock step no difference is explained: everything has to be
//! the same.

use std::collections::VecDeque;

use holdover::time::Duration;
use holdover::units::{Acceleration, Speed};
use holdover::wire::command::Command;
use holdover::wire::estimate::TargetEstimate;

use super::said::Said;

/// Difference that the wire's rounding and the clocks' error of half a millisecond explain, in metres.
const POSITION_ROUNDING_M: f64 = 0.01;
/// The same for the speed, in m/s.
const SPEED_ROUNDING_MPS: f64 = 0.01;
/// The same for the command, in m/s².
const COMMAND_ROUNDING_MPS2: f64 = 0.02;
/// Largest correction of a speed by a message, per second of its age, in m/s².
const HARDEST_MPS2: f64 = 8.0;
/// Largest change of a command: the jerk of the law, in m/s³.
const JERK_MPS3: f64 = 5.0;
/// Two roundings of a command to the steps of the wire, in m/s².
const STEPS_MPS2: f64 = 0.004;
/// Time by which the modes may differ for longer than the window: less than a period.
const MODE_LATER_S: f64 = 0.008;
/// Time for which the twin's commands are kept, in seconds.
const MEMORY_S: f64 = 1.0;

/// The differences so far.
#[derive(Clone, Debug, PartialEq)]
pub struct Deviation {
    period: Duration,
    /// Ticks that were compared.
    pub ticks: u64,
    /// Ticks in which both sent the same, bit for bit.
    pub same: u64,
    /// Ticks in which the modes differed.
    pub modes: u64,
    /// Largest difference of the estimated position.
    pub position_m: f64,
    /// Largest difference of the estimated speed.
    pub speed_mps: f64,
    /// Largest difference of the command.
    pub command_mps2: f64,
    /// Times of the run with an unexplained difference, in seconds.
    pub unexplained_s: Vec<f64>,
    /// The twin's commands in the last window, and the command before it: time of the run and m/s².
    recent: VecDeque<(f64, f64)>,
    /// The commands of the tick before, of device and twin in m/s².
    before_mps2: Option<[f64; 2]>,
    /// The difference of the commands that was explained and may be left.
    left_mps2: f64,
    /// Time since which the modes differ.
    modes_since_s: Option<f64>,
}

impl Deviation {
    /// No difference yet, of units with this period.
    #[must_use]
    pub const fn new(period: Duration) -> Self {
        Self {
            period,
            ticks: 0,
            same: 0,
            modes: 0,
            position_m: 0.0,
            speed_mps: 0.0,
            command_mps2: 0.0,
            unexplained_s: Vec::new(),
            recent: VecDeque::new(),
            before_mps2: None,
            left_mps2: 0.0,
            modes_since_s: None,
        }
    }

    /// Compares a command of the device with its twin's frames of that tick. `window` is the longest time by which the
    /// device may have ticked before the twin.
    pub fn command(&mut self, at_s: f64, device: &Command, twin: &Said, window: Duration) {
        self.ticks += 1;
        self.same += u64::from(same(device, &twin.command));
        let commands = [mps2(device.acceleration), mps2(twin.command.acceleration)];
        let difference = (commands[0] - commands[1]).abs();
        self.command_mps2 = self.command_mps2.max(difference);
        let allowed = COMMAND_ROUNDING_MPS2 + self.moved(at_s, twin, window) + JERK_MPS3 * seconds(window);
        let left = self.left(commands);
        let is_explained = difference <= allowed.max(left);
        if difference <= allowed {
            self.left_mps2 = difference;
        }
        let is_other = device.mode != twin.command.mode;
        self.modes += u64::from(is_other);
        // One of the two may know of a change a window and a tick before the other.
        self.modes_since_s = is_other.then(|| self.modes_since_s.unwrap_or(at_s));
        let is_long = self.modes_since_s.is_some_and(|since_s| at_s - since_s > seconds(window) + MODE_LATER_S);
        if !is_explained || is_long {
            self.unexplained_s.push(at_s);
        }
    }

    /// What may be left of a difference that was explained: all of it while one of the two changes by its jerk, and then nothing.
    fn left(&mut self, commands: [f64; 2]) -> f64 {
        let before = self.before_mps2.replace(commands).unwrap_or(commands);
        let step_mps2 = JERK_MPS3 * seconds(self.period) - STEPS_MPS2;
        let is_on_its_way = commands.iter().zip(before).any(|(now, before)| (now - before).abs() >= step_mps2);
        if !is_on_its_way {
            self.left_mps2 = 0.0;
        }
        self.left_mps2 + COMMAND_ROUNDING_MPS2
    }

    /// The range of the twin's commands in that window.
    fn moved(&mut self, at_s: f64, twin: &Said, window: Duration) -> f64 {
        self.recent.push_back((at_s, mps2(twin.command.acceleration)));
        while self.recent.get(1).is_some_and(|(then_s, _)| *then_s <= at_s - MEMORY_S) {
            self.recent.pop_front();
        }
        let begin_s = at_s - seconds(window);
        let before = self.recent.iter().rposition(|(then_s, _)| *then_s <= begin_s).unwrap_or(0);
        let within = self.recent.iter().skip(before).map(|(_, command)| *command);
        let (least, most) = within.fold((f64::MAX, f64::MIN), |(least, most), x| (least.min(x), most.max(x)));
        most - least
    }

    /// Compares an estimate of the device with its twin's of the same tick.
    pub fn estimate(&mut self, at_s: f64, device: &TargetEstimate, twin: &TargetEstimate, window: Duration) {
        let position = apart_m(device, twin);
        let speed = (mps(device.speed) - mps(twin.speed)).abs();
        self.position_m = self.position_m.max(position);
        self.speed_mps = self.speed_mps.max(speed);
        // The ages of the samples differ: one of the two has a message that the other has not, and a message corrects
        // the estimate.
        let is_other = device.age.minus(twin.age).as_micros().abs() > (window.as_micros() + 10_000).max(20_000);
        let corrected_s = if is_other { seconds(device.age.max(twin.age)) } else { 0.0 };
        let window_s = seconds(window) + 0.001;
        let allowed_m = POSITION_ROUNDING_M + mps(twin.speed) * window_s + HARDEST_MPS2 * corrected_s.powi(2);
        let allowed_mps = SPEED_ROUNDING_MPS + HARDEST_MPS2 * (window_s + corrected_s);
        if position > allowed_m || speed > allowed_mps {
            self.unexplained_s.push(at_s);
        }
    }
}

/// Whether two commands are the same, except for the count of periods and the clock, which start at power-up.
fn same(device: &Command, twin: &Command) -> bool {
    Command { tick: 0, time_ms: 0, ..*device } == Command { tick: 0, time_ms: 0, ..*twin }
}

/// The distance between two estimated positions, which are modulo 2^25 mm on the wire.
fn apart_m(a: &TargetEstimate, b: &TargetEstimate) -> f64 {
    const TURN_MM: i64 = 1 << 25;
    let apart_mm = (i64::from(a.position.mm()) - i64::from(b.position.mm()) + TURN_MM / 2).rem_euclid(TURN_MM);
    let apart_mm = (apart_mm - TURN_MM / 2).abs() as f64;
    apart_mm * 1e-3
}

fn mps2(acceleration: Acceleration) -> f64 {
    acceleration.get().to_num()
}

fn mps(speed: Speed) -> f64 {
    speed.get().to_num()
}

fn seconds(duration: Duration) -> f64 {
    duration.as_micros() as f64 * 1e-6
}

#[cfg(test)]
mod tests {
    use super::*;
    use holdover::wire::command::{Effort, ModeCode};

    const PERIOD: Duration = Duration::from_millis(10);

    fn command(mm_per_s2: i32, mode: ModeCode) -> Command {
        Command {
            acceleration: Acceleration::from_mm_per_s2(mm_per_s2),
            effort: Effort::Force(0),
            mode,
            limited: false,
            tick: 0,
            hold: false,
            time_ms: 0,
        }
    }

    /// The ticks that are not explained of a device and its twin with these commands in mm/s². Before tick 1 the device stood still for
    /// three periods, and is then in another mode.
    fn unexplained(commands: impl IntoIterator<Item = (i32, i32)>) -> Vec<usize> {
        let mut deviation = Deviation::new(PERIOD);
        for (tick, (device, twin)) in commands.into_iter().enumerate() {
            let mode = if tick == 1 { ModeCode::Fault } else { ModeCode::Cooperative };
            let twin = Said { command: command(twin, ModeCode::Cooperative), estimate: None };
            let window = if tick == 1 { PERIOD.times(4) } else { PERIOD };
            deviation.command(tick as f64 * 0.01, &command(device, mode), &twin, window);
        }
        deviation.unexplained_s.iter().map(|at_s| (at_s * 100.0).round() as usize).collect()
    }

    /// Both are on their way, the device to this demand and the twin to -3 m/s²; in tick 1 the device was three periods ahead.
    fn on_their_way(demand: i32) -> impl Iterator<Item = (i32, i32)> {
        let later = (2..66).map(move |tick| ((-200 - 50 * tick).max(demand), (-50 * tick).max(-3_000)));
        [(0, 0), (-250, -50)].into_iter().chain(later)
    }

    #[test]
    fn a_difference_that_was_explained_is_so_while_both_are_on_their_way() {
        assert!(unexplained(on_their_way(-3_000)).is_empty());
    }

    #[test]
    fn it_is_not_when_they_have_arrived() {
        assert_eq!(unexplained(on_their_way(-3_200)), [61, 62, 63, 64, 65]);
    }

    #[test]
    fn a_difference_that_grows_on_the_way_is_not_explained() {
        let apart = on_their_way(-3_000).take(40).map(|(device, twin)| (device + device / 10, twin));
        assert!(unexplained(apart).len() > 20);
    }
}
