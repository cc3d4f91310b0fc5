//! The ego's own horizon: its state and whom it follows enter; where it will be leaves, past the changes of whom it follows
//! that it can foresee.
//!
//! A vehicle that falls silent drives on by what it knows, and so do those ahead of it. When the one that it follows leaves the
//! conflict area, or it comes to the next intersection itself, it follows somebody else from then on: by the order that it
//! knows already and by horizons that it holds already. So its own horizon says so, and with it everyone who hears it knows,
//! and whoever is behind those.

use super::OnboardUnit;
use crate::controller::Gains;
use crate::coordination::{Choice, Entry, Gentleness, REVIEW, Slots, Standing};
use crate::estimator::{Driver, Reading};
use crate::peers::{Sample, Track};
use crate::time::Instant;
use crate::units::Position;

/// A stretch of the own horizon over which the ego drives in one way.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Stretch {
    /// The crossing that comes next.
    crossing: usize,
    /// Whom it follows, unless it halts.
    target: Option<usize>,
    /// Whether it halts before that crossing.
    halts: bool,
    gentleness: Gentleness,
}

impl Stretch {
    fn followed(&self) -> Option<usize> {
        self.target.filter(|_| !self.halts)
    }
}

/// What a review will find.
struct Outlook {
    /// Whom the ego will follow.
    target: Option<usize>,
    /// Who will be just ahead on its leg.
    lane: Option<usize>,
}

impl<const PEERS: usize, const SAMPLES: usize, const STEPS: usize> OnboardUnit<PEERS, SAMPLES, STEPS> {
    /// Computes the ego's own horizon from its own state.
    pub(super) fn foresee(&mut self, now: Instant, sample: &Sample, target: Option<usize>) {
        let choice = self.coordination.choice();
        let Choice { halts, gentleness, mut is_held, .. } = *choice;
        let mut stretch = Stretch { crossing: self.coordination.next(), target, halts, gentleness };
        let mut gains = self.association.map(|(_, gains)| gains);
        let mut manner = self.estimator.manner(self.driver(), stretch.followed(), &self.peers);
        let review = self.coordination.next_review().filter(|_| self.is_decided_by_order());
        self.estimator.foresee_own(now, review, sample, &manner);
        let Some(mut review) = review.map(|review| review.max(now)) else { return };
        let minded = self.minded(now, stretch.crossing);
        while self.estimator.is_own_short(now) {
            let Some(own) = self.estimator.read_own(review) else { return };
            let crossing = self.coordination.next_of(stretch.crossing, own.position, self.config.length);
            let Outlook { target, lane } = self.outlook(review, &own, crossing, minded, stretch.target);
            let may = self.gentleness(target, crossing, own.position, own.speed);
            let is_new = target != stretch.target;
            if is_new {
                gains = target.and_then(|index| self.gains_behind(index, &own, review));
            }
            let gentleness = if is_new { may } else { may.min(stretch.gentleness) };
            is_held = self.can_wait(is_held, crossing, own.position, own.speed)
                && self.has_to_wait(lane, crossing, now, review);
            let asked = target.map_or(i64::MAX, |index| self.asks(index, review, crossing));
            let halts = is_held && self.is_halt_due(crossing, own.position, asked);
            let next = Stretch { crossing, target, halts, gentleness };
            if next != stretch {
                stretch = next;
                manner = self.estimator.manner(self.driver_over(&stretch, gains), stretch.followed(), &self.peers);
            }
            review = review.plus(REVIEW);
            self.estimator.carry_own_on(now, review, &manner);
        }
    }

    /// How the ego drives over that stretch, with these gains behind whom it follows.
    fn driver_over(&self, stretch: &Stretch, gains: Option<Gains>) -> Driver {
        let halting = || self.driver_halting(stretch.crossing).filter(|_| stretch.halts);
        halting().unwrap_or_else(|| {
            let behind = |index| self.standstill_at(stretch.crossing, index);
            self.driver_with(gains.zip(stretch.target.map(behind)), stretch.gentleness)
        })
    }

    /// The gains of an association that begins then.
    fn gains_behind(&self, index: usize, own: &Reading, at: Instant) -> Option<Gains> {
        let ahead = self.estimated(index, at)?;
        let headway = ahead.position.ahead_of(own.position);
        Some(Gains::look_up(&self.config.law, own.speed, ahead.speed, headway))
    }

    /// Whom it may follow one day, with that crossing next: who is ahead on its leg now, and nobody passes there; who is ahead in the
    /// order; and who has come to a later crossing.
    fn minded(&self, now: Instant, next: usize) -> Slots {
        let mut minded = Slots::NONE;
        let Some(own) = self.estimator.read_own(now) else { return minded };
        for index in 0..PEERS {
            let is_minded = self.coordination.standing(index).is_some_and(|standing| {
                if self.coordination.is_on_lane(standing) {
                    self.estimated(index, now).is_some_and(|reading| reading.position > own.position)
                } else {
                    let is_ahead = || self.entry(index, standing).is_some_and(|entry| self.is_ahead(index, &entry));
                    standing.crossing > next || standing.crossing == next && is_ahead()
                }
            });
            minded.set(index, is_minded);
        }
        minded
    }

    /// Whom the ego will follow, with that state and that crossing next, by the order and the horizons as they are
    /// known now. Who registers in between is not known.
    fn outlook(
        &self,
        at: Instant,
        own: &Reading,
        crossing: usize,
        minded: Slots,
        followed: Option<usize>,
    ) -> Outlook {
        let (front, end) = (own.position, self.coordination.end_of(crossing));
        let is_later = crossing != self.coordination.next();
        let (mut order, mut lane) = (None::<(usize, Entry)>, None::<(usize, Position)>);
        for index in (0..PEERS).filter(|index| minded.contains(*index)) {
            let Some(standing) = self.coordination.standing(index) else { continue };
            let is_on_lane = self.coordination.is_on_lane(standing);
            // What needs no horizon is asked first.
            let entry = self.entry(index, standing).filter(|entry| {
                let is_ahead = is_later || self.is_ahead(index, entry);
                is_ahead && standing.crossing == crossing && order.is_none_or(|(_, last)| last.is_before(entry))
            });
            if !is_on_lane && entry.is_none() {
                continue;
            }
            let Some((reading, rear)) = self.rear(index, at) else { continue };
            if is_on_lane && reading.position > front && lane.is_none_or(|(_, nearest)| reading.position < nearest) {
                lane = Some((index, reading.position));
            }
            let Some(entry) = entry.filter(|_| end.is_some_and(|end| rear < end)) else { continue };
            if followed == Some(index) || self.coordination.is_announced(standing, at, crossing, front, own.speed) {
                order = Some((index, entry));
            }
        }
        // Who is ahead on the same leg and not yet at a later crossing comes there before the ego, and after all who are there now.
        let comes_last =
            |index| self.coordination.standing(index).is_some_and(|standing| standing.crossing != crossing);
        let order = order.filter(|_| !(is_later && lane.is_some_and(|(index, _)| comes_last(index))));
        let is_heeded = |index: &usize| self.is_heeded(*index, at, front, own.speed);
        let (order, lane) = (order.map(|(index, _)| index), lane.map(|(index, _)| index));
        let target =
            self.more_careful(order.filter(is_heeded), lane.filter(is_heeded), at, crossing, front, own.speed);
        let target = target.filter(|target| self.is_in_the_way(*target, at, crossing, front, followed));
        Outlook { target, lane }
    }

    /// A peer in the order.
    pub(super) fn entry(&self, index: usize, standing: &Standing) -> Option<Entry> {
        let station = self.peers.get(index).and_then(Track::station)?;
        Some(Entry { station, arrival: standing.arrival, claim: standing.claim })
    }

    /// Whether a station was ahead at the last review, and still is by what it has said since.
    fn is_ahead(&self, index: usize, entry: &Entry) -> bool {
        let arrival = self.coordination.registration().map(|registration| registration.arrival);
        let own = Entry { station: self.config.station, arrival, claim: self.coordination.claim() };
        self.coordination.choice().ahead.contains(index) && entry.is_before(&own)
    }
}
