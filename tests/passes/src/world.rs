//! The state: the vehicles, what they said last, and what each has heard of every other one. Time goes in whole steps.

use holdover::passes::{Claim, Known, Rules, Window};
use holdover::time::{Duration, GnssTime};

use crate::broken::Broken;

/// So many windows a vehicle may claim at once: an old one, and a piece that is added.
pub const PIECES: usize = 2;

/// What is tried.
#[derive(Clone, Debug)]
pub struct Plan {
    /// So many vehicles, each of whose ways crosses all others'.
    pub vehicles: usize,
    /// The step after the last one.
    pub until: u8,
    /// From this step on every message is received at once, and every vehicle does what gets it through.
    pub settles: Option<u8>,
    /// The last step in which a vehicle may come on air.
    pub last_comes: u8,
    /// The longest time in steps until two that are on air hear one another for the first time.
    pub silence: u8,
    /// The largest difference of clocks, in steps.
    pub clocks: u8,
    /// The steps for which a vehicle may be in the area.
    pub stay: u8,
    /// The steps of a window.
    pub window: u8,
    /// How many windows a vehicle may claim at once, of [`PIECES`] at most.
    pub pieces: usize,
    /// How many entries a vehicle may choose from.
    pub entries: u8,
    /// Whether a message may come a step late.
    pub delays: bool,
    /// Whether a message repeats what its sender knows of the others.
    pub relay: bool,
    /// Whether every vehicle first says for a step or longer that it is before the zone. Others hear that, or not.
    pub queue: bool,
    /// What is done otherwise than the rules say.
    pub broken: Option<Broken>,
}

impl Plan {
    /// Two vehicles whose clocks differ, which come at different times, with messages that are lost or late.
    pub const CLOCKS: Self = Self {
        vehicles: 2,
        until: 6,
        settles: None,
        last_comes: 1,
        silence: 2,
        clocks: 1,
        stay: 2,
        window: 2,
        pieces: 1,
        entries: 2,
        delays: true,
        relay: false,
        queue: false,
        broken: None,
    };

    /// Two vehicles with one clock. What takes longer to come about is in reach so.
    pub const LONG: Self = Self { until: 7, last_comes: 0, clocks: 0, ..Self::CLOCKS };

    /// Two vehicles that add a window to the one that they have, so that one stay is in two windows.
    pub const PIECES: Self = Self { pieces: PIECES, window: 1, entries: 3, delays: false, until: 5, ..Self::LONG };

    /// Two vehicles that are heard before the zone, or not, and come into it at different times.
    pub const QUEUE: Self = Self { queue: true, until: 7, ..Self::CLOCKS };

    /// Three vehicles.
    pub const THREE: Self = Self {
        vehicles: 3,
        stay: 1,
        window: 1,
        entries: 1,
        silence: 1,
        until: 3,
        delays: false,
        relay: true,
        ..Self::LONG
    };

    /// Two vehicles, and from the fifth step on nothing is lost any more.
    pub const SETTLED: Self = Self { settles: Some(5), until: 20, ..Self::CLOCKS };

    /// All plans, with their names.
    pub const ALL: [(&str, Self); 6] = [
        ("clocks", Self::CLOCKS),
        ("long", Self::LONG),
        ("pieces", Self::PIECES),
        ("queue", Self::QUEUE),
        ("three", Self::THREE),
        ("settled", Self::SETTLED),
    ];

    /// The first step in which a vehicle may come on air.
    #[must_use]
    pub fn first_comes(&self) -> u8 {
        u8::from(self.queue)
    }

    /// Whether this rule is taken out.
    #[must_use]
    pub fn breaks(&self, broken: Broken) -> bool {
        self.broken == Some(broken)
    }

    /// The rules as they are followed.
    #[must_use]
    pub fn rules(&self) -> Rules {
        let steps = |steps: u8| Duration::from_micros(steps.into());
        let silence = self.silence - u8::from(self.breaks(Broken::WaitsLess));
        let clocks = if self.breaks(Broken::PadsNoClocks) { 0 } else { self.clocks };
        Rules {
            silence: steps(silence),
            clocks: steps(clocks),
            clearance: Duration::ZERO,
            forgotten: steps(if self.breaks(Broken::ForgetsTheSilent) { 1 } else { u8::MAX }),
            step: steps(1),
        }
    }
}

/// Where a vehicle is. Times are steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Phase {
    /// Before the area.
    Before,
    /// In the area, since this step.
    Inside(u8),
    /// Beyond the area.
    Beyond,
}

/// One vehicle.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Vehicle {
    /// On air from this step on, and within range of all others.
    pub on_air: u8,
    /// Its clock is ahead by so many steps.
    pub ahead: u8,
    /// Where it is.
    pub phase: Phase,
    /// What it claims.
    pub claims: [Option<Claim>; PIECES],
    /// The stamp of its last message.
    pub said: Option<GnssTime>,
}

impl Vehicle {
    /// The time on its clock.
    #[must_use]
    pub fn clock(&self, now: u8) -> GnssTime {
        // Some way from the epoch, so that nothing saturates there.
        GnssTime::from_micros(100 + u64::from(now) + u64::from(self.ahead))
    }
}

/// What a message says of a vehicle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Said {
    /// When.
    pub stamp: GnssTime,
    /// What it claims.
    pub claims: [Option<Claim>; PIECES],
    /// Whether it has left the area.
    pub has_left: bool,
    /// Whether it is before the zone.
    pub is_before_zone: bool,
}

impl Said {
    /// As the rules take it; `None` of a vehicle that has left.
    #[must_use]
    pub fn known(&self, plan: &Plan) -> Option<(GnssTime, Vec<Claim>)> {
        let is_left_out = self.has_left || self.is_before_zone && plan.breaks(Broken::LeavesOutTheQueue);
        let heard = if self.is_before_zone { plan.rules().heard_by_all(self.stamp) } else { self.stamp };
        (!is_left_out).then(|| (heard, self.claims.iter().flatten().copied().collect()))
    }
}

/// A message: what its sender says of itself, and what it has heard of the others, by their number.
pub type Message = Vec<Option<Said>>;

/// What happens next.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Turn {
    /// This vehicle acts.
    Act(usize),
    /// This vehicle has claimed a window that it may use at once, and uses it or not.
    Use(usize),
    /// The message of one vehicle comes to another or not: the number of the pair.
    Hear(usize),
}

/// All of it.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct State {
    /// The step.
    pub now: u8,
    /// What happens next.
    pub turn: Turn,
    /// The vehicles.
    pub vehicles: Vec<Vehicle>,
    /// The message of each vehicle in this step, and in the step before.
    pub air: Vec<[Option<Message>; 2]>,
    /// What each vehicle has heard of each.
    pub heard: Vec<Vec<Option<Said>>>,
}

impl State {
    /// Before anything has happened.
    #[must_use]
    pub fn new(vehicles: Vec<Vehicle>) -> Self {
        let count = vehicles.len();
        Self {
            now: 0,
            turn: Turn::Act(0),
            vehicles,
            air: vec![[None, None]; count],
            heard: vec![vec![None; count]; count],
        }
    }

    /// What a vehicle knows of the others that it has to heed, with their claims.
    #[must_use]
    pub fn known(&self, index: usize, plan: &Plan) -> Vec<(GnssTime, Vec<Claim>)> {
        let (rules, now) = (plan.rules(), self.vehicles[index].clock(self.now));
        let others = self.heard[index].iter().flatten().filter_map(|said| said.known(plan));
        others
            .filter(|(heard, claims)| {
                // A slot that is given away forgets the vehicle with its windows.
                let exit = claims
                    .iter()
                    .map(|claim| claim.window.exit)
                    .max()
                    .filter(|_| !plan.breaks(Broken::ForgetsTheSilent));
                !rules.is_forgotten(now, *heard, exit)
            })
            .collect()
    }

    /// The windows of a vehicle that are firm.
    #[must_use]
    pub fn firm(&self, index: usize, plan: &Plan) -> Vec<Window> {
        let (rules, known, now) = (plan.rules(), self.known(index, plan), self.vehicles[index].clock(self.now));
        let is_firm = |claim: &&Claim| {
            rules.is_firm(
                now,
                claim,
                known.iter().map(|(heard, claims)| Known {
                    heard: if plan.breaks(Broken::HearsNobody) { GnssTime::from_micros(u64::MAX) } else { *heard },
                    claims: if plan.breaks(Broken::KeepsAll) { &[] } else { claims },
                }),
            )
        };
        self.vehicles[index].claims.iter().flatten().filter(is_firm).map(|claim| claim.window).collect()
    }
}
