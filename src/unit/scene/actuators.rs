//! What the actuators and the driver's feet say: their messages enter; why the unit must not drive, if it must not, leaves.
//!
//! The brake pedal hands back for good: the driver has taken over until the request was off once. The accelerator pedal hands back for
//! as long as it is pressed. Actuators that do not take commands make the unit stand by, so that it does not tell others that it drives
//! by its law. A vehicle that never sends the message is taken to have actuators that are ready.
//!
//! What the message said last holds, so that its loss never starts a vehicle whose driver has a foot on a pedal. A request that is off
//! ends that once the message has been silent for [`SILENT`]: the driver who asks anew is not held to a pedal that nobody reports.

use crate::held::Held;
use crate::time::{Duration, Instant};
use crate::wire::actuators::{ActuatorState, Control};

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

/// What was said.
#[derive(Clone, Copy, Debug)]
pub(in crate::unit) struct Actuators {
    told: Held<ActuatorState>,
    told_at: Instant,
    has_taken_over: bool,
}

impl Actuators {
    /// Nothing was said: all zero.
    pub(super) const NONE: Self = Self { told: Held::Nothing, told_at: Instant::from_micros(0), has_taken_over: false };

    /// Takes in a message while the unit is asked to drive or not; whether a pedal takes over from the unit.
    pub(super) fn take(&mut self, at: Instant, state: ActuatorState, is_asked: bool) -> bool {
        let before = self.cause();
        self.told.set(state);
        self.told_at = at;
        self.has_taken_over |= state.brake && is_asked;
        let is_driver = |cause| matches!(cause, Some(StandbyCause::DriverBrakes | StandbyCause::DriverAccelerates));
        is_asked && !is_driver(before) && is_driver(self.cause())
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
