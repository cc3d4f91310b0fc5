//! A vehicle's V2X modem. The unit's `Own*` frames enter, and a message for the channel leaves. Messages from the
//! channel enter, and `Peer*` frames leave on the vehicle's own bus, with the counters of that bus.
//!
//! *Slots:* a station keeps its slot while no other station takes it. A station without a slot gets a free one. If no
//! slot is free, it takes the slot of the least relevant station ([`Rank`]), provided that it is itself more relevant.
//! If it is equally relevant, it takes that slot only once the other station has been silent for [`SLOT_REUSE_S`].
//! Otherwise it is not relayed, and the message is counted. So a less relevant station never takes the slot of a
//! station that is in use.
//!
//! The last free slot is kept for the station that the unit follows. That station never loses its slot, not even by a
//! silence.
//!
//! A slot that changes hands rests until nothing has been relayed in it for [`SLOT_REUSE_S`], because until then the
//! unit takes the new station for an error.
//!
//! An irrelevant station is not relayed, even if a slot is free. A station in a slot that becomes irrelevant is still
//! relayed until the unit has heard that. So is a station that lost its slot, until another station is relayed there or is
//! about to be: the unit still has it at its last place, and may be waiting for it.
//!
//! *Driving parameters* are relayed when a station gets its slot (on a route with its first messages) and when they
//! change. Otherwise they are relayed every [`PARAMETERS_EVERY_S`], so that those of all stations fit the bus.

use holdover::wire::driving_parameters::DrivingParameters;
use holdover::wire::fd::State;
use holdover::wire::route::Route;
use holdover::wire::{Frame, Identifiers, Message, Predecessor, Said, Sender, Slot, StationHash, Transport};

mod front;
mod relevance;
mod repeater;
mod transmitter;
mod unserved;

use front::Front;
pub use relevance::{Across, Ahead, Course, Foremost, LEADERS, Rank};
pub use repeater::REPEATED;
use repeater::Repeater;
pub use transmitter::{Transmitter, V2xMessage};
pub use unserved::UNSERVED_EVERY_S;

/// Slots of a simulated unit: enough for every station that is on the corridor's roads at once.
pub const PEERS: usize = 16;

/// Slots of the firmware.
pub const ECU_PEERS: usize = 8;

/// A station that has been silent for this long may lose its slot.
pub const SLOT_REUSE_S: f64 = 2.0;

/// Number of messages that are still relayed of a station that has become irrelevant.
const NEWS: u8 = 4;

/// On a route, the first driving parameters of a slot are relayed with each message, this many times. The unit trusts
/// an identifier from its second frame on, and a vehicle may fall silent within half a second.
const FIRST_PARAMETERS: u8 = 3;

/// A station that has not been relayed for longer than this, in seconds, counts as having paused.
const PAUSE_S: f64 = 0.45;

/// The last place of a station without a slot is forgotten after this time, in seconds.
const FORGOTTEN_S: f64 = 10.0;

/// Length assumed for a station that does not publish its own, in metres.
const LONGEST_M: f64 = 20.0;

/// A station that has sent its place within this time, in seconds, counts as on the air.
const HEARD_S: f64 = 1.0;

/// On a route no station is relayed before the modem has listened for this time, in seconds. By then the modem knows
/// which stations are the most relevant, because every vehicle sends its place five times a second. A slot that was
/// given to the wrong station would rest for longer than this before another station could use it.
const LISTENS_S: f64 = 0.6;

/// Time between two relays of driving parameters that do not change.
pub const PARAMETERS_EVERY_S: f64 = 0.5;

/// A slot in use.
#[derive(Clone, Copy, Debug)]
struct Tenant {
    station: StationHash,
    /// Time at which this station, or the one that had the slot before, was last relayed.
    relayed_s: f64,
    /// Nothing is relayed before this time.
    from_s: f64,
    /// Whether the station has been relayed.
    relayed: bool,
    /// How many of its driving parameters have been relayed, up to [`FIRST_PARAMETERS`].
    parameter_messages: u8,
    /// How often the station has been relayed since it became irrelevant.
    gone: u8,
    parameters: Option<(DrivingParameters, f64)>,
}

/// The place that a station sent last.
#[derive(Clone, Copy, Debug)]
struct Placed {
    station: StationHash,
    route: Route,
    speed_mps: f64,
    length_m: f64,
    at_s: f64,
    /// Whether the station was ahead of the unit on the unit's lane at that time. It still is, because vehicles do not
    /// overtake there, even if the unit has driven past that place since.
    is_ahead: bool,
}

impl Placed {
    /// Distance by which that place is ahead of the unit on the unit's lane; `None` if the station is not ahead.
    fn ahead_m(&self, course: &Course) -> Option<f64> {
        course.on_lane(&self.route).filter(|_| self.is_ahead)
    }
}

/// The receiving side.
#[derive(Clone, Debug)]
pub struct Relay {
    sender: Sender<PEERS>,
    slots: Vec<Option<Tenant>>,
    /// The station that was relayed last in a slot in which no other one has been relayed since: the unit still has it there.
    left: Vec<Option<Tenant>>,
    /// Time from which a free slot may be used.
    rested_s: Vec<f64>,
    /// Whether anything has been relayed in a slot.
    is_begun: Vec<bool>,
    places: Vec<Placed>,
    course: Course,
    repeater: Repeater,
    turned_away: u64,
    /// Time of the first message that the modem heard.
    begun_s: Option<f64>,
}

impl Relay {
    /// A modem on a bus with these identifiers.
    #[must_use]
    pub fn new(identifiers: Identifiers) -> Self {
        let (slots, rested_s, places) = (vec![None; PEERS], vec![f64::NEG_INFINITY; PEERS], Vec::new());
        let (left, is_begun) = (vec![None; PEERS], vec![false; PEERS]);
        let (sender, course) = (Sender::new(identifiers), Course::default());
        let repeater = Repeater::default();
        Self { sender, slots, left, rested_s, is_begun, places, course, repeater, turned_away: 0, begun_s: None }
    }

    /// On a bus with these frames.
    #[must_use]
    pub fn over(self, transport: Transport) -> Self {
        Self { sender: self.sender.over(transport), ..self }
    }

    /// Limits the modem to the unit's number of slots. It has to be called before the first message is heard.
    pub fn limit(&mut self, slots: usize) {
        self.slots.truncate(slots);
        self.left.truncate(slots);
    }

    /// Tells the modem the unit's way.
    pub fn set_out(&mut self, course: Course) {
        self.course = course;
    }

    /// Takes in one of the unit's own messages.
    pub fn take(&mut self, said: &Said) {
        self.course.take(said);
    }

    /// Number of messages that found no slot.
    #[must_use]
    pub fn turned_away(&self) -> u64 {
        self.turned_away
    }

    /// Puts a message that was heard at `at_s` on the bus.
    pub fn hear(&mut self, at_s: f64, message: &V2xMessage, frames: &mut Vec<Frame>) {
        let station = message.motion.station;
        self.begun_s.get_or_insert(at_s);
        self.place(at_s, message);
        self.relay_passes(at_s, message, frames);
        let front = Front::of(&self.course, &self.places);
        let rank = self.rank(station, at_s, &front);
        if rank == Rank::Irrelevant && !self.has_to_say_so(station) {
            return;
        }
        let Some(slot) = self.slot_of(station, rank, at_s, &front) else {
            self.turned_away += u64::from(rank != Rank::Irrelevant);
            return;
        };
        let says_where = message.route.is_some() || !self.course.is_on_route();
        match &mut self.slots[slot] {
            // After a pause the place has to come first, or else the unit would take the station to be at its last
            // place.
            Some(tenant) if !says_where && (!tenant.relayed || at_s - tenant.relayed_s > PAUSE_S) => return,
            Some(tenant) if at_s >= tenant.from_s - 1e-9 => {
                tenant.relayed_s = at_s;
                tenant.relayed = true;
                self.left[slot] = None;
                self.left.iter_mut().for_each(|left| *left = left.filter(|left| left.station != station));
                tenant.gone = if rank == Rank::Irrelevant { tenant.gone.saturating_add(1) } else { 0 };
            }
            _ => return,
        }
        // The unit needs the route first, because it converts positions to its own axis by the route.
        let mut said: Vec<Said> = message.route.map(Said::Route).into_iter().collect();
        let parameters = message.parameters.filter(|parameters| self.are_parameters_due(slot, parameters, at_s));
        said.push(Said::State(State { motion: message.motion, parameters, horizon: message.horizon }));
        self.dismiss(slot, at_s);
        // Twice, because the unit trusts an identifier from its second frame on, and the first message may be the last
        // before a silence.
        let times = if std::mem::replace(&mut self.is_begun[slot], true) { 1 } else { 2 };
        for said in std::iter::repeat_n(said, times).flatten() {
            let sent = self.sender.send(&Message::Peer(Slot(slot as u8), said), &mut |frame| frames.push(frame));
            sent.expect("the catalogue has a line for each thing that a peer says");
        }
    }

    /// Whether an irrelevant station has a slot, and the unit has not yet heard that the station has left. Otherwise
    /// the unit would wait for a station that was silent while it left, because the unit last heard of it on its way.
    fn has_to_say_so(&self, station: StationHash) -> bool {
        let known = self.slots.iter().chain(&self.left).flatten();
        known.into_iter().any(|tenant| tenant.station == station && tenant.gone < NEWS)
    }

    /// Frees the slot of a station that has become irrelevant, once the unit has heard that.
    fn dismiss(&mut self, slot: usize, at_s: f64) {
        if self.slots[slot].is_some_and(|tenant| tenant.gone >= NEWS) {
            self.vacate(slot);
            self.rested_s[slot] = at_s + SLOT_REUSE_S;
        }
    }

    /// Takes a slot from its station. If that one has not been relayed yet, the unit still has the one before it.
    fn vacate(&mut self, slot: usize) {
        if let Some(tenant) = self.slots[slot].take().filter(|tenant| tenant.relayed) {
            self.left[slot] = Some(tenant);
        }
    }

    /// Records the place that a station sends. The modem forgets places that are older than any silence that a slot
    /// outlives.
    fn place(&mut self, at_s: f64, message: &V2xMessage) {
        let Some(route) = message.route else { return };
        let station = message.motion.station;
        let slots = &self.slots;
        let is_tenant = |station| slots.iter().flatten().any(|tenant| tenant.station == station);
        let is_known = |placed: &Placed| at_s - placed.at_s < FORGOTTEN_S || is_tenant(placed.station);
        self.places.retain(|placed| placed.station != station && is_known(placed));
        let speed_mps = message.motion.speed.get().to_num();
        let length_m = message.parameters.map_or(LONGEST_M, |parameters| parameters.length.get().to_num());
        let is_ahead = self.course.on_lane(&route).is_some_and(|ahead_m| ahead_m > 0.0);
        self.places.push(Placed { station, route, speed_mps, length_m, at_s, is_ahead });
    }

    fn slot_of(&mut self, station: StationHash, rank: Rank, at_s: f64, front: &Front) -> Option<usize> {
        let held = |tenant: &Option<Tenant>| tenant.is_some_and(|tenant| tenant.station == station);
        let has_left = rank == Rank::Irrelevant;
        let before = self.left.iter().position(held);
        if let Some(slot) = before.filter(|slot| has_left && self.is_idle(*slot, at_s)) {
            // The unit has it there, and not in a slot in which it has not been relayed yet.
            self.slots.iter_mut().filter(|tenant| held(tenant)).for_each(|tenant| *tenant = None);
            return Some(self.take_back(slot, at_s));
        }
        if let Some(slot) = self.slots.iter().position(held) {
            return Some(slot);
        }
        if has_left {
            return None;
        }
        if self.course.is_on_route() {
            let has_listened = self.begun_s.is_some_and(|begun_s| at_s - begun_s >= LISTENS_S - 1e-9);
            let is_served = has_listened && self.is_among_the_first(rank, at_s, front);
            if !is_served || !self.makes_room(rank, at_s, front) {
                return None;
            }
        }
        if let Some(slot) = before.filter(|slot| self.slots[*slot].is_none()) {
            return Some(self.take_back(slot, at_s));
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
        self.vacate(slot);
        self.rested_s[slot] = from_s;
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

    /// Whether nobody will be relayed in a slot soon: it is free, or its station is not heard.
    fn is_idle(&self, slot: usize, at_s: f64) -> bool {
        let is_heard = |placed: &Placed| at_s - placed.at_s < HEARD_S;
        let of = |station| self.places.iter().filter(move |placed| placed.station == station);
        self.slots[slot].is_none_or(|tenant| !of(tenant.station).any(is_heard))
    }

    /// Gives a slot back to the station that the unit has there.
    fn take_back(&mut self, slot: usize, at_s: f64) -> usize {
        self.slots[slot] = self.left[slot].take().map(|tenant| Tenant { from_s: at_s, ..tenant });
        slot
    }

    /// Whether a station of this rank is relevant enough for a slot, besides the slot in reserve: few enough of the
    /// stations on the air are more relevant. Otherwise it would take the slot from a more relevant station that is
    /// heard next.
    fn is_among_the_first(&self, rank: Rank, at_s: f64, front: &Front) -> bool {
        let heard = self.places.iter().filter(|placed| at_s - placed.at_s < HEARD_S);
        let mut first = heard.filter(|placed| self.rank_of(placed, at_s, front) < rank);
        self.slots.len().checked_sub(2).is_some_and(|others| first.nth(others).is_none())
    }

    /// Whether there is a slot for a station of this rank. On a route one slot is kept in reserve and rests, so that a
    /// station that comes near is relayed at once. So the last free slot is given only to a station that displaces a
    /// less relevant station from its slot.
    fn makes_room(&mut self, rank: Rank, at_s: f64, front: &Front) -> bool {
        if self.slots.iter().filter(|tenant| tenant.is_none()).count() != 1 {
            return true;
        }
        let Some((slot, rested_s)) = self.least_relevant(rank, at_s, front) else { return false };
        self.vacate(slot);
        self.rested_s[slot] = rested_s;
        true
    }

    /// Whether the station that the unit follows has not been heard yet.
    fn awaits(&self) -> bool {
        let followed = self.course.followed();
        followed.is_some_and(|followed| !self.slots.iter().flatten().any(|tenant| tenant.station == followed))
    }

    /// The slot of the least relevant station, and the time from which it may be used; `None` if a station of this rank
    /// may not have it. Of several least relevant stations, the one that has been silent for longest.
    fn least_relevant(&self, rank: Rank, at_s: f64, front: &Front) -> Option<(usize, f64)> {
        let tenants = self.slots.iter().enumerate().filter_map(|(slot, tenant)| Some((slot, (*tenant)?)));
        let ranked = tenants.map(|(slot, tenant)| (slot, self.rank(tenant.station, at_s, front), tenant.relayed_s));
        let (slot, least, relayed_s) =
            ranked.reduce(|a, b| if b.1 > a.1 || b.1 == a.1 && b.2 < a.2 { b } else { a })?;
        let rested_s = relayed_s + SLOT_REUSE_S;
        let is_free = rank.displaces(least) || rank <= least && at_s >= rested_s - 1e-9;
        is_free.then_some((slot, rested_s))
    }

    /// The rank of a station now, if it has kept its speed since its last message.
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

    /// The number of steps from the unit's target up the chain of vehicles that follow one another, to this station.
    /// `None`: the station is not on that chain.
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
