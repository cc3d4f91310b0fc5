//! The review of an order. The stations at the ego's next crossing enter; the stations ahead of the ego, and whether the ego yields,
//! leave.

use super::{Arrival, Coordination, Entry, Present, REVIEW, Regard, Registration, Side, Slots};
use crate::held::Held;
use crate::time::Instant;
use crate::units::Distance;
use crate::wire::StationHash;

impl<const PEERS: usize> Coordination<PEERS> {
    /// Reviews the stations that are present; `are_all` says that no station is heard for which there is no slot. Returns whether the ego
    /// yielded to a station that did not heed it.
    pub(crate) fn review(&mut self, now: Instant, own: StationHash, present: &[Present], are_all: bool) -> bool {
        self.at_once = false;
        self.due.set(match self.due.get() {
            Some(due) if now < due => due,
            Some(due) if now.since(due) < REVIEW => due.plus(REVIEW),
            _ => now.plus(REVIEW),
        });
        let Some(registration) = self.registration.get() else { return false };
        let ego = Entry { station: own, arrival: Some(registration.arrival), claim: self.claim(), leg: self.leg() };
        // No vehicle passes another on the same leg. So a vehicle that is behind the ego on its leg yields to every vehicle that the ego
        // yields to, whatever it has heard. A vehicle that is ahead on the leg takes the ego along. Otherwise three vehicles could wait
        // for one another, two by the order and two on the leg.
        let ahead = present.iter().filter(|other| other.lane == Some(Side::Ahead) && !other.has_left);
        let after = ahead.filter(|other| ego.is_before(&other.entry)).filter_map(|other| other.entry.arrival);
        if let Some(latest) = after.reduce(|a, b| if a.is_before(b) { b } else { a }) {
            self.registration.set(Registration { arrival: latest.next(), ..registration });
        }
        let arrival = self.registration.get().map(|registration| registration.arrival);
        let ego = Entry { arrival, ..ego };
        let mut given_way = None;
        for Present { index, entry, heard, is_far_behind, .. } in
            present.iter().filter(|other| other.lane != Some(Side::Behind) && other.conflicts)
        {
            // What a station said before it could hear of the ego does not count.
            let counts = !is_far_behind && heard.since(registration.since) >= REVIEW;
            let regard = Regard::of(entry, &ego, present.iter().map(|other| &other.entry));
            // A station that is claimed may be one of those without a slot.
            let is_known = counts && (are_all || regard != Regard::Unclear);
            let regard = if is_known { regard } else { Regard::Heeds };
            let is_over =
                self.yield_timer.get_mut(*index).is_some_and(|yield_timer| yield_timer.is_over(*heard, regard));
            if is_over && given_way.is_none_or(|other: &Entry| other.is_before(entry)) {
                given_way = Some(entry);
            }
        }
        let ego = match given_way.and_then(|other| other.arrival) {
            Some(arrival) => {
                self.registration.set(Registration { arrival: arrival.next(), since: now });
                Entry { arrival: Some(arrival.next()), ..ego }
            }
            None => ego,
        };
        let mut last = None::<Entry>;
        (self.choice.ahead, self.choice.first) = (Slots::NONE, Slots::NONE);
        let is_ahead = |other: &&Present| other.lane != Some(Side::Behind) && other.entry.is_before(&ego);
        let goes_first = |other: &&Present| is_ahead(other) && other.conflicts && !other.has_left;
        self.choice.namesakes = namesakes(present.iter().filter(goes_first));
        for Present { index, entry, has_left, is_announced, conflicts, lane, .. } in present.iter().filter(is_ahead) {
            self.choice.ahead.set(*index, true);
            let goes_first = *conflicts && !has_left && !self.choice.namesakes.contains(*index);
            self.choice.first.set(*index, goes_first && *is_announced);
            let is_passed = *conflicts || lane.is_some();
            if is_passed && !has_left && last.is_none_or(|last| last.is_before(entry)) {
                last = Some(*entry);
            }
        }
        self.claim = last.map(|entry| entry.station).into();
        given_way.is_some()
    }

    /// Notes whether the ego has to stop before the next conflict area.
    pub(crate) fn hold(&mut self, is_held: bool) {
        self.choice.is_held = is_held;
    }

    /// The ego yields to all stations that arrived before `arrival`: it tells `arrival` as its own, if that is later.
    pub(crate) fn give_way(&mut self, arrival: Arrival) {
        if let Held::Value(registration) = &mut self.registration
            && registration.arrival.is_before(arrival)
        {
            registration.arrival = arrival;
        }
    }
}

/// Of those with one name: all but the nearest ahead, or else the nearest. By that name the others take the ego to follow that one.
fn namesakes<'a>(first: impl Iterator<Item = &'a Present> + Clone) -> Slots {
    let mut namesakes = Slots::NONE;
    let way = |one: &Present| (one.way < Distance::ZERO, one.way.magnitude());
    for (place, one) in first.clone().enumerate() {
        let later = first.clone().skip(place.saturating_add(1));
        for other in later.filter(|other| other.entry.station == one.entry.station) {
            namesakes.set(if way(one) <= way(other) { other.index } else { one.index }, true);
        }
    }
    namesakes
}

#[cfg(test)]
mod tests;
