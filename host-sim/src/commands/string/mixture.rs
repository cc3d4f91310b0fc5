//! Who drives the ten followers: lists of vehicles enter; the driver of each leaves.

use crate::error::Error;
use crate::input::scenario::{Driver, MAX_VEHICLES, SensorShare};

/// The followers that people drive; a unit drives every other one.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Mixture {
    /// Those whose units tell their states.
    pub people: Vec<usize>,
    /// Those without a unit.
    pub unequipped: Vec<usize>,
}

impl Mixture {
    /// Checks the lists.
    ///
    /// # Errors
    /// A vehicle that is not a follower, or is in both lists; lists of all vehicles; and a unit behind a vehicle that it neither hears nor
    /// sees.
    pub fn checked(mut people: Vec<usize>, mut unequipped: Vec<usize>, sensors: SensorShare) -> Result<Self, Error> {
        for list in [&mut people, &mut unequipped] {
            list.sort_unstable();
            list.dedup();
        }
        for (option, list) in [("--people", &people), ("--unequipped", &unequipped)] {
            if let Some(wrong) = list.iter().find(|vehicle| !(1..MAX_VEHICLES).contains(*vehicle)) {
                let remedy = format!("give followers, from 1 to {}", MAX_VEHICLES - 1);
                return Err(Error::new(format!("vehicle {wrong} is none of the followers"), remedy).in_option(option));
            }
        }
        if let Some(both) = people.iter().find(|vehicle| unequipped.contains(vehicle)) {
            let cause = format!("vehicle {both} is in `--unequipped` too");
            return Err(Error::new(cause, "leave it out of one of the two").in_option("--people"));
        }
        let mixture = Self { people, unequipped };
        let Some(_) = mixture.first_unit() else {
            let remedy = "leave one of them out of `--people` and `--unequipped`";
            return Err(Error::new("no vehicle is left that a unit drives", remedy));
        };
        let is_lost = |vehicle: &&usize| {
            let behind = **vehicle + 1;
            behind < MAX_VEHICLES && mixture.driver(behind) == Driver::Unit && !sensors.has(behind)
        };
        if let Some(lost) = mixture.unequipped.iter().find(is_lost) {
            let cause = format!("the unit behind vehicle {lost} neither hears it nor sees it");
            return Err(Error::new(cause, "give `--range-sensors on`").in_option("--unequipped"));
        }
        Ok(mixture)
    }

    /// The first follower that a unit drives.
    #[must_use]
    pub fn first_unit(&self) -> Option<usize> {
        (1..MAX_VEHICLES).find(|vehicle| self.driver(*vehicle) == Driver::Unit)
    }

    /// Whether people drive some of the vehicles.
    #[must_use]
    pub fn is_mixed(&self) -> bool {
        !(self.people.is_empty() && self.unequipped.is_empty())
    }

    /// Who drives a vehicle; the leader counts as a unit's.
    #[must_use]
    pub fn driver(&self, vehicle: usize) -> Driver {
        if self.unequipped.contains(&vehicle) {
            Driver::Unequipped
        } else if self.people.contains(&vehicle) {
            Driver::Person
        } else {
            Driver::Unit
        }
    }

    /// The options that say the same, with a space before each.
    #[must_use]
    pub fn command(&self) -> String {
        let option = |name: &str, list: &[usize]| {
            let list: Vec<String> = list.iter().map(usize::to_string).collect();
            if list.is_empty() { String::new() } else { format!(" {name} {}", list.join(",")) }
        };
        option("--people", &self.people) + &option("--unequipped", &self.unequipped)
    }
}
