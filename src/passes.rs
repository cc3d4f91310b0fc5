//! Passes: who may be in a conflict area, and when. From claimed windows and what was heard, these functions decide which window may be
//! claimed, who gives way, and which window may be used.
//!
//! A *pass* is a window of GNSS time. Its vehicle may be in one conflict area only during that window: it goes in only if it is certain
//! to be out by the end, or by the clearance later. So the vehicle need not hear anything while it is in the area. Each vehicle *claims*
//! windows and publishes its claims with every message. The model checker in `tests/passes` runs these functions, and so does the unit.
//! The rules and their proof are in `docs/COORDINATION.md`.
//!
//! | rule | what | here |
//! |---|---|---|
//! | F2 | when a claim counts from, and that it overlaps nothing known | [`Rules::claims_from`], [`Rules::earliest_free`] |
//! | F3 | who gives way | [`Rules::gives_way`], [`Rules::trimmed`] |
//! | F4 | when a claim is firm, and for how long a vehicle stays known | [`Rules::is_firm`], [`Rules::is_forgotten`] |
//! | F5 | what may be used | [`is_covered`] |
//!
//! Times are GNSS times by the own clock of the station that says them. The clocks of two stations differ by at most
//! [`Rules::clocks`].

use crate::time::{Duration, GnssTime};

mod known;
mod own;

pub use known::{Full, KNOWN, List, Station};
pub use own::{Order, Outlook, Own, Slack};

/// So many windows a vehicle claims at once: an old one, and a piece that is added.
pub const PIECES: usize = 2;

/// A window of time in a conflict area: from the entry of the vehicle's front to the exit of its rear.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Window {
    /// The front enters at this time at the earliest.
    pub entry: GnssTime,
    /// The rear has left at this time at the latest.
    pub exit: GnssTime,
}

impl Window {
    /// Whether it has no time in it.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.exit <= self.entry
    }

    /// The window of the same length at another time.
    fn from(&self, entry: GnssTime) -> Self {
        Self { entry, exit: entry.plus(span(self)) }
    }
}

/// The length of a window.
fn span(window: &Window) -> Duration {
    let micros = window.exit.as_micros().saturating_sub(window.entry.as_micros());
    Duration::from_micros(i64::try_from(micros).unwrap_or(i64::MAX))
}

/// A window that a station has claimed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Claim {
    /// When it was claimed. Of two claims, the earlier one has priority.
    pub at: GnssTime,
    /// The window.
    pub window: Window,
    /// The station, which decides where two claims were made at the same time.
    pub station: u32,
}

impl Claim {
    /// Of nobody: all zero.
    const NONE: Self = Self {
        at: GnssTime::from_micros(0),
        window: Window { entry: GnssTime::from_micros(0), exit: GnssTime::from_micros(0) },
        station: 0,
    };

    /// Whether it has priority over the other (F3), by the time and the station alone.
    #[must_use]
    pub fn precedes(&self, other: &Self) -> bool {
        (self.at, self.station) < (other.at, other.station)
    }
}

/// What is known of another vehicle that comes by a conflicting way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Known<'a> {
    /// The stamp of the newest message that was heard of it.
    pub heard: GnssTime,
    /// The claims in that message.
    pub claims: &'a [Claim],
}

/// The times that the rules rest on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Rules {
    /// The longest time that two vehicles that are both on air may take until they hear one another for the first time. The period of
    /// messages and their delay are in it.
    pub silence: Duration,
    /// The largest difference of two clocks.
    pub clocks: Duration,
    /// By so much longer than clocks differ two windows are apart. A vehicle whose actuators are lazier than it believes may leave late by up
    /// to this.
    pub clearance: Duration,
    /// A vehicle that has been silent for so long is forgotten, if its windows are over.
    pub forgotten: Duration,
    /// The resolution of the time of a claim.
    pub step: Duration,
}

impl Rules {
    /// Those of the unit. Messages come five times a second and may be late, and no silence that is to surprise nobody is longer than 4 s.
    /// Clocks differ by up to 50 ms, and times are told by 10 ms.
    pub const UNIT: Self = Self {
        silence: Duration::from_millis(4_500),
        clocks: Duration::from_millis(60),
        clearance: Duration::from_millis(140),
        forgotten: Duration::from_millis(30_000),
        step: crate::wire::pass::STEP,
    };

    /// From when on a claim that is made now may count (F2): its station has been on air since `on_air`, and has stamped its last
    /// message with `said`.
    ///
    /// Two stations that have both been on air for [`silence`](Self::silence) have heard one another. No message that was sent already may
    /// lack a claim that counts at its stamp.
    #[must_use]
    pub fn claims_from(&self, now: GnssTime, on_air: GnssTime, said: Option<GnssTime>) -> GnssTime {
        let after_said = said.map_or(now, |said| said.plus(self.step));
        now.max(self.heard_by_all(on_air)).max(after_said)
    }

    /// From when on a station that has been on air since `on_air` has been heard by all.
    #[must_use]
    pub const fn heard_by_all(&self, on_air: GnssTime) -> GnssTime {
        on_air.plus(self.silence).plus(self.clocks)
    }

    /// Whether two vehicles may not have both windows: they overlap, or lie too close for the clocks and the clearance.
    #[must_use]
    pub fn conflict(&self, one: &Window, other: &Window) -> bool {
        let apart = self.clocks.plus(self.clearance);
        one.entry < other.exit.plus(apart) && other.entry < one.exit.plus(apart)
    }

    /// The earliest window of the same length as the wanted one, and not before it, that none of the taken ones forbids (F2).
    #[must_use]
    pub fn earliest_free(&self, wanted: &Window, taken: impl Iterator<Item = Window> + Clone) -> Window {
        let mut free = *wanted;
        // Each turn goes past one window for good.
        while let Some(other) = taken.clone().find(|other| self.conflict(&free, other)) {
            free = free.from(other.exit.plus(self.clocks).plus(self.clearance));
        }
        free
    }

    /// Whether the own claim has to give way to the other one (F3).
    #[must_use]
    pub fn gives_way(&self, own: &Claim, other: &Claim) -> bool {
        other.precedes(own) && self.conflict(&own.window, &other.window)
    }

    /// What the other window leaves of the own one: the longer part; empty if it leaves nothing (F3).
    #[must_use]
    pub fn trimmed(&self, own: &Window, other: &Window) -> Window {
        if !self.conflict(own, other) {
            return *own;
        }
        let apart = Duration::ZERO.minus(self.clocks.plus(self.clearance));
        let before = Window { exit: own.exit.min(other.entry.plus(apart)), ..*own };
        let after = Window { entry: own.entry.max(other.exit.plus(self.clocks).plus(self.clearance)), ..*own };
        let is_before_longer = !before.is_empty() && (after.is_empty() || span(&before) >= span(&after));
        if is_before_longer { before } else { after }
    }

    /// Whether a claim is firm (F4): it counts by now, everybody who is known on a conflicting way has been heard since it counts, and
    /// nobody claims what it has to give way to.
    #[must_use]
    pub fn is_firm<'a>(&self, now: GnssTime, own: &Claim, mut known: impl Iterator<Item = Known<'a>>) -> bool {
        let is_heard = |other: &Known| other.heard >= own.at;
        let has_priority = |other: &Known| other.claims.iter().any(|claim| self.gives_way(own, claim));
        own.at <= now && known.all(|other| is_heard(&other) && !has_priority(&other))
    }

    /// Whether a vehicle that has not said that it left is forgotten (F4): it was heard last with this stamp, and its last window ended
    /// at `exit`, if it has had one.
    #[must_use]
    pub fn is_forgotten(&self, now: GnssTime, heard: GnssTime, exit: Option<GnssTime>) -> bool {
        now > heard.plus(self.forgotten) && exit.is_none_or(|exit| now > exit.plus(self.clocks).plus(self.clearance))
    }
}

/// Whether a stay is wholly in firm windows (F5). Windows that follow one another cover a stay together.
#[must_use]
pub fn is_covered(stay: &Window, firm: impl Iterator<Item = Window> + Clone) -> bool {
    let mut reached = stay.entry;
    // Each turn goes past one window.
    while reached < stay.exit {
        let further = |window: &Window| window.entry <= reached && window.exit > reached;
        let Some(next) = firm.clone().filter(further).map(|window| window.exit).max() else { return false };
        reached = next;
    }
    true
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    pub const RULES: Rules = Rules {
        silence: Duration::from_micros(40),
        clocks: Duration::from_micros(2),
        clearance: Duration::from_micros(3),
        forgotten: Duration::from_micros(300),
        step: Duration::from_micros(1),
    };

    pub fn time(micros: u64) -> GnssTime {
        GnssTime::from_micros(micros)
    }

    pub fn window(entry: u64, exit: u64) -> Window {
        Window { entry: time(entry), exit: time(exit) }
    }

    pub fn claim(at: u64, window: Window, station: u32) -> Claim {
        Claim { at: time(at), window, station }
    }

    #[test]
    fn a_claim_counts_from_now_after_the_last_message_and_when_all_have_heard() {
        assert_eq!(RULES.claims_from(time(500), time(100), None), time(500));
        assert_eq!(RULES.claims_from(time(500), time(100), Some(time(500))), time(501));
        assert_eq!(RULES.claims_from(time(110), time(100), Some(time(105))), time(142));
    }

    #[test]
    fn windows_conflict_up_to_the_clocks_and_the_clearance() {
        for (entry, expected) in [(204, true), (205, false)] {
            assert_eq!(RULES.conflict(&window(100, 200), &window(entry, 300)), expected, "{entry}");
            assert_eq!(RULES.conflict(&window(entry, 300), &window(100, 200)), expected, "{entry}");
        }
    }

    #[test]
    fn the_earliest_free_window_is_the_first_gap_that_is_long_enough() {
        let taken = [window(300, 400), window(100, 200), window(220, 240)];
        let free = |entry, length| RULES.earliest_free(&window(entry, entry + length), taken.iter().copied());
        assert_eq!(free(0, 95), window(0, 95));
        assert_eq!(free(0, 96), window(405, 501));
        assert_eq!(free(90, 10), window(205, 215));
        assert_eq!(free(90, 11), window(245, 256));
        assert_eq!(free(390, 5), window(405, 410));
    }

    #[test]
    fn the_earlier_claim_has_priority_and_of_two_at_once_that_of_the_smaller_station() {
        let early = claim(10, window(100, 200), 9);
        let late = claim(11, window(150, 250), 1);
        let same = claim(10, window(150, 250), 8);
        assert!(RULES.gives_way(&late, &early) && !RULES.gives_way(&early, &late));
        assert!(RULES.gives_way(&early, &same) && !RULES.gives_way(&same, &early));
        assert!(!RULES.gives_way(&claim(11, window(205, 250), 1), &early), "they do not overlap");
    }

    #[test]
    fn a_trimmed_window_is_the_longer_part_that_is_free() {
        let own = window(100, 200);
        for (other, rest) in [
            (window(0, 50), own),
            (window(0, 130), window(135, 200)),
            (window(170, 300), window(100, 165)),
            (window(140, 150), window(155, 200)),
            (window(155, 160), window(100, 150)),
        ] {
            assert_eq!(RULES.trimmed(&own, &other), rest, "{other:?}");
            assert!(!RULES.conflict(&rest, &other));
        }
        assert!(RULES.trimmed(&own, &window(50, 250)).is_empty());
    }

    #[test]
    fn a_claim_is_firm_when_all_known_were_heard_since_and_none_has_priority() {
        let own = claim(50, window(100, 200), 5);
        let (first, apart) = ([claim(49, window(150, 250), 6)], [claim(49, window(300, 350), 6)]);
        let known = |heard, claims| Known { heard: time(heard), claims };
        let is_firm = |now, known: &[Known]| RULES.is_firm(time(now), &own, known.iter().copied());
        assert!(is_firm(50, &[]) && !is_firm(49, &[]));
        assert!(is_firm(60, &[known(50, &apart), known(60, &[])]));
        assert!(!is_firm(60, &[known(50, &apart), known(49, &[])]));
        assert!(!is_firm(60, &[known(50, &first)]));
    }

    #[test]
    fn a_vehicle_is_forgotten_after_its_window_and_a_long_silence() {
        assert!(!RULES.is_forgotten(time(1_300), time(1_000), None));
        assert!(RULES.is_forgotten(time(1_301), time(1_000), None));
        assert!(!RULES.is_forgotten(time(1_405), time(1_000), Some(time(1_400))));
        assert!(RULES.is_forgotten(time(1_406), time(1_000), Some(time(1_400))));
    }

    #[test]
    fn a_stay_is_covered_by_windows_that_join() {
        let firm = [window(150, 200), window(100, 150), window(190, 220), window(230, 300)];
        let covered = |entry, exit| is_covered(&window(entry, exit), firm.iter().copied());
        assert!(covered(100, 220) && covered(240, 300) && covered(120, 130));
        assert!(!covered(99, 120) && !covered(210, 240) && !covered(290, 301));
    }
}
