//! What the modem tells its unit of stations without a slot: the stations heard and those relayed enter, the message
//! leaves.

use holdover::units::Distance;
use holdover::wire::unserved::Unserved;

use super::front::Front;
use super::relevance::LEFT_M;
use super::{HEARD_S, Placed, Rank, Relay};

/// Time from one message to the next.
pub const UNSERVED_EVERY_S: f64 = 0.2;

impl Relay {
    /// The message for the unit. Only a unit on a route gets one.
    #[must_use]
    pub fn unserved(&self, at_s: f64) -> Option<Unserved> {
        let next = self.course.next()?;
        let front = Front::of(&self.course, &self.places);
        let unserved: Vec<&Placed> =
            self.places.iter().filter(|placed| self.is_unserved(placed, at_s, &front)).collect();
        let legs =
            unserved.iter().filter(|placed| self.is_in_the_way(placed, &front)).map(|placed| placed.route.movement.leg);
        let ahead_m = unserved.iter().filter_map(|placed| Some(placed.ahead_m(&self.course)? - placed.length_m));
        let ahead_m = ahead_m.reduce(f64::min).zip(self.course.way_m()).map(|(ahead_m, way_m)| way_m - ahead_m);
        Some(Unserved {
            intersection: next.intersection.id,
            legs: legs.fold(0, |legs, leg| legs | 1u8.checked_shl(leg.into()).unwrap_or(0)),
            ahead: ahead_m.map(|way_m| Distance::from_mm((way_m * 1e3) as i32)),
            stations: u8::try_from(self.without_slot(next.intersection.id, &front)).unwrap_or(63).min(63),
        })
    }

    /// Whether a station that the unit could meet has no slot.
    fn is_unserved(&self, placed: &Placed, at_s: f64, front: &Front) -> bool {
        let matters = || {
            let rank = self.rank_of(placed, at_s, front);
            self.course.comes_before(&placed.route) && !matches!(rank, Rank::Other | Rank::Irrelevant)
        };
        self.has_no_slot(placed, front) && matters()
    }

    /// The number of stations that come to an intersection, or are in it, and have no slot.
    fn without_slot(&self, intersection: u8, front: &Front) -> usize {
        let is_there = |placed: &&Placed| {
            placed.route.intersection == intersection && placed.route.distance.get().to_num::<f64>() > -LEFT_M
        };
        self.places.iter().filter(is_there).filter(|placed| self.has_no_slot(placed, front)).count()
    }

    /// Whether a station that is heard has no slot. A modem that hears no station any more goes by the last messages.
    fn has_no_slot(&self, placed: &Placed, front: &Front) -> bool {
        let is_relayed = self.slots.iter().flatten().any(|tenant| tenant.station == placed.station && tenant.relayed);
        front.newest_s() - placed.at_s < HEARD_S && !is_relayed
    }

    /// Whether a station is in the unit's next conflict area, or is near and the next one of its leg to enter.
    fn is_in_the_way(&self, placed: &Placed, front: &Front) -> bool {
        let Some(one) = self.course.across(&placed.route) else { return false };
        one.has_entered() || one.is_near() && front.is_first(one)
    }
}

#[cfg(test)]
mod tests;
