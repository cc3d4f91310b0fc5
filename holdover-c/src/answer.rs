//! The answer of one tick: the core's enters, plain numbers for C leave.

use holdover::controller::{FallbackCause, FaultCause};

use crate::frame::Frame;

/// The most frames that one tick sends.
pub const HOLDOVER_MAX_FRAMES: usize = 16;

const _: () = assert!(HOLDOVER_MAX_FRAMES == holdover::MAX_FRAMES);

/// In which mode a command was computed.
#[repr(u8)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// Not engaged: the command is not to be used.
    Standby = 0,
    /// Driving by fresh messages, or leading.
    Cooperative = 1,
    /// Driving by the estimate, the link being off.
    Holdover = 2,
    /// No target to drive by: braking that grows slowly.
    Fallback = 3,
    /// The own motion is unknown: braking as configured.
    Fault = 4,
}

/// Why it is in a fallback or a fault.
#[repr(u8)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cause {
    /// It is in neither.
    None = 0,
    /// Nobody said whom to follow.
    NotAssociated = 1,
    /// The target was never heard.
    NeverHeard = 2,
    /// The target has been silent for longer than a holdover lasts.
    Silent = 3,
    /// The own motion never came.
    EgoMissing = 4,
    /// The own motion has stopped coming.
    EgoStale = 5,
}

/// What brings the acceleration about.
#[repr(u8)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effort {
    /// Net engine force in N.
    Force = 0,
    /// Brake torque in N m.
    BrakeTorque = 1,
}

/// The command to the actuators.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Command {
    /// Demanded acceleration in mm/s2, rounded to nearest; negative: braking.
    pub acceleration_mm_s2: i32,
    /// What brings it about by the configured vehicle model.
    pub effort: Effort,
    /// In which mode it was computed.
    pub mode: Mode,
    /// Why it is in a fallback or a fault.
    pub cause: Cause,
    /// 1: the envelope changed it; else 0.
    pub limited: u8,
    /// How much of the effort, in N or N m; up to 65,534.
    pub effort_value: u16,
    /// Counts ticks; modulo 64.
    pub tick: u8,
}

/// Where the target is now, as the unit believes.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Estimate {
    /// Front bumper of the target along the lane in mm, rounded to nearest.
    pub position_mm: i64,
    /// Age of the newest sample that it rests on in us; negative: its stamp lies ahead of the clock.
    pub age_us: i64,
    /// Its speed in mm/s, rounded to nearest.
    pub speed_mm_s: i32,
    /// 1: there is an estimate; 0: there is none, and all the rest is 0.
    pub valid: u8,
    /// 1: the link to the target is on; else 0.
    pub link_on: u8,
}

/// The answer of one tick.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Answer {
    /// The command to the actuators.
    pub command: Command,
    /// The estimate of the target.
    pub estimate: Estimate,
    /// How many frames there are to send.
    pub frame_count: u32,
    /// The frames, in the order in which they are to be sent; the rest is 0.
    pub frames: [Frame; HOLDOVER_MAX_FRAMES],
}

impl Answer {
    /// What a caller gets who does not get an answer: a command that is not to be used, and nothing to send.
    pub const NONE: Self = Self {
        command: Command {
            acceleration_mm_s2: 0,
            effort: Effort::Force,
            mode: Mode::Standby,
            cause: Cause::None,
            limited: 0,
            effort_value: 0,
            tick: 0,
        },
        estimate: Estimate { position_mm: 0, age_us: 0, speed_mm_s: 0, valid: 0, link_on: 0 },
        frame_count: 0,
        frames: [Frame { id: 0, extended: 0, remote: 0, length: 0, data: [0; 8] }; HOLDOVER_MAX_FRAMES],
    };
}

impl From<&holdover::Answer> for Answer {
    fn from(answer: &holdover::Answer) -> Self {
        use holdover::wire::command::Effort as Core;
        let (mode, cause) = of_mode(&answer.mode);
        let command = &answer.command;
        let (effort, effort_value) = match command.effort {
            Core::Force(newtons) => (Effort::Force, newtons),
            Core::BrakeTorque(newton_metres) => (Effort::BrakeTorque, newton_metres),
        };
        let mut plain = Self {
            command: Command {
                acceleration_mm_s2: command.acceleration.to_mm_per_s2(),
                effort,
                mode,
                cause,
                limited: u8::from(command.limited),
                effort_value,
                tick: command.tick,
            },
            estimate: answer.estimate.as_ref().map_or(Estimate::default(), Estimate::from),
            ..Self::NONE
        };
        for (place, frame) in plain.frames.iter_mut().zip(&answer.frames) {
            *place = Frame::from(frame);
            plain.frame_count = plain.frame_count.saturating_add(1);
        }
        plain
    }
}

impl From<&holdover::Estimate> for Estimate {
    fn from(estimate: &holdover::Estimate) -> Self {
        Self {
            position_mm: estimate.reading.position.to_mm(),
            age_us: estimate.age.as_micros(),
            speed_mm_s: estimate.reading.speed.to_mm_per_s(),
            valid: 1,
            link_on: u8::from(estimate.link_on),
        }
    }
}

const fn of_mode(mode: &holdover::controller::Mode) -> (Mode, Cause) {
    use holdover::controller::Mode as Core;
    match mode {
        Core::Standby => (Mode::Standby, Cause::None),
        Core::Cooperative => (Mode::Cooperative, Cause::None),
        Core::Holdover { .. } => (Mode::Holdover, Cause::None),
        Core::Fallback { cause: FallbackCause::NotAssociated, .. } => (Mode::Fallback, Cause::NotAssociated),
        Core::Fallback { cause: FallbackCause::NeverHeard, .. } => (Mode::Fallback, Cause::NeverHeard),
        Core::Fallback { cause: FallbackCause::Silent, .. } => (Mode::Fallback, Cause::Silent),
        Core::Fault { cause: FaultCause::EgoMissing, .. } => (Mode::Fault, Cause::EgoMissing),
        Core::Fault { cause: FaultCause::EgoStale, .. } => (Mode::Fault, Cause::EgoStale),
    }
}
