//! The answer of one tick: the core's enters, plain numbers for C leave.

use holdover::controller::{FallbackCause, FaultCause};
use holdover::fixed::{PositionFormat, SpeedFormat, saturate_i32};

use crate::frame::Frame;

/// The most frames that one tick sends.
pub const HOLDOVER_MAX_FRAMES: usize = 20;

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
    /// No target to drive by: behind what is seen or still certain of it, else braking that grows slowly.
    Fallback = 3,
    /// The own motion is unknown, or what is heard and what is seen exclude one another: braking as configured.
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
    /// What the range sensor sees and what is heard of the target exclude one another.
    RangeDisagrees = 6,
    /// The driver's request has stopped coming: the unit hands back.
    RequestLost = 7,
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
    /// 1: the brakes are to hold the vehicle, which stands; else 0.
    pub hold: u8,
    /// Time since the first tick in ms; modulo 1024.
    pub time_ms: u16,
}

/// Where the target is now, as the unit believes.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
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
    /// 1: the four ends below are certain; 0: there is no bound, and they are 0.
    pub bounded: u8,
    /// It is not behind this, in mm, rounded down.
    pub lowest_position_mm: i64,
    /// It is not ahead of this, in mm, rounded up.
    pub highest_position_mm: i64,
    /// It is not slower, in mm/s, rounded down.
    pub lowest_speed_mm_s: i32,
    /// It is not faster, in mm/s, rounded up.
    pub highest_speed_mm_s: i32,
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
            hold: 0,
            time_ms: 0,
        },
        estimate: Estimate::NONE,
        frame_count: 0,
        frames: [Frame { id: 0, extended: 0, remote: 0, length: 0, data: [0; 8] }; HOLDOVER_MAX_FRAMES],
    };
}

impl Answer {
    /// Fills in what the core answered, where it lies: an answer is too large to be passed over the stack.
    pub fn fill(&mut self, answer: &holdover::Answer) {
        use holdover::wire::command::Effort as Core;
        let (mode, cause) = of_mode(&answer.mode);
        let command = &answer.command;
        let (effort, effort_value) = match command.effort {
            Core::Force(newtons) => (Effort::Force, newtons),
            Core::BrakeTorque(newton_metres) => (Effort::BrakeTorque, newton_metres),
        };
        self.command = Command {
            acceleration_mm_s2: command.acceleration.to_mm_per_s2(),
            effort,
            mode,
            cause,
            limited: u8::from(command.limited),
            effort_value,
            tick: command.tick,
            hold: u8::from(command.hold),
            time_ms: command.time_ms,
        };
        self.estimate = answer.estimate.as_ref().map_or(Estimate::NONE, Estimate::from);
        self.frame_count = 0;
        for (place, frame) in self.frames.iter_mut().zip(&answer.frames) {
            *place = Frame::from(frame);
            self.frame_count = self.frame_count.saturating_add(1);
        }
    }
}

impl Estimate {
    /// There is none.
    const NONE: Self = Self {
        position_mm: 0,
        age_us: 0,
        speed_mm_s: 0,
        valid: 0,
        link_on: 0,
        bounded: 0,
        lowest_position_mm: 0,
        highest_position_mm: 0,
        lowest_speed_mm_s: 0,
        highest_speed_mm_s: 0,
    };
}

impl From<&holdover::Estimate> for Estimate {
    fn from(estimate: &holdover::Estimate) -> Self {
        let plain = Self {
            position_mm: estimate.reading.position.to_mm(),
            age_us: estimate.age.as_micros(),
            speed_mm_s: estimate.reading.speed.to_mm_per_s(),
            valid: 1,
            link_on: u8::from(estimate.link_on),
            ..Self::NONE
        };
        let Some(bound) = &estimate.bound else { return plain };
        Self {
            bounded: 1,
            lowest_position_mm: milli_down(bound.lowest_position().to_bits(), PositionFormat::FRAC_NBITS),
            highest_position_mm: milli_up(bound.highest_position().to_bits(), PositionFormat::FRAC_NBITS),
            lowest_speed_mm_s: saturate_i32(milli_down(
                i64::from(bound.lowest_speed().to_bits()),
                SpeedFormat::FRAC_NBITS,
            )),
            highest_speed_mm_s: saturate_i32(milli_up(
                i64::from(bound.highest_speed().to_bits()),
                SpeedFormat::FRAC_NBITS,
            )),
            ..plain
        }
    }
}

/// Thousandths of a number with so many fraction bits, rounded down, saturating.
const fn milli_down(bits: i64, fraction: u32) -> i64 {
    let (whole, part) = (bits >> fraction, bits.wrapping_sub((bits >> fraction) << fraction));
    whole.saturating_mul(1000).saturating_add(part.wrapping_mul(1000) >> fraction) // a part is below 2^23
}

/// Likewise, rounded up.
const fn milli_up(bits: i64, fraction: u32) -> i64 {
    milli_down(bits.saturating_neg(), fraction).saturating_neg()
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
        Core::Fallback { cause: FallbackCause::RangeDisagrees, .. } => (Mode::Fallback, Cause::RangeDisagrees),
        Core::Fallback { cause: FallbackCause::RequestLost, .. } => (Mode::Fallback, Cause::RequestLost),
        Core::Fault { cause: FaultCause::EgoMissing, .. } => (Mode::Fault, Cause::EgoMissing),
        Core::Fault { cause: FaultCause::EgoStale, .. } => (Mode::Fault, Cause::EgoStale),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thousandths_are_rounded_to_the_side_that_is_asked_for() {
        let bits = |thousandths: f64| (thousandths / 1000.0 * f64::from(1 << 20)).round() as i64;
        for (value, down, up) in [(0.0, 0, 0), (1.5, 1, 2), (-1.5, -2, -1), (2_000_000.25, 2_000_000, 2_000_001)] {
            assert_eq!((milli_down(bits(value), 20), milli_up(bits(value), 20)), (down, up), "{value}");
        }
    }

    #[test]
    fn no_position_overflows() {
        assert_eq!(milli_down(i64::MIN, 20), -(1 << 43) * 1000);
        assert!(milli_up(i64::MAX, 20) >= ((1 << 43) - 1) * 1000);
    }
}
