//! The time gap while nothing new is known of the vehicle ahead. Whether there is news of it enters, before every own motion, and so does
//! a larger gap that the driver asks for; by how much the time gap is opened leaves, now and later.
//!
//! A unit that neither hears nor sees the vehicle ahead drives by an estimate that gets worse. The published rule:
//!
//! * when there has been no news for [`OPENS_AFTER`](crate::parameters::OPENS_AFTER), the time gap opens by one second in [`OPENS_BY`], up
//!   to [`Law::silent_time_gap`](crate::config::Law);
//! * with the next news it closes again, as slowly;
//! * a larger time gap that is wanted takes the place of as much that was opened.
//!
//! It goes on between own motions, so that no demand jumps. With the tables of gains the string is as stable at every larger gap. The own
//! horizon is computed with the gap as it will be if it goes on like that, and turns where the target is foreseen to change: others know of
//! the opening by it. Those that lost the horizon know the time gap that is told.

use crate::fixed::quotient;
use crate::held::Held;
use crate::parameters::OPENS_BY;
use crate::time::{Duration, Instant};
use crate::units::Seconds;

/// The time gap is told in such steps: driving parameters are sent at once when they change.
const TOLD: Duration = Duration::from_millis(100);
/// After a longer pause in the own motions the time gap goes on as if the pause had been this long.
const LONGEST: Duration = Duration::from_millis(1_000);

/// By how much the time gap is opened.
#[derive(Clone, Debug)]
pub(super) struct Opening {
    by: Duration,
    /// The most that it may be.
    most: Duration,
    opens: bool,
    /// When it was opened by `by`: at the last own motion, or at a foreseen turn.
    at: Held<Instant>,
}

impl Opening {
    /// As the driver wants it: all zero.
    pub const NONE: Self = Self { by: Duration::ZERO, most: Duration::ZERO, opens: false, at: Held::Nothing };

    /// One own motion later: it goes on as it did since the last one, and opens or closes from now on. It opens by `most` at most.
    pub fn go_on(&mut self, now: Instant, opens: bool, most: Seconds) {
        self.by = if self.is_opened() { self.at_instant(now) } else { Duration::ZERO };
        (self.at, self.opens) = (Held::Value(now), opens);
        self.limit(most);
    }

    /// The time gap that is wanted became larger by this, which takes the place of as much that was opened. It opens by `most` at most from
    /// now on.
    pub fn give_way(&mut self, wider: Seconds, most: Seconds) {
        self.by = self.by.minus(span(wider)).max(Duration::ZERO);
        self.limit(most);
    }

    fn limit(&mut self, most: Seconds) {
        self.opens &= most > Seconds::ZERO;
        self.most = span(most);
        self.by = self.by.min(self.most);
    }

    /// The gap is not the unit's: it begins as the driver wants it.
    pub fn forget(&mut self) {
        *self = Self::NONE;
    }

    /// By how much it is opened now; `None` if it is not.
    pub fn in_force(&self, now: Instant) -> Option<Seconds> {
        self.is_opened().then(|| self.at_instant(now).seconds())
    }

    /// Whether it is opened, or begins to open.
    pub fn is_opened(&self) -> bool {
        self.opens || self.by > Duration::ZERO
    }

    /// By how much it will be opened at a later instant, if it goes on like that.
    pub fn later(&self, at: Instant) -> Seconds {
        self.after(self.at.get().map_or(Duration::ZERO, |last| at.since(last))).seconds()
    }

    /// It goes on like that up to an instant, and opens or closes from then on.
    pub fn turn(&mut self, at: Instant, opens: bool) {
        self.by = self.after(self.at.get().map_or(Duration::ZERO, |last| at.since(last)));
        (self.at, self.opens) = (Held::Value(at), opens);
    }

    /// By how much it is opened as it is told.
    pub fn told(&self) -> Seconds {
        if self.by == Duration::ZERO {
            return Seconds::ZERO;
        }
        let half = TOLD.as_micros() / 2;
        TOLD.times(quotient(self.by.as_micros().saturating_add(half), TOLD.as_micros())).min(self.most).seconds()
    }

    fn at_instant(&self, now: Instant) -> Duration {
        self.after(self.at.get().map_or(Duration::ZERO, |last| now.since(last).min(LONGEST)))
    }

    fn after(&self, time: Duration) -> Duration {
        let way = Duration::from_micros(quotient(time.as_micros(), OPENS_BY));
        let by = if self.opens { self.by.plus(way) } else { self.by.minus(way) };
        by.max(Duration::ZERO).min(self.most)
    }
}

/// A time as a span, to a millisecond; a negative one is none.
fn span(seconds: Seconds) -> Duration {
    Duration::from_millis(seconds.to_millis().max(0).into())
}

#[cfg(test)]
mod tests {
    use super::*;

    const MOST: Seconds = Seconds::from_millis(800);

    fn at(millis: u64) -> Instant {
        Instant::from_micros(millis * 1_000)
    }

    /// By how much it is opened at the last own motion, in ms.
    fn now(opening: &Opening) -> i32 {
        opening.in_force(opening.at.get().unwrap_or(Instant::ZERO)).map_or(0, Seconds::to_millis)
    }

    /// Own motions every 100 ms up to an instant.
    fn drive(opening: &mut Opening, millis: core::ops::Range<u64>, opens: bool) {
        millis.step_by(100).for_each(|now| opening.go_on(at(now), opens, MOST));
    }

    #[test]
    fn it_opens_by_a_tenth_of_the_time_and_closes_as_slowly() {
        let mut opening = Opening::NONE;
        drive(&mut opening, 0..5_100, false);
        assert!(!opening.is_opened());
        assert_eq!(opening.in_force(at(5_050)), None);
        drive(&mut opening, 5_100..7_200, true);
        assert_eq!(now(&opening), 200);
        assert_eq!(opening.in_force(at(7_150)), Some(Seconds::from_millis(205)));
        drive(&mut opening, 7_200..8_300, false);
        assert_eq!(now(&opening), 110);
        drive(&mut opening, 8_300..20_000, false);
        assert_eq!(now(&opening), 0);
        assert!(!opening.is_opened());
    }

    #[test]
    fn it_opens_no_further_than_it_may() {
        let mut opening = Opening::NONE;
        drive(&mut opening, 0..60_000, true);
        assert_eq!(now(&opening), 800);
        // Less may be opened from now on.
        opening.go_on(at(60_000), true, Seconds::from_millis(300));
        assert_eq!(now(&opening), 300);
        opening.go_on(at(60_100), true, Seconds::from_millis(-300));
        assert_eq!(now(&opening), 0);
        assert!(!opening.is_opened());
    }

    #[test]
    fn a_larger_gap_that_is_wanted_takes_the_place_of_what_was_opened() {
        // Wanted by so much more in ms, after 500 ms were opened of 800.
        for (wider, left, most) in [(-200, 500, 1_000), (0, 500, 800), (200, 300, 600), (450, 50, 350), (600, 0, 200)] {
            let mut opening = Opening::NONE;
            drive(&mut opening, 0..5_100, true);
            opening.give_way(Seconds::from_millis(wider), MOST.minus(Seconds::from_millis(wider)));
            assert_eq!(now(&opening), left, "{wider}");
            let end = opening.later(at(65_000));
            assert_eq!(end, Seconds::from_millis(most), "{wider}");
        }
    }

    #[test]
    fn what_it_will_be_is_what_it_becomes() {
        let mut opening = Opening::NONE;
        drive(&mut opening, 0..1_100, true);
        let (soon, late, end) = (opening.later(at(1_500)), opening.later(at(4_500)), opening.later(at(10_500)));
        drive(&mut opening, 1_100..1_600, true);
        assert_eq!(now(&opening), soon.to_millis());
        drive(&mut opening, 1_600..4_600, true);
        assert_eq!(now(&opening), late.to_millis());
        assert_eq!(end, MOST);
    }

    #[test]
    fn it_turns_ahead_of_time() {
        // Opened by 400 ms at 4 s, it opens up to 5 s, and from then on it opens or closes.
        for (opens, then) in [(true, 700), (false, 300)] {
            let mut opening = Opening::NONE;
            drive(&mut opening, 0..4_100, true);
            opening.turn(at(5_000), opens);
            assert_eq!(opening.later(at(7_000)), Seconds::from_millis(then), "{opens}");
        }
    }

    #[test]
    fn it_is_told_to_the_nearest_tenth() {
        let mut opening = Opening::NONE;
        for (until, told) in [(100, 0), (500, 0), (600, 100), (1_500, 100), (1_600, 200), (60_000, 800)] {
            opening.forget();
            drive(&mut opening, 0..until, true);
            assert_eq!(opening.told(), Seconds::from_millis(told), "{until}");
        }
        // No more than it may be.
        opening.go_on(at(60_000), true, Seconds::from_millis(750));
        assert_eq!(opening.told(), Seconds::from_millis(750));
    }

    #[test]
    fn a_pause_does_not_open_it_at_once() {
        let mut opening = Opening::NONE;
        drive(&mut opening, 0..100, false);
        opening.go_on(at(30_000), true, MOST);
        assert_eq!(now(&opening), 0);
        opening.go_on(at(60_000), true, MOST);
        assert_eq!(now(&opening), 100);
    }
}
