//! The vehicles that are known to come to the next intersection by ways that cross the ego's. What was heard of them enters, and what is
//! known of their claims leaves. A vehicle stays in this list without a slot, and whether it is heard or not, until it says that it has
//! left, or for so long that it is [forgotten](super::Rules::is_forgotten). One that has left is on record as one that keeps passes, as long
//! as there is room, until it is forgotten.
//!
//! One that is not in the zone yet is in this list as long as there is room. What it claims later counts `A` + `e` after its last message at
//! the earliest (F2). So its last message is as good as one of that time.

use super::{Claim, Known, PIECES, Rules};
use crate::coordination::Arrival;
use crate::held::Held;
use crate::time::GnssTime;
use crate::wire::{Movement, StationHash};

/// So many vehicles are known at once.
pub const KNOWN: usize = 24;

/// What was heard of a vehicle last.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Station {
    /// Its whole identity.
    pub id: u32,
    /// Its way through the intersection.
    pub movement: Movement,
    /// The stamp of the message.
    pub heard: GnssTime,
    /// When it arrived.
    pub arrival: Arrival,
    claims: [Claim; PIECES],
    count: u8,
    place: Place,
    /// A person drives it, and keeps no pass.
    is_by_hand: bool,
}

/// Where a vehicle is, by what it said last.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
enum Place {
    /// Before the zone: what it claims later is claimed by a newcomer.
    BeforeZone,
    InZone,
    /// It has left the area.
    Left,
}

impl Station {
    /// A vehicle, with what it claims.
    #[must_use]
    pub fn new(
        id: u32,
        movement: Movement,
        heard: GnssTime,
        arrival: Arrival,
        claims: [Option<Claim>; PIECES],
    ) -> Self {
        let mut held = Self { place: Place::InZone, ..Self::before_zone(id, movement, heard, arrival) };
        for (place, claim) in held.claims.iter_mut().zip(claims.into_iter().flatten()) {
            *place = claim;
            held.count = held.count.saturating_add(1);
        }
        held
    }

    /// A vehicle that is not in the zone yet.
    #[must_use]
    pub const fn before_zone(id: u32, movement: Movement, heard: GnssTime, arrival: Arrival) -> Self {
        let claims = [Claim::NONE; PIECES];
        Self { id, movement, heard, arrival, claims, count: 0, place: Place::BeforeZone, is_by_hand: false }
    }

    /// The same vehicle, driven by a person or not. What it claims is honoured in both cases.
    #[must_use]
    pub const fn driven(self, is_by_hand: bool) -> Self {
        Self { is_by_hand, ..self }
    }

    /// Whether a person drives it.
    #[must_use]
    pub const fn is_by_hand(&self) -> bool {
        self.is_by_hand
    }

    /// Its name in messages that have room for 8 bits only.
    #[must_use]
    pub const fn station(&self) -> StationHash {
        StationHash(self.id.to_le_bytes()[0])
    }

    /// What it claims.
    #[must_use]
    pub fn claims(&self) -> &[Claim] {
        self.claims.get(..usize::from(self.count)).unwrap_or_default()
    }

    /// As the rules take it.
    #[must_use]
    pub fn known(&self, rules: &Rules) -> Known<'_> {
        let heard = match self.place {
            Place::BeforeZone => rules.heard_by_all(self.heard),
            Place::InZone | Place::Left => self.heard,
        };
        Known { heard, claims: self.claims() }
    }

    /// Whether it is certain to keep a pass at this time if it is in the area then. One that was heard before the zone may do anything since
    /// it could have claimed, and a person may do anything at any time.
    #[must_use]
    pub fn keeps_pass(&self, rules: &Rules, now: impl FnOnce() -> Option<GnssTime>) -> bool {
        let cannot_claim_yet = || now().is_some_and(|now| now <= rules.heard_by_all(self.heard));
        !self.is_by_hand && (self.place != Place::BeforeZone || cannot_claim_yet())
    }
}

/// There was no room for a vehicle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Full;

/// The list.
#[derive(Clone, Debug)]
pub struct List {
    stations: [Held<Station>; KNOWN],
    /// When a vehicle was heard last for which there was no room.
    missed: Held<GnssTime>,
}

impl List {
    /// Nobody: all zero.
    pub const EMPTY: Self = Self { stations: [Held::Nothing; KNOWN], missed: Held::Nothing };

    /// The vehicles whose claims count.
    pub fn iter(&self) -> impl Iterator<Item = &Station> + Clone {
        self.on_record().filter(|station| station.place != Place::Left)
    }

    /// These, and vehicles that have left.
    pub fn on_record(&self) -> impl Iterator<Item = &Station> + Clone {
        self.stations.iter().filter_map(Held::as_ref)
    }

    /// Whether there may be a vehicle for which there was no room. Then nothing is firm.
    #[must_use]
    pub fn lacks_one(&self) -> bool {
        self.missed.as_ref().is_some()
    }

    /// Takes in what was heard of a vehicle. Older news than the last changes nothing.
    ///
    /// # Errors
    /// [`Full`].
    pub fn hear(&mut self, station: Station) -> Result<(), Full> {
        let is_same = |held: &Held<Station>| held.as_ref().is_some_and(|held| held.id == station.id);
        let place = self.stations.iter().position(is_same);
        let place = place.or_else(|| self.stations.iter().position(|held| held.as_ref().is_none()));
        let is_at = |held: &Held<Station>, place| held.as_ref().is_some_and(|held| held.place == place);
        let place = place.or_else(|| self.stations.iter().position(|held| is_at(held, Place::Left)));
        if place.is_none() && station.place == Place::BeforeZone {
            return Ok(());
        }
        let place = place.or_else(|| self.stations.iter().position(|held| is_at(held, Place::BeforeZone)));
        let Some(held) = place.and_then(|place| self.stations.get_mut(place)) else {
            self.missed.set(station.heard);
            return Err(Full);
        };
        if held.as_ref().is_none_or(|held| held.heard <= station.heard) {
            held.set(station);
        }
        Ok(())
    }

    /// A vehicle has left, as it says.
    pub fn leave(&mut self, id: u32, said: GnssTime) {
        for held in self.stations.iter_mut() {
            if let Some(station) = held.get().filter(|station| station.id == id && station.heard <= said) {
                held.set(Station { heard: said, place: Place::Left, is_by_hand: false, ..station });
            }
        }
    }

    /// Forgets the vehicles that have been silent for long.
    pub fn forget(&mut self, rules: &Rules, now: GnssTime) {
        let is_forgotten = |station: &Station| {
            let exit = station.claims().iter().map(|claim| claim.window.exit).max();
            rules.is_forgotten(now, station.heard, exit)
        };
        for held in self.stations.iter_mut() {
            if held.as_ref().is_some_and(is_forgotten) {
                held.clear();
            }
        }
        if self.missed.get().is_some_and(|missed| rules.is_forgotten(now, missed, None)) {
            self.missed.clear();
        }
    }

    /// Forgets everybody.
    pub fn clear(&mut self) {
        self.stations = [Held::Nothing; KNOWN];
        self.missed.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::passes::tests::{RULES, claim, time, window};

    fn station(id: u32, heard: u64) -> Station {
        Station::new(id, Movement::straight(1), time(heard), Arrival(5), [None; PIECES])
    }

    #[test]
    fn the_newest_news_of_each_vehicle_is_known_until_it_has_left() {
        let mut list = List::EMPTY;
        for (id, heard) in [(7, 100), (8, 110), (7, 120), (7, 90)] {
            list.hear(station(id, heard)).unwrap();
        }
        let known = |list: &List| list.iter().map(|known| (known.id, known.heard)).collect::<Vec<_>>();
        assert_eq!(known(&list), [(7, time(120)), (8, time(110))]);
        list.leave(7, time(119));
        assert_eq!(known(&list).len(), 2, "it came back since");
        list.leave(7, time(121));
        assert_eq!(known(&list), [(8, time(110))]);
        list.hear(station(7, 120)).unwrap();
        assert_eq!(known(&list), [(8, time(110))], "old news does not bring it back");
        let on_record: Vec<u32> = list.on_record().map(|known| known.id).collect();
        assert_eq!(on_record, [7, 8]);
    }

    #[test]
    fn a_silent_vehicle_is_forgotten_after_its_windows() {
        let mut list = List::EMPTY;
        let claims = [Some(claim(1, window(1_100, 1_400), 7)), None];
        list.hear(Station::new(7, Movement::straight(1), time(1_000), Arrival(5), claims)).unwrap();
        for (now, known) in [(1_301, 1), (1_405, 1), (1_406, 0)] {
            list.forget(&RULES, time(now));
            assert_eq!(list.iter().count(), known, "{now}");
        }
    }

    #[test]
    fn one_before_the_zone_is_as_good_as_heard_until_it_could_have_claimed() {
        let before = |id, heard| Station::before_zone(id, Movement::straight(1), time(heard), Arrival(5));
        let mut list = List::EMPTY;
        list.hear(before(7, 100)).unwrap();
        let heard = |list: &List| list.iter().map(|known| known.known(&RULES).heard).collect::<Vec<_>>();
        let later = |at| RULES.claims_from(time(at), time(at), None);
        assert_eq!(heard(&list), [later(100)], "whatever it claims counts later");
        list.hear(station(7, 120)).unwrap();
        list.hear(before(7, 110)).unwrap();
        assert_eq!(heard(&list), [time(120)], "old news");
        list.hear(before(7, 130)).unwrap();
        assert_eq!(heard(&list), [later(130)]);
        let trusted = |now| list.on_record().all(|known| known.keeps_pass(&RULES, || Some(now)));
        assert!(trusted(later(130)) && !trusted(later(131)));
        for id in 0..2 * KNOWN as u32 {
            list.hear(before(100 + id, 130)).unwrap();
        }
        assert!(!list.lacks_one() && list.on_record().count() == KNOWN, "there is no room, and it does not matter");
        list.hear(station(99, 131)).unwrap();
        assert!(list.iter().any(|known| known.id == 99), "it has the place of one before the zone");
    }

    #[test]
    fn what_one_that_a_person_drives_has_claimed_is_honoured_and_nobody_trusts_it() {
        let mut list = List::EMPTY;
        for (heard, is_by_hand) in [(100, false), (120, true), (110, false)] {
            list.hear(station(7, heard).driven(is_by_hand)).unwrap();
        }
        let trusted = |list: &List| list.on_record().all(|known| known.keeps_pass(&RULES, || Some(time(130))));
        assert!(list.iter().count() == 1 && !trusted(&list), "old news changes nothing");
        list.hear(station(7, 130)).unwrap();
        assert!(trusted(&list));
    }

    #[test]
    fn one_for_whom_there_is_no_room_is_remembered_as_missing() {
        let mut list = List::EMPTY;
        for id in 0..KNOWN as u32 {
            list.hear(station(id, 1_000)).unwrap();
        }
        assert!(!list.lacks_one());
        assert_eq!(list.hear(station(99, 1_000)), Err(Full));
        assert!(list.lacks_one());
        list.leave(0, time(1_001));
        list.forget(&RULES, time(1_300));
        assert!(list.lacks_one(), "nobody knows where it is");
        list.hear(station(98, 1_299)).unwrap();
        assert!(
            list.iter().any(|known| known.id == 98) && list.on_record().all(|known| known.id != 0),
            "it has the place of one that left"
        );
        list.forget(&RULES, time(1_301));
        assert!(!list.lacks_one());
    }
}
