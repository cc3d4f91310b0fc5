//! A road on which the peers drive one behind the other, and the ego behind the last of them: a time enters, the frames
//! that the ego's bus carries then leave. Where there are intersections, every other peer is on the crossing street, as far from there as
//! it would be ahead of the ego.

use crate::junction::Place;
use holdover::coordination::Arrival;
use holdover::parameters::{DAMPING, GAIN};
use holdover::time::{Duration, GnssTime, Instant};
use holdover::units::{Acceleration, Distance, FineSeconds, Fraction, Jerk, Position, Seconds, Speed};
#[cfg(feature = "fd")]
use holdover::wire::Transport;
use holdover::wire::driver_request::DriverRequest;
use holdover::wire::driving_parameters::{DrivingParameters, Limits};
#[cfg(feature = "fd")]
use holdover::wire::fd::State;
use holdover::wire::horizon::{KNOTS_PER_MILLE, Knot, Knots};
use holdover::wire::motion::{Motion, WirePosition};
use holdover::wire::range_sensor::RangeSample;
use holdover::wire::sync::{FollowUp, Sync};
use holdover::wire::{Frame, Identifiers, Message, Predecessor, Said, Sender, Slot, StationHash};

/// The ego's station; a peer's is the number of its slot.
pub const EGO: StationHash = StationHash(100);
/// GNSS time when the unit's clock started.
const EPOCH: u64 = 1_465_000_123_000_000;
const SPEED: i32 = 11_000;
/// Front bumper to front bumper, for a gap that the law is content with.
const SPACING: i64 = 18_000;
/// Of every vehicle.
const LENGTH: Distance = Distance::from_mm(4_800);
/// Where the ego is along its street at the beginning, and where the streets have their zero on its axis.
const BEGINS: i64 = 60_000;
const AXIS: i64 = 240_000;
/// Stations of which only the passes are heard are named from here on.
const PASSERS_BY: u32 = 200;

/// The road.
pub struct Road {
    peers: u8,
    has_junctions: bool,
    has_sensor: bool,
    is_terse: bool,
    begins: i64,
    spacing: i64,
    sender: Sender<8>,
    tag: u8,
    sequence: u8,
}

impl Road {
    /// With so many peers, up to 8.
    pub fn new(peers: u8) -> Self {
        let sender = Sender::new(Identifiers::DEFAULT);
        #[cfg(feature = "fd")]
        let sender = sender.over(Transport::Fd);
        Self {
            peers,
            has_junctions: false,
            has_sensor: false,
            is_terse: false,
            begins: BEGINS,
            spacing: SPACING,
            sender,
            tag: 0,
            sequence: 0,
        }
    }

    /// The same with intersections on it.
    pub fn with_junctions(self) -> Self {
        Self { has_junctions: true, ..self }
    }

    /// The same with a range sensor on the ego.
    pub fn with_sensor(self) -> Self {
        Self { has_sensor: true, ..self }
    }

    /// The same with a last vehicle, which the ego follows, that tells nothing of how it drives.
    pub fn with_terse_target(self) -> Self {
        Self { is_terse: true, ..self }
    }

    /// The same where all are so many millimetres further away from the intersections at the beginning.
    pub fn further_away(self, by: i64) -> Self {
        Self { begins: self.begins - by, ..self }
    }

    /// The same with so many millimetres from front bumper to front bumper.
    pub fn spaced_by(self, spacing: i64) -> Self {
        Self { spacing, ..self }
    }

    /// Whether a peer is on the ego's street.
    pub fn is_on_lane(&self, peer: u8) -> bool {
        !self.has_junctions || peer.is_multiple_of(2)
    }

    fn is_silent_about_itself(&self, peer: u8) -> bool {
        self.is_terse && peer + 1 == self.peers
    }

    /// Whether there are intersections on it.
    pub fn has_junctions(&self) -> bool {
        self.has_junctions
    }

    fn say(&mut self, message: &Message, hear: &mut impl FnMut(&Frame)) {
        let _ = self.sender.send(message, &mut |frame| hear(&frame));
    }

    /// The time base.
    pub fn synchronise(&mut self, at: Instant, hear: &mut impl FnMut(&Frame)) {
        self.sequence = (self.sequence + 1) % 16;
        let (sequence, time) = (self.sequence, EPOCH + at.as_micros());
        self.say(&Message::Sync(Sync { sequence, seconds: (time / 1_000_000) as u32 }), hear);
        self.say(&Message::FollowUp(FollowUp { sequence, micros: (time % 1_000_000) as u32 }), hear);
    }

    /// The ego's own motion and the driver's request.
    pub fn ego(&mut self, at: Instant, hear: &mut impl FnMut(&Frame)) {
        let predecessor = match self.has_junctions {
            true => Predecessor::Unknown,
            false => Predecessor::Station(StationHash(self.peers - 1)),
        };
        let request =
            DriverRequest { engaged: true, predecessor, target_speed: Speed::from_mm_per_s(13_400), time_gap: None };
        self.say(&Message::DriverRequest(request), hear);
        let motion = self.motion(at, self.peers, EGO);
        self.say(&Message::Ego(Said::Motion(motion)), hear);
        if self.has_junctions && at.as_micros().is_multiple_of(100_000) {
            let geo = self.place(at, self.peers).on_globe(self.tag, motion.stamp);
            self.say(&Message::Ego(Said::Geo(geo)), hear);
        }
    }

    /// What the ego's range sensor sees every 20 ms, if it has one: the nearest vehicle on its street.
    pub fn view(&mut self, at: Instant, hear: &mut impl FnMut(&Frame)) {
        if !self.has_sensor || !at.as_micros().is_multiple_of(20_000) {
            return;
        }
        // On the ego's street every other peer is, where there are intersections, and the last one is on the other.
        let ahead = if self.has_junctions { 2 } else { 1 };
        let seen = RangeSample {
            distance: Distance::from_mm((self.spacing * ahead) as i32).minus(LENGTH),
            speed_difference: Speed::ZERO,
            distance_accuracy: Distance::from_mm(250),
            speed_accuracy: Speed::from_mm_per_s(100),
            age: Duration::ZERO,
            nobody: false,
        };
        self.say(&Message::Range(seen), hear);
    }

    /// Where there are intersections: where a peer is on the globe, its route, and its passes. All are of the motion that it sent last,
    /// which was sampled `age` ago.
    pub fn way_of(&mut self, peer: u8, at: Instant, age: Duration, hear: &mut impl FnMut(&Frame)) {
        if !self.has_junctions {
            return;
        }
        let (now, arrival) = (gnss(at.minus(age)), self.arrival(peer));
        let (place, stamp) = (self.place(at.minus(age), peer), now.stamp());
        let (geo, route) =
            (place.on_globe(self.tag, stamp), place.route(self.tag, stamp, arrival, peer.checked_sub(1)));
        self.say(&Message::Peer(Slot(peer), Said::Geo(geo)), hear);
        self.say(&Message::Peer(Slot(peer), Said::Route(route)), hear);
        self.say(&Message::PeerPass(place.pass(self.tag, peer.into(), now, arrival)), hear);
    }

    /// The passes of so many stations without a slot, on the crossing street behind the peers.
    pub fn passers_by(&mut self, stations: u8, at: Instant, hear: &mut impl FnMut(&Frame)) {
        for station in 0..stations {
            let along = self.place(at, 1).along - 5_000 * i64::from(station) - 1_000;
            let pass = Place { leg: 1, along }.pass(
                self.tag,
                PASSERS_BY + u32::from(station),
                gnss(at),
                self.arrival(self.peers),
            );
            self.say(&Message::PeerPass(pass), hear);
        }
    }

    fn place(&self, at: Instant, place: u8) -> Place {
        let ahead = self.spacing * (i64::from(self.peers) - i64::from(place));
        let along = self.begins + ahead + i64::from(SPEED) * at.as_micros() as i64 / 1_000_000;
        let is_ego = place == self.peers;
        Place { leg: if is_ego || self.is_on_lane(place) { 0 } else { 1 }, along }
    }

    /// When a vehicle arrived: one after the other, and before the ego.
    fn arrival(&self, peer: u8) -> Arrival {
        let before = 10_000 * 50 * u64::from(self.peers - peer.min(self.peers) + 1);
        Arrival::of_micros(EPOCH - before)
    }

    /// A peer's motion, sampled `age` ago.
    pub fn motion_of(&mut self, peer: u8, at: Instant, age: Duration, hear: &mut impl FnMut(&Frame)) {
        let motion = self.motion(at.minus(age), peer, StationHash(peer));
        self.say(&Message::Peer(Slot(peer), Said::Motion(motion)), hear);
    }

    /// How a peer drives; with another time gap if `other`.
    pub fn parameters_of(&mut self, peer: u8, other: bool, hear: &mut impl FnMut(&Frame)) {
        if !self.is_silent_about_itself(peer) {
            self.say(&Message::Peer(Slot(peer), Said::DrivingParameters(parameters(peer, other))), hear);
        }
    }

    /// Everything that a peer says of its motion and of what it will do: its motion sampled `age` ago, the horizon from it, and with
    /// every fifth its driving parameters.
    pub fn state_of(
        &mut self,
        peer: u8,
        at: Instant,
        age: Duration,
        with_parameters: bool,
        hear: &mut impl FnMut(&Frame),
    ) {
        let motion = self.motion(at.minus(age), peer, StationHash(peer));
        let horizon = horizon(motion.tag);
        let parameters = with_parameters.then(|| parameters(peer, false));
        #[cfg(feature = "fd")]
        {
            let state = State { motion, parameters, horizon: Some(horizon) };
            self.say(&Message::Peer(Slot(peer), Said::State(state)), hear);
        }
        #[cfg(not(feature = "fd"))]
        {
            let said =
                [Some(Said::Motion(motion)), parameters.map(Said::DrivingParameters), Some(Said::Horizon(horizon))];
            said.into_iter().flatten().for_each(|said| self.say(&Message::Peer(Slot(peer), said), hear));
        }
    }

    /// The horizon that a peer computed from the motion that it sent last: on at its speed.
    pub fn horizon_of(&mut self, peer: u8, hear: &mut impl FnMut(&Frame)) {
        if !self.is_silent_about_itself(peer) {
            self.say(&Message::Peer(Slot(peer), Said::Horizon(horizon(self.tag))), hear);
        }
    }

    fn motion(&mut self, at: Instant, place: u8, station: StationHash) -> Motion {
        self.tag = (self.tag + 1) % 4;
        let along = self.place(at, place).along;
        Motion {
            tag: self.tag,
            position: WirePosition::from_position(Position::from_mm(AXIS + along)),
            speed: Speed::from_mm_per_s(SPEED),
            acceleration: Acceleration::ZERO,
            demand: Acceleration::ZERO,
            stamp: gnss(at).stamp(),
            position_accuracy: Some(Distance::from_mm(500)),
            speed_accuracy: Some(Speed::from_mm_per_s(200)),
            station,
        }
    }
}

fn gnss(at: Instant) -> GnssTime {
    GnssTime::from_micros(EPOCH + at.as_micros())
}

/// How a peer drives; with another time gap if `other`.
fn parameters(peer: u8, other: bool) -> DrivingParameters {
    DrivingParameters {
        length: LENGTH,
        standstill: Distance::from_mm(2_000),
        predecessor: peer.checked_sub(1).map_or(Predecessor::None, |ahead| Predecessor::Station(StationHash(ahead))),
        target_speed: Speed::from_mm_per_s(13_400),
        catch_up: Fraction::from_milli(200),
        time_gap: Seconds::from_millis(if other { 1_200 } else { 1_000 }),
        gain: GAIN,
        damping: DAMPING,
        feed_forward: Fraction::ZERO,
        lag: FineSeconds::from_millis(300),
        limits: Limits {
            acceleration: Acceleration::from_mm_per_s2(2_500),
            braking: Acceleration::from_mm_per_s2(4_000),
            jerk: Jerk::from_mm_per_s3(5_000),
            emergency_braking: Acceleration::from_mm_per_s2(8_000),
        },
        horizon_tenths: 39,
    }
}

/// On at its speed, from the motion with this tag.
fn horizon(tag: u8) -> Knots {
    let knots = KNOTS_PER_MILLE.map(|share| Knot {
        displacement: Distance::from_mm((i64::from(SPEED) * 39 * i64::from(share) / 10_000) as i32),
        speed: Speed::from_mm_per_s(SPEED),
        acceleration: Acceleration::ZERO,
        bow: Distance::ZERO,
    });
    Knots { tag, knots }
}
