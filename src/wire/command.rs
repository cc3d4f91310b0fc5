//! `MotionCommand`: the unit's command to the actuators, in one frame every period.

use super::bits::Payload;
use super::field::Field;
use super::meaning::meaning;
use crate::units::Acceleration;

/// What brings the demanded acceleration about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Effort {
    /// Net engine force, `F_net`; 0 to 65,534 N.
    Force(u16),
    /// Brake torque, `T_br`; 0 to 65,534 N·m.
    BrakeTorque(u16),
}

/// The mode as it stands on the wire; the unit's own modes carry more.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum ModeCode {
    /// Not engaged: the command is not to be used.
    #[default]
    Standby = 0,
    /// Driving by fresh messages.
    Cooperative = 1,
    /// Driving by the estimate, the link being off.
    Holdover = 2,
    /// Driving by what is left: no usable target.
    Fallback = 3,
    /// Own state unknown: braking as configured.
    Fault = 4,
}

/// The command of one period.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Command {
    #[doc = meaning!(command_acceleration)]
    ///
    /// ±16.382 m/s² by 2 mm/s².
    pub acceleration: Acceleration,
    /// The effort that brings it about by the configured vehicle model.
    pub effort: Effort,
    #[doc = meaning!(mode)]
    pub mode: ModeCode,
    #[doc = meaning!(limited)]
    pub limited: bool,
    #[doc = meaning!(tick)]
    ///
    /// Modulo 64.
    pub tick: u8,
    #[doc = meaning!(hold)]
    pub hold: bool,
    #[doc = meaning!(time)]
    ///
    /// By 1 ms, 0 to 1023.
    pub time_ms: u16,
}

impl Command {
    /// Before anything was commanded.
    pub(crate) const NONE: Self = Self {
        acceleration: Acceleration::ZERO,
        effort: Effort::Force(0),
        mode: ModeCode::Standby,
        limited: false,
        tick: 0,
        hold: false,
        time_ms: 0,
    };
}

/// Commands are counted modulo this.
pub(crate) const TICKS: u8 = 64;

/// Names of the modes.
const MODES: &[(i64, &str)] = &[(0, "standby"), (1, "cooperative"), (2, "holdover"), (3, "fallback"), (4, "fault")];

impl ModeCode {
    /// The mode's field, shared with `Health`.
    pub(super) const fn field(start: u32) -> Field {
        Field::unsigned("Mode", start, 3).named(MODES)
    }

    /// Of a raw value; an unknown one is a fault (the field's limits exclude it).
    pub(super) const fn from_raw(raw: i64) -> Self {
        match raw {
            0 => Self::Standby,
            1 => Self::Cooperative,
            2 => Self::Holdover,
            3 => Self::Fallback,
            _ => Self::Fault,
        }
    }
}

/// Steps of the acceleration in 1 m/s².
pub const ACCELERATION_STEPS: i64 = 500;
/// The most of them that the frame can say, either way.
pub const ACCELERATION_MOST: i64 = 8_191;

const ACCELERATION: Field = Field::signed("Acceleration", 12, 14).steps(ACCELERATION_STEPS, "m/s2");
const MODE: Field = ModeCode::field(26);
const LIMITED: Field = Field::unsigned("Limited", 29, 1).named(&[(0, "as computed"), (1, "changed by the envelope")]);
const TICK: Field = Field::unsigned("Tick", 30, 6);
const EFFORT: Field = Field { values: &[(0, "force"), (1, "brake torque")], ..Field::selector("Effort", 36, 1, 2) };
const FORCE: Field = Field::unsigned("Force", 37, 16).limits(0, 65_534).steps(1, "N").part(0);
const BRAKE_TORQUE: Field = Field::unsigned("BrakeTorque", 37, 16).limits(0, 65_534).steps(1, "Nm").part(1);

const HOLD: Field = Field::unsigned("Hold", 53, 1).named(&[(0, "no hold"), (1, "hold at standstill")]);
const TIME: Field = Field::unsigned("Time", 54, 10).steps(1000, "s");

/// The frame; the effort's kind selects which of its two readings applies.
pub const FIELDS: &[Field] = &[ACCELERATION, MODE, LIMITED, TICK, EFFORT, FORCE, BRAKE_TORQUE, HOLD, TIME];

impl Command {
    /// The frame's payload; what does not fit is limited to its field's range.
    #[must_use]
    pub fn encode(&self) -> [Payload; 1] {
        let a = ACCELERATION.with(Payload::EMPTY, self.acceleration);
        let a = MODE.with_raw(a, self.mode as i64);
        let a = LIMITED.with_raw(a, i64::from(self.limited));
        let a = TICK.with_raw(a, i64::from(self.tick & 63));
        let a = HOLD.with_raw(a, i64::from(self.hold));
        let a = TIME.with_raw(a, i64::from(self.time_ms & 1023));
        [match self.effort {
            Effort::Force(newtons) => FORCE.with_raw(EFFORT.with_raw(a, 0), i64::from(newtons)),
            Effort::BrakeTorque(newton_metres) => {
                BRAKE_TORQUE.with_raw(EFFORT.with_raw(a, 1), i64::from(newton_metres))
            }
        }]
    }

    /// From the frame's payload; every payload within the fields' limits is a command.
    #[must_use]
    #[allow(clippy::cast_possible_truncation)] // fields of 16 bits
    pub fn decode([a]: &[Payload; 1]) -> Self {
        Self {
            acceleration: ACCELERATION.get(*a),
            effort: if EFFORT.raw(*a) == 0 {
                Effort::Force(FORCE.word(*a) as u16)
            } else {
                Effort::BrakeTorque(BRAKE_TORQUE.word(*a) as u16)
            },
            mode: ModeCode::from_raw(MODE.raw(*a)),
            limited: LIMITED.raw(*a) != 0,
            tick: TICK.byte(*a),
            hold: HOLD.raw(*a) != 0,
            time_ms: TIME.word(*a) as u16,
        }
    }
}
