//! An intersection on a flat globe where a step of 1e-7° is a centimetre: two straight streets, one to the north (leg 0) and
//! one to the east (leg 1), that cross 200 m from where each begins, and 190 m further north a second intersection, with a third
//! street to the east, which begins 400 m before. Vehicles with a unit each drive on them, and hear one another without delay, if at all.

use super::*;
use holdover::coordination::{Approach, Crossing, Intersection, Itinerary, Movement, Path, Scale, Segment};
use holdover::wire::geo::GeoPosition;
use holdover::wire::pass::Pass;

const CM: i32 = 687_194_767; // 0.01 · 2³⁶

static NORTH: [Segment; 1] = [Segment {
    latitude: 0,
    longitude: 0,
    begins: Position::ZERO,
    length: Distance::from_mm(500_000),
    along: Scale { north: CM, east: 0 },
    across: Scale { north: 0, east: CM },
    heading: 0,
}];
static EAST: [Segment; 1] = [Segment {
    latitude: 20_000,
    longitude: -20_000,
    begins: Position::ZERO,
    length: Distance::from_mm(500_000),
    along: Scale { north: 0, east: CM },
    across: Scale { north: -CM, east: 0 },
    heading: 7_200,
}];
static WEST: [Segment; 1] = [Segment {
    latitude: 20_000,
    longitude: 20_000,
    along: Scale { north: 0, east: -CM },
    across: Scale { north: CM, east: 0 },
    heading: 21_600,
    ..EAST[0]
}];
static WESTWARD: Path = Path { segments: &WEST };
static FAR_EAST: [Segment; 1] =
    [Segment { latitude: 39_000, longitude: -40_000, length: Distance::from_mm(700_000), ..EAST[0] }];
pub static NORTHWARD: Path = Path { segments: &NORTH };
pub static EASTWARD: Path = Path { segments: &EAST };
static FAR_EASTWARD: Path = Path { segments: &FAR_EAST };

static FIRST: Intersection = Intersection {
    id: 5,
    half: Distance::from_mm(4_000),
    approaches: &[
        Approach::straight(0, &NORTHWARD, Position::from_mm(200_000), 0b110),
        Approach::straight(1, &EASTWARD, Position::from_mm(200_000), 0b01),
        Approach::straight(2, &WESTWARD, Position::from_mm(200_000), 0b01),
    ],
};
static SECOND: Intersection = Intersection {
    id: 6,
    half: Distance::from_mm(4_000),
    approaches: &[
        Approach::straight(0, &NORTHWARD, Position::from_mm(390_000), 0b10),
        Approach::straight(1, &FAR_EASTWARD, Position::from_mm(400_000), 0b01),
    ],
};
pub static WAYS: [Itinerary; 4] = [
    Itinerary {
        path: &NORTHWARD,
        crossings: &[
            Crossing { intersection: &FIRST, movement: Movement::straight(0), at: Position::from_mm(200_000) },
            Crossing { intersection: &SECOND, movement: Movement::straight(0), at: Position::from_mm(390_000) },
        ],
    },
    Itinerary {
        path: &EASTWARD,
        crossings: &[Crossing {
            intersection: &FIRST,
            movement: Movement::straight(1),
            at: Position::from_mm(200_000),
        }],
    },
    Itinerary {
        path: &FAR_EASTWARD,
        crossings: &[Crossing {
            intersection: &SECOND,
            movement: Movement::straight(1),
            at: Position::from_mm(400_000),
        }],
    },
    Itinerary {
        path: &WESTWARD,
        crossings: &[Crossing {
            intersection: &FIRST,
            movement: Movement::straight(2),
            at: Position::from_mm(200_000),
        }],
    },
];

/// Where both streets cross, along each.
pub const CROSSING: f64 = 200.0;
/// Half of the conflict area.
pub const HALF: f64 = 4.0;

/// How wide vehicles are.
pub const WIDTH: f64 = 1.8;

/// Whether a body is where the streets cross.
pub fn is_on_point(body: &plant::Plant) -> bool {
    body.position > CROSSING - WIDTH / 2.0 && body.position - LENGTH < CROSSING + WIDTH / 2.0
}

/// A vehicle with its unit.
pub struct Driver {
    pub rig: Rig,
    /// North, east, or east at the second intersection.
    pub way: usize,
    /// The way that it is on beyond the first crossing, if it turns there. As far along it as along its own one.
    pub turns_to: Option<usize>,
    pub body: plant::Plant,
    /// Its own axis begins so far before its street.
    pub axis: f64,
    pub target_speed: f64,
    pub engaged: bool,
    /// Whether it speaks, whether it hears, and whether it says its route.
    pub speaks: bool,
    pub hears: bool,
    pub says_route: bool,
    /// Whether it says how it moves, and the others give it a slot.
    pub says_motion: bool,
    /// Whether it says how it will drive.
    pub says_plans: bool,
    /// Whether its range sensor sees the nearest vehicle ahead on its street.
    pub sees: bool,
    /// Whether its range sensor also sees vehicles of the other street that stand or drive across its way at the first crossing.
    pub sees_across: bool,
    /// Whether its range sensor says nothing.
    pub is_blind: bool,
    /// Whether its own motion is measured.
    pub is_measured: bool,
    /// The published accuracy of its position.
    pub accuracy: f64,
    /// What its driver commands instead of the unit.
    pub by_hand: Option<f64>,
    /// How much later than true its position is measured to be.
    pub off: f64,
    /// Whether it is told the time.
    pub is_timed: bool,
    /// Whether its driver's request comes.
    pub asks: bool,
    pub last: Option<Heard>,
    /// The driver whom it does not hear.
    pub deaf_to: Option<usize>,
    /// Whether its modem repeats the passes that it hears, every half second.
    pub repeats: bool,
}

impl Driver {
    pub fn new(station: u8, way: usize, at: f64, speed: f64, envelope: bool) -> Self {
        Self::of(config(), station, way, at, speed, envelope)
    }

    /// The same, with this configuration.
    pub fn of(mut config: Config, station: u8, way: usize, at: f64, speed: f64, envelope: bool) -> Self {
        config.station = StationHash(station);
        config.station_id = u32::from(station);
        config.envelope = envelope.then_some(holdover::config::Envelope::CAR);
        let mut rig = Rig::new(&config);
        rig.power_up(true, 0);
        rig.unit.set_out(&WAYS[way]).unwrap();
        let body = plant::Plant { position: at, speed, acceleration: 0.0, lag: 0.3 };
        let axis = 1_000.0 * f64::from(station);
        Self {
            rig,
            way,
            turns_to: None,
            body,
            axis,
            target_speed: speed,
            engaged: true,
            speaks: true,
            hears: true,
            says_route: true,
            says_motion: true,
            says_plans: true,
            sees: false,
            sees_across: false,
            is_blind: false,
            is_measured: true,
            accuracy: 0.05,
            by_hand: None,
            off: 0.0,
            is_timed: true,
            asks: true,
            last: None,
            deaf_to: None,
            repeats: false,
        }
    }

    /// The street that it is on.
    fn street(&self) -> usize {
        self.turns_to.filter(|_| self.body.position > CROSSING).unwrap_or(self.way)
    }

    pub fn geo(&self, at: i64) -> GeoPosition {
        let cm = (self.body.position * 100.0).round() as i32;
        let (tag, stamp) = ((at / 100_000 % 4) as u8, gnss(at, 0).stamp());
        let eastward = |latitude, begins| GeoPosition { tag, latitude, longitude: cm + begins, heading: 7_200, stamp };
        match self.street() {
            0 => GeoPosition { tag, latitude: cm, longitude: 0, heading: 0, stamp },
            1 => eastward(20_000, -20_000),
            3 => GeoPosition { tag, latitude: 20_000, longitude: 20_000 - cm, heading: 21_600, stamp },
            _ => eastward(39_000, -40_000),
        }
    }

    /// Whom the unit says that it follows.
    pub fn follows(&self) -> Option<u8> {
        let index = self.rig.unit.coordination().choice().target?;
        Some(self.rig.unit.peers().get(index.into())?.station()?.0)
    }

    fn put_pass(&mut self, now: i64, pass: Pass) {
        if self.hears {
            let _ = self.rig.put(now + 1_000, &Message::PeerPass(pass));
        }
    }

    /// Whether any of it is in the conflict area of the first crossing.
    pub fn is_inside(&self) -> bool {
        self.body.position > CROSSING - HALF && self.body.position - LENGTH < CROSSING + HALF
    }

    pub fn command(&self) -> f64 {
        self.last.as_ref().map_or(0.0, |last| mps2_of(last.command.acceleration))
    }

    /// Where the unit says that its target is, along its own street.
    pub fn estimate(&self) -> Option<f64> {
        let estimate = self.last.as_ref()?.answer.estimate.as_ref()?;
        Some(m_of(estimate.reading.position) - self.axis)
    }
}

/// All of them.
pub struct Junction {
    pub drivers: Vec<Driver>,
    pub now: i64,
    /// What each has said of its passes last.
    said: Vec<(usize, Pass)>,
}

pub const PERIOD: i64 = 10_000;

impl Junction {
    pub fn new(drivers: Vec<Driver>) -> Self {
        Self { drivers, now: 0, said: Vec::new() }
    }

    /// Drives four, of which two share a leg, for so many seconds. Leaves the least gap on a leg, whether two that cross were in the area
    /// at once, and the least position at the end.
    pub fn watch(mut self, seconds: f64, mut each: impl FnMut(&mut Self)) -> (f64, bool, f64) {
        let (mut least, mut both) = (f64::MAX, false);
        self.run(seconds, |junction| {
            each(junction);
            let Ok([a, b, c, d]) = <&[Driver; 4]>::try_from(&junction.drivers[..]) else { panic!("four") };
            for (front, rear) in [(a, b), (c, d)] {
                least = least.min(front.body.position - LENGTH - rear.body.position);
            }
            both |= [a, b].iter().any(|one| one.is_inside() && [c, d].iter().any(|other| other.is_inside()));
        });
        let last = self.drivers.iter().map(|driver| driver.body.position).fold(f64::MAX, f64::min);
        (least, both, last)
    }

    /// Ticks for so many seconds; `each` sees the junction after every tick.
    pub fn run(&mut self, seconds: f64, mut each: impl FnMut(&mut Self)) {
        for _ in 0..(seconds * 100.0).round() as usize {
            self.tick();
            each(self);
        }
    }

    fn tick(&mut self) {
        let now = self.now;
        let mut said: Vec<(usize, Said)> = Vec::new();
        let mut passes = Vec::new();
        let places: Vec<_> = self.drivers.iter().map(|driver| (driver.street(), driver.body)).collect();
        for (index, driver) in self.drivers.iter_mut().enumerate() {
            let plant::Plant { position, speed, acceleration, .. } = driver.body;
            let demand = driver.command();
            let station = driver.rig.unit.config().station;
            let street = driver.street();
            let at = position + driver.axis + driver.off;
            let motion =
                driver.rig.motion(station, now, at, speed, acceleration, demand, Some((driver.accuracy, 0.02)));
            if driver.is_measured {
                let _ = driver.rig.put(now, &Message::Ego(Said::Motion(motion)));
            }
            if now % 100_000 == 0 {
                let geo = driver.geo(now);
                let _ = driver.rig.put(now, &Message::Ego(Said::Geo(geo)));
                let request = DriverRequest {
                    engaged: driver.engaged,
                    predecessor: Predecessor::Unknown,
                    target_speed: mps(driver.target_speed),
                    time_gap: None,
                };
                if driver.asks {
                    let _ = driver.rig.put(now, &Message::DriverRequest(request));
                }
            }
            if driver.is_timed && now % 500_000 == 0 {
                driver.rig.synchronise(now, 0);
            }
            if driver.sees_across && !driver.is_blind && now % 20_000 == 0 {
                let own = driver.body;
                let ahead = places.iter().filter(|(way, body)| *way == street && body.position > own.position);
                let ahead = ahead.map(|(_, body)| (body.position - LENGTH, body.speed));
                let across = places.iter().filter(|(way, body)| (*way == 0) != (driver.way == 0) && is_on_point(body));
                let across = across.map(|_| (CROSSING - WIDTH / 2.0, 0.0));
                let seen = ahead.chain(across).filter(|(rear, _)| *rear >= own.position);
                let _ = match seen.min_by(|a, b| a.0.total_cmp(&b.0)) {
                    Some((rear, speed)) => driver.rig.range(now, rear - own.position, speed - own.speed, 0),
                    None => driver.rig.nobody(now, 100.0, 0),
                };
            }
            let ahead = places.iter().filter(|(way, body)| *way == street && body.position > driver.body.position);
            if driver.sees
                && now % 20_000 == 0
                && let Some((_, ahead)) = ahead.min_by(|a, b| a.1.position.total_cmp(&b.1.position))
            {
                let gap = ahead.position - LENGTH - driver.body.position;
                let _ = driver.rig.range(now, gap, ahead.speed - driver.body.speed, 0);
            }
            let heard = driver.rig.tick(now);
            if driver.speaks {
                for message in &heard.all {
                    match message {
                        Message::Own(Said::Horizon(_) | Said::DrivingParameters(_)) if !driver.says_plans => {}
                        Message::Own(own) if driver.says_motion => said.push((index, *own)),
                        Message::OwnPass(pass) if driver.says_route => passes.push((index, *pass)),
                        _ => {}
                    }
                }
                if !driver.says_route && now % 100_000 == 0 {
                    said.push((index, Said::Geo(driver.geo(now))));
                }
            }
            driver.last = Some(heard);
            let command = driver.by_hand.unwrap_or_else(|| driver.command());
            driver.body.drive(command, PERIOD as f64 * 1e-6);
        }
        for (from, pass) in passes {
            for to in (0..self.drivers.len()).filter(|to| *to != from) {
                if self.drivers[to].deaf_to != Some(from) {
                    self.drivers[to].put_pass(now, pass);
                }
            }
            self.said.retain(|(_, held)| held.station_id != pass.station_id);
            self.said.push((from, pass));
        }
        if now % 500_000 == 0 {
            let all = 0..self.drivers.len();
            let repeaters: Vec<usize> = all.filter(|index| self.drivers[*index].repeats).collect();
            for repeater in repeaters {
                // It repeats nothing to whoever said it.
                for (from, pass) in self.said.clone().into_iter().filter(|(from, _)| *from != repeater) {
                    let others = (0..self.drivers.len()).filter(|to| ![from, repeater].contains(to));
                    others.for_each(|to| self.drivers[to].put_pass(now, pass));
                }
            }
        }
        for (from, own) in said {
            for to in 0..self.drivers.len() {
                let is_silent = matches!(own, Said::Route(_)) && !self.drivers[from].says_route;
                let hears = self.drivers[to].hears && self.drivers[to].deaf_to != Some(from);
                if to != from && hears && !is_silent {
                    let slot = Slot(from as u8);
                    let _ = self.drivers[to].rig.put(now + 1_000, &Message::Peer(slot, own));
                }
            }
        }
        self.now += PERIOD;
    }
}
