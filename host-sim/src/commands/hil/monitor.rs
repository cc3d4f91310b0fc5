//! The monitor of the device: its frames on the bus enter, with their time stamps; its commands, its modes, its
//! refusals and the errors of its protection leave.

use std::collections::{BTreeMap, VecDeque};

use holdover::health::Cause;
use holdover::time::{Duration, Instant, Stamp};
use holdover::wire::command::{Command, ModeCode};
use holdover::wire::estimate::TargetEstimate;
use holdover::wire::fd::State;
use holdover::wire::{Identifiers, Message, Received, Receiver, Role, Said, Transport};

use crate::bus::Frame;

/// Number of motions that are kept: those of a second.
const INPUTS: usize = 100;

/// Number of commands that determine the lag: those of a quarter of a second, in which the drift of the clocks is
/// negligible.
const LAG_COMMANDS: usize = 25;

/// A command of the device.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CommandRecord {
    /// Time at which it was on the bus.
    pub at: Instant,
    /// The mode.
    pub mode: ModeCode,
    /// The count of periods.
    pub tick: u8,
    /// Time on the bus from the vehicle's motion that it rests on, if the device tells which motion that is. In lock
    /// step: from the step.
    pub latency: Option<Duration>,
}

/// The content of a frame of the device.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum News {
    /// A command, and whether the device has restarted before it.
    Command(Command, bool),
    /// An estimate.
    Estimate(TargetEstimate),
    /// Any other content.
    Other,
}

/// The monitor of the device.
pub struct Monitor {
    period: Duration,
    receiver: Receiver<1>,
    commands: Vec<CommandRecord>,
    /// Errors of the protection, with their times.
    e2e: Vec<(Instant, Cause)>,
    /// The refusals that the device reports.
    refusals: BTreeMap<&'static str, u32>,
    /// The vehicle's latest motions on the bus.
    inputs: VecDeque<(Stamp, Instant)>,
    /// Time at which the last step was on the bus.
    asked: Option<Instant>,
    frames: u64,
    restarts: Vec<Instant>,
    /// How much is kept of what comes again and again.
    most: usize,
}

impl Monitor {
    /// The monitor of a device whose catalogue is on these identifiers, with this period.
    #[must_use]
    pub fn new(identifiers: Identifiers, period: Duration) -> Self {
        Self {
            period,
            receiver: Receiver::new(identifiers, Role::Modem),
            commands: Vec::new(),
            e2e: Vec::new(),
            refusals: BTreeMap::new(),
            inputs: VecDeque::new(),
            asked: None,
            frames: 0,
            restarts: Vec::new(),
            most: usize::MAX,
        }
    }

    /// The same, which forgets all but the latest commands and errors, so many of each or up to twice as many: its memory does not grow.
    #[must_use]
    pub fn keeping(self, most: usize) -> Self {
        Self { most, ..self }
    }

    /// The same on a bus with these frames.
    #[must_use]
    pub fn over(self, transport: Transport) -> Self {
        Self { receiver: self.receiver.over(transport), ..self }
    }

    /// Records that the vehicle's motion with this stamp was on the bus.
    pub fn input(&mut self, at: Instant, stamp: Stamp) {
        self.inputs.push_back((stamp, at));
        if self.inputs.len() > INPUTS {
            self.inputs.pop_front();
        }
    }

    /// In lock step: records that a step was on the bus.
    pub fn ask(&mut self, at: Instant) {
        self.asked = Some(at);
    }

    /// Takes in a frame of the device.
    pub fn hear(&mut self, at: Instant, frame: &Frame) -> News {
        self.frames += 1;
        match self.receiver.receive(at, frame) {
            Ok(Received::Whole(Message::Command(command))) => self.command(at, command),
            Ok(Received::Whole(Message::Estimate(estimate))) => News::Estimate(estimate),
            Ok(Received::Whole(Message::Status(status))) => {
                self.refusals.insert(status.cause.name(), status.count);
                News::Other
            }
            Ok(Received::Whole(Message::Own(Said::Motion(motion) | Said::State(State { motion, .. })))) => {
                // The device tells on which motion its command rests.
                let input = self.inputs.iter().find(|(stamp, _)| *stamp == motion.stamp);
                if let (Some((_, input)), Some(command)) = (input, self.commands.last_mut()) {
                    command.latency = command.latency.or(Some(command.at.since(*input)));
                }
                News::Other
            }
            Ok(_) => News::Other,
            Err(cause) => {
                self.e2e.push((at, cause));
                forget(&mut self.e2e, self.most);
                News::Other
            }
        }
    }

    fn command(&mut self, at: Instant, command: Command) -> News {
        // After a gap, a unit that has kept running counts on from its last number, or by the number of periods that
        // passed. A unit that has restarted has a small number.
        let is_new = self.commands.last().is_some_and(|last| {
            let gap = at.since(last.at);
            let counted = i64::from(command.tick.wrapping_sub(last.tick) & 63);
            let passed = (gap.as_micros() + self.period.as_micros() / 2).div_euclid(self.period.as_micros());
            let off = (passed - counted).rem_euclid(64);
            let goes_on = (1..=4).contains(&counted) || off <= 2 || off >= 62;
            gap > self.period.times(3) && command.tick <= 8 && !goes_on
        });
        if is_new {
            self.restarts.push(at);
            forget(&mut self.restarts, self.most);
        }
        let latency = self.asked.take().map(|asked| at.since(asked));
        self.commands.push(CommandRecord { at, mode: command.mode, tick: command.tick, latency });
        forget(&mut self.commands, self.most);
        News::Command(command, is_new)
    }

    /// The time by which the last command was on the bus later than the device's count of periods says, relative to the
    /// earliest of the commands just before it. Either the device ticked late, or its connection was slow. A delay that
    /// is common to all commands does not show.
    #[must_use]
    pub fn lag(&self) -> Duration {
        let Some(last) = self.commands.last() else { return Duration::ZERO };
        let lag = |command: &CommandRecord| {
            let counted = i64::from(last.tick.wrapping_sub(command.tick) & 63);
            last.at.since(command.at).as_micros() - counted * self.period.as_micros()
        };
        Duration::from_micros(self.commands.iter().rev().take(LAG_COMMANDS).map(lag).max().unwrap_or(0))
    }

    /// The commands of the device.
    #[must_use]
    pub fn commands(&self) -> &[CommandRecord] {
        &self.commands
    }

    /// Errors of the protection, with their times. The first frame of each identifier is not an error, and neither is its
    /// message then being incomplete: no receiver trusts its first frame of an identifier.
    pub fn e2e(&self) -> impl Iterator<Item = (Instant, Cause)> + '_ {
        self.e2e.iter().copied().filter(|(_, cause)| !matches!(cause, Cause::NotYetTrusted | Cause::Torn))
    }

    /// The refusals that the device reports, by cause, without causes that did not occur.
    #[must_use]
    pub fn refusals(&self) -> BTreeMap<&'static str, u32> {
        self.refusals.iter().filter(|(_, count)| **count > 0).map(|(cause, count)| (*cause, *count)).collect()
    }

    /// Number of frames of the device.
    #[must_use]
    pub fn frames(&self) -> u64 {
        self.frames
    }

    /// Times at which the device restarted.
    #[must_use]
    pub fn restarts(&self) -> &[Instant] {
        &self.restarts
    }

    /// Periods in which the device sent nothing, each gap with the time of its end. If a command was late and the next
    /// one was not, the command is late and not missing.
    #[must_use]
    pub fn missed(&self) -> Vec<(Instant, i64)> {
        let period = self.period.as_micros();
        let gap = |(index, pair): (usize, &[CommandRecord])| {
            let late = pair[1].at.since(pair[0].at).as_micros();
            let next = self.commands.get(index + 2).map_or(late, |next| next.at.since(pair[0].at).as_micros() - period);
            (pair[1].at, (late.min(next) + period / 2).div_euclid(period) - 1)
        };
        self.commands.windows(2).enumerate().map(gap).filter(|(_, missed)| *missed > 0).collect()
    }
}

/// Of more than twice as many the latest so many.
fn forget<T>(kept: &mut Vec<T>, most: usize) {
    if kept.len() / 2 >= most {
        kept.drain(..kept.len() - most);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use holdover::units::Acceleration;
    use holdover::wire::Sender;
    use holdover::wire::command::Effort;

    struct Device {
        sender: Sender<0>,
        monitor: Monitor,
    }

    impl Device {
        fn new() -> Self {
            Self {
                sender: Sender::new(Identifiers::DEFAULT),
                monitor: Monitor::new(Identifiers::DEFAULT, Duration::from_millis(10)),
            }
        }

        fn command(&mut self, millis: u64, tick: u8) -> Vec<News> {
            let command = Command {
                acceleration: Acceleration::ZERO,
                effort: Effort::Force(0),
                mode: ModeCode::Cooperative,
                limited: false,
                tick,
                hold: false,
                time_ms: 0,
            };
            let (at, mut news) = (Instant::from_micros(millis * 1000), Vec::new());
            let Self { sender, monitor } = self;
            sender
                .send(&Message::Command(command), &mut |frame| news.push(monitor.hear(at, &(&frame).into())))
                .unwrap();
            news
        }
    }

    #[test]
    fn the_first_frame_is_not_trusted_and_no_fault() {
        let mut device = Device::new();
        assert_eq!(device.command(0, 1), [News::Other]);
        assert!(matches!(device.command(10, 2)[..], [News::Command(_, false)]));
        assert_eq!((device.monitor.e2e().count(), device.monitor.frames()), (0, 2));
    }

    #[test]
    fn a_gap_is_counted_in_whole_periods() {
        let mut device = Device::new();
        // The commands of the periods 4 and 5 are missing, and that of period 6 is late. That of period 8 is late, and
        // none is missing there.
        for (millis, tick) in [(0, 1), (10, 2), (20, 3), (56, 6), (61, 7), (77, 8), (81, 9), (91, 10)] {
            device.command(millis, tick);
        }
        let missed = device.monitor.missed();
        assert_eq!(missed, [(Instant::from_micros(56_000), 2)]);
    }

    #[test]
    fn a_device_that_is_slower_than_its_period_misses_every_other_one() {
        let mut device = Device::new();
        for command in 0..10 {
            device.command(15 * u64::from(command), command);
        }
        assert_eq!(device.monitor.missed().len(), 8); // the first frame is not trusted
    }

    #[test]
    fn a_command_that_comes_later_than_its_count_says_has_a_lag() {
        let mut device = Device::new();
        let mut lags = Vec::new();
        for (millis, tick) in [(0, 61), (10, 62), (21, 63), (52, 0), (53, 1), (54, 2), (60, 3), (80, 4)] {
            device.command(millis, tick);
            lags.push(device.monitor.lag().as_millis());
        }
        // The first frame is not trusted. From the fourth on: a stall, its backlog, commands on time again, and a lost
        // period.
        assert_eq!(lags, [0, 0, 1, 22, 13, 4, 0, 10]);
    }

    #[test]
    fn a_monitor_of_a_run_without_an_end_keeps_the_latest_and_tells_the_same_of_them() {
        let (mut all, mut latest) = (Device::new(), Device::new());
        latest.monitor = latest.monitor.keeping(50);
        // That of MotionCommand, with a wrong checksum.
        let spoilt = Frame::standard(1154, &[7; 8]).unwrap();
        for period in 0..5000_u64 {
            // Every 37th command is late.
            let millis = 10 * period + if period.is_multiple_of(37) { 4 } else { 0 };
            for device in [&mut all, &mut latest] {
                device.command(millis, (period % 64) as u8);
                device.monitor.hear(Instant::from_micros(millis * 1000), &spoilt);
            }
            assert_eq!(all.monitor.lag(), latest.monitor.lag());
        }
        let kept = |device: &Device| (device.monitor.commands().len(), device.monitor.e2e.len());
        assert!(kept(&all).0 > 4000 && kept(&all).1 > 4000, "{:?}", kept(&all));
        assert!(kept(&latest).0 <= 100 && kept(&latest).1 <= 100, "{:?}", kept(&latest));
        assert_eq!(all.monitor.commands().last(), latest.monitor.commands().last());
        assert_eq!(all.monitor.frames(), latest.monitor.frames());
    }

    #[test]
    fn in_lock_step_latency_is_from_the_step_to_the_command() {
        let mut device = Device::new();
        device.command(0, 1);
        device.monitor.ask(Instant::from_micros(3000));
        device.command(10, 2);
        device.command(20, 3);
        let latencies: Vec<_> = device.monitor.commands().iter().map(|command| command.latency).collect();
        assert_eq!(latencies, [Some(Duration::from_millis(7)), None]);
    }

    #[test]
    fn latency_is_from_the_motion_that_the_device_says_its_command_rests_on() {
        use holdover::wire::motion::{Motion, WirePosition};
        let mut device = Device::new();
        for (millis, stamp) in [(2, 100), (12, 200), (22, 300)] {
            device.monitor.input(Instant::from_micros(millis * 1000), Stamp::from_raw(stamp));
        }
        for (millis, tick) in [(15, 1), (25, 2)] {
            device.command(millis, tick);
            let motion = Motion {
                tag: tick % 4,
                position: WirePosition::default(),
                speed: holdover::units::Speed::ZERO,
                acceleration: Acceleration::ZERO,
                demand: Acceleration::ZERO,
                stamp: Stamp::from_raw(200),
                position_accuracy: None,
                speed_accuracy: None,
                station: holdover::wire::StationHash(1),
            };
            let Device { sender, monitor } = &mut device;
            let at = Instant::from_micros(millis * 1000 + 100);
            let said = Message::Own(Said::Motion(motion));
            let mut hear = |frame: &holdover::wire::Frame| assert_eq!(monitor.hear(at, &frame.into()), News::Other);
            sender.send(&said, &mut |frame: holdover::wire::Frame| hear(&frame)).unwrap();
        }
        assert_eq!(device.monitor.commands().last().unwrap().latency, Some(Duration::from_millis(13)));
    }

    #[test]
    fn a_count_of_periods_that_begins_anew_after_a_gap_is_a_restart() {
        let mut device = Device::new();
        for (millis, tick) in [(0, 62), (10, 63), (20, 0), (80, 1), (90, 2), (750, 4), (760, 20)] {
            device.command(millis, tick);
        }
        assert_eq!(device.monitor.restarts(), []);
        device.sender = Sender::new(Identifiers::DEFAULT);
        for (millis, tick) in [(1000, 1), (1010, 2), (1020, 3), (1030, 4)] {
            device.command(millis, tick);
        }
        // A receiver needs some frames to trust the new counters.
        assert_eq!(device.monitor.restarts().len(), 1);
    }
}
