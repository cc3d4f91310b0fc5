//! A corridor in `live`: what is driven and changed while it goes on is, saved and run, the same to the last bit; vehicles come and go, and
//! what is kept of them goes with them.

mod heard;

use std::collections::BTreeSet;
use std::path::Path;

use heard::Heard;
use holdover_sim::commands::live::order::Order;
use holdover_sim::commands::live::road::RoadPlay;
use holdover_sim::commands::live::scene::{Pulse, Scene, Seen};
use holdover_sim::commands::live::stage::{Play, Stage};
use holdover_sim::input::scenario::{Event, Overrides, Part, saved};
use holdover_sim::roads::Corridor;
use holdover_sim::roads::conditions::Conditions;
use holdover_sim::roads::experiment::{Experiment, of_sides};
use holdover_sim::roads::journal::Journal;
use holdover_sim::roads::read::corridor;
use holdover_sim::roads::referee::{Collision, Referee};
use holdover_sim::roads::touching::Place;
use holdover_sim::roads::watch::{Sighting, Watch};

fn text() -> String {
    std::fs::read_to_string("scenarios/corridor.toml").unwrap()
}

fn read(text: &str, overrides: &Overrides) -> Corridor {
    corridor(Path::new("live.toml"), text, overrides).unwrap()
}

fn play() -> RoadPlay {
    RoadPlay::new(read(&text(), &Overrides::default()))
}

/// Everything of a tick, bit by bit.
fn bits(sightings: &[Sighting]) -> Vec<(usize, Vec<u64>)> {
    let of = |own: &Sighting| {
        let belief = own.belief.map(|belief| (belief.position_m, belief.speed_mps, belief.age_s)).unwrap_or_default();
        let motion = [own.way_m, own.speed_mps, own.acceleration_mps2, own.command_mps2];
        let rest = [belief.0, belief.1, belief.2, f64::from(u8::from(own.limited))];
        (own.trip, motion.into_iter().chain(rest).map(f64::to_bits).collect())
    };
    sightings.iter().map(of).collect()
}

#[derive(Default)]
struct Bits(Vec<Vec<(usize, Vec<u64>)>>);

impl Watch for Bits {
    fn tick(&mut self, _: f64, sightings: &[Sighting]) {
        self.0.push(bits(sightings));
    }
    fn left(&mut self, _: f64, _: usize) {}
}

/// What is ordered after so many ticks. Five vehicles have appeared by then.
fn orders() -> Vec<(u64, Order)> {
    vec![
        (1500, Order::Drive { vehicle: 0, mps2: -2.35 }),
        (1501, Order::Links { vehicle: None, delay_mean_s: 0.1 + 0.2, delay_std_s: 0.05, loss: 0.3 }),
        (1600, Order::Outage { vehicle: Some(1), seconds: 1.7 }),
        (1700, Order::Release { vehicle: 0 }),
        (1700, Order::Switch { vehicle: Some(2), part: Part::Holdover, on: false }),
        (1750, Order::Switch { vehicle: None, part: Part::RangeSensor, on: false }),
        (1800, Order::Switch { vehicle: Some(3), part: Part::Envelope, on: false }),
    ]
}

const TICKS: u64 = 3000;

/// The stage after all of the orders, and the events. `each` sees every tick.
fn played<'a>(play: &'a RoadPlay, mut each: impl FnMut(&<RoadPlay as Play>::Stage<'a>)) -> Vec<Event> {
    let mut stage = play.begin(&[]).unwrap();
    let (mut events, mut orders) = (Vec::new(), orders().into_iter().peekable());
    while stage.ticks() < TICKS {
        while let Some((_, order)) = orders.next_if(|(tick, _)| *tick == stage.ticks()) {
            let event = order.event(stage.next_s()).unwrap();
            play.check(&event).unwrap();
            assert!(event.vehicle.is_none_or(|vehicle| stage.has(vehicle)), "{event:?}");
            stage.add(event);
            events.push(event);
        }
        stage.step().unwrap();
        each(&stage);
        if stage.ticks().is_multiple_of(777) {
            stage = stage.clone();
        }
    }
    events
}

#[test]
fn a_drive_that_is_saved_and_run_is_the_same_to_the_last_bit() {
    let (text, play) = (text(), play());
    let (mut seen, mut unseen) = (Bits::default(), Bits::default());
    let events = played(&play, |stage| {
        let _ = stage.scene(&Pulse::default());
        let _ = stage.frames(0);
        seen.0.push(bits(&stage.seen().on_way));
    });
    played(&play, |stage| unseen.0.push(bits(&stage.seen().on_way)));
    assert!(seen.0 == unseen.0, "whether anyone looks changes nothing");
    let duration_s = TICKS as f64 * play.period_s();
    let saved = saved::text((Path::new("live.toml"), &text), &Overrides::default(), &events, duration_s).unwrap();
    let again = read(&saved, &Overrides::default());
    assert_eq!((again.duration_s, &again.events), (duration_s, &events));
    let experiment = Experiment::new(again);
    let conditions = Conditions::of(&experiment.corridor);
    let (mut run, mut journal) = (Bits::default(), Journal::new(Some(1)));
    experiment.run_before(1, conditions, Some(&mut journal), &mut [&mut run]).unwrap();
    assert!(run.0[TICKS as usize - 1].len() > 4, "there is something to compare");
    for (tick, (run, live)) in run.0.iter().zip(&seen.0).enumerate() {
        assert_eq!(run, live, "tick {tick}");
    }
    // The log of a bus is as long as the drive, and the run goes on until the last vehicle has left.
    let log = play.log(&events, TICKS, 1).unwrap();
    assert!(log.len() > 10_000 && log[..] == journal.log[..log.len()]);
    assert!(play.log(&events, TICKS, 100).is_none(), "that vehicle has not appeared");
    // What was driven was driven.
    let quiet = experiment.of(Corridor { events: Vec::new(), ..experiment.corridor.clone() });
    let mut otherwise = Bits::default();
    quiet.run_before(1, conditions, None, &mut [&mut otherwise]).unwrap();
    assert!(otherwise.0[..1500] == run.0[..1500] && otherwise.0[1600] != run.0[1600]);
}

#[test]
fn what_is_kept_of_a_vehicle_goes_when_it_goes() {
    let play = play();
    let mut stage = play.begin(&[]).unwrap();
    let (mut most, mut names) = (0, std::collections::BTreeSet::new());
    while stage.next_s() < 240.0 {
        stage.step().unwrap();
        most = most.max(stage.kept());
        names.extend(stage.seen().on_way.iter().map(|own| own.trip));
        let there = stage.seen().on_way.len() + stage.seen().beyond.len();
        assert!(stage.kept() <= there + 1, "{} of {there}", stage.kept());
    }
    assert!(names.len() > 80 && most < 40, "{} and {most}", names.len());
}

#[test]
fn collisions_are_told_as_the_referee_finds_them_and_those_at_crossings_too() {
    const TICKS: u64 = 9000;
    let play = play();
    let mut stage = play.begin(&[]).unwrap();
    let (mut told, mut events) = (BTreeSet::new(), Vec::new());
    while stage.ticks() < TICKS {
        // Persons drive as fast as they can, whoever comes.
        if stage.ticks().is_multiple_of(250) {
            for seen in stage.scene(&Pulse::default()).vehicles.iter().filter(|seen| stage.has(seen.id)) {
                events.push(Order::Drive { vehicle: seen.id, mps2: 2.5 }.event(stage.next_s()).unwrap());
            }
            let now_s = stage.next_s();
            events.iter().filter(|event| event.at_s == now_s).for_each(|event| stage.add(*event));
        }
        stage.step().unwrap();
        told.extend(stage.scene(&Pulse::default()).hits);
    }
    let mut referee = Referee::new(&play.experiment.network, &play.trips);
    play.again(&events, TICKS, None, &mut [&mut referee]).unwrap();
    assert_eq!(told, referee.collisions.iter().map(|collision| collision.trips).collect());
    let is_crossing = |collision: &Collision| matches!(collision.place, Place::Intersection(_));
    assert!(referee.collisions.iter().any(is_crossing), "{:?}", referee.collisions);
}

#[test]
fn each_vehicle_is_told_with_its_leg_its_place_and_whom_it_follows() {
    let play = play();
    let (mut placed, mut crossing, mut largest_m) = (0, 0, 0.0_f64);
    let mut stage = play.begin(&[]).unwrap();
    while stage.next_s() < 60.0 {
        stage.step().unwrap();
        if !stage.ticks().is_multiple_of(20) {
            continue;
        }
        let Scene { vehicles, .. } = stage.scene(&Pulse::default());
        let way = |seen: &Seen| seen.way.clone().unwrap();
        for seen in &vehicles {
            let own = way(seen);
            if let (Some(next), Some(place)) = (own.next, own.place) {
                let others = vehicles.iter().filter(|other| way(other).next == Some(next));
                let same = others.filter(|other| way(other).place == Some(place)).count();
                assert_eq!(same, 1, "one place for each");
                placed += 1;
            }
            let Some(ghost) = &seen.target else { continue };
            let target = vehicles.iter().find(|other| other.id == ghost.of).unwrap();
            assert_eq!(own.follows, Some(ghost.of));
            assert!((ghost.position_m - target.position_m - ghost.error_m).abs() < 2e-4);
            let bound = ghost.bound_m.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
            assert!((bound[0]..=bound[1]).contains(&target.position_m), "{ghost:?} {}", target.position_m);
            largest_m = largest_m.max(ghost.error_m.abs());
            if way(target).road != own.road {
                crossing += 1;
                assert!(seen.newest_m.is_some_and(|newest_m| newest_m < target.position_m + 1e-3));
            }
        }
    }
    assert!(placed > 500 && crossing > 100 && largest_m < 10.0, "{placed} {crossing} {largest_m}");
}

/// The largest of some figure of a vehicle in a span of time, with these events.
fn largest(events: &str, vehicle: usize, span_s: (f64, f64), of: impl Fn(&Seen) -> f64) -> f64 {
    let play = RoadPlay::new(read(&format!("{}\n{events}", text()), &Overrides::default()));
    let mut stage = play.begin(play.events()).unwrap();
    let mut most = f64::NEG_INFINITY;
    while stage.next_s() < span_s.1 {
        stage.step().unwrap();
        if stage.next_s() > span_s.0
            && let Some(seen) = stage.scene(&Pulse::default()).vehicles.iter().find(|seen| seen.id == vehicle)
        {
            most = most.max(of(seen));
        }
    }
    most
}

#[test]
fn events_of_a_corridor_befall_its_vehicles_and_those_that_come_later() {
    let speed = |seen: &Seen| seen.speed_mps;
    let drive = "[[event]]\nat_s = 15\nvehicle = 1\ndrive_mps2 = -4\n";
    assert!(largest("", 1, (18.0, 19.0), speed) > 9.0);
    assert!(largest(drive, 1, (18.5, 19.0), speed) < 0.1);
    let blind = "[[event]]\nat_s = 1\nrange_sensor = false\n[[event]]\nat_s = 2\nenvelope = false\n";
    let is = |part: fn(&Seen) -> bool| move |seen: &Seen| f64::from(u8::from(part(seen)));
    for (events, wanted) in [("", 1.0), (blind, 0.0)] {
        assert_eq!(largest(events, 4, (19.0, 20.0), is(|seen| seen.sees)), wanted);
        assert_eq!(largest(events, 4, (19.0, 20.0), is(|seen| seen.has_envelope)), wanted);
    }
    let plain = "[[event]]\nat_s = 1\nholdover = false\n";
    assert_eq!(largest(plain, 4, (19.0, 20.0), is(|seen| seen.is_plain)), 1.0);
    let silent = "[[event]]\nat_s = 15\nvehicle = 1\noutage_s = 4\n";
    assert_eq!(largest(silent, 1, (15.0, 16.0), is(|seen| seen.is_silent)), 1.0);
}

#[test]
fn the_sides_of_a_run_heed_what_leaves_them_what_they_are_called() {
    let short = text().replacen("duration_s = 600.0", "duration_s = 15.0", 1);
    let runs = |events: &str| {
        let experiment = Experiment::new(read(&format!("{short}\n{events}"), &Overrides::default()));
        of_sides(&experiment.corridor).map(|conditions| {
            let mut bits = Bits::default();
            experiment.run_before(1, conditions, None, &mut [&mut bits]).unwrap();
            bits.0
        })
    };
    let differs = |events: &str| {
        let (quiet, with) = (runs(""), runs(events));
        [0, 1, 2, 3, 4, 5].map(|side| quiet[side] != with[side])
    };
    let links = "[[event]]\nat_s = 5\ndelay_mean_s = 0.5\ndelay_std_s = 0\nloss = 0.5\n";
    assert_eq!(differs(links), [true, false, true, true, false, true], "a perfect link stays perfect");
    assert_eq!(differs("[[event]]\nat_s = 5\nenvelope = false\n"), [false; 6], "a side has the envelope or not");
    assert_eq!(
        differs(
            "[[event]]\nat_s = 9\nvehicle = 0\ndrive_mps2 = -1\n[[event]]\nat_s = 10\nvehicle = 0\nrelease = true\n"
        ),
        [true; 6]
    );
}

#[test]
fn an_event_of_a_vehicle_that_never_comes_is_refused_in_its_line() {
    let of = |events: &str| {
        let file = format!("{}\n{events}", text());
        let error = corridor(Path::new("live.toml"), &file, &Overrides::default()).unwrap_err();
        (error.to_string(), file.lines().count())
    };
    let (said, lines) = of("[[event]]\nat_s = 15\nvehicle = 9999\noutage_s = 4");
    let wanted =
        format!("live.toml:{}: an event is of vehicle 9999, and there is none; give an index from 0 to ", lines - 1);
    assert!(said.starts_with(&wanted), "{said}");
    let (said, _) = of("[[event]]\nat_s = 15\ndrive_mps2 = 1");
    assert!(said.contains("what a person drives is of no vehicle"), "{said}");
}

#[test]
fn time_goes_back_past_arrivals_and_departures_and_the_same_is_seen_again() {
    let heard = Heard::begin(play());
    heard.step_to(1500);
    heard.order(Order::Drive { vehicle: 1, mps2: -3.0 }).unwrap();
    heard.step_to(1600);
    heard.order(Order::Release { vehicle: 1 }).unwrap();
    heard.step_to(6000);
    let first = heard.vehicles(6000);
    for seconds in [10.0, 52.0] {
        heard.order(Order::Back { seconds }).unwrap();
        assert_eq!(heard.journal().1, 6000 - (100.0 * seconds) as u64);
        heard.step_to(6000);
        assert_eq!(heard.vehicles(6000), first);
    }
    // The envelope of one vehicle is switched: all is played anew, and up to then nothing differs.
    let id = first[3]["id"].as_u64().unwrap() as usize;
    heard.order(Order::Switch { vehicle: Some(id), part: Part::Envelope, on: false }).unwrap();
    assert_eq!((heard.journal().1, heard.vehicles(6000)), (6000, first));
    heard.step_to(6001);
    let is_engaged = |seen: &serde_json::Value| seen["has_envelope"].as_bool().unwrap();
    let after = heard.vehicles(6001);
    let without: Vec<_> = after.as_array().unwrap().iter().filter(|seen| !is_engaged(seen)).collect();
    assert!(without.len() == 1 && without[0]["id"] == id, "{without:?}");
    let said = heard.order(Order::Drive { vehicle: 0, mps2: 1.0 }).unwrap_err();
    assert_eq!(said, "vehicle 0 is not on the road now; choose one that the page shows");
    assert_eq!(heard.end().1, 6001);
}
