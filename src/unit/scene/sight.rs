//! What the range sensor has seen: views enter; what the unit remembers of them, and whether they contradict what is heard,
//! leave.
//!
//! A view shows the nearest vehicle on the ego's path: nothing is between the ego and what it sees. That is an assumption of
//! use; all that is concluded here rests on it.
//!
//! *Memory.* What was seen does not vanish with the view. Its near end is carried on, as a stranger's that may brake as hard
//! as any vehicle: for [`MOVING`] of whoever was driving, and for [`STANDING`] of whoever stood or crawled. A newer view
//! takes its place unless it is nearer: then it hides what stood beyond, and both are remembered.
//!
//! *Contradiction.* [`DISAGREEMENT`] views in a row that what is certain of the target excludes are one. It lasts until
//! none has contradicted it for [`SETTLED`]. If as many in a row saw past all that is certain of the target, nobody is where that
//! is held to be, and the contradiction lasts until the target is heard again, however long it is silent.

use crate::held::Held;
use crate::model::Reading;
use crate::model::bound::{AccelerationRange, Bound, Uncertainty};
use crate::time::{Duration, Instant};
use crate::units::{Distance, Position, Speed};
use crate::wire::StationHash;

/// A view older than this is not driven by, and shows no longer that nobody is nearer.
const RANGE_TIMEOUT: Duration = Duration::from_millis(200);

/// A vehicle that was driving is remembered for so long. It may have left the path; at the gap of the cruise control the gate does
/// not act within this time, so a vehicle that turns off costs nothing.
const MOVING: Duration = Duration::from_millis(1_000);

/// A vehicle that stood or crawled is remembered for so long, which is longer than a sensor takes to start anew. It ends, because a
/// sensor that sees nothing says nothing: without an end, a vehicle that leaves unseen would hold the ego for ever.
const STANDING: Duration = Duration::from_millis(10_000);

/// A vehicle that may be slower than this stands or crawls: at the hardest braking it stands within 0.1 s and 4 cm.
const CRAWL: Speed = Speed::from_mm_per_s(1_000);

/// So many views in a row that contradict what is certain of the target are a disagreement.
const DISAGREEMENT: u8 = 3;

/// So long no view may contradict it until a disagreement is over.
const SETTLED: Duration = Duration::from_millis(1_000);

/// A view, at an instant of the unit's clock.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::unit) struct Sight {
    pub at: Instant,
    /// Rear bumper of the vehicle ahead.
    pub rear: Position,
    pub speed: Speed,
    pub uncertainty: Uncertainty,
    /// How much of the uncertainty of the place is beyond the accuracies that were told.
    pub excess: Distance,
    /// Whose it is, if it went into what is certain of that station.
    pub station: Option<StationHash>,
}

impl Sight {
    /// What is certain of the rear that was seen, by what was seen alone.
    pub fn bound(&self) -> Bound {
        Bound::around(self.at, self.rear, self.speed, &self.uncertainty, &AccelerationRange::WORST)
    }
}

/// Views that what is certain of a station excludes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Contradiction {
    station: StationHash,
    /// The last of them.
    at: Instant,
    /// Whether it saw past all that is certain of the station.
    is_past: bool,
}

/// The range sensor's part of the unit.
#[derive(Clone, Debug, Default)]
pub(in crate::unit) struct Ranging {
    newest: Held<Sight>,
    /// Whoever was seen standing last, until a view shows that it is not there.
    standing: Held<Sight>,
    /// Views in a row that contradict.
    contradictions: u8,
    /// Views in a row that saw past all that is certain of the target.
    past: u8,
    contradiction: Held<Contradiction>,
    /// Since when the driver has named whom it names.
    named: Instant,
}

impl Ranging {
    pub(in crate::unit) const fn new() -> Self {
        Self {
            newest: Held::Nothing,
            standing: Held::Nothing,
            contradictions: 0,
            past: 0,
            contradiction: Held::Nothing,
            named: Instant::ZERO,
        }
    }

    /// Takes note that the driver names another one from now on: what was seen before is not of that one.
    pub(in crate::unit) fn note_named(&mut self, at: Instant) {
        (self.named, self.contradictions, self.past) = (at, 0, 0);
    }

    /// Whether a view may be of whom the driver names: who was not on the way yet was not hidden by what was seen.
    pub(in crate::unit) fn is_of_named(&self, seen: Instant) -> bool {
        seen >= self.named
    }

    /// Takes a view in.
    pub(in crate::unit) fn see(&mut self, sight: Sight) {
        let seen = sight.bound();
        // The same one again, or farther: nobody is where it was held to be, then.
        let is_beyond = |held: &Sight| {
            seen.highest_position() >= held.bound().after(seen.at(), &AccelerationRange::WORST).lowest_position()
        };
        if seen.lowest_speed() <= CRAWL {
            self.standing.set(sight);
        } else if self.standing.as_ref().is_some_and(is_beyond) {
            self.standing.clear();
        }
        self.newest.set(sight);
    }

    /// The vehicle ahead at now as the sensor saw it, at constant speed since; its rear bumper takes the place of the
    /// front one. `None` if the view is too old.
    pub(in crate::unit) fn ahead(&self, now: Instant) -> Option<Reading> {
        let sight = self.newest.get().filter(|sight| now.since(sight.at) <= RANGE_TIMEOUT)?;
        let age = now.since(sight.at).seconds();
        Some(Reading { position: sight.rear.ahead(sight.speed.over(age)), speed: sight.speed })
    }

    /// What is certain of the rears of those who are remembered as `station` is not, each at the time of its view.
    pub(in crate::unit) fn strangers(
        &self,
        now: Instant,
        station: Option<StationHash>,
    ) -> impl Iterator<Item = Bound> + use<> {
        let moving = self.newest.get().filter(|sight| now.since(sight.at) <= MOVING);
        let remembered = [moving, self.standing(now)].into_iter().flatten();
        remembered.filter(move |sight| station.is_none() || sight.station != station).map(|sight| sight.bound())
    }

    /// Whoever was seen standing.
    pub(in crate::unit) fn standing(&self, now: Instant) -> Option<Sight> {
        self.standing.get().filter(|sight| now.since(sight.at) <= STANDING)
    }

    /// Takes note of whether a view contradicts what is certain of a station, and saw past that. Whether a disagreement begins.
    pub(in crate::unit) fn judge(
        &mut self,
        station: StationHash,
        at: Instant,
        verdict: Verdict,
        heard: Option<Instant>,
    ) -> bool {
        self.past = if verdict == Verdict::SeesPast { self.past.saturating_add(1) } else { 0 };
        if verdict == Verdict::Agrees {
            self.contradictions = 0;
            return false;
        }
        self.contradictions = self.contradictions.saturating_add(1);
        let held = self.holds(station, at, heard, SETTLED);
        let begins = held.is_none();
        if begins && self.contradictions < DISAGREEMENT {
            return false;
        }
        // A single view past it, while somebody nearer had contradicted it, is one that missed it.
        let was_past = held.is_some_and(|held| held.is_past) && self.past > 0;
        self.contradiction.set(Contradiction { station, at, is_past: was_past || self.past >= DISAGREEMENT });
        begins
    }

    /// Whether what is seen and what is heard of a station, `heard` last, contradict one another.
    pub(in crate::unit) fn disagrees(&self, station: StationHash, now: Instant, heard: Option<Instant>) -> bool {
        self.holds(station, now, heard, SETTLED).is_some()
    }

    /// Whether the sensor sees that a station is not where it is held to be: by a view that is not too old, or since which nothing
    /// was heard of it.
    pub(in crate::unit) fn sees_past(&self, station: StationHash, now: Instant, heard: Option<Instant>) -> bool {
        self.holds(station, now, heard, RANGE_TIMEOUT).is_some_and(|contradiction| contradiction.is_past)
    }

    fn holds(
        &self,
        station: StationHash,
        now: Instant,
        heard: Option<Instant>,
        lasts: Duration,
    ) -> Option<Contradiction> {
        self.contradiction.get().filter(|held| {
            let is_unheard = held.is_past && heard.is_none_or(|heard| heard <= held.at);
            held.station == station && (is_unheard || now.since(held.at) <= lasts)
        })
    }
}

/// What a view says of what is certain of a station.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::unit) enum Verdict {
    /// It may be that station's.
    Agrees,
    /// It is not, or what is heard is wrong.
    Contradicts,
    /// Likewise, and the station cannot be where it is held to be.
    SeesPast,
}
