//! What a page asks for: JSON enters; an order leaves.

use serde::Deserialize;

use crate::error::{Error, shown};
use crate::input::scenario::{Change, DRIVEN_MPS2, Event, OUTAGES_S, Part, Radio};

/// The longest way back, and the most ticks at once.
const LONGEST_BACK_S: f64 = 86_400.0;
const MOST_TICKS: u32 = 10_000;
/// The slowest and the fastest pace.
const PACES: std::ops::RangeInclusive<f64> = 0.01..=20.0;

/// An order.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(tag = "do", rename_all = "snake_case", deny_unknown_fields)]
pub enum Order {
    /// Time stands still.
    Pause {},
    /// Time goes on.
    Play {},
    /// So many ticks, and then time stands still.
    Step {
        /// How many.
        ticks: u32,
    },
    /// So many seconds of the run in a second.
    Pace {
        /// How many.
        factor: f64,
    },
    /// So many seconds back: the run is played again up to then.
    Back {
        /// How many.
        seconds: f64,
    },
    /// From the beginning, without what was driven and changed.
    Restart {},
    /// A person drives.
    Drive {
        /// Which vehicle.
        vehicle: usize,
        /// The acceleration that the pedals ask for.
        mps2: f64,
    },
    /// The person lets go.
    Release {
        /// Which vehicle.
        vehicle: usize,
    },
    /// Delay and loss.
    Links {
        /// Of which vehicle; of all without.
        vehicle: Option<usize>,
        /// Mean of the delay.
        delay_mean_s: f64,
        /// Spread of the delay.
        delay_std_s: f64,
        /// Share of messages lost.
        loss: f64,
    },
    /// Silence.
    Outage {
        /// Of which vehicle; of all without.
        vehicle: Option<usize>,
        /// For how long; 0 ends it.
        seconds: f64,
    },
    /// On or off.
    Switch {
        /// Of which vehicle; of all without.
        vehicle: Option<usize>,
        /// What.
        part: Part,
        /// Which of the two.
        on: bool,
    },
}

impl Order {
    /// Reads an order.
    ///
    /// # Errors
    /// No order, or one with an impossible number.
    pub fn read(bytes: &[u8]) -> Result<Self, Error> {
        let order: Self = serde_json::from_slice(bytes).map_err(|error| {
            Error::new(format!("the order is none ({error})"), "see docs/LIVE.md for the orders and their values")
        })?;
        let refused = |cause: String, remedy: &str| Err(Error::new(cause, remedy));
        match order {
            Self::Step { ticks } if !(1..=MOST_TICKS).contains(&ticks) => {
                refused(format!("`ticks` is {ticks}"), "give a number from 1 to 10000")
            }
            Self::Pace { factor } if !PACES.contains(&factor) => {
                refused(format!("`factor` is {}", shown(factor)), "give a number from 0.01 to 20")
            }
            Self::Back { seconds } if !(0.0..=LONGEST_BACK_S).contains(&seconds) => {
                refused(format!("`seconds` is {}", shown(seconds)), "give a number from 0 to 86400")
            }
            Self::Drive { mps2, .. } if !DRIVEN_MPS2.contains(&mps2) => {
                refused(format!("`mps2` is {}", shown(mps2)), "give m/s² from -12 to 12")
            }
            Self::Outage { seconds, .. } if !OUTAGES_S.contains(&seconds) => {
                refused(format!("`seconds` is {}", shown(seconds)), "give seconds from 0 to 600")
            }
            order => Ok(order),
        }
    }

    /// The event that it is, if it changes something in the world.
    #[must_use]
    pub fn event(self, at_s: f64) -> Option<Event> {
        let (vehicle, change) = match self {
            Self::Drive { vehicle, mps2 } => (Some(vehicle), Change::Drive(mps2)),
            Self::Release { vehicle } => (Some(vehicle), Change::Release),
            Self::Links { vehicle, delay_mean_s, delay_std_s, loss } => {
                (vehicle, Change::Links(Radio { delay_mean_s, delay_std_s, loss }))
            }
            Self::Outage { vehicle, seconds } => (vehicle, Change::Outage(seconds)),
            Self::Switch { vehicle, part, on } => (vehicle, Change::Switch(part, on)),
            _ => return None,
        };
        Some(Event { at_s, vehicle, change })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_order_is_read_and_what_is_none_is_refused() {
        assert_eq!(Order::read(br#"{"do":"pause"}"#), Ok(Order::Pause {}));
        let switch = Order::Switch { vehicle: None, part: Part::RangeSensor, on: false };
        assert_eq!(Order::read(br#"{"do":"switch","part":"range_sensor","on":false}"#), Ok(switch));
        for none in ["", "{}", r#"{"do":"fly"}"#, r#"{"do":"pause","x":1}"#, r#"{"do":"drive","vehicle":-1,"mps2":0}"#]
        {
            let said = Order::read(none.as_bytes()).unwrap_err().to_string();
            assert!(said.starts_with("the order is none (") && said.contains("docs/LIVE.md"), "{said}");
        }
        let said = Order::read(br#"{"do":"pace","factor":0}"#).unwrap_err().to_string();
        assert_eq!(said, "`factor` is 0; give a number from 0.01 to 20");
    }
}
