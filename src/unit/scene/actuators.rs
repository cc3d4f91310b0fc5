//! What the actuators and the driver's feet say: their messages enter; why the unit must not drive, if it must not, leaves.
//!
//! The brake pedal hands back for good: the driver has taken over until the request was off once. The accelerator pedal hands back for
//! as long as it is pressed. Actuators that do not take commands make the unit stand by, so that it does not tell others that it drives
//! by its law. A vehicle that never sends the message is taken to have actuators that are ready.
//!
//! What the message said last holds, so that its loss never starts a vehicle whose driver has a foot on a pedal. A request that is off
//! ends that once the message has been silent for [`SILENT`]: the driver who asks anew is not held to a pedal that nobody reports.
//!
//! The message acknowledges a command by its number. Actuators that go on to acknowledge none, or old ones, are named, and nothing else:
//! the unit may be wrong about them, and to stand by would leave a moving vehicle to nobody.

use crate::health::Cause;
use crate::held::Held;
use crate::time::{Duration, Instant};
use crate::wire::actuators::{ActuatorState, Control};
use crate::wire::command::TICKS;

/// Why a unit that is asked to drive stands by; the number is `Detail` on the wire.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub(in crate::unit) enum StandbyCause {
    /// The driver has braked.
    DriverBrakes = 8,
    /// The driver accelerates.
    DriverAccelerates = 9,
    /// The actuators do not take commands.
    ActuatorsNotReady = 10,
}

/// Ten cycles of the message.
const SILENT: Duration = Duration::from_millis(200);
/// The actuators' timeout of `MotionCommand`: an older command is not in force.
const IN_FORCE: Duration = Duration::from_millis(50);
/// After so long without an acknowledgement of a command in force the actuators are named.
const UNHEEDED: Duration = Duration::from_millis(200);

/// What was said.
#[derive(Clone, Copy, Debug)]
pub(in crate::unit) struct Actuators {
    told: Held<ActuatorState>,
    told_at: Instant,
    has_taken_over: bool,
    /// The number of the newest command.
    commanded: u8,
    /// Since when no command in force has been acknowledged.
    unheeded: Held<Instant>,
    is_named: bool,
}

impl Actuators {
    /// Nothing was said: all zero.
    pub(super) const NONE: Self = Self {
        told: Held::Nothing,
        told_at: Instant::from_micros(0),
        has_taken_over: false,
        commanded: 0,
        unheeded: Held::Nothing,
        is_named: false,
    };

    /// Takes in a message while the unit is asked to drive or not; tells that a pedal takes over from the unit, or that the actuators do
    /// not do what they are commanded every `period`.
    pub(super) fn take(
        &mut self,
        at: Instant,
        state: ActuatorState,
        is_asked: bool,
        period: Duration,
    ) -> Option<Cause> {
        let before = self.cause();
        self.told.set(state);
        self.told_at = at;
        self.has_taken_over |= state.brake && is_asked;
        let is_unheeded = self.is_unheeded(at, state, is_asked, period);
        let is_driver = |cause| matches!(cause, Some(StandbyCause::DriverBrakes | StandbyCause::DriverAccelerates));
        if is_asked && !is_driver(before) && is_driver(self.cause()) {
            return Some(Cause::DriverOverride);
        }
        is_unheeded.then_some(Cause::CommandUnheeded)
    }

    /// Takes note of the number of the command that goes out.
    pub fn note_command(&mut self, tick: u8) {
        self.commanded = tick;
    }

    /// Whether it shows now that no command has been in force for long.
    fn is_unheeded(&mut self, at: Instant, state: ActuatorState, is_asked: bool, period: Duration) -> bool {
        let age = period.times(i64::from(self.commanded.wrapping_sub(state.tick) % TICKS));
        let is_heeded = state.control == Control::Driving && age <= IN_FORCE;
        if is_heeded || !is_asked || self.cause().is_some() {
            (self.unheeded, self.is_named) = (Held::Nothing, false);
            return false;
        }
        let since = self.unheeded.get().unwrap_or(at);
        self.unheeded.set(since);
        let is_news = at.since(since) > UNHEEDED && !self.is_named;
        self.is_named |= is_news;
        is_news
    }

    /// Takes note of whether the unit is asked to drive.
    pub(super) fn ask(&mut self, at: Instant, is_asked: bool) {
        self.has_taken_over &= is_asked;
        let is_silent = at.since(self.told_at) > SILENT;
        if let Held::Value(state) = &mut self.told
            && is_silent
            && !is_asked
        {
            (state.brake, state.accelerator) = (false, false);
        }
    }

    /// Why the unit must not drive.
    pub fn cause(&self) -> Option<StandbyCause> {
        if self.has_taken_over {
            return Some(StandbyCause::DriverBrakes);
        }
        match self.told.as_ref() {
            Some(state) if state.brake => Some(StandbyCause::DriverBrakes),
            Some(state) if state.accelerator => Some(StandbyCause::DriverAccelerates),
            Some(state) if matches!(state.control, Control::Off | Control::Failed) => {
                Some(StandbyCause::ActuatorsNotReady)
            }
            _ => None,
        }
    }
}
