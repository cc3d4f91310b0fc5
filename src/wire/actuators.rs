//! `ActuatorState`: what the actuators make of the unit's commands, and what the driver does with the pedals, in one frame.

use super::bits::Payload;
use super::field::Field;
use super::meaning::meaning;

/// Whether the actuators take the unit's commands.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum Control {
    /// They are off.
    #[default]
    Off = 0,
    /// They would take them.
    Ready = 1,
    /// They take them.
    Driving = 2,
    /// They cannot take them.
    Failed = 3,
}

/// What the actuators say.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ActuatorState {
    #[doc = meaning!(control)]
    pub control: Control,
    #[doc = meaning!(accelerator)]
    pub accelerator: bool,
    #[doc = meaning!(brake)]
    pub brake: bool,
    #[doc = meaning!(holding)]
    pub holding: bool,
    #[doc = meaning!(acknowledged)]
    ///
    /// Modulo 64.
    pub tick: u8,
}

const CONTROLS: &[(i64, &str)] = &[(0, "off"), (1, "ready"), (2, "driving"), (3, "failed")];
const CONTROL: Field = Field::unsigned("Control", 12, 2).named(CONTROLS);
const ACCELERATOR: Field = Field::unsigned("Accelerator", 14, 1).named(&[(0, "released"), (1, "pressed")]);
const BRAKE: Field = Field::unsigned("Brake", 15, 1).named(&[(0, "released"), (1, "pressed")]);
const HOLDING: Field = Field::unsigned("Holding", 16, 1).named(&[(0, "not held"), (1, "held at standstill")]);
const TICK: Field = Field::unsigned("Tick", 17, 6);

/// The frame.
pub const FIELDS: &[Field] = &[CONTROL, ACCELERATOR, BRAKE, HOLDING, TICK];

impl ActuatorState {
    /// The frame's payload.
    #[must_use]
    pub fn encode(&self) -> [Payload; 1] {
        let a = CONTROL.with_raw(Payload::EMPTY, self.control as i64);
        let a = ACCELERATOR.with_raw(a, i64::from(self.accelerator));
        let a = BRAKE.with_raw(a, i64::from(self.brake));
        let a = HOLDING.with_raw(a, i64::from(self.holding));
        [TICK.with_raw(a, i64::from(self.tick & 63))]
    }

    /// From the frame's payload; every payload is a state.
    #[must_use]
    pub fn decode([a]: &[Payload; 1]) -> Self {
        Self {
            control: match CONTROL.raw(*a) {
                0 => Control::Off,
                1 => Control::Ready,
                2 => Control::Driving,
                _ => Control::Failed,
            },
            accelerator: ACCELERATOR.raw(*a) != 0,
            brake: BRAKE.raw(*a) != 0,
            holding: HOLDING.raw(*a) != 0,
            tick: TICK.byte(*a),
        }
    }
}
