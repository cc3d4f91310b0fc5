//! The faults of a run: the text of the command line enters, a schedule of faults leaves.
//!
//! ```text
//! KIND[=VALUE]@START[:DURATION]      seconds of the run
//! ```

use std::str::FromStr;

use crate::error::{Error, quoted};

/// A fault of the device, or of its bus.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// The device's power is cut.
    Power,
    /// The interface is taken down.
    Interface,
    /// A node babbles at the highest priority, with as many frames as the bus carries.
    Babble,
    /// Every third frame to the device has a flipped bit.
    Corrupt,
    /// Every third frame to the device is shortened.
    Truncate,
    /// Another node sends on the vehicle's identifiers that the vehicle is at another place.
    Foreign,
    /// A hundred error frames per second.
    Errors,
    /// The time synchronisation is wrong by this many seconds.
    ClockStep(f64),
    /// The time synchronisation is fast by this many parts per million.
    ClockDrift(f64),
}

/// A fault and its time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fault {
    /// The kind of fault.
    pub kind: Kind,
    /// Beginning, in seconds of the run.
    pub from_s: f64,
    /// End, in seconds of the run.
    pub to_s: f64,
}

/// Kinds by name, with their default duration, and a default value where they take one.
const KINDS: [(&str, Kind, f64); 9] = [
    ("power", Kind::Power, 1.0),
    ("interface", Kind::Interface, 1.0),
    ("babble", Kind::Babble, 1.0),
    ("corrupt", Kind::Corrupt, 1.0),
    ("truncate", Kind::Truncate, 1.0),
    ("foreign", Kind::Foreign, 1.0),
    ("errors", Kind::Errors, 1.0),
    ("clock-step", Kind::ClockStep(0.1), 2.0),
    ("clock-drift", Kind::ClockDrift(1000.0), 5.0),
];

impl Kind {
    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        let same = |kind: &Kind| std::mem::discriminant(kind) == std::mem::discriminant(&self);
        KINDS.iter().find(|(_, kind, _)| same(kind)).map_or("", |(name, ..)| name)
    }

    fn with(self, value: f64) -> Option<Self> {
        match self {
            Self::ClockStep(_) if value.abs() <= 10.0 => Some(Self::ClockStep(value)),
            Self::ClockDrift(_) if value.abs() <= 1e5 => Some(Self::ClockDrift(value)),
            _ => None,
        }
    }

    /// The error of the time synchronisation after this many seconds of the fault, in seconds.
    #[must_use]
    pub fn clock_error_s(self, after_s: f64) -> f64 {
        match self {
            Self::ClockStep(step_s) => step_s,
            Self::ClockDrift(millionths) => millionths * 1e-6 * after_s,
            _ => 0.0,
        }
    }
}

impl Fault {
    /// Whether the fault is on at this time.
    #[must_use]
    pub fn is_on(&self, at_s: f64) -> bool {
        (self.from_s..self.to_s).contains(&at_s)
    }
}

impl FromStr for Fault {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self, Error> {
        let wrong = |cause: String| Error::new(cause, FORM).in_option("--fault");
        let (what, when) = text.split_once('@').ok_or_else(|| wrong(format!("{} has no @", quoted(text))))?;
        let (name, value) = what.split_once('=').map_or((what, None), |(name, value)| (name, Some(value)));
        let number = |text: &str| {
            let number = text.parse::<f64>().ok().filter(|number| number.is_finite());
            number.ok_or_else(|| wrong(format!("{} is no number", quoted(text))))
        };
        let (_, kind, usual_s) = KINDS
            .into_iter()
            .find(|(other, ..)| *other == name)
            .ok_or_else(|| wrong(format!("there is no fault {}", quoted(name))))?;
        let kind = match value {
            None => kind,
            Some(value) => {
                let value = number(value)?;
                kind.with(value).ok_or_else(|| wrong(format!("{name} cannot have the value {value}")))?
            }
        };
        let (from, length) = when.split_once(':').map_or((when, None), |(from, length)| (from, Some(length)));
        let (from_s, length_s) = (number(from)?, length.map_or(Ok(usual_s), number)?);
        if from_s < 0.0 || length_s <= 0.0 {
            return Err(wrong(format!("{} is not within the run", quoted(when))));
        }
        Ok(Self { kind, from_s, to_s: from_s + length_s })
    }
}

const FORM: &str = "give KIND[=VALUE]@START[:DURATION] in seconds, with power, interface, babble, corrupt, truncate, foreign, \
                    errors, clock-step=SECONDS or clock-drift=MILLIONTHS for KIND";

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Fault, String> {
        text.parse().map_err(|error: Error| error.cause().to_owned())
    }

    #[test]
    fn a_fault_has_a_kind_a_start_and_a_usual_duration() {
        assert_eq!(read("power@5"), Ok(Fault { kind: Kind::Power, from_s: 5.0, to_s: 6.0 }));
        assert_eq!(read("babble@2.5:0.5"), Ok(Fault { kind: Kind::Babble, from_s: 2.5, to_s: 3.0 }));
        assert_eq!(read("clock-step=-0.2@3"), Ok(Fault { kind: Kind::ClockStep(-0.2), from_s: 3.0, to_s: 5.0 }));
        assert!(KINDS.iter().all(|(name, kind, _)| kind.name() == *name));
    }

    #[test]
    fn what_is_wrong_with_a_fault_is_said() {
        assert_eq!(read("power"), Err("\"power\" has no @".into()));
        assert_eq!(read("fire@5"), Err("there is no fault \"fire\"".into()));
        assert_eq!(read("power@x"), Err("\"x\" is no number".into()));
        assert_eq!(read("power=3@1"), Err("power cannot have the value 3".into()));
        assert_eq!(read("clock-step=11@1"), Err("clock-step cannot have the value 11".into()));
        assert_eq!(read("power@5:0"), Err("\"5:0\" is not within the run".into()));
    }

    #[test]
    fn a_fault_is_on_from_its_start_to_before_its_end() {
        let fault = read("errors@2:1").unwrap();
        assert_eq!([1.99, 2.0, 2.99, 3.0].map(|at_s| fault.is_on(at_s)), [false, true, true, false]);
        assert!((Kind::ClockDrift(200.0).clock_error_s(3.0) - 6e-4).abs() < 1e-12);
        assert_eq!(Kind::ClockStep(0.1).clock_error_s(3.0), 0.1);
    }
}
