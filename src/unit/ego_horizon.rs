//! The ego's own horizon: its state and whom it follows enter; where it will be leaves, past the changes of whom it follows
//! that it can foresee.
//!
//! A vehicle that falls silent drives on by what it knows, and so do those ahead of it. When the one that it follows leaves the
//! conflict area, or it comes to the next intersection itself, it follows somebody else from then on: by the order that it
//! knows already and by horizons that it holds already. So its own horizon says so, and with it everyone who hears it knows,
//! and whoever is behind those.

use super::OnboardUnit;
use crate::controller::Gains;
use crate::coordination::{Entry, PeerApproach, REVIEW, Slots};
use crate::model::Reading;
use crate::peers::{Sample, Track};
use crate::time::Instant;
use crate::units::Position;

impl<const PEERS: usize, const SAMPLES: usize, const STEPS: usize> OnboardUnit<PEERS, SAMPLES, STEPS> {
    /// Computes the ego's own horizon from its own state.
    pub(super) fn foresee(&mut self, now: Instant, sample: &Sample, target: Option<usize>) {
        let mut manner = self.estimator.manner(self.driver(), target, &self.peers);
        let review = self.coordination.next_review().filter(|_| self.is_decided_by_order());
        self.estimator.foresee_own(now, review, sample, &manner);
        let Some(mut review) = review.map(|review| review.max(now)) else { return };
        let (mut crossing, mut comfort) = (self.coordination.next(), self.coordination.choice().comfort);
        let mut gains = self.association.map(|(_, gains)| gains);
        let minded = self.minded(now, crossing);
        while self.estimator.is_own_short(now) {
            let Some(own) = self.estimator.read_own(review) else { return };
            crossing = self.coordination.next_of(crossing, own.position, self.config.length);
            let target = self.outlook(review, &own, crossing, minded, manner.target);
            let is_new = target != manner.target;
            let may = self.comfort(target, crossing, own.position, own.speed);
            if is_new || may < comfort {
                comfort = may;
                if is_new {
                    gains = target.and_then(|index| self.gains_behind(index, &own, review));
                }
                let association = gains.zip(target).map(|(gains, index)| (gains, self.standstill_at(crossing, index)));
                manner = self.estimator.manner(self.driver_with(association, comfort), target, &self.peers);
            }
            review = review.plus(REVIEW);
            self.estimator.carry_own_on(now, review, &manner);
        }
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
    ) -> Option<usize> {
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
        let (order, lane) = (order.filter(is_heeded), lane.filter(is_heeded));
        let target = self.more_careful(order, lane, at, crossing, front, own.speed)?;
        self.is_in_the_way(target, at, crossing, front, followed).then_some(target)
    }

    /// A peer in the order.
    pub(super) fn entry(&self, index: usize, standing: &PeerApproach) -> Option<Entry> {
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
