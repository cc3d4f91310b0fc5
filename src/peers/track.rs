//! The track of one peer. Checked messages enter by rule; the newest sample, and which samples were heard before it, leave.

use heapless::Deque;

use super::limits::Limits;
use super::link::Link;
use super::plausibility::{Belief, Certainty, Grounds, Judgement, uncertainty};
use super::sample::{Heard, Sample};
use super::sender_clock::{Off, SenderClock};
use crate::config::Link as Settings;
use crate::health::Cause;
use crate::held::Held;
use crate::model::bound::{AccelerationRange, Bound, Uncertainty};
use crate::parameters::DEFAULT_LENGTH;
use crate::time::{Duration, Instant};
use crate::units::{Distance, Position, Speed};
use crate::wire::StationHash;
use crate::wire::driving_parameters::DrivingParameters;
use crate::wire::horizon::Knots;

/// What an admitted sample is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Admission {
    /// The newest of its peer.
    News,
    /// Older than the newest; it only fills the history.
    History,
}

/// What is held of one slot: the newest sample of its station, which ones were heard, and what the station said of itself.
#[derive(Clone, Debug)]
pub struct Track<const SAMPLES: usize> {
    newest: Held<Sample>,
    /// The last samples with the newest, oldest first.
    heard: Deque<Heard, SAMPLES>,
    certainty: Certainty,
    parameters: Held<DrivingParameters>,
    /// When its driving parameters were received last.
    published_at: Instant,
    limits: Held<Limits>,
    horizon: Held<Foresight>,
    link: Link,
    sender_clock: SenderClock,
    is_disputed: bool,
    /// What is certain, carried on to the last tick, if that was done since the last change: many ask for it in a tick.
    carried: Bound,
    is_carried: bool,
}

impl<const SAMPLES: usize> Track<SAMPLES> {
    /// A free slot.
    #[must_use]
    pub const fn new(period: Duration) -> Self {
        Self {
            newest: Held::Nothing,
            heard: Deque::new(),
            certainty: Certainty::NONE,
            parameters: Held::Nothing,
            published_at: Instant::ZERO,
            limits: Held::Nothing,
            horizon: Held::Nothing,
            link: Link::new(period),
            sender_clock: SenderClock::NEW,
            is_disputed: false,
            carried: Bound::ZERO,
            is_carried: false,
        }
    }

    /// The station of the track.
    #[must_use]
    pub fn station(&self) -> Option<StationHash> {
        self.newest().map(|sample| sample.station)
    }

    /// The newest sample by its stamp.
    #[must_use]
    pub fn newest(&self) -> Option<&Sample> {
        self.newest.as_ref()
    }

    /// The last samples with the newest, oldest first.
    pub fn heard(&self) -> impl ExactSizeIterator<Item = &Heard> {
        self.heard.iter()
    }

    /// What is certain of the vehicle.
    #[must_use]
    pub const fn certainty(&self) -> &Certainty {
        &self.certainty
    }

    /// What is certain at an instant, now or later.
    #[must_use]
    pub fn bound(&self, at: Instant) -> Option<Bound> {
        if self.is_carried_to(at) {
            return Some(self.carried);
        }
        Some(self.certainty.bound()?.after(at, &self.reach()))
    }

    /// Whether what is certain at this instant was computed, and has not changed since.
    #[must_use]
    pub fn is_carried_to(&self, at: Instant) -> bool {
        self.is_carried && self.carried.at() == at
    }

    /// Computes what is certain at this instant, for all who ask for it.
    pub fn carry(&mut self, at: Instant) {
        if let Some(bound) = self.bound(at) {
            (self.carried, self.is_carried) = (bound, true);
        }
    }

    /// Narrows what is certain by what another sensor saw. Returns whether the two agree.
    pub fn narrow(&mut self, other: &Bound) -> bool {
        self.is_carried = false;
        let reach = self.reach();
        self.certainty.narrow(other, &reach)
    }

    /// How hard the vehicle can change its speed, from the instant of its bound on. These are the published limits, or the worst limits
    /// if none were published. Softer limits do not hold as soon as they are published.
    #[must_use]
    pub fn reach(&self) -> AccelerationRange {
        self.limits.as_ref().map_or(AccelerationRange::WORST, Limits::now)
    }

    /// The grounds on which a sample is judged.
    #[must_use]
    pub fn grounds(&self, around: Bound, uncertainty: Uncertainty, period: Duration) -> Grounds {
        let from_last = match (self.limits.as_ref(), self.newest()) {
            (Some(limits), Some(last)) => limits.from(last.at.minus(uncertainty.earlier)),
            _ => self.reach(),
        };
        Grounds { around, uncertainty, reach: self.reach(), from_last, period }
    }

    /// What is certain of the vehicle by a sample, or by what another sensor saw of it.
    #[must_use]
    pub fn around(&self, at: Instant, position: Position, speed: Speed, uncertainty: &Uncertainty) -> Bound {
        match self.limits.as_ref() {
            Some(limits) => limits.around(at, position, speed, uncertainty),
            None => Bound::around(at, position, speed, uncertainty, &AccelerationRange::WORST),
        }
    }

    /// Moves everything that is held of its place ahead by this way, because its axis moved.
    pub fn shift(&mut self, way: Distance) {
        if let Held::Value(newest) = &mut self.newest {
            newest.position = newest.position.ahead(way);
        }
        self.shift_certainty(way);
    }

    /// Forgets everything that is held of its place. What it said of how it drives still holds.
    pub fn restart(&mut self) {
        self.forget_samples();
        self.set_certainty(&Certainty::NONE);
    }

    fn set_certainty(&mut self, certainty: &Certainty) {
        self.certainty = *certainty;
        self.is_carried = false;
    }

    fn forget_samples(&mut self) {
        self.newest.clear();
        self.heard.clear();
    }

    /// Takes over what the same station said of how it drives in the slot that it was in before.
    pub fn follow_on(&mut self, before: &Self) {
        if self.parameters.as_ref().is_none() {
            (self.parameters, self.published_at, self.limits) = (before.parameters, before.published_at, before.limits);
            self.is_carried = false;
        }
    }

    /// Whether the driving parameters here came before any motion named a station, and so long ago that they may be of another station
    /// than the one that a motion names now.
    #[must_use]
    pub fn is_of_another(&self, at: Instant, slot_reuse: Duration) -> bool {
        let is_old = at.since(self.published_at) >= slot_reuse;
        self.station().is_none() && self.parameters.as_ref().is_some() && is_old
    }

    /// Begins anew for the station that a motion names now. Of the driving parameters that were said here before by an unknown station,
    /// the length counts if it is longer than the default length, because it may be this station's.
    pub fn begin(&mut self) {
        let said = self.parameters.get().filter(|parameters| parameters.length > DEFAULT_LENGTH);
        *self = Self { parameters: said.into(), published_at: self.published_at, ..Self::new(self.link.period()) };
    }

    /// What the vehicle said of how it drives.
    #[must_use]
    pub const fn parameters(&self) -> Option<&DrivingParameters> {
        self.parameters.as_ref()
    }

    /// The length that the vehicle publishes.
    #[must_use]
    pub fn published_length(&self) -> Option<Distance> {
        self.parameters().map(|parameters| parameters.length)
    }

    /// The length of the vehicle: as published, or else that of a car.
    #[must_use]
    pub fn length(&self) -> Distance {
        self.published_length().unwrap_or(DEFAULT_LENGTH)
    }

    /// The horizon that the vehicle computed from its newest sample, if it has come.
    #[must_use]
    pub fn knots(&self) -> Option<&Knots> {
        let Foresight { received, of, knots } = self.horizon.as_ref()?;
        let newest = self.newest()?;
        let is_of_newest = match of {
            Some(at) => newest.at == *at,
            None => newest.tag == knots.tag && self.is_of_one_round(*received, newest.received),
        };
        is_of_newest.then_some(knots)
    }

    /// Whether the second of two parts of a message came so soon after the first that their tags, which repeat after four messages, tell
    /// which message each is of.
    fn is_of_one_round(&self, first: Instant, second: Instant) -> bool {
        (Duration::ZERO..self.link.period().times(2)).contains(&second.since(first))
    }

    /// The link.
    #[must_use]
    pub const fn link(&self) -> &Link {
        &self.link
    }

    /// How far the clock of the station is off.
    #[must_use]
    pub fn clock_off(&self) -> Off {
        self.sender_clock.off()
    }

    /// Notes when a motion of the station was received and stamped, on clocks that are off by `limits.clock_error` at most. Returns
    /// whether the station's clock is found to be off, once for each window. If the uncertainty grows by that, what was certain is given
    /// up, because it relied on the stamps too much.
    pub fn hear_clock(&mut self, received: Instant, stamped: Instant, limits: &Settings) -> bool {
        let before = self.clock_off();
        let begins = self.sender_clock.hear(received, stamped, limits.clock_error, limits.period);
        let off = self.clock_off();
        let ((earlier, later), (earlier_before, later_before)) = (off.uncertainty(), before.uncertainty());
        if (earlier > earlier_before || later > later_before)
            && let Some(newest) = self.newest().copied()
        {
            let at = if newest.is_timed { off.corrected(newest.at) } else { newest.at };
            let newest = Sample { at, ..newest };
            let uncertainty = uncertainty(&newest, newest.is_timed, limits, off);
            self.is_carried = false;
            self.certainty.restart(self.around(newest.at, newest.position, newest.speed, &uncertainty));
        }
        off != Off::No && (begins || before == Off::No)
    }

    /// Whether another station spoke last in the slot, and was refused. Only motions name their station. So other messages in the slot
    /// are not taken for this station's then.
    #[must_use]
    pub const fn is_disputed(&self) -> bool {
        self.is_disputed
    }

    /// Notes a refused motion of another station.
    pub fn dispute(&mut self) {
        self.is_disputed = true;
    }

    /// Notes that the station of the slot spoke last.
    pub fn settle(&mut self) {
        self.is_disputed = false;
    }

    /// Judges a sample of the slot's own station, by the first rule that it breaks:
    ///
    /// 1. its stamp is held already, or was refused last: [`Cause::Duplicate`]. A stamp repeats after 13.1 s, but the stamp of the newest
    ///    sample counts as frozen whenever it comes again. So one honest sample in 131,072 is lost;
    /// 2. it is older than a full history: [`Cause::OutOfOrder`];
    /// 3. it is newer than all samples held, but contradicts what is certain of the station: see [`plausibility`](super::plausibility).
    #[must_use]
    pub fn judge(&self, sample: &Sample, uncertainty: &Uncertainty, period: Duration) -> Judgement {
        let verdict = |verdict| Judgement { certainty: self.certainty, verdict };
        let is_frozen = self.newest().is_some_and(|newest| newest.stamp == sample.stamp);
        if is_frozen || self.heard.iter().any(|held| held.is_again(sample)) {
            return verdict(Err(Cause::Duplicate));
        }
        if self.newest().is_none_or(|newest| newest.at < sample.at) {
            let around = self.around(sample.at, sample.position, sample.speed, uncertainty);
            return self.certainty.judge(sample, self.newest(), &self.grounds(around, *uncertainty, period));
        }
        let is_oldest = self.heard.front().is_some_and(|oldest| sample.at <= oldest.at);
        verdict(if is_oldest && self.heard.is_full() { Err(Cause::OutOfOrder) } else { Ok(Belief::Late) })
    }

    /// Admits a sample that was judged like this, and what is certain with it.
    pub fn admit(&mut self, sample: &Sample, certainty: &Certainty, belief: Belief) -> Admission {
        if belief == Belief::Recovered {
            self.forget_samples();
        }
        self.set_certainty(certainty);
        self.link.heard(sample.received, sample.at);
        self.settle();
        self.insert(sample)
    }

    /// Keeps the evidence of a refused sample.
    pub fn note(&mut self, certainty: &Certainty) {
        self.is_carried &= self.certainty.bound() == certainty.bound();
        self.certainty = *certainty;
    }

    /// Moves what is certain ahead by this way, because the axis moved, on which the newest sample is already.
    pub fn shift_certainty(&mut self, way: Distance) {
        self.is_carried = false;
        self.certainty.shift(way);
    }

    fn insert(&mut self, sample: &Sample) -> Admission {
        let heard = Heard::of(sample);
        if self.newest().is_none_or(|newest| newest.at < sample.at) {
            if self.heard.is_full() {
                self.heard.pop_front();
            }
            let _ = self.heard.push_back(heard); // there is room
            self.newest.set(*sample);
            return Admission::News;
        }
        let older = self.heard.iter().take_while(|held| held.at < sample.at).count();
        // The others move by swaps, so that no index can be out of bounds.
        let mut moved = heard;
        if self.heard.is_full() {
            self.heard.iter_mut().take(older).rev().for_each(|held| core::mem::swap(held, &mut moved));
        } else {
            self.heard.iter_mut().skip(older).for_each(|held| core::mem::swap(held, &mut moved));
            let _ = self.heard.push_back(moved); // it is not full
        }
        Admission::History
    }

    /// Takes in the driving parameters of the station, received at `at`. Returns whether they are new. No message older than `stale`
    /// comes after them.
    pub fn publish(&mut self, at: Instant, parameters: DrivingParameters, stale: Duration) -> bool {
        let published = AccelerationRange::published(&parameters.limits);
        let limits = match self.limits.get() {
            Some(held) => held.publish(at, published, stale),
            None => Limits::first(at, published),
        };
        self.limits.set(limits);
        self.is_carried = false;
        self.certainty.settle(&limits);
        self.published_at = at;
        let is_new = self.parameters.as_ref() != Some(&parameters);
        self.parameters.set(parameters);
        is_new
    }

    /// Takes in the horizon that the station computed. Returns whether it belongs to the newest sample. It belongs to the sample with its
    /// tag that was received last before it. Where there is none, it has overtaken its sample, and waits for it. A horizon that was
    /// overtaken together with its sample does not displace the newest sample's.
    pub fn foresee(&mut self, received: Instant, knots: Knots) -> bool {
        let is_its = |held: &&Heard| held.tag == knots.tag && self.is_of_one_round(held.received, received);
        let of = self.heard.iter().filter(is_its).max_by_key(|held| held.received).map(|held| held.at);
        let behind = self.newest().map_or(0, |newest| newest.tag.wrapping_sub(knots.tag) % 4);
        let is_overtaken = match of {
            Some(at) => self.newest().is_some_and(|newest| newest.at != at),
            None => matches!(behind, 1 | 2),
        };
        if is_overtaken && self.knots().is_some() {
            return false;
        }
        self.horizon.set(Foresight { received, of, knots });
        self.knots().is_some()
    }
}

/// A horizon that the station sent.
#[derive(Clone, Debug)]
struct Foresight {
    received: Instant,
    /// The time of the sample that it was computed from, if that came before it.
    of: Option<Instant>,
    knots: Knots,
}
