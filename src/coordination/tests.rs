//! The order, against a naive oracle; and stations that hear one another late, in part or not at all.

use super::*;
use crate::coordination::order::Arrival;

static SCALE: Scale = Scale { north: 0, east: 0 };
static SEGMENTS: [Segment; 1] = [Segment {
    latitude: 0,
    longitude: 0,
    begins: Position::ZERO,
    length: Distance::from_mm(1),
    along: SCALE,
    across: SCALE,
    heading: 0,
}];
static PATH: Path = Path { segments: &SEGMENTS };

const fn approach(leg: u8, conflicts: u8) -> Approach {
    Approach::straight(leg, &PATH, Position::from_mm(200_000), conflicts)
}

// Leg 2 comes along the same street from the other side.
static INTERSECTION: Intersection = Intersection {
    id: 1,
    half: Distance::from_mm(4_000),
    approaches: &[approach(0, 0b010), approach(1, 0b101), approach(2, 0b010)],
};
static CROSSINGS: [Crossing; 1] =
    [Crossing { intersection: &INTERSECTION, movement: Movement::straight(0), at: Position::from_mm(200_000) }];
pub(super) static ITINERARY: Itinerary = Itinerary { path: &PATH, crossings: &CROSSINGS };

pub(super) fn entry(station: u8, arrival: u32, claim: Option<u8>) -> Entry {
    let claim = claim.map_or(Predecessor::None, |station| Predecessor::Station(StationHash(station)));
    Entry { station: StationHash(station), arrival: Some(Arrival(arrival)), claim, leg: 0 }
}

#[test]
fn arrivals_decide_then_stations_and_who_does_not_say_goes_first() {
    let turn = 1 << 20;
    for (a, b) in [(5, 6), (turn - 1, 0), (turn - 5, turn / 2 - 6), (0, turn / 2 - 1)] {
        assert!(entry(9, a, None).is_before(&entry(1, b, None)), "{a} {b}");
        assert!(!entry(1, b, None).is_before(&entry(9, a, None)), "{a} {b}");
    }
    assert!(entry(1, 7, None).is_before(&entry(2, 7, None)));
    assert!(!entry(2, 7, None).is_before(&entry(2, 7, None)));
    let silent = Entry { arrival: None, ..entry(200, 0, None) };
    assert!(silent.is_before(&entry(1, 7, None)));
    assert!(!entry(1, 7, None).is_before(&silent));
    assert!(Entry { station: StationHash(1), ..silent }.is_before(&silent));
}

#[test]
fn arrivals_of_gnss_time_come_round_after_2_9_hours() {
    assert_eq!(Arrival::of_micros(0), Arrival(0));
    assert_eq!(Arrival::of_micros(19_999), Arrival(1));
    assert_eq!(Arrival::of_micros((1 << 20) * 10_000 + 30_000), Arrival(3));
}

#[test]
fn who_arrived_later_and_claims_somebody_before_the_ego_or_nobody_overlooks_it_and_a_stranger_is_unclear() {
    let (before, own, after, later) =
        (entry(1, 10, None), entry(2, 20, Some(1)), entry(3, 30, Some(2)), entry(4, 40, None));
    let all = [before, after, later];
    let claims = |claim| Entry { claim, ..later };
    let station = |station| Predecessor::Station(StationHash(station));
    let regard = |other: &Entry| Regard::of(other, &own, all.iter());
    assert_eq!(regard(&claims(Predecessor::None)), Regard::Overlooks);
    assert_eq!(regard(&claims(station(1))), Regard::Overlooks);
    assert_eq!(regard(&claims(station(2))), Regard::Heeds);
    assert_eq!(regard(&claims(station(3))), Regard::Heeds);
    assert_eq!(regard(&claims(station(77))), Regard::Unclear);
    assert_eq!(regard(&claims(Predecessor::Unknown)), Regard::Heeds);
    assert_eq!(regard(&before), Regard::Heeds);
}

/// Stations at one intersection, each with its own coordination, and what each station heard last of every other.
struct Meeting {
    stations: Vec<(Entry, Coordination<8>)>,
    heard: Vec<Vec<Option<(Entry, Instant)>>>,
}

const TICK_MS: u64 = 100;

pub(super) fn at(tick: u64) -> Instant {
    Instant::from_micros(tick * TICK_MS * 1000)
}

impl Meeting {
    fn of(arrivals: &[u32]) -> Self {
        static INTERSECTION: Intersection = Intersection { id: 1, half: Distance::from_mm(4_000), approaches: &[] };
        static CROSSINGS: [Crossing; 1] =
            [Crossing { intersection: &INTERSECTION, movement: Movement::straight(0), at: Position::from_mm(200_000) }];
        static ITINERARY: Itinerary = Itinerary { path: &PATH, crossings: &CROSSINGS };
        let stations = arrivals.iter().enumerate().map(|(index, arrival)| {
            let mut coordination = Coordination::idle();
            coordination.set_out(&ITINERARY, Distance::ZERO).unwrap();
            coordination.locate(Position::ZERO, Position::ZERO);
            coordination.advance(Position::ZERO, Distance::from_mm(4_800), at(0), Arrival(*arrival));
            (entry(index as u8 + 1, *arrival, None), coordination)
        });
        Self { stations: stations.collect(), heard: vec![vec![None; arrivals.len()]; arrivals.len()] }
    }

    /// Every station hears the stations that `hears` lets it hear, and then reviews. Returns how many stations yielded.
    fn tick(&mut self, tick: u64, mut hears: impl FnMut(usize, usize) -> bool) -> usize {
        let mut gave_way = 0;
        for to in 0..self.stations.len() {
            for from in (0..self.stations.len()).filter(|from| *from != to) {
                if hears(to, from) {
                    let (own, coordination) = &self.stations[from];
                    let arrival = coordination.registration().map(|registration| registration.arrival);
                    let said = Entry { arrival, claim: coordination.claim(), ..*own };
                    self.heard[to][from] = Some((said, at(tick)));
                }
            }
        }
        for (index, (own, coordination)) in self.stations.iter_mut().enumerate() {
            let heard = self.heard[index].iter().enumerate();
            let present: Vec<_> = heard
                .filter_map(|(index, heard)| {
                    heard.map(|(entry, heard)| Present {
                        index,
                        entry,
                        heard,
                        has_left: false,
                        is_far_behind: false,
                        conflicts: true,
                        way: Distance::ZERO,
                        is_announced: true,
                        lane: None,
                    })
                })
                .collect();
            gave_way += usize::from(coordination.review(at(tick + 1), own.station, &present, true));
        }
        gave_way
    }

    /// The station that each station takes to be just ahead, by index.
    fn claims(&self) -> Vec<Option<usize>> {
        let index = |claim| match claim {
            Predecessor::Station(StationHash(station)) => Some(usize::from(station) - 1),
            _ => None,
        };
        self.stations.iter().map(|(_, coordination)| index(coordination.claim())).collect()
    }

    /// The stations in the order of the chain of claims; `None` if the claims are not one chain.
    fn chain(&self) -> Option<Vec<usize>> {
        let claims = self.claims();
        let mut chain = vec![claims.iter().position(Option::is_none)?];
        while let Some(next) = claims.iter().position(|claim| *claim == chain.last().copied()) {
            chain.push(next);
            if chain.len() > claims.len() {
                return None;
            }
        }
        (chain.len() == claims.len()).then_some(chain)
    }
}

/// A seeded generator, so that a failure can be repeated.
struct Dice(u64);

impl Dice {
    fn below(&mut self, sides: u64) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % sides
    }
}

fn arrivals(dice: &mut Dice) -> Vec<u32> {
    (0..2 + dice.below(7)).map(|_| dice.below(40) as u32).collect()
}

fn by_arrival(arrivals: &[u32]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..arrivals.len()).collect();
    order.sort_by_key(|index| (arrivals[*index], *index));
    order
}

#[test]
fn who_hears_late_and_with_loss_agrees_on_arrivals_and_nobody_gives_way() {
    let mut dice = Dice(1);
    for _ in 0..2_000 {
        let arrivals = arrivals(&mut dice);
        let mut meeting = Meeting::of(&arrivals);
        let mut gave_way = 0;
        for tick in 0..30 {
            gave_way += meeting.tick(tick, |_, _| dice.below(10) > 0);
        }
        assert_eq!(meeting.chain(), Some(by_arrival(&arrivals)), "{arrivals:?}");
        assert_eq!(gave_way, 0, "{arrivals:?}");
    }
}

#[test]
fn after_any_deafness_all_agree_again_on_one_order() {
    let mut dice = Dice(2);
    for round in 0..2_000 {
        let arrivals = arrivals(&mut dice);
        let mut meeting = Meeting::of(&arrivals);
        let deaf: Vec<bool> = (0..64).map(|_| dice.below(2) == 0).collect();
        for tick in 0..40 {
            meeting.tick(tick, |to, from| !deaf[to * 8 + from] && dice.below(10) > 0);
        }
        for tick in 40..70 {
            meeting.tick(tick, |_, _| dice.below(10) > 0);
        }
        let mut chain = meeting.chain().unwrap_or_else(|| panic!("{round}: {arrivals:?} {:?}", meeting.claims()));
        chain.sort_unstable();
        assert_eq!(chain, (0..arrivals.len()).collect::<Vec<_>>());
    }
}

#[test]
fn one_of_two_that_head_for_the_same_place_gives_way() {
    // One station cannot hear another one, whichever the others are. Of two with the same claim, one makes room.
    let mut dice = Dice(3);
    for _ in 0..2_000 {
        let arrivals = arrivals(&mut dice);
        let (deaf, unheard) = (dice.below(arrivals.len() as u64), dice.below(arrivals.len() as u64));
        let mut meeting = Meeting::of(&arrivals);
        for tick in 0..60 {
            let hears = |to: usize, from: usize| (to as u64, from as u64) != (deaf, unheard);
            meeting.tick(tick, |to, from| hears(to, from) && dice.below(20) > 0);
        }
        let claims = meeting.claims();
        for (a, b) in (0..claims.len()).flat_map(|a| (0..a).map(move |b| (a, b))) {
            assert_ne!(claims[a], claims[b], "{arrivals:?}, {deaf} does not hear {unheard}: {claims:?}");
        }
    }
}

#[test]
fn one_whose_claim_is_of_a_stranger_for_longer_than_a_silence_lasts_is_given_way() {
    // The first two stations do not hear one another. The last does not hear the second, and the second hears the last.
    let deaf = [(0, 1), (1, 0), (2, 1)];
    let mut meeting = Meeting::of(&[1, 2, 3]);
    for tick in 0..100 {
        let gave_way = meeting.tick(tick, |to, from| !deaf.contains(&(to, from)));
        assert_eq!(gave_way, usize::from(tick == 61), "{tick}");
        let claims = if tick < 61 { [None, None, Some(0)] } else { [None, Some(2), Some(0)] };
        assert_eq!(meeting.claims(), claims, "{tick}");
    }
    // A silence of 4 s is shorter than that.
    let mut meeting = Meeting::of(&[1, 2, 3]);
    for tick in 0..100 {
        assert_eq!(meeting.tick(tick, |to, from| tick > 41 || !deaf.contains(&(to, from))), 0, "{tick}");
    }
    assert_eq!(meeting.chain(), Some(vec![0, 1, 2]));
}

#[test]
fn who_comes_by_another_leg_is_followed_after_4_5_s_and_sooner_only_where_no_gentle_stop_is_left() {
    let mut coordination: Coordination<8> = Coordination::idle();
    coordination.set_out(&ITINERARY, Distance::ZERO).unwrap();
    coordination.locate(Position::ZERO, Position::ZERO);
    // At 10 m/s, 10 m and v²/(2 · 1.5 m/s²) before the conflict area.
    let gentle_until = 196_000 - 10_000 - 33_333;
    for (front, is_far) in [(0, true), (gentle_until - 1, true), (gentle_until + 1, false), (195_000, false)] {
        for (ms, is_told) in [(0, false), (4_499, false), (4_500, true), (60_000, true)] {
            for (leg, is_followed) in [(0, true), (1, is_told || !is_far), (2, is_told || !is_far)] {
                let (since, claim) = (at(3), Predecessor::Unknown);
                let (movement, shift) = (Movement::straight(leg), Distance::ZERO);
                let approach = PeerApproach { crossing: 0, movement, shift, arrival: None, claim, heard: since, since };
                let (front, speed) = (Position::from_mm(front), Speed::from_mm_per_s(10_000));
                let now = since.plus(Duration::from_millis(ms));
                let is_announced = coordination.is_announced(&approach, now, 0, front, speed);
                assert_eq!(is_announced, is_followed, "leg {leg}, {ms} ms, {front:?}");
            }
        }
    }
}

#[test]
fn a_review_at_once_does_not_move_the_times_of_the_others() {
    let mut coordination: Coordination<8> = Coordination::idle();
    coordination.set_out(&ITINERARY, Distance::ZERO).unwrap();
    let after = |ms| at(0).plus(Duration::from_millis(ms));
    let mut review = |ms| {
        coordination.review_at_once();
        assert!(coordination.is_due(after(ms)));
        let _ = coordination.review(after(ms), StationHash(1), &[], true);
        assert!(!coordination.is_due(after(ms)));
        coordination.next_review()
    };
    assert_eq!(review(0), Some(after(100)));
    assert_eq!(review(70), Some(after(100)));
    assert_eq!(review(99), Some(after(100)));
    // A tick that comes late does not move the due times either, unless it misses one.
    assert_eq!(review(103), Some(after(200)));
    assert_eq!(review(299), Some(after(300)));
    assert_eq!(review(450), Some(after(550)));
}

#[test]
fn on_a_way_through_intersections_the_distance_is_that_of_who_is_seen_or_else_longer_and_across_at_least_the_area() {
    static SHORT: Intersection = Intersection { id: 1, half: Distance::from_mm(3_500), approaches: &[] };
    static LONG: Intersection = Intersection { half: Distance::from_mm(5_110), ..SHORT };
    let [short, long] = [&SHORT, &LONG].map(|intersection| Crossing {
        intersection,
        movement: Movement::straight(0),
        at: Position::ZERO,
    });
    let kept = |crossing, sees| standstill_on_way(Distance::from_mm(2_000), crossing, sees).to_mm();
    assert_eq!((kept(None, true), kept(None, false)), (4_000, 10_000));
    for sees in [true, false] {
        assert_eq!(kept(Some(&short), sees), 10_000);
        assert_eq!(kept(Some(&long), sees), 10_220);
    }
}
