//! How long the ego waits before it yields to a station that does not heed it. How the station regards the ego enters, at every review;
//! whether that has lasted too long leaves.

use super::Regard;
use crate::held::Held;
use crate::time::{Duration, Instant};

/// The ego yields to a later arrival that has overlooked it for this long. These are five of the messages that tell the ego's arrival. So
/// a message that is still under way, or is lost once or twice, costs nothing.
pub(crate) const OVERLOOKED: Duration = Duration::from_millis(1_000);

/// The ego yields to a station whose claim is unclear for this long. By then the claimed station has not only been silent, but is out of
/// the ego's hearing.
pub(crate) const UNCLEAR: Duration = Duration::from_millis(6_000);

/// The timer of one station.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(crate) struct YieldTimer {
    /// Since when the station has not heeded the ego, in one way or the other.
    unheeded: Held<Instant>,
    /// Since when the station has overlooked the ego.
    overlooked: Held<Instant>,
}

impl YieldTimer {
    /// The station heeds the ego.
    pub(crate) const FULL: Self = Self { unheeded: Held::Nothing, overlooked: Held::Nothing };

    /// Whether a station has regarded the ego in this way for too long. The time counts by when the station said so, because the last
    /// words of a silent station may be out of date.
    pub(crate) fn is_over(&mut self, heard: Instant, regard: Regard) -> bool {
        let unheeded = lasts(&mut self.unheeded, regard != Regard::Heeds, heard);
        let overlooked = lasts(&mut self.overlooked, regard == Regard::Overlooks, heard);
        unheeded.is_some_and(|lasts| lasts >= UNCLEAR) || overlooked.is_some_and(|lasts| lasts >= OVERLOOKED)
    }
}

/// For how long `is_so` has held; `None` if it does not hold.
fn lasts(since: &mut Held<Instant>, is_so: bool, heard: Instant) -> Option<Duration> {
    if !is_so {
        since.clear();
        return None;
    }
    let begun = since.get().unwrap_or(heard);
    since.set(begun);
    Some(heard.since(begun))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// When the timer is over for a station that is heard every 100 ms, in tenths of a second.
    fn over_at(mut regard: impl FnMut(u64) -> Regard) -> Option<u64> {
        let mut yield_timer = YieldTimer::FULL;
        (0..200).find(|tick| yield_timer.is_over(Instant::from_micros(tick * 100_000), regard(*tick)))
    }

    #[test]
    fn it_is_over_after_a_second_of_being_overlooked_or_six_of_not_being_heeded_in_one_way_or_the_other() {
        assert_eq!(over_at(|_| Regard::Overlooks), Some(10));
        assert_eq!(over_at(|_| Regard::Unclear), Some(60));
        assert_eq!(over_at(|tick| if tick % 5 == 0 { Regard::Unclear } else { Regard::Overlooks }), Some(60));
        assert_eq!(over_at(|tick| if tick < 41 { Regard::Unclear } else { Regard::Overlooks }), Some(51));
        assert_eq!(over_at(|tick| if tick % 9 == 0 { Regard::Heeds } else { Regard::Overlooks }), None);
    }
}
