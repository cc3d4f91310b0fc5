//! Drawing of scenarios: a family and a seed enter; a scenario that keeps every assumption of use leaves.

use crate::body::safe_gap;
use crate::manoeuvre;
use crate::random::Random;
use crate::scenario::{Bus, Ego, Error, Event, Family, Peer, Radio, Range, Scenario, Sensor, What};

/// Possible published accuracies of position, m, and (below) of speed, m/s.
const POSITIONS: [f64; 6] = [0.0, 0.05, 0.2, 0.5, 1.0, 3.0];
const SPEEDS: [f64; 5] = [0.0, 0.02, 0.1, 0.3, 1.0];
/// Largest clock offset of a sender, µs: what the clock's uncertainty of half a millisecond leaves for it.
const CLOCK: f64 = 300.0;

/// Draws a scenario.
pub fn draw(family: Family, seed: u64) -> Scenario {
    let mut random = Random::new(seed, 0);
    let mut scenario = base(family, seed, &mut random);
    match family {
        Family::Following => following(&mut scenario, &mut random),
        Family::Closing => closing(&mut scenario, &mut random),
        Family::Stranger => stranger(&mut scenario, &mut random),
        Family::CutIn => cut_in(&mut scenario, &mut random),
        Family::Lorry => lorry(&mut scenario, &mut random),
        Family::Silence => silence(&mut scenario, &mut random),
        Family::Restart => restart(&mut scenario, &mut random),
        Family::Slots => slots(&mut scenario, &mut random),
        Family::Garbage => garbage(&mut scenario, &mut random),
        Family::Crossing => crate::crossing::draw(&mut scenario, &mut random),
    }
    if family != Family::Crossing && random.chance(0.25) {
        let length = scenario.length;
        scenario.event.retain(|event| event.at < length); // nothing happens after all is well
        scenario.event.push(Event { at: length, what: What::Well });
        scenario.length += 26.0;
    }
    scenario.event.sort_by(|a, b| a.at.total_cmp(&b.at));
    scenario
}

fn sensor(random: &mut Random) -> Sensor {
    let kinds = [Error::None, Error::Uniform, Error::Uniform, Error::Edges, Error::High, Error::Low];
    let good = random.chance(0.6);
    Sensor {
        position: if good { 0.05 } else { random.one_of(&POSITIONS) },
        speed: if good { 0.02 } else { random.one_of(&SPEEDS) },
        error: random.one_of(&kinds),
        speed_error: random.one_of(&kinds),
    }
}

fn base(family: Family, seed: u64, random: &mut Random) -> Scenario {
    let speed = random.between(2.0, 30.0);
    let is_stressed = random.chance(0.4);
    let bad_bus = [0.0, 0.0, 0.001, 0.01];
    let lossy = random.chance(0.5);
    Scenario {
        family,
        broken: None,
        amount: 0.0,
        shifted: 0.0,
        seed,
        length: random.between(20.0, 45.0),
        epoch: 1_400_000_000_000_000 + (random.bits() % 100_000_000_000_000) as i64,
        follow: 2,
        ego: Ego {
            position: random.between(-16_000.0, 16_000.0),
            speed,
            wanted: random.one_of(&[speed, speed + 6.0, 13.4, 25.0]),
            gap: random.one_of(&[1.0, 1.6, 1.6, 2.5]),
            lag: random.one_of(&[0.2, 0.3, 0.3, 0.5]),
            lag_factor: if is_stressed { random.between(0.8, 1.2) } else { 1.0 },
            road: random.one_of(&[8.0, 9.0, 12.0]),
            sensor: sensor(random),
            acceleration_off: if is_stressed { random.signed() } else { 0.0 },
            engages: random.between(2.0, 3.0),
            clock: 1_000_000 + random.bits() % 1_000_000_000_000,
            drift: random.signed() * 20.0,
            starts: 0.0,
            envelope: true,
            long: random.chance(0.04),
        },
        radio: Radio {
            delay: random.between(0.005, 0.06),
            jitter: random.one_of(&[0.0, 0.005, 0.05]),
            tails: random.one_of(&[0.0, 0.0, 0.05]),
            tail: random.between(0.2, 1.5),
            loss: if lossy { random.between(0.0, 0.5) } else { 0.0 },
            burst: random.between(1.0, 8.0),
        },
        bus: Bus { loss: random.one_of(&bad_bus), twice: random.one_of(&bad_bus), jitter: 50.0 },
        range: Range {
            fitted: random.chance(0.3),
            sees: random.between(80.0, 200.0),
            sensor: Sensor { position: 0.2, speed: 0.2, ..sensor(random) },
            age: random.between(0.001, 0.04),
            misses: random.one_of(&[0.0, 0.05, 0.3]),
        },
        crossing: Vec::new(),
        peer: Vec::new(),
        event: Vec::new(),
    }
}

/// A peer so far ahead that the ego is safe behind it, and at least at the driver's time gap.
fn peer(scenario: &Scenario, random: &mut Random, braking: f64, speed: f64, blind: f64) -> Peer {
    let (ego, sensor) = (&scenario.ego, sensor(random));
    let lag = ego.lag * ego.lag_factor;
    let length = random.one_of(&[4.8, 4.8, 2.5, 12.0]);
    let uncertain = 2.0 * (sensor.position + ego.sensor.position) + (sensor.speed + ego.sensor.speed) * 4.0;
    let safe = safe_gap(ego.speed + 1.0, speed, braking, 8.0, lag, blind);
    let closes = (ego.speed + 0.5 - speed).max(0.0) * (ego.engages + 0.2);
    let gap = safe.max(ego.speed * ego.gap + 2.0) + uncertain + closes;
    Peer {
        station: 2,
        slot: random.below(8) as u8,
        length,
        braking,
        pulling: random.between(1.0, 4.0),
        ahead: gap + length,
        speed,
        on_lane: true,
        intends: random.chance(0.95) || length > 4.8,
        sensor,
        clock: CLOCK * if random.chance(0.5) { random.signed() } else { random.one_of(&[1.0, -1.0]) },
        phase: random.between(0.0, 0.1),
        demand: 0.0,
    }
}

fn braking(random: &mut Random) -> f64 {
    if random.chance(0.5) { random.between(7.0, 12.0) } else { random.between(2.0, 12.0) }
}

fn following(scenario: &mut Scenario, random: &mut Random) {
    let braking = braking(random);
    let peer = peer(scenario, random, braking, scenario.ego.speed, 0.4);
    scenario.peer.push(peer);
    manoeuvre::drive(scenario, random, 0, 1.0);
    manoeuvre::disturb(scenario, random, 0, 4);
}

fn closing(scenario: &mut Scenario, random: &mut Random) {
    scenario.ego.speed = random.between(12.0, 30.0);
    scenario.ego.wanted = scenario.ego.speed + random.between(0.0, 5.0);
    let speed = if random.chance(0.5) { 0.0 } else { random.between(0.0, scenario.ego.speed * 0.7) };
    let braking = braking(random);
    let mut peer = peer(scenario, random, braking, speed, 0.4);
    peer.ahead += random.between(20.0, 250.0);
    scenario.peer.push(peer);
    manoeuvre::drive(scenario, random, 0, 0.5);
    manoeuvre::disturb(scenario, random, 0, 3);
}

fn lorry(scenario: &mut Scenario, random: &mut Random) {
    let closes = random.chance(0.5);
    let speed = if closes { random.between(2.0, 20.0) } else { scenario.ego.speed };
    let hardest = random.one_of(&[3.5, 7.0]);
    let braking = random.between(2.0, hardest);
    let mut lorry = peer(scenario, random, braking, speed, 0.4);
    (lorry.length, lorry.intends) = (random.between(8.0, 18.0), true);
    lorry.length = (lorry.length * 100.0).floor() / 100.0;
    lorry.pulling = random.between(0.5, 2.0);
    lorry.ahead += lorry.length;
    scenario.ego.gap = random.one_of(&[1.0, 1.0, 1.6]);
    // The peer brakes to a stand when the ego has come near, and has perhaps just fallen silent.
    let closing = scenario.ego.speed - speed;
    let after = if closing > 2.0 { (lorry.ahead - lorry.length) / closing } else { random.between(5.0, 15.0) };
    let at = match random.below(2) {
        0 => scenario.ego.engages + random.between(0.1, 2.5),
        _ => (after * random.between(0.6, 1.2)).clamp(scenario.ego.engages + 1.0, 30.0),
    };
    scenario.ego.wanted = scenario.ego.wanted.max(scenario.ego.speed + 3.0);
    scenario.event.push(Event { at, what: What::Drive { peer: 0, demand: -99.0 } });
    if random.chance(0.7) {
        let seconds = random.between(4.0, 20.0);
        scenario.event.push(Event { at: at - random.between(0.0, 2.0), what: What::Mute { peer: 0, seconds } });
    }
    scenario.peer.push(lorry);
    if random.chance(0.5) {
        manoeuvre::drive(scenario, random, 0, 1.0);
    }
    manoeuvre::disturb(scenario, random, 0, 2);
}

fn stranger(scenario: &mut Scenario, random: &mut Random) {
    scenario.follow = 0;
    (scenario.range.fitted, scenario.range.sees) = (true, random.between(150.0, 240.0));
    scenario.ego.speed = random.between(5.0, 26.0);
    scenario.ego.wanted = scenario.ego.speed;
    let speed = if random.chance(0.7) { 0.0 } else { random.between(0.0, scenario.ego.speed) };
    let mut stranger = peer(scenario, random, 12.0, speed, 0.6);
    stranger.station = 0;
    stranger.ahead += scenario.range.sees * random.between(0.2, 1.2);
    scenario.peer.push(stranger);
    if speed > 0.0 {
        manoeuvre::drive(scenario, random, 0, 1.0);
    }
    for _ in 0..random.below(6) {
        let at = random.between(scenario.ego.engages, scenario.length);
        // Six such silences stay below 10 s, after which a stationary vehicle is forgotten.
        let longest = if speed > 0.0 { 0.9 } else { 1.6 };
        scenario.event.push(Event { at, what: What::Blind { seconds: random.between(0.1, longest) } });
    }
    manoeuvre::disturb(scenario, random, 0, 1);
}

fn cut_in(scenario: &mut Scenario, random: &mut Random) {
    (scenario.range.fitted, scenario.range.sees) = (true, random.between(150.0, 240.0));
    let braking_ahead = braking(random);
    let mut ahead = peer(scenario, random, braking_ahead, scenario.ego.speed, 0.4);
    ahead.ahead += random.between(0.0, 150.0);
    scenario.peer.push(ahead);
    let hardest = braking(random);
    let speed = scenario.ego.speed * random.between(0.5, 1.1);
    let mut other = peer(scenario, random, hardest, speed, 0.4);
    (other.on_lane, other.slot) = (false, (ahead.slot + 1) % 8);
    other.station = random.one_of(&[0, 3]);
    other.ahead = random.between(5.0, ahead.ahead);
    scenario.peer.push(other);
    let at = random.between(scenario.ego.engages + 1.0, scenario.length * 0.6);
    scenario.event.push(Event { at, what: What::CutIn { peer: 1 } });
    manoeuvre::drive(scenario, random, 0, 0.5);
    manoeuvre::drive(scenario, random, 1, 0.5);
    manoeuvre::disturb(scenario, random, 1, 2);
}

fn silence(scenario: &mut Scenario, random: &mut Random) {
    scenario.length = random.one_of(&[40.0, 60.0, 120.0]);
    following(scenario, random);
    let mut at = scenario.ego.engages + random.between(1.0, 10.0);
    while at < scenario.length {
        let (least, most) = random.one_of(&[(0.2, 2.0), (2.0, 12.0), (10.0, 100.0)]);
        let seconds = random.between(least, most);
        let what = match random.below(4) {
            0 => What::Deaf { seconds },
            1 => What::Mute { peer: 0, seconds },
            2 => What::Overtaken { peer: 0, half: random.below(2) as u8 },
            _ => What::Torn {
                peer: 0,
                half: random.below(2) as u8,
                messages: if random.chance(0.2) { random.below(200) as u32 } else { random.one_of(&[3, 7, 11, 31]) },
            },
        };
        scenario.event.push(Event { at, what });
        if random.chance(0.4) {
            let brakes = at + random.between(0.1, 2.0);
            scenario.event.push(Event { at: brakes, what: What::Drive { peer: 0, demand: -99.0 } });
        }
        at += seconds + random.between(1.0, 10.0);
    }
}

fn restart(scenario: &mut Scenario, random: &mut Random) {
    scenario.ego.starts = random.between(0.0, 3.0);
    scenario.ego.clock = if random.chance(0.7) { 0 } else { random.bits() % 3_000_000 };
    scenario.ego.engages = scenario.ego.starts + random.between(0.0, 1.5);
    scenario.length = random.between(10.0, 20.0);
    scenario.radio.tails = random.one_of(&[0.0, 0.3, 0.9]);
    scenario.radio.tail = random.between(0.2, 1.8);
    let hardest = braking(random);
    let speed = random.between(0.0, scenario.ego.speed);
    let mut ahead = peer(scenario, random, hardest, speed, 4.0);
    // The peer may drive in any way from the beginning: the unit assumes the worst of what it does not know.
    ahead.ahead += safe_gap(scenario.ego.speed, 0.0, 12.0, 8.0, 0.6, 4.0);
    ahead.demand = random.one_of(&[0.0, -99.0, 1.0]);
    scenario.peer.push(ahead);
    manoeuvre::drive(scenario, random, 0, 1.0);
}

fn slots(scenario: &mut Scenario, random: &mut Random) {
    following(scenario, random);
    let mut station = 3;
    for number in 1..4 {
        let hardest = braking(random);
        let mut other = peer(scenario, random, hardest, scenario.ego.speed, 0.4);
        (other.station, other.slot, other.on_lane) = (station, (scenario.peer[0].slot + number) % 8, false);
        other.ahead += random.between(-50.0, 300.0);
        scenario.peer.push(other);
        station += 1;
    }
    for _ in 0..3 {
        let at = random.between(scenario.ego.engages + 1.0, scenario.length - 5.0);
        let (peer, slot) = (random.below(4), random.below(8) as u8);
        let gone = 2.1 + random.exponential(2.0);
        if random.chance(0.3) {
            // Another station, and with it another slot. The driver names the new station when the unit has heard it.
            scenario.event.push(Event { at, what: What::Mute { peer, seconds: gone } });
            scenario.event.push(Event { at, what: What::Station { peer, station } });
            scenario.event.push(Event { at, what: What::Slot { peer, slot } });
            if peer == 0 {
                scenario.event.push(Event { at: at + gone + 1.5, what: What::Follow { station } });
            }
            station += 1;
        } else {
            scenario.event.push(Event { at, what: What::Mute { peer, seconds: gone } });
            scenario.event.push(Event { at, what: What::Slot { peer, slot } });
        }
    }
}

fn garbage(scenario: &mut Scenario, random: &mut Random) {
    following(scenario, random);
    for _ in 0..random.below(6) {
        // Before the first honest motion there is no bound that a false motion could contradict.
        let at = random.between(2.0, scenario.length);
        let count = 1 + random.below(50) as u32;
        let what = match random.below(3) {
            0 => What::Garbage { count },
            1 => What::Copies { peer: 0, count, off: 0.0 },
            _ => {
                let side = random.one_of(&[-1.0, 1.0]);
                What::Copies { peer: 0, count, off: side * random.between(50.0, 300.0) }
            }
        };
        scenario.event.push(Event { at, what });
    }
}
