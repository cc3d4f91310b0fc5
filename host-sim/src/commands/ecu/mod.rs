//! `ecu`: the onboard unit as a Linux process in place of a device. Frames of a CAN interface enter; the unit's answers
//! leave on it, by a clock every period, or in lock step with the bus's time synchronisation, until SIGINT or SIGTERM.

pub mod arguments;
pub mod options;

use std::io::{self, ErrorKind};

use holdover::health::Incident;
use holdover::time::{Duration, Instant};
use holdover::{Answer, Config, ConfigError, LockStep};

use crate::bus;
use crate::bus::port::{Event, Port};
use crate::commands::interruption::Interruption;
use crate::error::Error;
use crate::output;
use crate::sim::vehicle::Unit;
use crate::verdict::Verdict;
use options::{EcuOptions, heard};

/// Time from the start of its clock to its first tick. The stamp of a message may be from before that tick.
const POWERED_BEFORE: Duration = Duration::from_millis(60_000);

/// The most frames that it takes in before it checks its clock.
const AT_ONCE: usize = 256;
/// Time between two checks of the bus in lock step.
const PATIENCE: Duration = Duration::from_millis(100);

/// Runs the unit until SIGINT or SIGTERM.
///
/// # Errors
/// An interface that cannot be used, or that is removed.
pub fn run(options: &EcuOptions) -> Result<Verdict, Error> {
    let interruption = Interruption::awaited()?;
    let mut port = bus::open(&options.bus)?;
    let failed = |error: &io::Error| {
        let cause = format!("the interface failed: {error}");
        Error::new(cause, "see whether it is still there: ip -details link").in_option("--bus")
    };
    #[cfg(target_os = "linux")]
    port.hear_only(heard(&options.config.identifiers)).map_err(|error| failed(&error))?;
    let mut ecu = Ecu::new(&options.config, options.lock_step).map_err(|cause| {
        Error::new(format!("the unit refuses its configuration: {cause}"), "change the scenario accordingly")
    })?;
    output::say(&format!("a unit with station {} on {}", options.config.station.0, options.bus));
    live(&mut ecu, &mut port, &interruption).map_err(|error| failed(&error))?;
    Ok(Verdict::Pass)
}

/// Runs on a port until it is interrupted, which it notices within a tick or [`PATIENCE`]. As in the firmware, frames that have arrived are
/// taken in before the unit ticks. A flood of frames does not keep the unit from ticking.
fn live(ecu: &mut Ecu, port: &mut impl Port, interruption: &Interruption) -> io::Result<()> {
    while !interruption.is_asked() {
        let wake = ecu.wakes().unwrap_or(port.now().plus(PATIENCE));
        let mut until = if ecu.is_by_clock() && ecu.wakes().is_none() { port.now() } else { wake };
        for _ in 0..AT_ONCE {
            let Some((at, event)) = port.wait(until)? else { break };
            if let Event::Received(frame) = event
                && let Some(answer) = ecu.receive(at, &frame)
            {
                transmit(ecu, port, &answer)?;
            }
            until = wake;
        }
        if let Some(answer) = ecu.tick(port.now()) {
            transmit(ecu, port, &answer)?;
        }
    }
    Ok(())
}

/// Sends an answer. An interface that is down may come up again, and a full queue may empty.
fn transmit(ecu: &mut Ecu, port: &mut impl Port, answer: &Answer) -> io::Result<()> {
    for frame in &answer.frames {
        match port.send(frame.into()) {
            Ok(()) => {}
            Err(error) if matches!(error.kind(), ErrorKind::NetworkDown | ErrorKind::WouldBlock) => {
                ecu.unit.note(Incident::TransmitOverflow, 1);
            }
            Err(error) => return Err(error),
        }
    }
    Ok(())
}

/// The shell around the unit: frames and the time enter, answers leave.
#[derive(Clone, Debug)]
pub struct Ecu {
    unit: Unit,
    pace: Pace,
}

/// The source of the ticks.
#[derive(Clone, Debug)]
enum Pace {
    /// A clock of its own; the first tick is immediate.
    Clock {
        /// Time of its first tick, and of the next one.
        ticks: Option<(Instant, Instant)>,
    },
    /// The time synchronisation on the bus.
    LockStep(LockStep),
}

impl Ecu {
    /// A unit that was just powered up.
    ///
    /// # Errors
    /// An error of the unit's configuration.
    pub fn new(config: &Config, lock_step: bool) -> Result<Self, ConfigError> {
        let pace = if lock_step { Pace::LockStep(LockStep::new()) } else { Pace::Clock { ticks: None } };
        Ok(Self { unit: Unit::new(config)?, pace })
    }

    /// Time of the next tick, by the bus's time; `None`: at once, or when the bus triggers it.
    #[must_use]
    pub fn wakes(&self) -> Option<Instant> {
        match &self.pace {
            Pace::Clock { ticks } => ticks.map(|(_, next)| next),
            Pace::LockStep(_) => None,
        }
    }

    /// Whether it ticks by a clock of its own.
    fn is_by_clock(&self) -> bool {
        matches!(self.pace, Pace::Clock { .. })
    }

    /// Ticks if its clock is due. Missed periods are not made up for.
    pub fn tick(&mut self, now: Instant) -> Option<Answer> {
        let Pace::Clock { ticks } = &mut self.pace else { return None };
        let (start, due) = ticks.unwrap_or((now, now));
        if now < due {
            return None;
        }
        let period = self.unit.config().period;
        let passed = now.since(due).as_micros().div_euclid(period.as_micros());
        *ticks = Some((start, due.plus(period.times(passed + 1))));
        Some(self.unit.tick(local(start, now)))
    }

    /// Takes in a frame; in lock step it may make the unit tick.
    pub fn receive(&mut self, at: Instant, frame: &bus::Frame) -> Option<Answer> {
        match &mut self.pace {
            Pace::LockStep(lock_step) => lock_step.receive(&mut self.unit, frame),
            Pace::Clock { ticks } => {
                let (start, _) = (*ticks)?;
                let _ = self.unit.receive(local(start, at), frame); // the unit counts refusals
                None
            }
        }
    }
}

/// The unit's own clock at a time of the bus.
fn local(start: Instant, at: Instant) -> Instant {
    Instant::from_micros(0).plus(POWERED_BEFORE).plus(at.since(start))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bus::port::BusError;
    use holdover::wire::StationHash;

    /// A bus without other nodes, whose time passes in waits. It asks the unit to end at a time.
    struct Lonely {
        now: Instant,
        ends: Instant,
        sent: usize,
        interruption: Interruption,
    }

    impl Port for Lonely {
        fn now(&self) -> Instant {
            self.now
        }

        fn send(&mut self, _: bus::Frame) -> io::Result<()> {
            self.sent += 1;
            Ok(())
        }

        fn send_error(&mut self, _: BusError) -> io::Result<()> {
            Ok(())
        }

        fn wait(&mut self, until: Instant) -> io::Result<Option<(Instant, Event)>> {
            self.now = self.now.max(until);
            if self.now >= self.ends {
                self.interruption.ask();
            }
            Ok(None)
        }
    }

    #[test]
    fn it_runs_until_it_is_interrupted() {
        for (lock_step, ticks) in [(false, 11), (true, 0)] {
            let interruption = Interruption::default();
            let mut port = Lonely { now: at(0), ends: at(100), sent: 0, interruption: interruption.clone() };
            let mut ecu = Ecu::new(&Config::car(StationHash(1)), lock_step).unwrap();
            live(&mut ecu, &mut port, &interruption).unwrap();
            assert_eq!(port.now, at(100));
            assert!(port.sent >= ticks && (ticks > 0 || port.sent == 0), "{} frames", port.sent);
        }
    }

    fn at(millis: u64) -> Instant {
        Instant::from_micros(1_700_000_000_000_000 + millis * 1000)
    }

    #[test]
    fn it_ticks_every_period_from_its_first_look_at_the_clock_on() {
        let mut ecu = Ecu::new(&Config::car(StationHash(1)), false).unwrap();
        let ticked: Vec<u64> = (0..35).filter(|millis| ecu.tick(at(*millis)).is_some()).collect();
        assert_eq!(ticked, [0, 10, 20, 30]);
        assert_eq!(ecu.wakes(), Some(at(40)));
    }

    #[test]
    fn periods_that_it_slept_through_are_left_out_and_the_beat_is_kept() {
        let mut ecu = Ecu::new(&Config::car(StationHash(1)), false).unwrap();
        assert!(ecu.tick(at(0)).is_some() && ecu.tick(at(37)).is_some() && ecu.tick(at(38)).is_none());
        assert_eq!(ecu.wakes(), Some(at(40)));
    }
}
