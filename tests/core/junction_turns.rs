//! Ways that join and ways that part at an intersection, in the whole unit: who turns into the ego's street is not in the area with it and
//! is followed beyond it where it is in the way; who turns off it is followed no more.

use crate::rig::LENGTH;
use crate::rig::config;
use crate::rig::junction::{CROSSING, Driver, EASTWARD, HALF, Junction, NORTHWARD};
use crate::rig::{instant, m_of};
use holdover::Config;
use holdover::coordination::{Approach, Crossing, Intersection, Itinerary, Movement, Movements, Path, Segment};
use holdover::time::Duration;
use holdover::units::{Distance, Position, Seconds};

const POINT: Position = Position::from_mm(200_000);

/// The first 200 m of one street and all of another from there on, which are as long.
const fn turn(from: &Path, to: &Path, [latitude, longitude]: [i32; 2]) -> [Segment; 2] {
    let (from, to) = (from.segments[0], to.segments[0]);
    [
        Segment { length: Distance::from_mm(200_000), ..from },
        Segment { latitude, longitude, begins: POINT, length: Distance::from_mm(300_000), ..to },
    ]
}

static TO_THE_NORTH: [Segment; 2] = turn(&EASTWARD, &NORTHWARD, [20_000, 0]);
static TO_THE_EAST: [Segment; 2] = turn(&NORTHWARD, &EASTWARD, [20_000, 0]);
static LEFT: Path = Path { segments: &TO_THE_NORTH };
static RIGHT: Path = Path { segments: &TO_THE_EAST };

const NORTH_ON: Movement = Movement::straight(0);
const INTO_NORTH: Movement = Movement { leg: 1, exit: 0 };
const OFF_NORTH: Movement = Movement { leg: 0, exit: 1 };

const fn way(movement: Movement, path: &'static Path, conflicts: Movements) -> Approach {
    Approach { movement, path, crossing: POINT, exits: Distance::from_mm(10_000), conflicts }
}

static CORNER: Intersection = Intersection {
    id: 5,
    half: Distance::from_mm(4_000),
    approaches: &[
        way(NORTH_ON, &NORTHWARD, Movements::NONE.with(INTO_NORTH)),
        way(INTO_NORTH, &LEFT, Movements::NONE.with(NORTH_ON)),
        way(OFF_NORTH, &RIGHT, Movements::NONE),
    ],
};

const fn crossing(movement: Movement) -> Crossing {
    Crossing { intersection: &CORNER, movement, at: POINT }
}
static GOES_ON: Itinerary = Itinerary { path: &NORTHWARD, crossings: &[crossing(NORTH_ON)] };
static TURNS_IN: Itinerary = Itinerary { path: &LEFT, crossings: &[crossing(INTO_NORTH)] };
static TURNS_OFF: Itinerary = Itinerary { path: &RIGHT, crossings: &[crossing(OFF_NORTH)] };

/// With or without a range sensor.
fn on(itinerary: &'static Itinerary, station: u8, at: f64, envelope: bool, sees: bool) -> Driver {
    let config = Config { range_sensor: sees, ..config() };
    let (way, turns_to) = match itinerary.crossings[0].movement {
        INTO_NORTH => (1, Some(0)),
        OFF_NORTH => (0, Some(1)),
        _ => (0, None),
    };
    let mut driver = Driver::of(config, station, way, at, 10.0, envelope);
    driver.rig.unit.set_out(itinerary).unwrap();
    driver.turns_to = turns_to;
    driver.sees = sees;
    driver
}

/// Metres between the two, where both are on the street to the north.
fn gap(junction: &Junction) -> Option<f64> {
    let [a, b] = [0, 1].map(|index| junction.drivers[index].body.position);
    (a.min(b) > CROSSING + HALF).then(|| (a - b).abs() - LENGTH)
}

#[test]
fn two_that_join_are_not_in_the_area_together_and_one_follows_the_other_beyond_it() {
    for envelope in [false, true] {
        for behind in [-20.0, -8.0, -3.0, 0.5, 3.0, 8.0, 20.0] {
            let mut junction = Junction::new(vec![
                on(&GOES_ON, 2, 60.0, envelope, true),
                on(&TURNS_IN, 3, 60.0 - behind, envelope, true),
            ]);
            let (mut least, mut is_followed) = (f64::MAX, false);
            junction.run(30.0, |junction| {
                let both = junction.drivers.iter().all(Driver::is_inside);
                assert!(!both, "{envelope} {behind} m: at {:.2} s", junction.now as f64 * 1e-6);
                least = gap(junction).map_or(least, |gap| gap.min(least));
                let [one, other] = &junction.drivers[..] else { panic!("two") };
                let follows = |a: &Driver, b: &Driver| a.follows() == Some(b.rig.unit.config().station.0);
                is_followed |= gap(junction).is_some() && (follows(one, other) || follows(other, one));
            });
            junction.drivers.sort_by(|a, b| b.body.position.total_cmp(&a.body.position));
            let [first, second] = &junction.drivers[..] else { panic!("two") };
            assert!(second.body.position > CROSSING + 40.0, "{envelope} {behind} m: {}", second.body.position);
            assert!(least > 2.0, "{envelope} {behind} m: a gap of {least}");
            assert_eq!(first.follows(), None);
            // With the envelope it comes out of the area too late for the other one to be in its way.
            assert!(envelope || is_followed, "{behind} m");
        }
    }
}

#[test]
fn one_that_joins_falls_silent_and_stands_behind_the_area_is_not_run_into() {
    for stands_at in [CROSSING + HALF + LENGTH + 0.5, CROSSING + HALF + LENGTH + 15.0] {
        let mut junction = Junction::new(vec![on(&TURNS_IN, 2, 70.0, true, true), on(&GOES_ON, 3, 60.0, true, true)]);
        junction.run(40.0, |junction| {
            let first = &mut junction.drivers[0];
            first.speaks &= first.body.position < CROSSING - 20.0;
            let left = stands_at - first.body.position;
            // As hard as it has to, and then it stands.
            let hard = first.body.speed.powi(2) / (2.0 * left.max(0.1));
            first.by_hand = (first.by_hand.is_some() || hard > 4.0).then_some(-6.0);
            assert!(!junction.drivers.iter().all(Driver::is_inside), "{stands_at} m");
        });
        let [first, second] = &junction.drivers[..] else { panic!("two") };
        assert!(first.body.speed < 0.1 && second.body.speed < 0.1, "both stand");
        assert!(first.body.position > CROSSING + HALF, "{}", first.body.position);
        let gap = first.body.position - LENGTH - second.body.position;
        assert!(gap > 0.0, "{stands_at} m: {gap}");
    }
}

#[test]
fn one_that_turns_off_is_followed_to_the_area_and_slows_nobody_beyond_it() {
    for envelope in [false, true] {
        let mut junction =
            Junction::new(vec![on(&TURNS_OFF, 3, 90.0, envelope, false), on(&GOES_ON, 2, 70.0, envelope, false)]);
        let (mut followed, mut slowest) = (false, f64::MAX);
        junction.run(30.0, |junction| {
            let [first, second] = &mut junction.drivers[..] else { panic!("two") };
            // On the other street it creeps.
            let creeps = first.body.position > CROSSING + HALF + LENGTH && first.body.speed > 1.0;
            first.by_hand = (first.body.position > CROSSING + HALF + LENGTH).then_some(if creeps { -4.0 } else { 0.0 });
            followed |= second.follows() == Some(3) && second.body.position < CROSSING - 30.0;
            if first.body.position > CROSSING + HALF + LENGTH + 2.0 {
                slowest = slowest.min(second.body.speed);
            }
        });
        let [first, second] = &junction.drivers[..] else { panic!("two") };
        assert!(followed, "{envelope}: on their common leg");
        assert_eq!(second.follows(), None);
        assert!(second.body.position > first.body.position + 20.0, "{envelope}: {}", second.body.position);
        // It comes to the area before it can know that there will be room beyond: this unit foresees 0.6 s.
        assert!(slowest > 5.0, "{envelope}: {slowest} m/s");
    }
}

/// The largest error with which the ego was foreseen 4 s before, while it follows station 2. Before that it follows station 3, which turns
/// off, and hears nothing of that one for 10 s.
fn farthest_off(station_2: &'static Itinerary, hears_it: bool) -> f64 {
    let mut junction = Junction::new(Vec::new());
    for (itinerary, station, at, target_speed) in
        [(station_2, 2, 104.0, 9.5), (&TURNS_OFF, 3, 84.0, 10.5), (&GOES_ON, 1, 64.0, 20.0)]
    {
        let mut driver = on(itinerary, station, at, false, false);
        let mut config = *driver.rig.unit.config();
        config.law.silent_time_gap = Seconds::from_millis(1_800);
        config.prediction.step = Duration::from_millis(100);
        config.prediction.horizon = Duration::from_millis(6_000);
        driver.rig.unit.start(&config).expect("the configuration is sound");
        driver.rig.unit.set_out(itinerary).expect("so is the map");
        driver.rig.power_up(true, 0);
        driver.target_speed = target_speed;
        junction.drivers.push(driver);
    }
    junction.run(2.0, |_| {});
    junction.drivers[2].hears = hears_it;
    junction.drivers[2].deaf_to = Some(1);
    let (mut told, mut farthest, mut followed) = (Vec::new(), 0.0f64, Vec::new());
    // Up to the end of the holdover, 15 s after the last message.
    for _ in 0..148 {
        junction.run(0.1, |_| {});
        let ego = &junction.drivers[2];
        let mode = ego.rig.unit.mode();
        assert!(mode.is_by_law(), "{mode:?}");
        if let Some((_, place)) = told.iter().find(|(due, _)| *due == junction.now) {
            let off: f64 = place - ego.body.position;
            farthest = if ego.follows() == Some(2) { farthest.max(off.abs()) } else { 0.0 };
        }
        followed.push(ego.follows());
        let then = junction.now + 4_000_000;
        let reading = ego.rig.unit.estimator().read_own(instant(then)).expect("it has a horizon");
        told.push((then, m_of(reading.position) - ego.axis));
    }
    let before = followed.iter().position(|followed| *followed == Some(2)).expect("it is followed");
    let (turns_off, goes_on) = followed.split_at(before);
    assert!(turns_off.len() > 95 && turns_off.iter().all(|followed| *followed == Some(3)), "{turns_off:?}");
    assert!(goes_on.len() >= 30 && goes_on.iter().all(|followed| *followed == Some(2)), "{goes_on:?}");
    farthest
}

#[test]
fn the_own_horizon_knows_whether_the_time_gap_opens_behind_the_next_one() {
    // Behind one on the ego's street that is silent too it goes on. Behind one that is heard it closes, and behind one that is not certain to
    // have come into the street.
    for (station_2, hears_it) in [(&GOES_ON, false), (&GOES_ON, true), (&TURNS_IN, false)] {
        let off = farthest_off(station_2, hears_it);
        assert!(off < 0.4, "{hears_it}, {:?}: {off} m", station_2.crossings[0].movement);
    }
}
