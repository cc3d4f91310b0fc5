//! The range sensor on the way through intersections: what it sees is not taken for a vehicle that may be behind the ego, and a vehicle
//! that crosses and that the ego already minds is no stranger.

use crate::rig;
use crate::rig::junction::{CROSSING, Driver, Junction};
use crate::rig::plant::Body;
use crate::rig::{LENGTH, m_of, metres};
use holdover::controller::{FallbackCause, Mode};
use holdover::wire::Movement;
use holdover::wire::route::Route;
use holdover::wire::{Message, Predecessor, Said, Slot, StationHash};

/// The vehicle behind did not hear the ego, and drives on by its own horizon; then it is silent, and stops in time.
#[test]
fn a_vehicle_behind_that_is_estimated_to_have_driven_on_is_not_the_one_that_the_sensor_sees() {
    let mut ego = Driver::new(1, 0, 60.0, 2.0, true);
    ego.sees = true;
    let mut stranger = Driver::new(2, 0, 100.0, 0.0, false);
    stranger.speaks = false;
    let mut behind = Driver::new(3, 0, 5.0, 9.0, false);
    behind.hears = false;
    let mut junction = Junction::new(vec![ego, stranger, behind]);
    let mut checked = 0;
    junction.run(20.0, |junction| {
        let now = junction.now;
        let [ego, stranger, behind] = &mut junction.drivers[..] else { panic!("three") };
        stranger.body.speed = 0.0;
        stranger.body.position = 100.0;
        behind.speaks = now < 2_000_000;
        if now > 2_000_000 {
            behind.body.speed = (behind.body.speed - 0.05).max(0.0);
            behind.body.acceleration = 0.0;
        }
        assert!(ego.body.position - 4.8 > behind.body.position, "it stops in time");
        let track = ego.rig.unit.peers().get(2).expect("a slot");
        let Some(bound) = track.certainty().bound() else { return };
        let bound = bound.after(rig::instant(now), &track.reach());
        let truth = behind.body.position + ego.axis;
        let (low, high) = (m_of(bound.lowest_position()), m_of(bound.highest_position()));
        assert!((low..high).contains(&truth), "{:.2} s: {low:.2} <= {truth:.2} <= {high:.2}", now as f64 * 1e-6);
        checked += 1;
    });
    assert!(checked > 1_500, "{checked}");
}

/// From here on a vehicle on the other street is in the ego's way: half the width of a body before the place where both cross.
const SIDE: f64 = CROSSING - 1.25;

/// What the ego's sensor sees of the nearest vehicle in its way: of one on its street the rear, of one that crosses the side.
fn look(junction: &mut Junction) {
    let now = junction.now;
    let own = junction.drivers[0].body;
    let views = junction.drivers[1..].iter().filter_map(|other| {
        let (rear, speed) = if other.way == 0 { (other.body.position - LENGTH, other.body.speed) } else { (SIDE, 0.0) };
        let front = other.body.position;
        let is_there = other.way == 0 || front > SIDE && front - LENGTH < CROSSING + (CROSSING - SIDE);
        (is_there && rear > own.position).then_some((rear - own.position, speed - own.speed))
    });
    let nearest = views.filter(|(gap, _)| *gap < 100.0).min_by(|a, b| a.0.total_cmp(&b.0));
    if let Some((gap, difference)) = nearest.filter(|_| now % 20_000 == 0) {
        let _ = junction.drivers[0].rig.range(now, gap, difference, 0);
    }
}

/// A vehicle far ahead of the ego on its street, one that crosses between the two, and the ego with the envelope. Returns when the ego is
/// past the crossing, in seconds, and for how many ticks its sensor disagreed with what it heard.
fn behind_one_that_crosses(sees: bool) -> (f64, u32) {
    // Arrivals are equal, and the lower number goes first.
    let ego = Driver::new(4, 0, 95.0, 10.0, true);
    let ahead = Driver::new(3, 0, 390.0, 10.0, false);
    let across = Driver::new(2, 1, 118.0, 10.0, false);
    let mut junction = Junction::new(vec![ego, ahead, across]);
    let (mut past, mut disagreed, mut hidden) = (None, 0, 0);
    junction.run(40.0, |junction| {
        let [ego, ahead, across] = &junction.drivers[..] else { panic!("three") };
        assert!(!(ego.is_inside() && across.is_inside()), "at {:.2} s", junction.now as f64 * 1e-6);
        let mode = ego.rig.unit.mode();
        disagreed += u32::from(matches!(mode, Mode::Fallback { cause: FallbackCause::RangeDisagrees, .. }));
        hidden += u32::from(across.body.position > SIDE && ego.body.position < SIDE && ahead.body.position > CROSSING);
        if ego.body.position > CROSSING + LENGTH {
            past.get_or_insert(junction.now as f64 * 1e-6);
        }
        if sees {
            look(junction);
        }
    });
    assert!(hidden > 30, "the one that crosses hides the one ahead: {hidden}");
    (past.expect("it passes"), disagreed)
}

#[test]
fn one_that_crosses_and_is_heard_neither_contradicts_the_one_ahead_nor_is_remembered_as_standing() {
    let (without, _) = behind_one_that_crosses(false);
    let (with, disagreed) = behind_one_that_crosses(true);
    // When it has crossed, nobody is in the sensor's range, so no view shows that it has gone.
    assert!(with < without + 0.3, "{with} {without}");
    assert_eq!(disagreed, 0);
}

#[test]
fn the_ego_stops_for_one_that_stands_across_its_way_and_was_never_heard() {
    let ego = Driver::new(1, 0, 95.0, 10.0, true);
    let mut across = Driver::new(2, 1, CROSSING + 2.0, 0.0, false);
    (across.speaks, across.hears) = (false, false);
    let mut junction = Junction::new(vec![ego, across]);
    junction.run(40.0, |junction| {
        junction.drivers[1].body =
            rig::plant::Plant { position: CROSSING + 2.0, speed: 0.0, acceleration: 0.0, lag: 0.3 };
        look(junction);
        assert!(junction.drivers[0].body.position < SIDE, "at {:.2} s", junction.now as f64 * 1e-6);
    });
    assert!(junction.drivers[0].body.speed < 0.1, "it stands");
}

/// Two vehicles ahead on the ego's street fall silent, and the nearer one leaves it. The sensor sees the other one, past all that is
/// certain of the first; then it is blind, and the other one brakes. Returns the least gap to it.
fn least_gap_behind_the_second(stations: [u8; 2]) -> f64 {
    let mut junction = Junction::new(vec![Driver::new(1, 0, 20.0, 13.0, true)]);
    let at = |gap: f64| Body { position: 20.0 + gap + LENGTH, speed: 13.0 };
    let mut bodies = [at(27.0), at(27.0 + LENGTH + 9.0)];
    let (silent, blind) = (3_000_000, 4_000_000);
    let mut least = f64::MAX;
    while junction.now < 20_000_000 {
        let now = junction.now;
        bodies = [bodies[0].after(0.0, 0.01), bodies[1].after(if now >= blind { -8.0 } else { 0.0 }, 0.01)];
        for (slot, (body, station)) in
            (2..).zip(bodies.iter().zip(stations)).filter(|_| now % 100_000 == 0 && now < silent)
        {
            let rig = &mut junction.drivers[0].rig;
            let motion = rig.motion(StationHash(station), now, body.position, body.speed, 0.0, 0.0, Some((0.05, 0.02)));
            let route = Route {
                tag: motion.tag,
                intersection: 5,
                movement: Movement::straight(0),
                distance: metres(CROSSING - body.position),
                stamp: motion.stamp,
                arrival: 1,
                predecessor: Predecessor::None,
            };
            let parameters = Said::DrivingParameters(rig::parameters(2.5, 8.0));
            for said in [parameters, Said::Route(route), Said::Motion(motion)] {
                let _ = rig.put(now, &Message::Peer(Slot(slot), said));
            }
        }
        let (own, seen) = (junction.drivers[0].body, bodies[usize::from(now >= silent)]);
        if now % 20_000 == 0 && now < blind {
            let gap = seen.position - LENGTH - own.position;
            let _ = junction.drivers[0].rig.range(now, gap, seen.speed - own.speed, 0);
        }
        junction.run(0.01, |_| ());
        least = least.min(bodies[1].position - LENGTH - junction.drivers[0].body.position);
    }
    least
}

#[test]
fn one_that_the_sensor_sees_past_takes_no_namesake_off_the_gates_mind() {
    let (others, namesakes) = (least_gap_behind_the_second([42, 43]), least_gap_behind_the_second([42, 42]));
    assert!(others > 0.0 && namesakes > 0.0, "{others} {namesakes}");
}
