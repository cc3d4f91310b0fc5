//! Whose horizon starts anew in a tick. News of peers enters; for each of them whether its turn has come leaves.
//!
//! To start a horizon anew takes as long as all its steps, and the peers may all have talked since the last tick. So that a tick is
//! bounded, it has room for so many steps. The rules:
//!
//! * The target's news is used at once, so that after a silence the controller is led from the old horizon to the new one in one tick. So
//!   is a view of another sensor. Old news that comes in the tick after other news of the target waits for one tick, if there is no room.
//! * The other peers with news follow in the order of the chain, as many as there is room for. The rest waits, and the next tick begins
//!   with the first of those that wait. So nobody waits for longer than all the others take.
//! * If others had to wait, the target's horizon was computed from an old horizon of the vehicle ahead of it. So it starts anew once more
//!   when nobody waits any longer.
//!
//! Until its turn comes, a horizon goes on as one without news. What is certain of a peer does not wait: it is computed from the newest
//! sample in every tick.

use super::chain::Chain;
use super::forecast::LATE;
use crate::time::Duration;

/// A tick of 10 ms has room for so many steps of horizons that start anew: three horizons of 400 steps.
const STEPS_A_TICK: usize = 3 * (400 + BEGINNING);
const TICK_MS: usize = 10;

/// To start a horizon anew takes as long as so many steps in addition: its constants, its sample or its knots, and a few steps up to now.
const BEGINNING: usize = 64;

/// These few steps, by which a sample may be older than now. Each further one, up to [`LATE`] of them, takes as long as so many others:
/// the vehicle ahead is read before its horizon begins.
const YOUNG: usize = 8;
const EACH_LATE: usize = 4;

/// See [`steps_sent`].
const SENT: Duration = Duration::from_millis(10_700);

/// How many steps of this length a sent horizon may have that is as long as that of [`crate::Config::car`], where there is room for `most`.
pub(super) fn steps_sent(step: Duration, most: usize) -> usize {
    let steps = SENT.as_micros().checked_div(step.as_micros()).unwrap_or(0);
    usize::try_from(steps).unwrap_or(most).min(most)
}

/// For how many steps a tick of this period has room. In a longer period there is more time. A shorter one has no less room: then one
/// horizon would not fit.
pub(super) fn steps_a_tick(period: Duration) -> usize {
    let ticks = usize::try_from(period.as_millis()).unwrap_or(0) / TICK_MS;
    STEPS_A_TICK.saturating_mul(ticks.max(1))
}

/// For how many steps there is room in a tick, and how many a horizon takes.
#[derive(Clone, Copy)]
pub(super) struct Room {
    left: usize,
    each: usize,
}

impl Room {
    /// For all.
    pub const ENDLESS: Self = Self { left: usize::MAX, each: 0 };

    /// For so many steps, with horizons of so many steps, of which those that were sent may have `sent` steps. What else the tick does
    /// takes as long as so many horizons `besides`.
    pub fn of(room: usize, length: usize, sent: usize, besides: usize) -> Self {
        let each = length.max(sent).saturating_add(BEGINNING);
        let taken = length.saturating_add(BEGINNING).saturating_mul(besides);
        Self { left: room.saturating_sub(taken), each }
    }

    /// What a horizon takes that starts anew from a sample that is so many steps old.
    fn of_one(&self, late: usize) -> usize {
        self.each.saturating_add(late.min(LATE).saturating_sub(YOUNG).saturating_mul(EACH_LATE))
    }

    fn has(&self, late: usize) -> bool {
        self.left >= self.of_one(late)
    }

    fn take(&mut self, late: usize) -> bool {
        let left = self.left.checked_sub(self.of_one(late));
        self.left = left.unwrap_or(self.left);
        left.is_some()
    }

    /// Takes it in any case.
    fn spend(&mut self, late: usize) {
        self.left = self.left.saturating_sub(self.of_one(late));
    }
}

/// What becomes of a peer's horizon in a tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub(super) enum Turn {
    /// It goes on.
    None = 0,
    /// It starts anew from news.
    News = 1,
    /// It starts anew once more.
    Again = 2,
}

/// News that is not used yet, and what becomes of the horizons in this tick.
#[derive(Clone, Debug)]
pub(super) struct Turns<const PEERS: usize> {
    news: [bool; PEERS],
    turns: [Turn; PEERS],
    /// The slot of the target whose horizon is to start anew once more, and one more; or 0.
    again: u8,
    /// The place in the chain of the first peer that waits.
    first: u8,
}

impl<const PEERS: usize> Turns<PEERS> {
    /// No news: all zero.
    pub const NONE: Self = Self { news: [false; PEERS], turns: [Turn::None; PEERS], again: 0, first: 0 };

    /// Notes news of a peer.
    pub fn note(&mut self, index: usize) {
        if let Some(news) = self.news.get_mut(index) {
            *news = true;
        }
    }

    /// Whether there is news of a peer that is not used yet.
    pub fn has_news(&self, index: usize) -> bool {
        self.news.get(index) == Some(&true)
    }

    /// What becomes of a peer's horizon in this tick.
    pub fn of(&self, index: usize) -> Turn {
        self.turns.get(index).copied().unwrap_or(Turn::None)
    }

    /// Decides on a tick. News of these two does not wait, unless it is `old`er than so many steps. `late` tells by how many steps the
    /// newest sample of a peer is older than now.
    #[allow(clippy::cast_possible_truncation)] // the catalogue has 16 slots at most
    pub fn take(
        &mut self,
        mut room: Room,
        chain: &Chain<PEERS>,
        target: Option<usize>,
        corrected: Option<usize>,
        old: usize,
        late: impl Fn(usize) -> usize,
    ) {
        let had_turn = target.is_some_and(|index| self.of(index) == Turn::News);
        self.turns = [Turn::None; PEERS];
        if self.again == 0 && !self.news.contains(&true) {
            return;
        }
        let late_target = target.map_or(0, &late);
        let can_wait = had_turn && late_target > old && !room.has(late_target);
        let has_news = target.is_some_and(|index| !can_wait && self.serve(index));
        if has_news {
            room.spend(late_target);
        }
        if let Some(index) = corrected {
            self.serve(index);
            room.spend(0);
        }
        let (first, mut waits) = (usize::from(self.first), None);
        for place in (first..PEERS).chain(0..first.min(PEERS)) {
            let Some(index) = chain.at(place).filter(|index| self.news.get(*index) == Some(&true)) else { continue };
            if waits.is_none() && room.take(late(index)) {
                self.serve(index);
            } else if waits.is_none() {
                waits = Some(place);
            }
        }
        let name = target.map_or(0, |index| (index as u8).saturating_add(1));
        let is_behind = if has_news { waits.is_some() } else { self.again == name };
        self.again = if is_behind { name } else { 0 };
        if let Some(index) = target.filter(|_| is_behind && waits.is_none() && room.take(late_target)) {
            self.set(index, Turn::Again);
            self.again = 0;
        }
        self.first = waits.unwrap_or(0) as u8;
    }

    /// Uses the news of a peer, if there is any.
    fn serve(&mut self, index: usize) -> bool {
        let has_news = self.news.get_mut(index).is_some_and(core::mem::take);
        if has_news {
            self.set(index, Turn::News);
        }
        has_news
    }

    fn set(&mut self, index: usize, turn: Turn) {
        if let Some(place) = self.turns.get_mut(index) {
            *place = turn;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ticks of eight peers, who follow one another in the order of their slots, with horizons of 359 steps.
    struct Ticks {
        turns: Turns<8>,
        target: Option<usize>,
        /// How old the samples are, in steps.
        late: usize,
    }

    impl Ticks {
        fn new(target: Option<usize>) -> Self {
            Self { turns: Turns::NONE, target, late: 3 }
        }

        fn hear(&mut self, peers: impl IntoIterator<Item = usize>) {
            peers.into_iter().for_each(|index| self.turns.note(index));
        }

        /// The slots whose horizons start anew, and those which do once more.
        fn tick(&mut self, length: usize, besides: usize) -> (Vec<usize>, Vec<usize>) {
            let room = Room::of(STEPS_A_TICK, length, length, besides);
            self.turns.take(room, &Chain::new(), self.target, None, 10, |_| self.late);
            let of = |turn| (0..8).filter(|index| self.turns.of(*index) == turn).collect();
            (of(Turn::News), of(Turn::Again))
        }
    }

    #[test]
    fn the_target_is_first_and_starts_anew_once_more_after_all_others() {
        let mut ticks = Ticks::new(Some(7));
        ticks.hear(0..8);
        assert_eq!(ticks.tick(359, 0), (vec![0, 1, 7], vec![]));
        assert_eq!(ticks.tick(359, 0), (vec![2, 3, 4], vec![]));
        assert_eq!(ticks.tick(359, 0), (vec![5, 6], vec![7]));
        assert_eq!(ticks.tick(359, 0), (vec![], vec![]));
    }

    #[test]
    fn where_the_own_horizon_is_due_only_the_target_has_its_turn() {
        let mut ticks = Ticks::new(Some(2));
        ticks.hear([0, 2]);
        assert_eq!(ticks.tick(400, 3), (vec![2], vec![]));
        assert_eq!(ticks.tick(400, 0), (vec![0], vec![2]));
    }

    #[test]
    fn old_news_of_the_target_in_two_ticks_in_a_row_waits_where_there_is_no_room() {
        for (late, second) in [(200, vec![]), (11, vec![]), (10, vec![7])] {
            let mut ticks = Ticks { late, ..Ticks::new(Some(7)) };
            ticks.hear([7]);
            assert_eq!(ticks.tick(359, 3), (vec![7], vec![]), "the first is used at once");
            ticks.hear([7]);
            assert_eq!(ticks.tick(359, 3), (second, vec![]), "{late}");
            ticks.hear([7]);
            assert_eq!(ticks.tick(359, 3), (vec![7], vec![]), "{late}");
        }
        let mut ticks = Ticks { late: 200, ..Ticks::new(Some(7)) };
        ticks.hear([7]);
        ticks.tick(359, 3);
        ticks.hear([7]);
        assert_eq!(ticks.tick(359, 0), (vec![7], vec![]), "there is room");
    }

    #[test]
    fn beside_a_review_there_is_room_for_two() {
        let mut ticks = Ticks::new(Some(7));
        ticks.hear(0..8);
        assert_eq!(ticks.tick(359, 1), (vec![0, 7], vec![]));
        assert_eq!(ticks.tick(359, 1), (vec![1, 2], vec![]));
    }

    #[test]
    fn short_horizons_never_wait() {
        let mut ticks = Ticks::new(Some(7));
        ticks.hear(0..8);
        assert_eq!(ticks.tick(12, 3), ((0..8).collect(), vec![]));
        assert_eq!(ticks.tick(12, 3), (vec![], vec![]));
    }

    #[test]
    fn nobody_waits_for_longer_than_all_the_others_take_however_often_they_talk() {
        let mut ticks = Ticks::new(Some(0));
        let mut waited = [0; 8];
        for _ in 0..100 {
            ticks.hear(0..8);
            let (anew, _) = ticks.tick(359, 0);
            for (index, waited) in waited.iter_mut().enumerate() {
                *waited = if anew.contains(&index) { 0 } else { *waited + 1 };
                assert!(*waited <= 3, "{index}");
            }
        }
    }

    /// In how many ticks all peers with news are served, where the first of these ticks do so much besides.
    fn served_within(late: usize, besides: &[usize]) -> usize {
        let mut ticks = Ticks { late, ..Ticks::new(Some(7)) };
        ticks.hear(0..8);
        let (mut served, mut count) = (0, 0);
        while served < 8 {
            served += ticks.tick(400, besides.get(count).copied().unwrap_or(0)).0.len();
            count += 1;
        }
        count
    }

    #[test]
    fn news_waits_for_five_ticks_at_most_and_for_ten_if_it_is_old() {
        // The own horizon and a review after it, also where an extra review puts them off.
        for besides in [&[][..], &[3, 1], &[1, 3, 1]] {
            for (late, most) in [(0, 5), (3, 5), (8, 5), (20, 6), (200, 10), (1_000, 10)] {
                let within = served_within(late, besides);
                assert!(within <= most, "{late} {besides:?}: {within}");
            }
        }
    }

    #[test]
    fn an_old_sample_takes_the_room_of_three() {
        let mut ticks = Ticks { late: 200, ..Ticks::new(Some(7)) };
        ticks.hear(0..8);
        assert_eq!(ticks.tick(359, 0), (vec![7], vec![]));
        assert_eq!(ticks.tick(359, 0), (vec![0], vec![]));
    }

    #[test]
    fn another_target_does_not_start_anew_for_the_old_one() {
        let mut ticks = Ticks::new(Some(7));
        ticks.hear(0..8);
        ticks.tick(359, 0);
        ticks.target = Some(6);
        assert_eq!(ticks.tick(359, 0), (vec![2, 3, 6], vec![]));
        assert_eq!(ticks.tick(359, 0), (vec![4, 5], vec![6]));
    }
}
