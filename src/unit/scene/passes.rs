//! Passes of the others, as they are heard. What a vehicle says of its passes enters; which vehicles the ego's claims have to be heard by
//! leaves.

use super::Scene;
use crate::coordination::{Arrival, Entry};
use crate::health::{Cause, Health};
use crate::held::Held;
use crate::passes::{Claim, Known, List, Order, Outlook, Own, PIECES, Rules, Station, Window};
use crate::time::{Duration, GnssTime, Instant};
use crate::wire::pass::{Claimed, LONGEST, Pass, PassTime, STEP};
use crate::wire::{Predecessor, StationHash};

/// The passes at the next intersection.
#[derive(Clone, Debug)]
pub(in crate::unit) struct Passes {
    /// The ego's own.
    pub own: Own,
    /// Those of the vehicles on ways that cross the ego's.
    pub known: List,
    /// Whether the gate keeps the ego out of areas, as of the last plan: a person does not drive, nor has one handed the vehicle back too near
    /// to an area.
    pub keeps: bool,
    /// The index of that intersection on the ego's way, and one more.
    crossing: usize,
    /// The last time at which GNSS time was asked for, and what it was.
    clock: Held<(Instant, GnssTime)>,
}

/// A clock that is off by more than this against the unit's own has stepped.
const STEPPED: Duration = Duration::from_millis(5);

impl Passes {
    /// Nothing is known: all zero.
    pub const NONE: Self =
        Self { own: Own::NOTHING, known: List::EMPTY, keeps: false, crossing: 0, clock: Held::Nothing };

    /// Forgets what was known and claimed when another intersection comes next.
    pub fn turn_to(&mut self, next: usize) {
        let crossing = next.saturating_add(1);
        if self.crossing != crossing {
            self.crossing = crossing;
            self.own.begin();
            self.known.clear();
        }
    }

    /// Notes what GNSS time is. If it is not known, or has stepped, nothing that was claimed counts (F8).
    pub fn note_time(&mut self, now: Instant, gnss: Option<GnssTime>) {
        let Some(gnss) = gnss else {
            self.clock.clear();
            return self.own.begin();
        };
        let has_stepped = self.clock.get().is_some_and(|(then, said)| {
            let foretold = Instant::from_micros(said.plus(now.since(then)).as_micros());
            let off = Instant::from_micros(gnss.as_micros()).since(foretold);
            off > STEPPED || off < Duration::ZERO.minus(STEPPED)
        });
        if has_stepped {
            self.own.begin();
        }
        self.clock.set((now, gnss));
    }
}

impl<const PEERS: usize, const SAMPLES: usize, const STEPS: usize> Scene<PEERS, SAMPLES, STEPS> {
    /// Whether the ego keeps passes where there is something to cross. Its own gate has to be engaged, because that is what keeps the
    /// promise.
    pub fn may_claim(&self) -> bool {
        self.config.passes && self.config.envelope.is_some()
    }

    /// Whether the ego keeps passes at the next intersection.
    pub fn keeps_passes(&self) -> bool {
        self.may_claim() && self.coordination.crossing().is_some()
    }

    /// GNSS time, if it is known well enough for passes.
    pub fn pass_time(&self, now: Instant) -> Option<GnssTime> {
        self.clock.gnss(now).filter(|_| self.is_synchronised(now))
    }

    /// Takes in what a vehicle says of its passes.
    pub(super) fn take_pass(&mut self, at: Instant, pass: &Pass, health: &mut Health) -> Result<(), Cause> {
        let (Some(crossing), Some(now)) = (self.coordination.crossing(), self.pass_time(at)) else { return Ok(()) };
        if !self.keeps_passes() {
            return Ok(());
        }
        if pass.station_id == self.config.station_id {
            return Err(Cause::StationConflict);
        }
        self.passes.turn_to(self.coordination.next());
        let stamp = pass.stamp.near(now);
        if stamp > now.plus(Rules::UNIT.clocks) {
            return Err(Cause::Future);
        }
        let intersection = crossing.intersection;
        if pass.left == Some(intersection.id) {
            self.passes.known.leave(pass.station_id, stamp);
        } else if pass.intersection == intersection.id && intersection.conflict(crossing.movement, pass.movement) {
            let (id, movement, arrival) = (pass.station_id, pass.movement, Arrival(pass.arrival));
            let station = if pass.is_before_zone {
                Station::before_zone(id, movement, stamp, arrival)
            } else {
                let claims = pass.claims.map(|claimed| claimed.map(|claimed| claim(&claimed, id, now)));
                Station::new(id, movement, stamp, arrival, claims)
            };
            if self.passes.known.hear(station.driven(pass.is_by_hand)).is_err() {
                health.count(Cause::PassesFull);
            }
        }
        Ok(())
    }

    /// The vehicles that the ego's claims have to be heard by, as the rules take them.
    pub fn known_passes(&self) -> impl Iterator<Item = Known<'_>> + Clone {
        self.passes.known.iter().map(|station| station.known(&Rules::UNIT))
    }

    /// Whether the vehicle in a slot keeps passes at the next intersection. One that is forgotten is not trusted any more: the ego's claims
    /// do not wait for it, nor do its claims for the ego. At a time, one that was heard before the zone is trusted only as long as it cannot
    /// have come in since, and one that a person drives is not trusted.
    pub fn has_pass(&self, index: usize, at: Option<Instant>) -> bool {
        let Some((station, approach)) =
            self.peers.get(index).and_then(|track| track.station()).zip(self.coordination.approach(index))
        else {
            return false;
        };
        let is_it = |known: &&Station| known.station() == station && known.movement == approach.movement;
        // Of several with the same name, it may be any.
        let mut keeps = false;
        for known in self.passes.known.on_record().filter(is_it) {
            keeps = at.is_none_or(|at| known.keeps_pass(&Rules::UNIT, || self.pass_time(at)));
            if !keeps {
                break;
            }
        }
        keeps
    }

    /// Whether firm claims cover a stay in the next conflict area, in GNSS time.
    pub fn is_stay_covered(&self, now: Instant, stay: &Window) -> bool {
        let Some(gnss) = self.pass_time(now).filter(|_| !self.passes.known.lacks_one()) else { return false };
        self.passes.own.covers(&Rules::UNIT, gnss, stay, self.known_passes())
    }

    /// The end of the firmly claimed time that begins at `entry` or before, in GNSS time.
    pub fn is_covered_until(&self, now: Instant, entry: GnssTime) -> Option<GnssTime> {
        self.passes.own.firmly_reaches(&Rules::UNIT, self.pass_time(now)?, entry, self.known_passes())
    }

    /// Plans the ego's claims, by what it foresees.
    pub fn plan_passes(&mut self, now: GnssTime, outlook: Option<&Outlook>) {
        let mut own = self.passes.own.clone();
        let (leg, registration) = (self.coordination.leg(), self.coordination.registration());
        let ego = registration.map(|registration| entry(self.config.station, registration.arrival, leg));
        let known = self.passes.known.iter().map(|other| (other.known(&Rules::UNIT), order_of(other, ego.as_ref())));
        own.plan(&Rules::UNIT, now, self.config.station_id, outlook, known);
        self.passes.own = own;
    }

    /// The ego's own message about its passes.
    pub fn say_passes(&mut self, now: Instant, tag: u8, is_committed: bool) -> Option<Pass> {
        let gnss = self.pass_time(now)?;
        let itinerary = self.coordination.itinerary()?;
        let (named, registration) = (self.coordination.named()?, self.coordination.registration()?);
        let left = self.coordination.next().checked_sub(1).and_then(|last| itinerary.crossings.get(last));
        let stamp = whole_steps(gnss);
        let claims = self.passes.own.say(&Rules::UNIT, stamp, is_committed);
        Some(Pass {
            tag,
            station_id: self.config.station_id,
            intersection: named.intersection.id,
            movement: named.movement,
            left: left.map(|crossing| crossing.intersection.id),
            is_before_zone: self.passes.own.is_before_zone(),
            is_by_hand: !self.passes.keeps,
            stamp: PassTime::down(stamp),
            arrival: registration.arrival.0,
            claims: claims.map(|claim| claim.and_then(|claim| claimed(&claim))),
        })
    }
}

/// Whether a vehicle is ahead of the ego in the order. A person gives back nothing of what the unit has claimed, whatever the order is.
fn order_of(other: &Station, ego: Option<&Entry>) -> Order {
    if other.is_by_hand() {
        return Order::Ahead;
    }
    let Some(ego) = ego else { return Order::Unknown };
    let is_before = entry(other.station(), other.arrival, other.movement.leg).is_before(ego);
    if is_before { Order::Ahead } else { Order::Behind }
}

fn entry(station: StationHash, arrival: Arrival, leg: u8) -> Entry {
    Entry { station, arrival: Some(arrival), claim: Predecessor::Unknown, leg }
}

/// A GNSS time, rounded down to what a message can say.
pub(in crate::unit) fn whole_steps(time: GnssTime) -> GnssTime {
    let step = STEP.as_micros().unsigned_abs().max(1);
    GnssTime::from_micros(time.as_micros().checked_div(step).unwrap_or(0).saturating_mul(step))
}

fn claim(claimed: &Claimed, station: u32, now: GnssTime) -> Claim {
    let entry = claimed.entry.near(now);
    let window = Window { entry, exit: entry.plus(STEP.times(i64::from(claimed.length))) };
    Claim { at: claimed.at.near(now), window, station }
}

/// A claim as it is said: its window is in whole steps already. Of one that is longer than can be said, the beginning is left out: nobody
/// claims so far ahead, so that it is over.
fn claimed(claim: &Claim) -> Option<Claimed> {
    let Window { entry, exit } = claim.window;
    let steps = exit.as_micros().saturating_sub(entry.as_micros()).checked_div(STEP.as_micros().unsigned_abs())?;
    let length = u16::try_from(steps).unwrap_or(LONGEST).min(LONGEST);
    let entry = entry.max(exit.plus(Duration::ZERO.minus(STEP.times(i64::from(length)))));
    Some(Claimed { at: PassTime::down(claim.at), entry: PassTime::down(entry), length })
}

const _: () = assert!(PIECES == 2, "a message has room for two");

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_a_window_that_is_longer_than_can_be_said_the_end_is_said() {
        let time = |millis: u64| GnssTime::from_micros(1_000_000_000 + millis * 1_000);
        for seconds in [1, 40, 41, 60] {
            let window = Window { entry: time(0), exit: time(seconds * 1_000) };
            let own = Claim { at: time(0), window, station: 7 };
            let heard = claim(&claimed(&own).unwrap(), 7, time(seconds * 1_000 - 20_000.min(seconds * 1_000)));
            assert_eq!(heard.window.exit, window.exit, "{seconds} s");
            assert!(heard.window.entry >= window.entry && (seconds > 40 || heard.window.entry == window.entry));
        }
    }
}
