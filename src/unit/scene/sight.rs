//! What the range sensor has seen. Views enter; what the unit remembers of them, and whether they contradict what is heard, leave.
//!
//! A view shows the nearest vehicle on the ego's path, or that none is nearer than a place: no vehicle is between the ego and that. This is
//! an assumption of use, and all conclusions here rest on it.
//!
//! *Memory.* A vehicle that was seen is remembered after the view has ended. Its near end is carried on like that of an unknown vehicle,
//! which may brake as hard as any vehicle. A vehicle that was driving is remembered for [`MOVING`], and a vehicle that stood or crawled
//! for [`STANDING`]. A newer view takes its place, unless the newer view is nearer. Then the nearer vehicle hides what is beyond it,
//! and both are remembered.
//!
//! *Contradiction.* A disagreement begins with [`DISAGREEMENT`] views in a row that what is certain of the target excludes. It lasts
//! until no view has contradicted the target for [`SETTLED`]. If as many views in a row saw past all that is certain of the target, no
//! vehicle is where the target is held to be. Then the contradiction lasts until the target is heard again, however long the target is
//! silent.

use crate::held::Held;
use crate::model::Reading;
use crate::model::bound::{AccelerationRange, Bound, Uncertainty};
use crate::time::{Duration, Instant};
use crate::units::{Distance, Position, Speed};
use crate::wire::range_sensor::RangeSample;
use crate::wire::{Slot, StationHash};

/// A view older than this is not driven by. It also does not show any more that no vehicle is nearer.
const RANGE_TIMEOUT: Duration = Duration::from_millis(200);

/// A vehicle that was driving is remembered for this long. It may have left the path. At the gap of the cruise control the gate does not
/// act within this time, so that a vehicle that turns off costs nothing.
const MOVING: Duration = Duration::from_millis(1_000);

/// A vehicle that stood or crawled is remembered for this long, which is longer than a sensor takes to start anew. The memory ends,
/// because a sensor may say nothing when it sees nobody: without an end, a vehicle that leaves unseen would hold the ego for ever.
const STANDING: Duration = Duration::from_millis(10_000);

/// A vehicle that may be slower than this stands or crawls. At the hardest braking it stands within 0.1 s and 4 cm.
const CRAWL: Speed = Speed::from_mm_per_s(1_000);

/// A vehicle that was seen to cross may still be there for this long, unless the sensor has seen since then that it is not: longer than a
/// dropout of half a second.
const CROSSING: Duration = Duration::from_millis(1_000);

/// A sensor of which no view is younger than this is not relied on to see who crosses. What it says of nobody is up to 63 ms old, and it
/// says so only some views after it has seen somebody.
const BLIND: Duration = Duration::from_millis(250);

/// How far from where the vehicle ahead was to be, and by how much slower or faster, a view may be of the same vehicle. Two views err by
/// half a metre, and with 2 m/s² a vehicle is 0.25 m off after a dropout of half a second.
const GOES_ON: Distance = Distance::from_mm(1_000);
const FASTER: Speed = Speed::from_mm_per_s(1_500);

/// This many views in a row that contradict what is certain of the target are a disagreement.
const DISAGREEMENT: u8 = 3;

/// A disagreement is over when no view has contradicted the target for this long.
const SETTLED: Duration = Duration::from_millis(1_000);

/// So many vehicles that are hidden by nearer ones are remembered.
const HIDDEN: usize = 3;

/// A view, at an instant of the unit's clock.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::unit) struct Sight {
    pub at: Instant,
    /// Rear bumper of the vehicle ahead.
    pub rear: Position,
    pub speed: Speed,
    /// What is certain of the rear that was seen, by this view alone.
    pub bound: Bound,
    /// Whose it is, if it went into what is certain of that station.
    pub whose: Option<Whose>,
    /// Whether it is of a vehicle that was ahead on the ego's leg before the next conflict area.
    pub is_on_leg: bool,
}

impl Sight {
    /// A view of nobody's place in particular.
    pub fn new(at: Instant, rear: Position, speed: Speed, uncertainty: &Uncertainty) -> Self {
        let bound = Bound::around(at, rear, speed, uncertainty, &AccelerationRange::WORST);
        Self { at, rear, speed, bound, whose: None, is_on_leg: false }
    }

    /// Whether the vehicle may have stood or crawled.
    pub(in crate::unit) fn stands(&self) -> bool {
        self.bound.lowest_speed() <= CRAWL
    }

    /// Whether the vehicle is still remembered.
    fn is_remembered(&self, now: Instant) -> bool {
        let age = now.since(self.at);
        age <= MOVING || age <= STANDING && self.stands()
    }
}

/// Whose place is compared with a view: the slot, because two vehicles may have one name, and the name, because a slot changes hands.
pub(in crate::unit) type Whose = (Slot, StationHash);

/// Views that what is certain of a station excludes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Contradiction {
    whose: Whose,
    /// The instant of the last of them.
    at: Instant,
    /// Whether the last view saw past all that is certain of the station.
    is_past: bool,
}

/// The range sensor's part of the unit.
#[derive(Clone, Debug, Default)]
pub(in crate::unit) struct Ranging {
    /// The newest view with the time of its reception, until the next tick.
    waiting: Held<(Instant, RangeSample)>,
    newest: Held<Sight>,
    /// The instant of the newest view of a vehicle, whether it is remembered or not.
    seen: Held<Instant>,
    /// No vehicle is nearer than this place, by the newest view that shows nobody.
    free: Held<(Instant, Position)>,
    /// The last views of vehicles that a nearer one has hidden since, until a view shows that they are not there.
    hidden: [Held<Sight>; HIDDEN],
    /// The last view of a vehicle in the next conflict area, on a way that crosses the ego's.
    crossing: Held<Sight>,
    /// The vehicle that the views are compared with.
    judged: Held<Whose>,
    /// Views in a row that contradict what is certain of it.
    contradictions: u8,
    /// Views in a row that saw past all that is certain of it.
    past: u8,
    contradiction: Held<Contradiction>,
    /// Since when the driver has named the present target.
    named: Instant,
}

impl Ranging {
    pub(in crate::unit) const fn new() -> Self {
        Self {
            waiting: Held::Nothing,
            newest: Held::Nothing,
            seen: Held::Nothing,
            free: Held::Nothing,
            hidden: [Held::Nothing; HIDDEN],
            crossing: Held::Nothing,
            judged: Held::Nothing,
            contradictions: 0,
            past: 0,
            contradiction: Held::Nothing,
            named: Instant::ZERO,
        }
    }

    /// Keeps a view until the next tick. Returns the one that was kept before.
    pub(in crate::unit) fn wait(&mut self, received: Instant, view: RangeSample) -> Option<(Instant, RangeSample)> {
        core::mem::replace(&mut self.waiting, Held::Value((received, view))).get()
    }

    /// The view that was kept.
    pub(in crate::unit) fn take_waiting(&mut self) -> Option<(Instant, RangeSample)> {
        core::mem::take(&mut self.waiting).get()
    }

    /// Notes that the driver names another vehicle from now on. What was seen before is not of that vehicle.
    pub(in crate::unit) fn note_named(&mut self, at: Instant) {
        (self.named, self.contradictions, self.past) = (at, 0, 0);
    }

    /// Whether a view may be of the vehicle that the driver names. A view from before it was named may be from before it was on the ego's
    /// path, when the view did not hide it.
    pub(in crate::unit) fn is_of_named(&self, seen: Instant) -> bool {
        seen >= self.named
    }

    /// Notes that the sensor saw a vehicle, at this instant.
    pub(in crate::unit) fn note_seen(&mut self, at: Instant) {
        self.seen.set(self.seen.get().unwrap_or(at).max(at));
    }

    /// Whether the sensor would see a vehicle that is nearer than this place, or one that hides it.
    pub(in crate::unit) fn sees_up_to(&self, place: Position, now: Instant) -> bool {
        let is_young = |at: Instant| now.since(at) <= BLIND;
        self.seen.get().is_some_and(is_young) || self.free.get().is_some_and(|(at, near)| is_young(at) && near >= place)
    }

    /// Whether the last view says that nobody is nearer than this place. A view of a vehicle beyond it does not say so of what is beside
    /// the ego's path.
    pub(in crate::unit) fn is_free_up_to(&self, place: Position, now: Instant) -> bool {
        let is_last = |at: Instant| now.since(at) <= BLIND && self.seen.get().is_none_or(|seen| seen <= at);
        self.free.get().is_some_and(|(at, near)| is_last(at) && near >= place)
    }

    /// Takes in that no vehicle is nearer than the near end of a place. Vehicles that would certainly be nearer have gone.
    pub(in crate::unit) fn see_nobody(&mut self, free: &Sight) {
        let near = free.bound.lowest_position();
        self.free.set((free.at, near));
        let is_gone = |held: &Sight| {
            let then = held.bound.after(free.bound.at(), &AccelerationRange::WORST);
            held.at <= free.at && then.highest_position() < near
        };
        let held = self.hidden.iter_mut().chain([&mut self.newest, &mut self.crossing]);
        for held in held.filter(|held| held.as_ref().is_some_and(is_gone)) {
            held.clear();
        }
    }

    /// No vehicle is nearer than this place. `None` if that was seen too long ago.
    pub(in crate::unit) fn free(&self, now: Instant) -> Option<Position> {
        let (at, near) = self.free.get()?;
        (now.since(at) <= RANGE_TIMEOUT).then_some(near)
    }

    /// Takes in a view. One that comes late says nothing: since it was taken, a nearer vehicle was seen, or a farther one.
    pub(in crate::unit) fn see(&mut self, sight: Sight) {
        let newest = self.newest.get();
        if newest.is_some_and(|newest| sight.at < newest.at) {
            return;
        }
        let seen = &sight.bound;
        // The view is of the same vehicle, or farther: then no vehicle is where that one was held to be. One that drives may leave the path
        // close before one that stood. So a view of one that certainly drives is of one that stood only if that was seen just now, and can
        // be as fast.
        let drives = seen.lowest_speed() > CRAWL;
        let is_beyond = |held: &Sight| {
            let then = held.bound.after(seen.at(), &AccelerationRange::WORST);
            let is_the_same = sight.at.since(held.at) <= RANGE_TIMEOUT && seen.lowest_speed() <= then.highest_speed();
            if drives && !is_the_same && held.stands() && held.is_remembered(sight.at) {
                return seen.lowest_position() > held.bound.highest_position();
            }
            seen.highest_position() >= then.lowest_position()
        };
        for held in self.hidden.iter_mut().filter(|held| held.as_ref().is_some_and(is_beyond)) {
            held.clear();
        }
        if let Some(newest) = newest.filter(|newest| !is_beyond(newest)) {
            self.hide(sight.at, newest);
        }
        let is_gone = |held: &Sight| seen.lowest_position() > held.bound.highest_position();
        if self.crossing.as_ref().is_some_and(is_gone) {
            self.crossing.clear();
        }
        self.newest.set(sight);
    }

    /// Whether a view is of the vehicle that was ahead on the ego's leg just now: it is where that one was to be by now, and about as fast.
    /// Another one there would touch it.
    pub(in crate::unit) fn goes_on(&self, sight: &Sight) -> bool {
        let Some(last) = self.newest.as_ref().filter(|last| last.is_on_leg) else { return false };
        let age = sight.at.since(last.at);
        if age < Duration::ZERO || age > MOVING {
            return false;
        }
        let off = sight.rear.ahead_of(last.rear.ahead(last.speed.over(age.seconds())));
        let faster = sight.speed.minus(last.speed);
        off <= GOES_ON && off >= GOES_ON.negated() && faster <= FASTER && faster >= FASTER.negated()
    }

    /// For how long the sensor has seen no vehicle on the ego's way; `None` if it sees that none is there, or never saw one.
    pub(in crate::unit) fn unseen(&self, now: Instant) -> Option<Duration> {
        self.newest.get().map(|newest| now.since(newest.at))
    }

    /// Takes in a view of a vehicle that crosses the ego's way in the next conflict area, and is not one that was heard in there. It is not
    /// remembered like others: it drives out of the way.
    pub(in crate::unit) fn see_crossing(&mut self, sight: Sight) {
        self.crossing.set(sight);
    }

    /// The near end of the vehicle that was seen to cross just now.
    pub(in crate::unit) fn crossing(&self, now: Instant) -> Option<Position> {
        let sight = self.crossing.get().filter(|sight| now.since(sight.at) <= CROSSING)?;
        Some(sight.bound.lowest_position())
    }

    /// The vehicle ahead at now as the sensor saw it, at constant speed since the view. The position is that of its rear bumper. `None`
    /// if the view is too old.
    pub(in crate::unit) fn ahead(&self, now: Instant) -> Option<Reading> {
        let sight = self.newest.get().filter(|sight| now.since(sight.at) <= RANGE_TIMEOUT)?;
        let age = now.since(sight.at).seconds();
        Some(Reading { position: sight.rear.ahead(sight.speed.over(age)), speed: sight.speed })
    }

    /// What is certain of the rears of the remembered vehicles that are not this one, each at the time of its view.
    pub(in crate::unit) fn strangers(
        &self,
        now: Instant,
        whose: Option<Whose>,
    ) -> impl Iterator<Item = Bound> + use<'_> {
        let remembered = self.remembered(now);
        remembered.filter(move |sight| whose.is_none() || sight.whose != whose).map(|sight| sight.bound)
    }

    /// The vehicles that were seen standing.
    pub(in crate::unit) fn standing(&self, now: Instant) -> impl Iterator<Item = Sight> + use<'_> {
        self.remembered(now).filter(Sight::stands)
    }

    fn remembered(&self, now: Instant) -> impl Iterator<Item = Sight> + use<'_> {
        let held = core::iter::once(&self.newest).chain(&self.hidden).filter_map(Held::as_ref);
        held.filter(move |sight| sight.is_remembered(now)).copied()
    }

    /// Keeps the last view of a vehicle that a nearer one hides from now on: in place of one that is not remembered any more, or else of
    /// the oldest.
    fn hide(&mut self, now: Instant, sight: Sight) {
        let age = |held: &Held<Sight>| {
            let held = held.as_ref().filter(|held| held.is_remembered(now));
            held.map_or(Duration::MAX, |held| now.since(held.at))
        };
        if let Some(place) = self.hidden.iter_mut().max_by_key(|held| age(held)) {
            place.set(sight);
        }
    }

    /// Notes whether a view contradicts what is certain of a station, and whether it saw past that. Returns whether a disagreement
    /// begins.
    pub(in crate::unit) fn judge(
        &mut self,
        whose: Whose,
        at: Instant,
        verdict: Verdict,
        heard: Option<Instant>,
    ) -> bool {
        if self.judged != Held::Value(whose) {
            self.judged.set(whose);
            (self.contradictions, self.past) = (0, 0);
        }
        self.past = if verdict == Verdict::SeesPast { self.past.saturating_add(1) } else { 0 };
        if verdict == Verdict::Agrees {
            self.contradictions = 0;
            return false;
        }
        self.contradictions = self.contradictions.saturating_add(1);
        let held = self.holds(whose, at, heard, SETTLED);
        let begins = held.is_none();
        if begins && self.contradictions < DISAGREEMENT {
            return false;
        }
        // If a nearer vehicle has contradicted the target, a single view past the target is one that missed that vehicle.
        let was_past = held.is_some_and(|held| held.is_past) && self.past > 0;
        self.contradiction.set(Contradiction { whose, at, is_past: was_past || self.past >= DISAGREEMENT });
        begins
    }

    /// Whether what is seen and what is heard of a station contradict one another. `heard` is when the station was heard last.
    pub(in crate::unit) fn disagrees(&self, whose: Whose, now: Instant, heard: Option<Instant>) -> bool {
        self.holds(whose, now, heard, SETTLED).is_some()
    }

    /// Whether the sensor sees that a station is not where it is held to be: by a view that is not too old, or by any view since which
    /// the station has not been heard.
    pub(in crate::unit) fn sees_past(&self, whose: Whose, now: Instant, heard: Option<Instant>) -> bool {
        self.holds(whose, now, heard, RANGE_TIMEOUT).is_some_and(|contradiction| contradiction.is_past)
    }

    fn holds(&self, whose: Whose, now: Instant, heard: Option<Instant>, lasts: Duration) -> Option<Contradiction> {
        self.contradiction.get().filter(|held| {
            let is_unheard = held.is_past && heard.is_none_or(|heard| heard <= held.at);
            held.whose == whose && (is_unheard || now.since(held.at) <= lasts)
        })
    }
}

/// How a view relates to what is certain of a station.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::unit) enum Verdict {
    /// The view may be of that station.
    Agrees,
    /// The view is not of that station, or what is heard is wrong.
    Contradicts,
    /// The same, and the station cannot be where it is held to be.
    SeesPast,
}

#[cfg(test)]
mod tests;
