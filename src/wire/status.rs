//! `Health`: one refusal count in each frame, cause after cause, with the mode and the state of the time base.

use super::bits::Payload;
use super::command::ModeCode;
use super::field::Field;
use super::meaning::meaning;
use crate::health::Cause;

/// One page of the unit's state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Status {
    #[doc = meaning!(cause)]
    pub cause: Cause,
    #[doc = meaning!(count)]
    ///
    /// 0 to 16,777,215, saturating.
    pub count: u32,
    #[doc = meaning!(mode)]
    pub mode: ModeCode,
    #[doc = meaning!(detail)]
    ///
    /// 0 to 31.
    pub detail: u8,
    #[doc = meaning!(synchronised)]
    pub synchronised: bool,
    #[doc = meaning!(links_on)]
    pub links_on: u8,
    /// [`INTERFACE`] of the sender.
    pub interface: u8,
}

/// The version of the interface, 0 to 7: it changes with every change of the catalogue after which a node built for the catalogue
/// before it would misread a signal, or miss one that it needs.
pub const INTERFACE: u8 = 2;

/// Every cause of a fallback and of a fault, with its number.
const DETAILS: &[(i64, &str)] = &[
    (0, "none"),
    (1, "not associated"),
    (2, "never heard"),
    (3, "silent"),
    (4, "range disagrees"),
    (5, "request lost"),
    (8, "driver brakes"),
    (9, "driver accelerates"),
    (10, "actuators not ready"),
    (16, "ego missing"),
    (17, "ego stale"),
];

/// Every cause with its number.
static CAUSES: [(i64, &str); Cause::ALL.len()] = causes();

#[allow(clippy::indexing_slicing, clippy::arithmetic_side_effects, clippy::cast_possible_wrap)] // in const, a few
const fn causes() -> [(i64, &'static str); Cause::ALL.len()] {
    let mut causes = [(0, ""); Cause::ALL.len()];
    let mut number = 0;
    while number < causes.len() {
        causes[number] = (number as i64, Cause::ALL[number].name());
        number += 1;
    }
    causes
}

const CAUSE: Field = Field::unsigned("Cause", 12, 8).named(&CAUSES);
const COUNT: Field = Field::unsigned("Count", 20, 24);
const MODE: Field = ModeCode::field(44);
const DETAIL: Field = Field { values: DETAILS, ..Field::unsigned("Detail", 47, 5) };
const SYNCHRONISED: Field =
    Field::unsigned("Synchronised", 52, 1).named(&[(0, "no GNSS time"), (1, "GNSS time known")]);
const LINKS_ON: Field = Field::unsigned("LinksOn", 53, 8);
const INTERFACE_VERSION: Field = Field::unsigned("InterfaceVersion", 61, 3);

/// The frame.
pub const FIELDS: &[Field] = &[CAUSE, COUNT, MODE, DETAIL, SYNCHRONISED, LINKS_ON, INTERFACE_VERSION];

impl Status {
    /// The frame's payload; what does not fit is limited to its field's range.
    #[must_use]
    pub fn encode(&self) -> [Payload; 1] {
        let a = CAUSE.with_raw(Payload::EMPTY, self.cause as i64);
        let a = COUNT.with_raw(a, i64::from(self.count));
        let a = MODE.with_raw(a, self.mode as i64);
        let a = DETAIL.with_raw(a, i64::from(self.detail));
        let a = SYNCHRONISED.with_raw(a, i64::from(self.synchronised));
        let a = LINKS_ON.with_raw(a, i64::from(self.links_on));
        [INTERFACE_VERSION.with_raw(a, i64::from(self.interface))]
    }

    /// From the frame's payload.
    ///
    /// # Errors
    /// `Range` for the number of a cause that there is not.
    pub fn decode([a]: &[Payload; 1]) -> Result<Self, Cause> {
        Ok(Self {
            cause: Cause::ALL.get(usize::from(CAUSE.byte(*a))).copied().ok_or(Cause::Range)?,
            count: COUNT.word(*a),
            mode: ModeCode::from_raw(MODE.raw(*a)),
            detail: DETAIL.byte(*a),
            synchronised: SYNCHRONISED.raw(*a) != 0,
            links_on: LINKS_ON.byte(*a),
            interface: INTERFACE_VERSION.byte(*a),
        })
    }
}
