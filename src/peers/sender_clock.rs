//! The clock of a sender. The stamps of its messages and their times of reception enter; how far the clock is off, as far as that can be
//! seen, leaves.
//!
//! No message is received before it is sent. So if five messages of a sender within two windows of 5 s are stamped in the future, its
//! clock is ahead. It is ahead by as much as the earliest of them was in the future, and by as much more as that message was under way.
//! The latter is at most [`UNDER_WAY`], which is an assumption of use. If all messages of a sender take longer than [`SUSPICIOUS`], over
//! a whole window and what has passed of the next, its clock may be behind: by the shortest of these times at most. The uncertainty of a
//! sample is widened by this, to either side, so that it also holds for a sender whose clock is right.

use crate::time::{Duration, Instant};

const WINDOW: Duration = Duration::from_millis(5_000);
/// Of the messages in two windows, some message is under way for less than this.
const UNDER_WAY: Duration = Duration::from_millis(100);
/// If every message takes longer than this, the clock may be behind.
const SUSPICIOUS: Duration = Duration::from_millis(100);
/// A stamp that is ahead by more than this is not due to a clock's error.
const MOST_AHEAD: Duration = Duration::from_millis(200);
/// This many messages ahead are evidence.
const EVIDENCE: u8 = 5;
/// A window with fewer messages says nothing.
const ENOUGH: u8 = 10;

/// How far a sender's clock is off.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Off {
    /// No error is seen.
    #[default]
    No,
    /// Ahead by this, or by up to 100 ms more, because a message may be under way for so long.
    Ahead(Duration),
    /// Perhaps behind, by this at most.
    Behind(Duration),
}

impl Off {
    /// When a message with this stamp was sent at the latest, corrected for a clock that is ahead.
    #[must_use]
    pub fn corrected(self, stamped: Instant) -> Instant {
        match self {
            Self::Ahead(ahead) => stamped.minus(ahead),
            _ => stamped,
        }
    }

    /// How much earlier and later than [`corrected`](Self::corrected) the message may have been sent, beyond the error of right clocks.
    #[must_use]
    pub fn uncertainty(self) -> (Duration, Duration) {
        match self {
            Self::No => (Duration::ZERO, Duration::ZERO),
            Self::Ahead(ahead) => (UNDER_WAY, ahead),
            Self::Behind(behind) => (Duration::ZERO, behind),
        }
    }
}

/// What a window has seen; empty if `messages` is 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
struct Window {
    begun: Instant,
    /// The shortest time from stamp to reception.
    least: Duration,
    messages: u8,
    /// Messages that were ahead.
    ahead: u8,
}

impl Window {
    const EMPTY: Self = Self { begun: Instant::ZERO, least: Duration::ZERO, messages: 0, ahead: 0 };
}

/// What is known of a sender's clock.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SenderClock {
    current: Window,
    before: Window,
    /// The stamp of the last message that counted as ahead.
    counted: Instant,
}

impl SenderClock {
    /// Nothing seen.
    pub const NEW: Self = Self { current: Window::EMPTY, before: Window::EMPTY, counted: Instant::ZERO };

    /// Notes a message. Returns whether a window begins with it. Right clocks are off by `error` at most, and messages come with this
    /// period.
    pub fn hear(&mut self, received: Instant, stamped: Instant, error: Duration, period: Duration) -> bool {
        let delay = received.since(stamped);
        let ahead = Duration::ZERO.minus(delay);
        if ahead > MOST_AHEAD {
            return false;
        }
        let passed = received.since(self.current.begun);
        let begins = self.current.messages == 0 || passed >= WINDOW;
        if begins {
            self.before = if passed < WINDOW.times(2) { self.current } else { Window::EMPTY };
            self.current = Window { begun: received, least: delay, ..Window::EMPTY };
        }
        self.current.messages = self.current.messages.saturating_add(1);
        self.current.least = self.current.least.min(delay);
        // Copies of a message do not count.
        let apart = Duration::from_micros(stamped.since(self.counted).as_micros().saturating_abs());
        if ahead > error && apart.times(2) >= period {
            self.current.ahead = self.current.ahead.saturating_add(1);
            self.counted = stamped;
        }
        begins
    }

    /// How far the clock is off.
    #[must_use]
    pub fn off(&self) -> Off {
        let has_before = self.before.messages > 0;
        let least = if has_before { self.current.least.min(self.before.least) } else { self.current.least };
        if self.current.ahead.saturating_add(self.before.ahead) >= EVIDENCE {
            Off::Ahead(Duration::ZERO.minus(least).max(Duration::ZERO))
        } else if self.before.messages >= ENOUGH && least > SUSPICIOUS {
            Off::Behind(least)
        } else {
            Off::No
        }
    }
}
