//! Vehicles that leave the ego's way, and what stays certain of them: one that comes back elsewhere, one that the driver has named. The
//! peers are bodies in float64 that the unit knows by their frames alone.

use crate::rig;
use crate::rig::junction::{CROSSING, Driver, Junction, NORTHWARD};
use crate::rig::plant::Body;
use holdover::controller::Mode;
use holdover::coordination::{Approach, Crossing, Intersection, Itinerary, Movement};
use holdover::units::{Distance, Position};
use holdover::wire::driver_request::DriverRequest;
use holdover::wire::driving_parameters::DrivingParameters;
use holdover::wire::geo::GeoPosition;
use holdover::wire::route::Route;
use holdover::wire::{Message, Predecessor, Said, Slot, StationHash};

/// A vehicle on the ego's street in this slot: a car whose odometer begins somewhere else.
struct Peer {
    slot: u8,
    body: Body,
    braking: f64,
}

impl Peer {
    const ODOMETER: f64 = 7_000.0;

    fn station(&self) -> StationHash {
        StationHash(40 + self.slot)
    }

    /// Says its motion, and that it comes to this intersection, which is `crossing` metres along the street.
    fn speak(&self, junction: &mut Junction, intersection: u8, crossing: f64) {
        let (now, slot) = (junction.now, Slot(self.slot));
        let rig = &mut junction.drivers[0].rig;
        let at = self.body.position + Self::ODOMETER;
        let motion = rig.motion(self.station(), now, at, self.body.speed, 0.0, 0.0, Some((0.05, 0.02)));
        let route = Route {
            tag: motion.tag,
            intersection,
            movement: Movement::straight(0),
            distance: rig::metres(crossing - self.body.position),
            stamp: motion.stamp,
            arrival: 1,
            predecessor: Predecessor::None,
        };
        for said in [Said::Route(route), Said::Motion(motion)] {
            let _ = rig.put(now, &Message::Peer(slot, said));
        }
    }
}

/// Drives for so long; each peer speaks every 0.1 s, if `says` tells to which intersection it comes and how far along the street that is.
/// Returns the least gap behind the nearest peer ahead.
fn drive(
    junction: &mut Junction,
    peers: &mut [Peer],
    seconds: f64,
    says: impl Fn(usize, &Peer) -> Option<(u8, f64)>,
) -> f64 {
    let mut least = f64::MAX;
    junction.run(seconds, |junction| {
        for (number, peer) in peers.iter_mut().enumerate() {
            peer.body = peer.body.after(-peer.braking, 0.01);
            if junction.now % 100_000 == 0
                && let Some((intersection, crossing)) = says(number, peer)
            {
                peer.speak(junction, intersection, crossing);
            }
        }
        let front = junction.drivers[0].body.position;
        let gaps = peers.iter().map(|peer| peer.body.position - rig::LENGTH - front).filter(|gap| *gap > -rig::LENGTH);
        least = gaps.fold(least, f64::min);
    });
    least
}

const FIRST: (u8, f64) = (5, CROSSING);
const SECOND: (u8, f64) = (6, 390.0);
const ELSEWHERE: (u8, f64) = (99, CROSSING);

#[test]
fn a_vehicle_that_left_the_way_and_came_back_behind_another_is_not_ahead_of_that_one_any_more() {
    let mut junction = Junction::new(vec![Driver::new(1, 0, 20.0, 8.0, true)]);
    let peer = |slot, position| Peer { slot, body: Body { position, speed: 8.0 }, braking: 0.0 };
    let mut peers = [peer(2, 110.0), peer(3, 70.0)];
    assert!(drive(&mut junction, &mut peers, 4.0, |_, _| Some(SECOND)) > 0.0);
    // The first one takes another street, and comes back behind the second one.
    assert!(
        drive(&mut junction, &mut peers, 2.0, |number, _| Some(if number == 0 { ELSEWHERE } else { SECOND })) > 0.0
    );
    peers[0].body.position = peers[1].body.position - 30.0;
    assert!(drive(&mut junction, &mut peers, 8.0, |_, _| Some(SECOND)) > 0.0);
    // It falls silent and brakes; the second one drives on.
    peers[0].braking = 6.0;
    let least = drive(&mut junction, &mut peers, 15.0, |number, _| (number == 1).then_some(SECOND));
    assert!(least > 0.0, "{least}");
}

#[test]
fn what_was_certain_of_a_vehicle_before_it_left_the_way_is_not_held_against_its_return() {
    let mut junction = Junction::new(vec![Driver::new(1, 0, 20.0, 8.0, true)]);
    let mut peers = [Peer { slot: 2, body: Body { position: 120.0, speed: 8.0 }, braking: 0.0 }];
    drive(&mut junction, &mut peers, 3.0, |_, _| Some(SECOND));
    drive(&mut junction, &mut peers, 1.0, |_, _| Some(ELSEWHERE));
    peers[0].body.position -= 60.0;
    let mut checked = 0;
    for tenth in 0..30 {
        drive(&mut junction, &mut peers, 0.1, |_, _| Some(SECOND));
        let ego = &junction.drivers[0];
        let track = ego.rig.unit.peers().get(2).expect("a slot");
        let Some(bound) = track.certainty().bound() else { continue };
        let now = rig::instant(junction.now - rig::junction::PERIOD);
        let bound = bound.after(now, &track.reach());
        let truth = peers[0].body.position + ego.axis;
        let (low, high) = (rig::m_of(bound.lowest_position()), rig::m_of(bound.highest_position()));
        assert!(low <= truth && truth <= high, "after {tenth} tenths: {low} <= {truth} <= {high}");
        checked += 1;
    }
    assert!(checked > 20, "{checked}");
}

#[test]
fn the_vehicle_that_the_driver_has_named_is_minded_on_a_way_too_also_when_it_says_another_way() {
    for says in [FIRST, ELSEWHERE] {
        let mut ego = Driver::new(1, 0, 100.0, 12.0, true);
        ego.asks = false;
        let mut junction = Junction::new(vec![ego]);
        let mut peers = [Peer { slot: 2, body: Body { position: 150.0, speed: 12.0 }, braking: 0.0 }];
        let request = |junction: &mut Junction| {
            let now = junction.now;
            let request = DriverRequest {
                engaged: true,
                predecessor: Predecessor::Station(StationHash(42)),
                target_speed: rig::mps(12.0),
                time_gap: None,
            };
            let _ = junction.drivers[0].rig.put(now, &Message::DriverRequest(request));
        };
        let mut least = f64::MAX;
        for tenth in 0..300 {
            request(&mut junction);
            // From the first crossing on it says so, and 5 s later it brakes.
            let is_beyond = peers[0].body.position > CROSSING;
            peers[0].braking = if tenth > 100 { 6.0 } else { 0.0 };
            let told = if is_beyond { says } else { FIRST };
            least = least.min(drive(&mut junction, &mut peers, 0.1, |_, _| Some(told)));
        }
        assert!(least > 0.0, "{says:?}: {least}");
        assert_ne!(junction.drivers[0].rig.unit.mode(), Mode::Standby);
    }
}

/// Two intersections on the street, 20 m apart.
static AT_200: Intersection = Intersection {
    id: 5,
    half: Distance::from_mm(4_000),
    approaches: &[Approach::straight(0, &NORTHWARD, Position::from_mm(200_000), 0b10)],
};
static AT_220: Intersection = Intersection {
    id: 6,
    approaches: &[Approach::straight(0, &NORTHWARD, Position::from_mm(220_000), 0b10)],
    ..AT_200
};
static CLOSE: Itinerary = Itinerary {
    path: &NORTHWARD,
    crossings: &[
        Crossing { intersection: &AT_200, movement: Movement::straight(0), at: Position::from_mm(200_000) },
        Crossing { intersection: &AT_220, movement: Movement::straight(0), at: Position::from_mm(220_000) },
    ],
};

#[test]
fn a_vehicle_in_the_area_just_beyond_the_next_one_is_not_met() {
    let mut ego = Driver::new(1, 0, 60.0, 13.0, true);
    ego.rig.unit.set_out(&CLOSE).expect("a map");
    let mut junction = Junction::new(vec![ego]);
    // It stands in the second area, which it came to by the other leg.
    let place = 220.0 + 2.0;
    junction.run(25.0, |junction| {
        let now = junction.now;
        if now % 100_000 == 0 {
            let rig = &mut junction.drivers[0].rig;
            let motion = rig.motion(StationHash(42), now, 7_000.0, 0.0, 0.0, 0.0, Some((0.05, 0.02)));
            let (tag, stamp, predecessor) = (motion.tag, motion.stamp, Predecessor::None);
            let distance = rig::metres(220.0 - place);
            let route = Route {
                tag,
                intersection: 6,
                movement: Movement::straight(1),
                distance,
                stamp,
                arrival: 1,
                predecessor,
            };
            for said in [Said::Route(route), Said::Motion(motion)] {
                let _ = rig.put(now, &Message::Peer(Slot(2), said));
            }
        }
        let front = junction.drivers[0].body.position;
        assert!(front < 216.0, "in the area with it at {:.2} s", now as f64 * 1e-6);
    });
    assert!(junction.drivers[0].body.position > 195.0, "it comes up to the second area");
}

#[test]
fn before_the_intersection_after_the_next_one_the_ego_can_stop_in_any_case() {
    // The first crossing at 200 m, the second one at 390 m: with nobody there the ego never has to slow down for the second one.
    let mut junction = Junction::new(vec![Driver::new(1, 0, 20.0, 15.0, true)]);
    let mut slowest = f64::MAX;
    junction.run(20.0, |junction| slowest = slowest.min(junction.drivers[0].body.speed));
    assert!(slowest > 14.5, "{slowest}");
}

#[test]
fn a_long_vehicle_that_says_its_place_alone_is_in_the_area_until_its_rear_has_left() {
    // An articulated lorry of 18 m stands with its front 13 m past the crossing point of the other street: 1 m of it is in the area.
    let mut junction = Junction::new(vec![Driver::new(1, 0, 60.0, 13.0, true)]);
    let length = 18.0;
    let front = CROSSING + 13.0;
    let parameters = DrivingParameters { length: rig::metres(length), ..rig::parameters(2.0, 8.0) };
    junction.run(25.0, |junction| {
        let (now, slot) = (junction.now, Slot(2));
        if now % 100_000 == 0 {
            let rig = &mut junction.drivers[0].rig;
            let motion = rig.motion(StationHash(42), now, 7_000.0, 0.0, 0.0, 0.0, Some((0.05, 0.02)));
            let (tag, stamp) = (motion.tag, motion.stamp);
            let longitude = (front * 100.0) as i32 - 20_000;
            let geo = GeoPosition { tag, latitude: 20_000, longitude, heading: 7_200, stamp };
            for said in [Said::DrivingParameters(parameters), Said::Geo(geo), Said::Motion(motion)] {
                let _ = rig.put(now, &Message::Peer(slot, said));
            }
        }
        assert!(!junction.drivers[0].is_inside(), "in the area with it at {:.2} s", now as f64 * 1e-6);
    });
    assert!(junction.drivers[0].body.position > 180.0, "it comes up to the area");
}
