//! The unit's knowledge of GNSS time: the two steps of a synchronisation enter, the mapping between the unit's clock and
//! GNSS time leaves.
//!
//! The *reception* of `Sync` is the mark. `FollowUp` says when the mark was really sent. With two marks half a second apart, the error is
//! bounded by the relative drift of the clocks (100 ppm · 0.5 s = 50 µs) and the jitter of the reception. So no rate is estimated.
//!
//! A mark can be late, because a gateway or the unit itself was busy. What a follow-up says can be wrong. If a synchronisation says that
//! less time has passed than the unit's own clock says, it is refused as late. If it says that more time has passed, it is refused as
//! early. The mark before it then holds. If GNSS time itself steps, or if the mark before was the late one, all marks are off from then
//! on, by the same amount. So the second mark in a row that is off by the same amount is believed. The price is half a second more of a
//! wrong time.

use crate::health::Cause;
use crate::time::{Duration, GnssTime, Instant, Stamp};
use crate::wire::sync::{FollowUp, Sync};

/// The mapping between the unit's clock and GNSS time, once it is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
struct Fix {
    local: Instant,
    gnss: GnssTime,
}

/// The clock's state.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Clock {
    mark: Option<(Instant, Sync)>,
    fix: Option<Fix>,
    /// The last mark, if it was refused as late or early.
    doubted: Option<Fix>,
}

impl Fix {
    fn gnss(&self, at: Instant) -> GnssTime {
        GnssTime::from_micros(self.gnss.as_micros().saturating_add_signed(at.since(self.local).as_micros()))
    }

    /// How late the mark `later` is by this mark; negative if it is early. `None` after [`MEMORY`], when this mark says nothing any more.
    fn lateness_of(&self, later: &Self) -> Option<Duration> {
        let (foretold, said) = (self.gnss(later.local).as_micros(), later.gnss.as_micros());
        let is_near = later.local.since(self.local) < MEMORY;
        is_near.then(|| Instant::from_micros(foretold).since(Instant::from_micros(said)))
    }
}

/// How long after its mark a follow-up may come.
const FOLLOW_UP_TIMEOUT: Duration = Duration::from_millis(250);
/// A mark may be this late or early. At urban speed this is 5 cm, and far more than the clocks drift apart while a mark is remembered.
const LATE: Duration = Duration::from_millis(5);
/// For how long a mark can tell whether a later one is late. The drift of 100 ppm makes 0.5 ms of it.
const MEMORY: Duration = Duration::from_millis(5_000);

impl Clock {
    /// Not synchronised.
    #[must_use]
    pub const fn new() -> Self {
        Self { mark: None, fix: None, doubted: None }
    }

    /// Takes the first step, received at `at`.
    pub fn sync(&mut self, at: Instant, sync: Sync) {
        self.mark = Some((at, sync));
    }

    /// Takes the second step, received at `at`.
    ///
    /// # Errors
    /// [`Cause::SyncSequence`] if the first step is missing, belongs to another sequence, or is too long ago. [`Cause::SyncLate`] and
    /// [`Cause::SyncEarly`] if the first step came too late or too early, by the unit's own clock.
    pub fn follow_up(&mut self, at: Instant, follow_up: FollowUp) -> Result<(), Cause> {
        let (marked, sync) = self.mark.ok_or(Cause::SyncSequence)?;
        if sync.sequence != follow_up.sequence || at.since(marked) > FOLLOW_UP_TIMEOUT || at < marked {
            return Err(Cause::SyncSequence);
        }
        self.mark = None;
        let fix = Fix { local: marked, gnss: follow_up.time_of(&sync) };
        let after = |earlier: Option<Fix>| earlier.and_then(|earlier| earlier.lateness_of(&fix));
        let late = after(self.fix).unwrap_or(Duration::ZERO);
        let is_off = |late: Duration| late > LATE || late < Duration::ZERO.minus(LATE);
        let is_off_by_the_same = after(self.doubted).is_some_and(|late| !is_off(late));
        if is_off(late) && !is_off_by_the_same {
            self.doubted = Some(fix);
            return Err(if late > Duration::ZERO { Cause::SyncLate } else { Cause::SyncEarly });
        }
        (self.fix, self.doubted) = (Some(fix), None);
        Ok(())
    }

    /// Whether GNSS time is known at this instant, by a synchronisation that is no older than `timeout`.
    #[must_use]
    pub fn is_synchronised(&self, now: Instant, timeout: Duration) -> bool {
        self.fix.is_some_and(|fix| now.since(fix.local) <= timeout)
    }

    /// GNSS time at an instant, if there ever was a synchronisation.
    #[must_use]
    pub fn gnss(&self, at: Instant) -> Option<GnssTime> {
        Some(self.fix?.gnss(at))
    }

    /// The instant of a stamp that was received at `at`, if there ever was a synchronisation.
    #[must_use]
    pub fn instant_of(&self, stamp: Stamp, at: Instant) -> Option<Instant> {
        let now = self.gnss(at)?;
        let time = stamp.unwrap_near(now).as_micros();
        let age = i64::try_from(now.as_micros()).ok()?.checked_sub(i64::try_from(time).ok()?)?;
        Some(at.minus(Duration::from_micros(age)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HOUR: u64 = 3_600_000_000;

    fn synchronised() -> Clock {
        let mut clock = Clock::new();
        clock.sync(Instant::from_micros(2_000_000), Sync { sequence: 3, seconds: 3600 });
        clock.follow_up(Instant::from_micros(2_003_000), FollowUp { sequence: 3, micros: 250 }).unwrap();
        clock
    }

    #[test]
    fn the_reception_of_the_sync_message_is_the_mark() {
        let clock = synchronised();
        assert_eq!(clock.gnss(Instant::from_micros(2_000_000)), Some(GnssTime::from_micros(HOUR + 250)));
        assert_eq!(clock.gnss(Instant::from_micros(1_000_000)), Some(GnssTime::from_micros(HOUR - 999_750)));
    }

    #[test]
    fn a_stamp_becomes_the_instant_it_was_taken_at() {
        let clock = synchronised();
        let received = Instant::from_micros(29_000_000);
        for age in (-1_000_000..=10_000_000i64).step_by(99_900) {
            let taken = received.minus(Duration::from_micros(age));
            let gnss = HOUR + 250 + taken.as_micros().wrapping_sub(2_000_000);
            let instant = clock.instant_of(GnssTime::from_micros(gnss).stamp(), received).unwrap();
            assert!(instant.since(taken).as_micros().abs() <= 50, "{age}");
        }
    }

    #[test]
    fn a_follow_up_of_another_sync_message_does_not_spoil_the_right_one() {
        let mut clock = Clock::new();
        let at = Instant::from_micros(5);
        clock.sync(at, Sync { sequence: 3, seconds: 1 });
        assert_eq!(clock.follow_up(at, FollowUp { sequence: 4, micros: 0 }), Err(Cause::SyncSequence));
        assert_eq!(clock.follow_up(at, FollowUp { sequence: 3, micros: 0 }), Ok(()));
        assert_eq!(clock.follow_up(at, FollowUp { sequence: 3, micros: 0 }), Err(Cause::SyncSequence));
    }

    #[test]
    fn a_follow_up_needs_its_own_sync_message_just_before_it() {
        let sync = Sync { sequence: 3, seconds: 1 };
        let at = Instant::from_micros(0);
        let refused = Err(Cause::SyncSequence);
        assert_eq!(Clock::new().follow_up(at, FollowUp { sequence: 3, micros: 0 }), refused);
        for (sequence, micros) in [(4, 1_000), (3, 250_001)] {
            let mut clock = Clock::new();
            clock.sync(at, sync);
            assert_eq!(clock.follow_up(Instant::from_micros(micros), FollowUp { sequence, micros: 0 }), refused);
            assert!(!clock.is_synchronised(at, Duration::MAX));
        }
    }

    const TAKEN: Result<(), Cause> = Ok(());
    const LATER: Result<(), Cause> = Err(Cause::SyncLate);
    const EARLY: Result<(), Cause> = Err(Cause::SyncEarly);

    /// Synchronisations, as: milliseconds after the first was sent, by how much the mark is later than sent, and the expected result.
    fn marks(marks: &[(u64, i64, Result<(), Cause>)]) {
        let mut clock = Clock::new();
        for (number, (sent_ms, late_ms, expected)) in (0..).zip(marks) {
            let sent = 10_000_000 + 1_000 * sent_ms;
            let at = Instant::from_micros(sent).plus(Duration::from_millis(*late_ms));
            let (sequence, micros) = (number % 16, (sent % 1_000_000) as u32);
            clock.sync(at, Sync { sequence, seconds: (sent / 1_000_000) as u32 });
            let result = clock.follow_up(at, FollowUp { sequence, micros });
            assert_eq!(result, *expected, "{number}");
            if result.is_ok() {
                assert_eq!(clock.gnss(at), Some(GnssTime::from_micros(sent)), "{number}");
            }
        }
    }

    #[test]
    fn a_mark_that_was_too_long_on_its_way_is_refused() {
        marks(&[
            (0, 0, TAKEN),
            (500, 5, TAKEN),
            (1_000, 11, LATER),
            (1_500, 10, TAKEN),
            (2_000, 5, TAKEN),
            (2_500, 11, LATER),
        ]);
    }

    #[test]
    fn a_first_mark_that_was_late_is_corrected_by_the_next_two() {
        // A single mark does not tell which of the two is wrong.
        marks(&[(0, 30, TAKEN), (500, 0, EARLY), (1_000, 0, TAKEN), (1_500, 30, LATER), (2_000, 0, TAKEN)]);
    }

    #[test]
    fn a_mark_that_is_early_is_refused_and_the_one_before_it_holds() {
        marks(&[(0, 0, TAKEN), (500, -60, EARLY), (1_000, 0, TAKEN), (1_500, -6, EARLY), (2_000, -5, TAKEN)]);
        marks(&[(0, 0, TAKEN), (500, -60, EARLY), (1_000, 60, LATER), (1_500, -30, EARLY), (2_000, 0, TAKEN)]);
    }

    #[test]
    fn a_time_that_steps_ahead_is_believed_from_the_second_mark_on() {
        marks(&[(0, 0, TAKEN), (500, -100, EARLY), (1_000, -102, TAKEN), (1_500, -98, TAKEN), (2_000, 0, LATER)]);
    }

    #[test]
    fn marks_that_are_late_by_this_and_that_are_all_refused_until_the_last_good_one_is_forgotten() {
        let late =
            [(500, 6), (1_000, 80), (1_500, 74), (2_000, 80), (2_500, 20), (3_000, 26), (3_500, 90), (4_900, 40)];
        let late: Vec<_> = late.into_iter().map(|(sent_ms, late_ms)| (sent_ms, late_ms, LATER)).collect();
        marks(&[&[(0, 0, TAKEN)], &late[..], &[(4_990, 30, TAKEN)]].concat());
    }

    #[test]
    fn a_time_that_steps_back_is_believed_from_the_second_mark_on() {
        let back = [(500, 100, LATER), (1_000, 102, TAKEN), (1_500, 98, TAKEN), (2_000, 0, EARLY), (2_500, 0, TAKEN)];
        marks(&[&[(0, 0, TAKEN)], &back[..], &[(3_000, 30, LATER), (3_500, 25, TAKEN)]].concat());
    }

    #[test]
    fn after_a_long_silence_the_first_mark_is_believed_and_an_old_doubt_is_none() {
        marks(&[(0, 0, TAKEN), (60_000, 6, TAKEN)]);
        marks(&[(0, 0, TAKEN), (4_000, 30, LATER), (4_900, 0, TAKEN), (5_400, 30, LATER)]);
        marks(&[(0, 0, TAKEN), (500, 30, LATER), (4_800, 40, LATER)]);
    }

    #[test]
    fn a_synchronisation_expires() {
        let clock = synchronised();
        let timeout = Duration::from_millis(5000);
        assert!(clock.is_synchronised(Instant::from_micros(7_000_000), timeout));
        assert!(!clock.is_synchronised(Instant::from_micros(7_000_001), timeout));
    }
}
