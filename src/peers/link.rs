//! The link to one peer, as a fact about this moment. Receptions enter; on or off, and the measured period, delay and loss, leave.

use crate::config::Link as Limits;
use crate::time::{Duration, Instant};

/// What is known of the link to one peer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Link {
    heard: Option<Instant>,
    newest: Option<Instant>,
    period: Duration,
    delay: Duration,
    loss: u16,
    /// Gaps in a row that were longer than a period.
    longer: u8,
}

/// Weight of a new measurement in the running means: 1/8.
const WEIGHT: i64 = 8;
/// So many gaps in a row that are longer than a period show another period. Of a link that loses 40 % of the messages at random, one in
/// two million runs of gaps is that long. Of one that loses 80 %, one in 35 is: the period is then too long until gaps of one period have
/// made it shorter again.
const LONGER: u8 = 16;
/// The full scale of [`Link::loss`].
pub const LOSS_ONE: u16 = 10_000;

impl Link {
    /// Nothing is heard yet. Messages are expected with this period.
    #[must_use]
    pub const fn new(period: Duration) -> Self {
        Self { heard: None, newest: None, period, delay: Duration::ZERO, loss: 0, longer: 0 }
    }

    /// Notes a valid message, received at `received`, about the instant `at`.
    pub fn heard(&mut self, received: Instant, at: Instant) {
        let delay = received.since(at).max(Duration::ZERO);
        self.delay = if self.heard.is_none() { delay } else { mean_time(self.delay, delay) };
        self.heard = Some(self.heard.map_or(received, |before| before.max(received)));
        let Some(newest) = self.newest else {
            self.newest = Some(at);
            return;
        };
        let step = at.since(newest);
        if step <= Duration::ZERO {
            return;
        }
        self.newest = Some(at);
        // A gap of n periods is n - 1 lost messages and a received one. A longer gap says nothing of the period.
        let periods = step.plus(Duration::from_micros(self.period.as_micros() / 2)).as_micros();
        let periods = periods.checked_div(self.period.as_micros()).unwrap_or(1).clamp(1, 1000);
        self.measure_period(step, periods);
        let lost = periods.saturating_sub(1).saturating_mul(i64::from(LOSS_ONE)).checked_div(periods).unwrap_or(0);
        self.loss = u16::try_from(mean(self.loss.into(), lost)).unwrap_or(LOSS_ONE);
    }

    /// Where every gap is of several periods, the peer has begun to send less often.
    fn measure_period(&mut self, step: Duration, periods: i64) {
        let limited = |period: Duration| period.clamp(Duration::from_millis(10), Duration::from_millis(1000));
        self.longer = if periods == 1 { 0 } else { self.longer.saturating_add(1) };
        if periods == 1 {
            self.period = limited(mean_time(self.period, step));
        } else if self.longer >= LONGER {
            (self.period, self.longer) = (limited(self.period.times(2)), 0);
        }
    }

    /// Whether a valid message came within the expected period and the tolerance.
    #[must_use]
    pub fn is_on(&self, now: Instant, limits: &Limits) -> bool {
        self.silence(now).is_some_and(|silence| silence <= self.period.plus(limits.tolerance))
    }

    /// For how long no valid message has come; `None` if none ever did.
    #[must_use]
    pub fn silence(&self, now: Instant) -> Option<Duration> {
        self.heard.map(|heard| now.since(heard))
    }

    /// Mean period of the messages as stamped.
    #[must_use]
    pub const fn period(&self) -> Duration {
        self.period
    }

    /// Mean delay from stamp to reception.
    #[must_use]
    pub const fn delay(&self) -> Duration {
        self.delay
    }

    /// Mean fraction of the messages that are lost, in ten-thousandths.
    #[must_use]
    pub const fn loss(&self) -> u16 {
        self.loss
    }
}

/// The running mean with the weight of 1/8 for the new value.
fn mean(old: i64, new: i64) -> i64 {
    old.saturating_add(new.saturating_sub(old) / WEIGHT)
}

fn mean_time(old: Duration, new: Duration) -> Duration {
    Duration::from_micros(mean(old.as_micros(), new.as_micros()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::Config;
    use crate::wire::StationHash;

    fn at(millis: u64) -> Instant {
        Instant::from_micros(millis * 1000)
    }

    #[test]
    fn a_link_is_off_after_a_period_and_the_tolerance() {
        let limits = Config::car(StationHash(1)).link;
        let mut link = Link::new(Duration::from_millis(100));
        assert!(!link.is_on(at(0), &limits));
        link.heard(at(1000), at(960));
        assert!(link.is_on(at(1250), &limits));
        assert!(!link.is_on(at(1251), &limits));
    }

    #[test]
    fn delay_and_loss_are_those_of_the_messages() {
        let mut link = Link::new(Duration::from_millis(100));
        for n in (0..200u64).filter(|n| n % 4 != 3) {
            link.heard(at(n * 100 + 40), at(n * 100));
        }
        assert_eq!(link.delay(), Duration::from_millis(40));
        assert_eq!(link.period(), Duration::from_millis(100));
        // A quarter is lost. Each gap of two periods weighs like one message of three.
        assert!((1_000..=2_600).contains(&link.loss()), "{}", link.loss());
    }

    #[test]
    fn a_late_message_neither_shortens_the_silence_nor_changes_the_period() {
        let mut link = Link::new(Duration::from_millis(100));
        link.heard(at(1000), at(990));
        link.heard(at(1010), at(500));
        assert_eq!(link.silence(at(1110)), Some(Duration::from_millis(100)));
        assert_eq!(link.period(), Duration::from_millis(100));
    }

    #[test]
    fn a_peer_that_sends_less_often_than_it_did_is_on_again() {
        let (mut link, settings) = (Link::new(Duration::from_millis(50)), Config::car(StationHash(1)).link);
        let mut now = Instant::from_micros(1_000_000);
        for _ in 0..100 {
            now = now.plus(Duration::from_millis(222));
            link.heard(now, now);
        }
        assert!(link.is_on(now.plus(Duration::from_millis(222)), &settings), "{:?}", link.period());
    }

    #[test]
    fn fifteen_long_gaps_in_a_row_are_losses_and_sixteen_another_period() {
        for (gaps, period) in [(LONGER - 1, 100), (LONGER, 200)] {
            let mut link = Link::new(Duration::from_millis(100));
            let mut now = Instant::from_micros(1_000_000);
            link.heard(now, now);
            for _ in 0..gaps {
                now = now.plus(Duration::from_millis(200));
                link.heard(now, now);
            }
            assert_eq!(link.period(), Duration::from_millis(period), "{gaps} gaps");
        }
    }

    #[test]
    fn a_gap_of_one_period_ends_a_row_of_long_ones() {
        let mut link = Link::new(Duration::from_millis(100));
        let mut now = Instant::from_micros(1_000_000);
        for number in 0..2_000 {
            now = now.plus(Duration::from_millis(if number % 16 == 0 { 100 } else { 300 }));
            link.heard(now, now);
        }
        assert_eq!(link.period(), Duration::from_millis(100));
    }
}
