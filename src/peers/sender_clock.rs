//! A sender's clock: when messages were stamped and when they were received enter; how far the clock is off, as far as that can be
//! seen, leaves.
//!
//! No message is received before it is sent. So a sender whose messages are stamped in the future, five of them within two
//! windows of 5 s, is ahead by what the earliest of them was, and by as much more as that one was under way: by [`UNDER_WAY`] at
//! the most, as is assumed of use. One whose messages all take longer than [`SUSPICIOUS`] over a whole window and what has passed
//! of the next may be behind, by the least of it at the most. What is uncertain about a sample is widened by that, either way, so
//! that a sender who is not off at all is inside it too.

use crate::time::{Duration, Instant};

const WINDOW: Duration = Duration::from_millis(5_000);
/// In two windows some message is under way for less than this.
const UNDER_WAY: Duration = Duration::from_millis(100);
/// Of which messages may be that far behind none is.
const SUSPICIOUS: Duration = Duration::from_millis(100);
/// Beyond this a stamp is no clock's error.
const MOST_AHEAD: Duration = Duration::from_millis(200);
/// Messages ahead that are evidence.
const EVIDENCE: u8 = 5;
/// A window with fewer messages says nothing.
const ENOUGH: u8 = 10;

/// How far a sender's clock is off.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Off {
    /// Not to be seen.
    #[default]
    No,
    /// Ahead by this or up to 100 ms more, as messages may be under way for so long.
    Ahead(Duration),
    /// Perhaps behind, by this at the most.
    Behind(Duration),
}

impl Off {
    /// When a message with this stamp was sent at the latest, as far as it is ahead.
    #[must_use]
    pub fn corrected(self, stamped: Instant) -> Instant {
        match self {
            Self::Ahead(ahead) => stamped.minus(ahead),
            _ => stamped,
        }
    }

    /// How much earlier and later than [`corrected`](Self::corrected) it may have been sent than with clocks that are right.
    #[must_use]
    pub fn uncertainty(self) -> (Duration, Duration) {
        match self {
            Self::No => (Duration::ZERO, Duration::ZERO),
            Self::Ahead(ahead) => (UNDER_WAY, ahead),
            Self::Behind(behind) => (Duration::ZERO, behind),
        }
    }
}

/// What a window has brought; empty if `messages` is 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
struct Window {
    begun: Instant,
    /// The least from stamp to reception.
    least: Duration,
    messages: u8,
    /// Messages that were ahead.
    ahead: u8,
}

impl Window {
    const EMPTY: Self = Self { begun: Instant::ZERO, least: Duration::ZERO, messages: 0, ahead: 0 };
}

/// What is seen of a sender's clock.
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

    /// Takes note of a message; whether a window begins with it. Clocks that are right are off by `error` at the most, and
    /// messages come with this period.
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
        // Not the copies of one message.
        let apart = Duration::from_micros(stamped.since(self.counted).as_micros().saturating_abs());
        if ahead > error && apart.times(2) >= period {
            self.current.ahead = self.current.ahead.saturating_add(1);
            self.counted = stamped;
        }
        begins
    }

    /// How far it is off.
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
