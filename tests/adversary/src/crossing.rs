//! A drive over an intersection: two straight streets on a flat globe, one to the north and one to the east, which
//! cross 400 m from where each begins. Every vehicle has its own unit and hears the others over the radio, unless it is
//! deaf. A vehicle that drives straight on while another vehicle is in its place has collided.

use holdover::coordination::{Approach, Crossing, Intersection, Itinerary, Movement, Path, Scale, Segment};
use holdover::units::{Distance, Position};
use serde::{Deserialize, Serialize};

use crate::random::Random;
use crate::scenario::{Ego, Error, Scenario, Sensor};
use crate::vehicle::{Vehicle, raw};
use crate::verdict::{Fault, Outcome};
use crate::wire::{BOOK, Can};
use crate::world::STEP;

/// A vehicle that comes to the intersection.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Comer {
    /// 0: to the north, 1: to the east.
    pub street: u8,
    /// Distance of its front bumper from the beginning of the street, m, and speed, m/s.
    pub at: f64,
    pub speed: f64,
    /// It hears no vehicle from then until then, s.
    pub deaf_from: f64,
    pub deaf_until: f64,
    /// It is not synchronised from then until then, s.
    #[serde(default)]
    pub timeless_from: f64,
    #[serde(default)]
    pub timeless_until: f64,
    /// Its driver wants to stand at that time, s, and for how long, s.
    pub rests_at: f64,
    pub rests: f64,
}

/// 0.01 m to a step of 1e-7°, in 36 fraction bits.
const CENTIMETRE: i32 = 687_194_767;
/// Place of the crossing, and half the length of the conflict area, m.
const CROSSES: f64 = 400.0;
const HALF: f64 = 4.0;
const LENGTH: f64 = 4.8;
/// End of the streets and of the map, m. A vehicle that drives on there is still heard, and is no longer in any order.
const ENDS: f64 = 500.0;
/// If every vehicle hears, is synchronised and wants to drive, all of them get past within this time, s.
const SERVED: f64 = 90.0;

const fn streets() -> [[Segment; 1]; 2] {
    let north = Segment {
        latitude: 0,
        longitude: 0,
        begins: Position::ZERO,
        length: Distance::from_mm(500_000),
        along: Scale { north: CENTIMETRE, east: 0 },
        across: Scale { north: 0, east: CENTIMETRE },
        heading: 0,
    };
    let east = Segment {
        latitude: 40_000,
        longitude: -40_000,
        begins: Position::ZERO,
        length: Distance::from_mm(500_000),
        along: Scale { north: 0, east: CENTIMETRE },
        across: Scale { north: -CENTIMETRE, east: 0 },
        heading: 7_200,
    };
    [[north], [east]]
}

static STREETS: [[Segment; 1]; 2] = streets();
static NORTH: Path = Path { segments: &STREETS[0] };
static EAST: Path = Path { segments: &STREETS[1] };
const AT: Position = Position::from_mm(400_000);
static CORNER: Intersection = Intersection {
    id: 5,
    half: Distance::from_mm(4_000),
    approaches: &[Approach::straight(0, &NORTH, AT, 0b10), Approach::straight(1, &EAST, AT, 0b01)],
};
static WAYS: [Itinerary; 2] = [
    Itinerary {
        path: &NORTH,
        crossings: &[Crossing { intersection: &CORNER, movement: Movement::straight(0), at: AT }],
    },
    Itinerary {
        path: &EAST,
        crossings: &[Crossing { intersection: &CORNER, movement: Movement::straight(1), at: AT }],
    },
];

/// Draws the vehicles.
pub fn draw(scenario: &mut Scenario, random: &mut Random) {
    // Some vehicles are deaf for minutes.
    let long = random.chance(0.1);
    scenario.length = if long { random.between(150.0, 300.0) } else { random.between(60.0, 90.0) };
    scenario.range.fitted = false;
    scenario.radio.tail = scenario.radio.tail.min(0.5);
    let number = 2 + random.below(3);
    let heavy = random.chance(0.5);
    let mut last = [CROSSES - 130.0; 2];
    for _ in 0..number {
        let street = random.below(2);
        let speed = random.between(5.0, 15.0);
        last[street] -= random.between(45.0, 80.0);
        let deaf_from = random.between(3.0, 40.0);
        let longest = if long { 200.0 } else { 70.0 };
        let deaf = if heavy { random.between(10.0, longest) } else { random.between(0.0, 5.0) };
        let timeless_from = random.between(3.0, 40.0);
        let timeless = if random.chance(0.3) { random.between(0.5, 40.0) } else { 0.0 };
        let rests_at = if random.chance(0.4) { random.between(5.0, 40.0) } else { 1e3 };
        scenario.crossing.push(Comer {
            street: street as u8,
            at: last[street],
            speed,
            deaf_from,
            deaf_until: deaf_from + deaf,
            timeless_from,
            timeless_until: timeless_from + timeless,
            rests_at,
            rests: random.between(5.0, 40.0),
        });
    }
}

/// A vehicle, and the frames that it hears.
struct Driver {
    comer: Comer,
    vehicle: Vehicle,
    /// Origin of its own axis.
    axis: f64,
    /// Frames on their way to it: time of arrival, sender, place in the block of a slot, data.
    air: Vec<(f64, usize, usize, [u8; 8])>,
    losing: Vec<u32>,
}

/// Runs the drive.
pub fn run(scenario: &Scenario) -> Outcome {
    let mut outcome = Outcome::default();
    let mut random = Random::new(scenario.seed, 3);
    let mut drivers: Vec<Driver> =
        scenario.crossing.iter().enumerate().map(|(number, comer)| driver(scenario, *comer, number)).collect();
    let steps = (scenario.length / STEP).round() as u64;
    for step in 0..steps {
        if drivers.iter().all(Driver::is_gone) {
            return outcome;
        }
        let now = step as f64 * STEP;
        for (number, driver) in drivers.iter_mut().enumerate() {
            driver.step(scenario, now, step, number);
        }
        spread(scenario, now + STEP, &mut drivers, &mut random);
        outcome.ticks += 1;
        if collide(now + STEP, &drivers, &mut outcome) {
            return outcome;
        }
    }
    serve(scenario, &drivers, &mut outcome);
    outcome
}

/// Checks that in the end every vehicle has got past the crossing, if all was well for long enough.
fn serve(scenario: &Scenario, drivers: &[Driver], outcome: &mut Outcome) {
    let well = |comer: &Comer| {
        let rested = if comer.rests_at < scenario.length { comer.rests_at + comer.rests } else { 0.0 };
        comer.deaf_until.max(comer.timeless_until).max(rested)
    };
    let since = scenario.crossing.iter().map(well).fold(0.0, f64::max);
    let lasts = scenario.length - since;
    if lasts < SERVED {
        return;
    }
    for (number, driver) in drivers.iter().enumerate().filter(|(_, driver)| driver.front() < CROSSES + HALF) {
        let (at, speed, mode) = (driver.front(), driver.vehicle.body.speed, driver.vehicle.said.mode);
        outcome.find(Fault::Deadlock, scenario.length, lasts, || {
            format!("{} is at {at:.1} m with {speed:.2} m/s in mode {mode}, after {lasts:.0} s", number + 1)
        });
    }
}

fn driver(scenario: &Scenario, comer: Comer, number: usize) -> Driver {
    let axis = -3_000.0 + 1_700.0 * number as f64;
    let ego = Ego {
        position: comer.at + axis,
        speed: comer.speed,
        wanted: comer.speed.max(8.0),
        gap: scenario.ego.gap.max(1.6),
        clock: scenario.ego.clock + 1_234_567 * number as u64,
        sensor: Sensor { position: 0.05, speed: 0.02, error: Error::Uniform, speed_error: Error::Uniform },
        long: false,
        ..scenario.ego
    };
    let vehicle = Vehicle::new(&ego, &scenario.bus, scenario.epoch, scenario.seed, number as u8 + 1);
    Driver { comer, vehicle, axis, air: Vec::new(), losing: vec![0; scenario.crossing.len()] }
}

impl Driver {
    /// Distance of the front bumper along its street.
    fn front(&self) -> f64 {
        self.vehicle.body.position - self.axis
    }

    fn is_gone(&self) -> bool {
        self.front() > ENDS
    }

    fn step(&mut self, scenario: &Scenario, now: f64, step: u64, number: usize) {
        let Self { comer, vehicle, .. } = self;
        vehicle.ticks_at(now + STEP);
        if !vehicle.runs {
            vehicle.start(Some(&WAYS[usize::from(comer.street)]));
        }
        let rests = (comer.rests_at..comer.rests_at + comer.rests).contains(&now);
        let before = vehicle.body;
        let demand = if vehicle.said.mode == 0 { 0.0 } else { vehicle.said.acceleration };
        vehicle.body.drive(demand, STEP);
        if step.is_multiple_of(50) && !(comer.timeless_from..comer.timeless_until).contains(&now) {
            vehicle.synchronise(now + 0.0003, 0.0);
        }
        let sensed = now + 0.004;
        let body = before.after(demand, 0.004);
        vehicle.sense(sensed, &body, 1.0);
        if step % 10 == 3 {
            let wanted = if rests { 0.0 } else { comer.speed.max(8.0) };
            vehicle.request(now + 0.006, true, None, wanted, scenario.ego.gap.max(1.6));
        }
        if step % 10 == 5 {
            let along = ((body.position - self.axis) * 100.0).round() as i64;
            let (latitude, longitude, heading) =
                if comer.street == 0 { (along, 0, 0.0) } else { (40_000, along - 40_000, 90.0) };
            vehicle.place(now + 0.007, latitude, longitude, heading, sensed);
        }
        self.hear(now + STEP, number);
        self.vehicle.tick(now + STEP);
    }

    /// Delivers what arrives: the same bits in a slot of this vehicle's own modem.
    fn hear(&mut self, until: f64, number: usize) {
        self.air.sort_by(|a, b| a.0.total_cmp(&b.0));
        let arrived = self.air.iter().take_while(|frame| frame.0 <= until).count();
        for (at, from, what, data) in self.air.drain(..arrived).collect::<Vec<_>>() {
            if (self.comer.deaf_from..self.comer.deaf_until).contains(&at) {
                continue;
            }
            let slot = if from > number { from - 1 } else { from };
            let layout = &BOOK.own[what].1[slot];
            let frame: Can = layout.seal_word(&mut self.vehicle.modem, u64::from_le_bytes(data));
            self.vehicle.put(at.max(until - STEP), &frame);
        }
    }
}

/// Sends what the units said to all other vehicles. The frames of a tick are one message, which is lost or late as a
/// whole.
fn spread(scenario: &Scenario, now: f64, drivers: &mut [Driver], random: &mut Random) {
    for from in 0..drivers.len() {
        let said = core::mem::take(&mut drivers[from].vehicle.own);
        let frames: Vec<(usize, [u8; 8])> = said
            .iter()
            .filter_map(|frame| {
                let what = BOOK.own.iter().position(|(own, _)| own.open(frame).is_some())?;
                Some((what, raw(frame)?))
            })
            .collect();
        if frames.is_empty() {
            continue;
        }
        for (to, driver) in drivers.iter_mut().enumerate() {
            if to == from {
                continue;
            }
            let radio = &scenario.radio;
            if driver.losing[from] > 0 {
                driver.losing[from] -= 1;
                continue;
            }
            // Every vehicle is heard at least once.
            if now > 3.0 && random.chance(radio.loss / radio.burst.max(1.0)) {
                driver.losing[from] = random.exponential(radio.burst - 0.5).round().max(0.0) as u32;
                continue;
            }
            let arrives = now + radio.delay + random.exponential(radio.jitter).min(0.5);
            let air = frames
                .iter()
                .enumerate()
                .map(|(place, (what, data))| (arrives + 1e-5 * place as f64, from, *what, *data));
            driver.air.extend(air);
        }
    }
}

/// Whether two vehicles are in a place that has room for one only.
fn collide(now: f64, drivers: &[Driver], outcome: &mut Outcome) -> bool {
    for (number, one) in drivers.iter().enumerate() {
        for (other_number, other) in drivers.iter().enumerate().skip(number + 1) {
            let ((a, b), same) = ((one.front(), other.front()), one.comer.street == other.comer.street);
            if one.is_gone() || other.is_gone() {
                continue;
            }
            let is_inside = |front: f64| front > CROSSES - HALF && front - LENGTH < CROSSES + HALF;
            let overlap = if same { (a - b).abs() < LENGTH } else { is_inside(a) && is_inside(b) };
            if overlap {
                let (fast, slow) = (one.vehicle.body.speed, other.vehicle.body.speed);
                let impact = if same { (fast - slow).abs() } else { fast.max(slow) };
                outcome.find(Fault::Collision, now, impact, || {
                    let how = if same { "rear end" } else { "in the crossing" };
                    let modes = (one.vehicle.said.mode, other.vehicle.said.mode);
                    format!(
                        "{how}: {} at {a:.1} m, {fast:.2} m/s and {} at {b:.1} m, {slow:.2} m/s, modes {modes:?}",
                        number + 1,
                        other_number + 1
                    )
                });
                return true;
            }
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wire::Counters;

    #[test]
    fn a_frame_of_a_unit_is_the_same_in_a_slot() {
        let word = 0x1234_5678_9ABC_D000;
        let frame = BOOK.own[0].1[3].seal_word(&mut Counters::new(0), word);
        assert_eq!(u64::from_le_bytes(frame.data) & !0xFFF, word & !0xFFF);
    }
}
