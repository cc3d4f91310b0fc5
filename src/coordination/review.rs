//! The review of an order: who is at the ego's next crossing enters; who is ahead of the ego, and whether the ego gives way, leaves.

use super::{Arrival, Coordination, Entry, Present, REVIEW, Regard, Registration, Side, Slots};
use crate::held::Held;
use crate::time::Instant;
use crate::wire::StationHash;

impl<const PEERS: usize> Coordination<PEERS> {
    /// Reviews who is here. Gives whether the ego gave way to one that did not heed it.
    pub(crate) fn review(&mut self, now: Instant, own: StationHash, present: &[Present]) -> bool {
        self.at_once = false;
        self.due.set(match self.due.get() {
            Some(due) if now < due => due,
            Some(due) if now.since(due) < REVIEW => due.plus(REVIEW),
            _ => now.plus(REVIEW),
        });
        let Some(registration) = self.registration.get() else { return false };
        let ego = Entry { station: own, arrival: Some(registration.arrival), claim: self.claim() };
        // Nobody passes on the same leg: who is behind there gives way to whom the ego gives way, whatever it has heard, and who
        // is ahead takes the ego along. Or else three could wait for one another, two by the order and two on the leg.
        let ahead = present.iter().filter(|other| other.lane == Some(Side::Ahead) && !other.has_left);
        let after = ahead.filter(|other| ego.is_before(&other.entry)).filter_map(|other| other.entry.arrival);
        if let Some(latest) = after.reduce(|a, b| if a.is_before(b) { b } else { a }) {
            self.registration.set(Registration { arrival: latest.next(), ..registration });
        }
        let arrival = self.registration.get().map(|registration| registration.arrival);
        let ego = Entry { arrival, ..ego };
        let mut given_way = None;
        for Present { index, entry, heard, is_far_behind, .. } in
            present.iter().filter(|other| other.lane != Some(Side::Behind))
        {
            // What was said before the ego could be heard of does not count.
            let counts = !is_far_behind && heard.since(registration.since) >= REVIEW;
            let regard = Regard::of(entry, &ego, present.iter().map(|other| &other.entry));
            let regard = if counts { regard } else { Regard::Heeds };
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
        let (mut last, mut followed) = (None::<Entry>, None::<(usize, Entry)>);
        self.choice.ahead = Slots::NONE;
        let is_ahead = |other: &&Present| other.lane != Some(Side::Behind) && other.entry.is_before(&ego);
        for Present { index, entry, has_left, is_announced, .. } in present.iter().filter(is_ahead) {
            self.choice.ahead.set(*index, true);
            if !has_left && last.is_none_or(|last| last.is_before(entry)) {
                last = Some(*entry);
            }
            if !has_left && *is_announced && followed.is_none_or(|(_, last)| last.is_before(entry)) {
                followed = Some((*index, *entry));
            }
        }
        self.choice.order = followed.and_then(|(index, _)| u8::try_from(index).ok());
        self.claim = last.map(|entry| entry.station).into();
        given_way.is_some()
    }

    /// Takes note of whether the ego is to stop before the next conflict area.
    pub(crate) fn hold(&mut self, is_held: bool) {
        self.choice.is_held = is_held;
    }

    /// The ego lets all go first who arrived before then: it tells that arrival, if it is later than its own.
    pub(crate) fn give_way(&mut self, arrival: Arrival) {
        if let Held::Value(registration) = &mut self.registration
            && registration.arrival.is_before(arrival)
        {
            registration.arrival = arrival;
        }
    }
}
