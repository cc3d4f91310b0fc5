//! A vehicle's V2X modem: the unit's `Own*` frames enter and a message for the channel leaves; messages from the channel
//! enter and `Peer*` frames on the vehicle's own bus leave, with that bus's own counters.
//!
//! *Slots:* a station keeps its slot while nobody takes it. One without a slot gets a free one. If there is none, it takes
//! that of the least relevant station ([`Rank`]), if it is more relevant itself; or if it is as relevant and that station has
//! been silent for [`SLOT_REUSE_S`]. Otherwise it is not relayed, and counted. So a station in use is never pushed out by a
//! less relevant one; whom the unit follows finds the last free slot kept for it and is not pushed out at all, even by a
//! silence. A slot that changes hands rests until nothing has been said in it for [`SLOT_REUSE_S`], because before that the
//! unit takes the new station for a mistake. A station that cannot matter is not relayed even if there is room;
//! but one in a slot that ceases to matter is until the unit has heard that. So is one that was put out of its slot, while nobody
//! else has spoken there: to the unit it is still where it was, and may be waited for.
//!
//! *Driving parameters* are relayed when a station gets its slot (on a route with its first messages), when they change, and otherwise
//! every [`PARAMETERS_EVERY_S`], so that all of them fit the bus.

use holdover::wire::driving_parameters::DrivingParameters;
use holdover::wire::route::Route;
use holdover::wire::{BaseId, Frame, Message, Predecessor, Said, Sender, Slot, StationHash};

mod front;
mod relevance;
mod transmitter;
mod unserved;

use front::Front;
pub use relevance::{Across, Ahead, Course, Foremost, LEADERS, Rank};
pub use transmitter::{Transmitter, V2xMessage};
pub use unserved::UNSERVED_EVERY_S;

/// Slots of a simulated unit: whoever is on the corridor's roads at once finds one.
pub const PEERS: usize = 16;

/// Slots of the firmware.
pub const ECU_PEERS: usize = 8;

/// A station that has been silent for this long may lose its slot.
pub const SLOT_REUSE_S: f64 = 2.0;

/// What a station that ceases to matter says is relayed so often still.
const NEWS: u8 = 4;

/// On a route a slot's first driving parameters are relayed with each message, so many of them, because the unit trusts an identifier from its
/// second frame on, and a vehicle may fall silent before half a second has gone by.
const FIRST_PARAMETERS: u8 = 3;

/// A station that has not been relayed for longer than this has paused.
const PAUSE_S: f64 = 0.45;

/// Where a station said it was is forgotten after so long, if it has no slot.
const FORGOTTEN_S: f64 = 10.0;

/// A station that does not say how long it is may be so long, in metres.
const LONGEST_M: f64 = 20.0;

/// Who has said where it is within so long is on the air.
const HEARD_S: f64 = 1.0;

/// On a route nobody is relayed before the modem has listened for so long, so that it knows who matters most: a slot that was given
/// to the wrong station rests for longer than that before it can be another one's. Everyone says where it is five times a second.
const LISTENS_S: f64 = 0.6;

/// Time between two relays of driving parameters that do not change.
pub const PARAMETERS_EVERY_S: f64 = 0.5;

/// A slot in use.
#[derive(Clone, Copy, Debug)]
struct Tenant {
    station: StationHash,
    /// When it was relayed last, or whoever had the slot before.
    relayed_s: f64,
    /// Nothing is relayed before.
    from_s: f64,
    /// Whether it has been relayed.
    relayed: bool,
    /// How many of its driving parameters have been relayed, up to [`FIRST_PARAMETERS`].
    parameter_messages: u8,
    /// How often it has been relayed since it ceased to matter.
    gone: u8,
    parameters: Option<(DrivingParameters, f64)>,
}

/// Where a station was when it said so.
#[derive(Clone, Copy, Debug)]
struct Placed {
    station: StationHash,
    route: Route,
    speed_mps: f64,
    length_m: f64,
    at_s: f64,
    /// Whether it was ahead of the unit on its leg then. Nobody passes there: it still is, though the unit may have driven past that
    /// place since.
    is_ahead: bool,
}

impl Placed {
    /// How far ahead of the unit on its leg it was when it said that, if it is ahead.
    fn ahead_m(&self, course: &Course) -> Option<f64> {
        course.on_leg(&self.route).filter(|_| self.is_ahead)
    }
}

/// The receiving side.
#[derive(Clone, Debug)]
pub struct Relay {
    sender: Sender<PEERS>,
    slots: Vec<Option<Tenant>>,
    /// Who was in a free slot last: to the unit it still is.
    left: Vec<Option<Tenant>>,
    /// From when on a free slot may be used.
    rested_s: Vec<f64>,
    /// Whether anything has been said in a slot.
    is_begun: Vec<bool>,
    places: Vec<Placed>,
    course: Course,
    turned_away: u64,
    /// When it heard the first message.
    begun_s: Option<f64>,
}

impl Relay {
    /// On a bus whose catalogue starts at `base`.
    #[must_use]
    pub fn new(base: BaseId) -> Self {
        let (slots, rested_s, places) = (vec![None; PEERS], vec![f64::NEG_INFINITY; PEERS], Vec::new());
        let (left, is_begun) = (vec![None; PEERS], vec![false; PEERS]);
        let (sender, course) = (Sender::new(base), Course::default());
        Self { sender, slots, left, rested_s, is_begun, places, course, turned_away: 0, begun_s: None }
    }

    /// Limits it to the slots that the unit has, if nothing has been heard yet.
    pub fn limit(&mut self, slots: usize) {
        self.slots.truncate(slots);
        self.left.truncate(slots);
    }

    /// Lets it know the unit's way.
    pub fn set_out(&mut self, course: Course) {
        self.course = course;
    }

    /// Takes in one of the unit's own messages.
    pub fn take(&mut self, said: &Said) {
        self.course.take(said);
    }

    /// Messages that found no slot.
    #[must_use]
    pub fn turned_away(&self) -> u64 {
        self.turned_away
    }

    /// Puts a message that was heard at `at_s` on the bus.
    pub fn hear(&mut self, at_s: f64, message: &V2xMessage, frames: &mut Vec<Frame>) {
        let station = message.motion.station;
        self.begun_s.get_or_insert(at_s);
        self.place(at_s, message);
        let front = Front::of(&self.course, &self.places);
        let rank = self.rank(station, at_s, &front);
        if rank == Rank::Irrelevant && !self.has_to_say_so(station) {
            return;
        }
        let Some(slot) = self.slot_of(station, rank, at_s, &front) else {
            self.turned_away += 1;
            return;
        };
        let says_where = message.route.is_some() || !self.course.is_on_route();
        match &mut self.slots[slot] {
            // After a pause it has to say first where it is, or the unit would take it where it was.
            Some(tenant) if !says_where && (!tenant.relayed || at_s - tenant.relayed_s > PAUSE_S) => return,
            Some(tenant) if at_s >= tenant.from_s - 1e-9 => {
                tenant.relayed_s = at_s;
                tenant.relayed = true;
                tenant.gone = if rank == Rank::Irrelevant { tenant.gone.saturating_add(1) } else { 0 };
            }
            _ => return,
        }
        // The unit puts positions on its own axis by the route, so that has to be there first.
        let mut said: Vec<Said> = message.route.map(Said::Route).into_iter().collect();
        said.push(Said::Motion(message.motion));
        if let Some(parameters) =
            message.parameters.filter(|parameters| self.are_parameters_due(slot, parameters, at_s))
        {
            said.push(Said::DrivingParameters(parameters));
        }
        said.extend(message.horizon.map(Said::Horizon));
        self.dismiss(slot, at_s);
        // The unit trusts an identifier from its second frame on; a station's first message may be its last one before a silence.
        let times = if std::mem::replace(&mut self.is_begun[slot], true) { 1 } else { 2 };
        for said in std::iter::repeat_n(said, times).flatten() {
            let sent = self.sender.send(&Message::Peer(Slot(slot as u8), said), &mut |frame| frames.push(frame));
            debug_assert!(sent.is_ok(), "a peer says nothing that the catalogue has no line for");
        }
    }

    /// Whether a station that matters no more is in a slot and has not said so: who was silent while it left would otherwise be
    /// waited for, because the unit last heard of it on its way.
    fn has_to_say_so(&self, station: StationHash) -> bool {
        let known = self.slots.iter().chain(&self.left).flatten();
        known.into_iter().any(|tenant| tenant.station == station && tenant.gone < NEWS)
    }

    /// Frees the slot of a station that matters no more, once it has said so.
    fn dismiss(&mut self, slot: usize, at_s: f64) {
        if self.slots[slot].is_some_and(|tenant| tenant.gone >= NEWS) {
            self.left[slot] = self.slots[slot].take();
            self.rested_s[slot] = at_s + SLOT_REUSE_S;
        }
    }

    /// Takes note of where a station says it is; what is older than a silence that a slot outlives is forgotten.
    fn place(&mut self, at_s: f64, message: &V2xMessage) {
        let Some(route) = message.route else { return };
        let station = message.motion.station;
        let slots = &self.slots;
        let is_tenant = |station| slots.iter().flatten().any(|tenant| tenant.station == station);
        let is_known = |placed: &Placed| at_s - placed.at_s < FORGOTTEN_S || is_tenant(placed.station);
        self.places.retain(|placed| placed.station != station && is_known(placed));
        let speed_mps = message.motion.speed.get().to_num();
        let length_m = message.parameters.map_or(LONGEST_M, |parameters| parameters.length.get().to_num());
        let is_ahead = self.course.on_leg(&route).is_some_and(|ahead_m| ahead_m > 0.0);
        self.places.push(Placed { station, route, speed_mps, length_m, at_s, is_ahead });
    }

    fn slot_of(&mut self, station: StationHash, rank: Rank, at_s: f64, front: &Front) -> Option<usize> {
        let held = |tenant: &Option<Tenant>| tenant.is_some_and(|tenant| tenant.station == station);
        if let Some(slot) = self.slots.iter().position(held) {
            return Some(slot);
        }
        if self.course.is_on_route() {
            let has_listened = self.begun_s.is_some_and(|begun_s| at_s - begun_s >= LISTENS_S - 1e-9);
            let is_served = has_listened && self.is_among_the_first(rank, at_s, front);
            if rank != Rank::Irrelevant && (!is_served || !self.makes_room(rank, at_s, front)) {
                return None;
            }
        }
        if let Some(slot) = self.left.iter().position(held) {
            self.slots[slot] = self.left[slot].take().map(|tenant| Tenant { from_s: at_s, ..tenant });
            return Some(slot);
        }
        let mut free = self.slots.iter().enumerate().filter(|(_, tenant)| tenant.is_none());
        let (slot, from_s) = match (free.next(), free.next()) {
            (Some(_), None) if rank > Rank::Followed && self.awaits() => return None,
            (Some((free, _)), None) => (free, self.rested_s[free].max(at_s)),
            (Some((one, _)), Some((other, _))) => {
                let first = if self.rested_s[other] < self.rested_s[one] { other } else { one };
                (first, self.rested_s[first].max(at_s))
            }
            (None, _) => self.least_relevant(rank, at_s, front)?,
        };
        self.left[slot] = None;
        self.slots[slot] = Some(Tenant {
            station,
            relayed_s: at_s,
            from_s,
            relayed: false,
            parameter_messages: 0,
            gone: 0,
            parameters: None,
        });
        Some(slot)
    }

    /// Whether so few of those that are heard matter more than one of that rank that there is a slot for it too, beside the one in
    /// reserve: or else it would be in the way of somebody who matters more and is heard next.
    fn is_among_the_first(&self, rank: Rank, at_s: f64, front: &Front) -> bool {
        let heard = self.places.iter().filter(|placed| at_s - placed.at_s < HEARD_S);
        let mut first = heard.filter(|placed| self.rank_of(placed, at_s, front) < rank);
        self.slots.len().checked_sub(2).is_some_and(|others| first.nth(others).is_none())
    }

    /// On a route one slot is held in reserve and rests, so that whoever comes up near by is heard at once: the last free one is
    /// taken only by a station that puts a less relevant one out of its slot. Whether there is room then.
    fn makes_room(&mut self, rank: Rank, at_s: f64, front: &Front) -> bool {
        if self.slots.iter().filter(|tenant| tenant.is_none()).count() != 1 {
            return true;
        }
        let Some((slot, rested_s)) = self.least_relevant(rank, at_s, front) else { return false };
        self.left[slot] = self.slots[slot].take();
        self.rested_s[slot] = rested_s;
        true
    }

    /// Whether whom the unit follows has not been heard yet.
    fn awaits(&self) -> bool {
        let followed = self.course.followed();
        followed.is_some_and(|followed| !self.slots.iter().flatten().any(|tenant| tenant.station == followed))
    }

    /// The slot of the least relevant station, of several the one silent for longest, if one of that rank may have it; and
    /// from when on.
    fn least_relevant(&self, rank: Rank, at_s: f64, front: &Front) -> Option<(usize, f64)> {
        let tenants = self.slots.iter().enumerate().filter_map(|(slot, tenant)| Some((slot, (*tenant)?)));
        let ranked = tenants.map(|(slot, tenant)| (slot, self.rank(tenant.station, at_s, front), tenant.relayed_s));
        let (slot, least, relayed_s) =
            ranked.reduce(|a, b| if b.1 > a.1 || b.1 == a.1 && b.2 < a.2 { b } else { a })?;
        let rested_s = relayed_s + SLOT_REUSE_S;
        let is_free = rank.displaces(least) || rank <= least && at_s >= rested_s - 1e-9;
        is_free.then_some((slot, rested_s))
    }

    /// How much a station matters now, if it has gone on at its speed.
    fn rank(&self, station: StationHash, at_s: f64, front: &Front) -> Rank {
        match self.places.iter().find(|placed| placed.station == station) {
            Some(placed) => self.rank_of(placed, at_s, front),
            None => self.course.rank(station, None, self.steps_to(station), Foremost::No),
        }
    }

    fn rank_of(&self, placed: &Placed, at_s: f64, front: &Front) -> Rank {
        let way_m = placed.route.distance.get().to_num::<f64>() - placed.speed_mps * (at_s - placed.at_s);
        let (route, foremost) = (Some((placed.route, way_m)), front.foremost(&self.course, placed));
        self.course.rank(placed.station, route, self.steps_to(placed.station), foremost)
    }

    /// How many steps up the chain of those who follow one another, from whom the unit follows, a station is.
    fn steps_to(&self, station: StationHash) -> Option<usize> {
        let mut next = self.course.followed()?;
        for steps in 0..=PEERS {
            if next == station {
                return Some(steps);
            }
            let (parameters, _) = self.slots.iter().flatten().find(|tenant| tenant.station == next)?.parameters?;
            let Predecessor::Station(ahead) = parameters.predecessor else { return None };
            next = ahead;
        }
        None
    }

    fn are_parameters_due(&mut self, slot: usize, parameters: &DrivingParameters, at_s: f64) -> bool {
        let is_on_route = self.course.is_on_route();
        let Some(tenant) = &mut self.slots[slot] else { return false };
        let is_due = is_on_route && tenant.parameter_messages < FIRST_PARAMETERS
            || tenant
                .parameters
                .is_none_or(|(last, last_s)| last != *parameters || at_s - last_s >= PARAMETERS_EVERY_S - 1e-9);
        if is_due {
            tenant.parameters = Some((*parameters, at_s));
            tenant.parameter_messages = tenant.parameter_messages.saturating_add(1).min(FIRST_PARAMETERS);
        }
        is_due
    }
}

#[cfg(test)]
mod tests;
