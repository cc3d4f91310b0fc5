//! `MotionCommand`: the unit's command to the actuators, in one frame every period.

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
    /// Demanded acceleration; ±16.38 m/s² by 2 mm/s².
    pub acceleration: Acceleration,
    /// The effort that brings it about by the configured vehicle model.
    pub effort: Effort,
    /// In which mode it was computed.
    pub mode: ModeCode,
    /// Whether the envelope changed it.
    pub limited: bool,
    /// Counts periods; modulo 64.
    pub tick: u8,
}
