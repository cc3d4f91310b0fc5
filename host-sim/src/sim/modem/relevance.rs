//! The relevance of a station to the unit: what the unit sends of itself and what the station sends enter, a rank
//! leaves. The ranks, the most relevant first:
//!
//! - The station that the unit says it follows.
//! - On a route: the two stations nearest ahead on the unit's own leg by their last messages, wherever they are now.
//!   The unit must not run into them. If one of them is silent, the other need not be the nearest.
//! - Stations in the conflict area that the unit reaches next, and stations that are about to enter or to leave it.
//! - Of each leg that crosses the unit's leg, the next station to enter that area. If it is about to enter, the one
//!   after it too. Vehicles do not overtake on a leg, so the stations behind come later.
//! - Stations at an intersection that the unit has still to cross. The unit's nearest intersection comes first; there,
//!   those come last that come by other legs on ways that do not conflict with the unit's. Stations ahead of the unit
//!   come before stations behind it. Of those ahead, a station that is leaving comes first, because the unit may be
//!   waiting for that; then the nearest.
//! - The station that the unit's target follows, the one that this station follows, and so on along the chain: the unit
//!   predicts its target by them.
//! - All other stations.
//!
//! Of the stations in and before the conflict area, only those count that arrived no later than the unit; a station
//! that arrived later lets the unit pass.
//!
//! For a unit on a route, some stations are irrelevant: those that name no intersection on the unit's remaining way,
//! and those that crossed long ago and do not lead. The unit could not tell where on its lane they are.

use holdover::coordination::{Arrival, Intersection, Movement};
use holdover::wire::fd::State;
use holdover::wire::route::Route;
use holdover::wire::{Predecessor, Said, StationHash};

/// A station that has crossed stays relevant up to this distance beyond the crossing point, in metres. At this distance
/// even a bus has left any conflict area.
const CLEAR_M: f64 = 40.0;

/// The ranks, from the most relevant to the least relevant.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub enum Rank {
    /// The unit follows the station.
    Followed,
    /// The station is one of the [`LEADERS`] just ahead on the unit's own leg.
    Leads,
    /// The station is in the conflict area that the unit reaches next, or about to enter or to leave it.
    Inside,
    /// The station is the next one of its leg to enter that area, or the second one while the first is about to enter.
    Enters,
    /// The station comes to an intersection that the unit will also cross.
    Meets {
        /// Number of intersections that the unit crosses before that one.
        after: usize,
        /// The station comes by another leg, and its way does not conflict with the unit's.
        beside: bool,
        /// The station is farther from the crossing point than the unit.
        behind: bool,
        /// The station has not reached the crossing point, or comes by the unit's own leg.
        arriving: bool,
        /// Difference of the two distances to the crossing point, in metres.
        apart_m: f64,
    },
    /// The station is this many steps up the chain: the unit's target follows it, or follows a vehicle that follows it,
    /// and so on.
    OnChain(usize),
    /// Nothing is known that would make the station relevant.
    Other,
    /// The station cannot matter to the unit.
    Irrelevant,
}

/// At this distance beyond the crossing point, in metres, the rear of most vehicles has left the conflict area.
pub(super) const LEFT_M: f64 = 16.0;

/// A station that is nearer to the crossing point than this, in metres, is in the conflict area, or can no longer stop
/// before it. The next station on its leg may be right behind it.
const ENTERED_M: f64 = 5.0;

/// A station that is nearer to the crossing point than this, in metres, enters the area within a second or two.
const SOON_M: f64 = 15.0;

/// A station that is farther from the crossing point than this, in metres, cannot be there before the unit has passed.
/// The unit needs 5 s from standstill, and no vehicle is faster than 16 m/s in a town.
const NEAR_M: f64 = 80.0;

/// The role of a station among those that the unit could meet next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Foremost {
    /// The station is one of the [`LEADERS`] just ahead on the unit's own leg.
    Ahead,
    /// The station is the next one of a crossing leg to enter the next conflict area. No station behind it on that leg
    /// enters first.
    Across,
    /// The station is in that area.
    Inside,
    /// None of these.
    No,
}

/// A station on a crossing leg of the intersection that the unit reaches next. It arrived there no later than the unit
/// and has not left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Across {
    /// Leg of the station.
    pub leg: u8,
    /// Distance from the station to the crossing point by its last message, in metres.
    pub way_m: f64,
}

impl Across {
    /// Whether the station has entered the conflict area.
    #[must_use]
    pub fn has_entered(self) -> bool {
        self.way_m <= ENTERED_M
    }

    /// Whether the station will enter so soon that the one behind it is as relevant.
    #[must_use]
    pub fn enters_soon(self) -> bool {
        self.way_m <= SOON_M
    }

    /// Whether the station is so near that it may be there before the unit has passed.
    #[must_use]
    pub fn is_near(self) -> bool {
        self.way_m <= NEAR_M
    }
}

/// Number of stations just ahead on the unit's own leg that come first after the target.
pub const LEADERS: usize = 2;

/// A station takes another station's slot only if it is nearer by this distance, in metres. This keeps two stations
/// from taking turns.
const NEARER_M: f64 = 20.0;

impl Rank {
    /// Whether a station of this rank takes the slot of a station of rank `other`. A station that is leaving keeps its
    /// slot, because it will soon be gone.
    #[must_use]
    pub fn displaces(self, other: Self) -> bool {
        match (self, other) {
            (
                Self::Meets { after, beside, behind, apart_m, .. },
                Self::Meets { after: later, beside: too, behind: back, arriving, apart_m: far_m },
            ) if (after, beside, behind) == (later, too, back) => arriving && apart_m + NEARER_M < far_m,
            _ => self < other,
        }
    }
}

/// An intersection ahead.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ahead {
    /// The intersection.
    pub intersection: &'static Intersection,
    /// The unit's way through it.
    pub movement: Movement,
    /// Distance to it from where the unit sets out, in metres.
    pub at_m: f64,
}

/// What the unit sends of itself.
#[derive(Clone, Debug, Default)]
pub struct Course {
    /// The intersections of the unit's way.
    crossings: Vec<Ahead>,
    route: Option<Route>,
    /// The station that the driver told the unit to follow.
    told: Option<StationHash>,
    followed: Option<StationHash>,
}

impl Course {
    /// The course of a unit whose way leads through these intersections.
    #[must_use]
    pub fn through(crossings: Vec<Ahead>) -> Self {
        Self { crossings, ..Self::default() }
    }

    /// The course of a unit in a string, behind `station`.
    #[must_use]
    pub fn behind(station: StationHash) -> Self {
        Self { told: Some(station), followed: Some(station), ..Self::default() }
    }

    /// Takes in one of the unit's own messages.
    pub fn take(&mut self, said: &Said) {
        match said {
            Said::Route(route) => self.route = Some(*route),
            Said::DrivingParameters(parameters) | Said::State(State { parameters: Some(parameters), .. }) => {
                self.followed = match parameters.predecessor {
                    Predecessor::Station(station) => Some(station),
                    // A unit that waits for the first message of its target names no target, but it has to hear that
                    // target.
                    Predecessor::None | Predecessor::Unknown => self.told,
                }
            }
            _ => {}
        }
    }

    /// Whether the unit's way leads through intersections.
    #[must_use]
    pub fn is_on_route(&self) -> bool {
        !self.crossings.is_empty()
    }

    /// The station that the unit says it follows.
    #[must_use]
    pub fn followed(&self) -> Option<StationHash> {
        self.followed
    }

    /// The rank of a station. `route` is its route and its present distance to the crossing point, if it publishes a
    /// route. `steps` is its number of steps up the chain, if it is on it. `foremost` is its role at the next
    /// intersection.
    #[must_use]
    pub fn rank(
        &self,
        station: StationHash,
        route: Option<(Route, f64)>,
        steps: Option<usize>,
        foremost: Foremost,
    ) -> Rank {
        if self.followed == Some(station) {
            return Rank::Followed;
        }
        match foremost {
            Foremost::Ahead => return Rank::Leads,
            Foremost::Across => return Rank::Enters,
            Foremost::Inside => return Rank::Inside,
            Foremost::No => {}
        }
        let chain = steps.map_or(Rank::Other, Rank::OnChain);
        if self.crossings.is_empty() {
            return chain;
        }
        let meets = route.and_then(|(other, way_m)| self.meets(&other, way_m));
        meets.unwrap_or(if chain == Rank::Other { Rank::Irrelevant } else { chain })
    }

    /// The station, if it is on a crossing leg of the intersection that the unit reaches next, arrived there no later
    /// than the unit, and has not left.
    #[must_use]
    pub fn across(&self, other: &Route) -> Option<Across> {
        let next = self.next()?;
        let across = Across { leg: other.movement.leg, way_m: other.distance.get().to_num() };
        let is_crossing = other.intersection == next.intersection.id
            && self.comes_before(other)
            && next.intersection.conflict(next.movement, other.movement);
        (is_crossing && across.way_m > -LEFT_M).then_some(across)
    }

    /// Whether a station at the same intersection arrived there no later than the unit. A station that arrived later
    /// lets the unit pass: it knows of the unit, or it knows that it does not know of every station.
    #[must_use]
    pub fn comes_before(&self, other: &Route) -> bool {
        self.route.is_none_or(|own| {
            own.intersection != other.intersection || !Arrival(own.arrival).is_before(Arrival(other.arrival))
        })
    }

    /// The intersection that the unit reaches next.
    #[must_use]
    pub fn next(&self) -> Option<Ahead> {
        self.crossings.get(self.here()?).copied()
    }

    /// Distance from the unit's last published place to the crossing point of that intersection, in metres.
    #[must_use]
    pub fn way_m(&self) -> Option<f64> {
        Some(self.route?.distance.get().to_num())
    }

    /// Distance by which the last place of a station is ahead of the unit's last place, on the unit's own lane, in
    /// metres. Negative if the unit has driven past that place since. Until a station has left the conflict area it is
    /// on the lane of its leg, and then on that of its exit.
    #[must_use]
    pub fn on_lane(&self, other: &Route) -> Option<f64> {
        let (there, own_m) = self.way_to(other.intersection)?;
        let Ahead { intersection, movement, .. } = self.crossings[there];
        let way_m = other.distance.get().to_num::<f64>();
        let is_on_lane =
            if way_m > -LEFT_M { movement.leg == other.movement.leg } else { movement.exit == other.movement.exit };
        let shift_m = || intersection.shift(movement, other.movement).get().to_num::<f64>();
        is_on_lane.then(|| own_m + shift_m() - way_m)
    }

    /// An intersection that the unit has still to cross: its index on the unit's way, and the distance to it.
    fn way_to(&self, intersection: u8) -> Option<(usize, f64)> {
        let here = self.here()?;
        let here_m = self.route.map_or(self.crossings[0].at_m, |own| own.distance.get().to_num());
        let there = self.place(intersection).filter(|there| *there >= here)?;
        Some((there, here_m + self.crossings[there].at_m - self.crossings[here].at_m))
    }

    fn place(&self, id: u8) -> Option<usize> {
        self.crossings.iter().position(|named| named.intersection.id == id)
    }

    /// Index of the intersection that the unit reaches next. Before the unit has published its place, it is at the
    /// start of its way.
    fn here(&self) -> Option<usize> {
        if self.crossings.is_empty() { None } else { self.route.map_or(Some(0), |own| self.place(own.intersection)) }
    }

    fn meets(&self, other: &Route, way_m: f64) -> Option<Rank> {
        let here = self.here()?;
        let (there, own_m) = self.way_to(other.intersection)?;
        let Ahead { intersection, movement, .. } = self.crossings[there];
        let beside = movement.leg != other.movement.leg && !intersection.conflict(movement, other.movement);
        let is_on_lane = there == here && self.route.is_none_or(|own| own.movement.leg == other.movement.leg);
        // By its last message, because the unit waits for a silent station, wherever that station has gone since. On
        // its own leg the unit waits for no station: one beyond the crossing point matters only if it leads.
        let has_gone = other.distance.get().to_num::<f64>() < -CLEAR_M;
        let (behind, arriving) = (way_m > own_m, way_m >= 0.0 || is_on_lane);
        let apart_m = (way_m - own_m).abs();
        (!has_gone).then_some(Rank::Meets { after: there - here, beside, behind, arriving, apart_m })
    }
}
