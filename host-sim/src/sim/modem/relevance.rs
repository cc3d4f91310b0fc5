//! How much a station matters to the unit: what the unit says of itself and what the station says enter, a rank leaves.
//!
//! First comes whom the unit says it follows. On a route, next are the two nearest ahead on the unit's own leg by what they
//! said last, wherever they are: it must not run into them, and if one of them is silent the other need not be the nearest. Then
//! those in the conflict area that the unit comes to next, or just about to enter or to leave it; and of each leg that crosses the
//! unit's the next one into it, or also the one after it, where the first is there soon: nobody passes on a leg, so those behind come after
//! it. Of both only who arrived no later than the unit: everyone else lets it pass.
//!
//! Then come the stations that name an intersection which the unit has still to cross: the one that it comes to first before the
//! next one, there those ahead before those behind, of those ahead first who are leaving it, because the unit may be waiting for
//! that, and otherwise the nearest. Then those whom the one followed follows, and so on along the chain, because a unit predicts its target by
//! them; then everyone else. For a unit on a route, a station that names no intersection of the way that is left, or that
//! has long crossed and does not lead, does not matter at all: the unit could not tell where on its lane it is.

use holdover::coordination::Arrival;
use holdover::wire::route::Route;
use holdover::wire::{Predecessor, Said, StationHash};

/// A station that has crossed matters until it is so far beyond, in metres: a bus has then left any
/// conflict area.
const CLEAR_M: f64 = 40.0;

/// How much a station matters; the less, the more.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub enum Rank {
    /// The unit follows it.
    Followed,
    /// It is one of the [`LEADERS`] just ahead on the unit's own leg.
    Leads,
    /// It is in the conflict area that the unit comes to next, or just about to enter or to leave it.
    Inside,
    /// It is the next one into that area, of all on its leg, or the second where the first is there soon.
    Enters,
    /// It comes to an intersection that the unit comes to.
    Meets {
        /// How many intersections the unit crosses before that one.
        after: usize,
        /// It is farther from the crossing point than the unit.
        behind: bool,
        /// It has not reached the crossing point, or comes by the unit's own leg.
        arriving: bool,
        /// By how many metres they differ.
        apart_m: f64,
    },
    /// The unit's target follows it, or the one that that one follows, and so on: so many steps.
    OnChain(usize),
    /// Nothing is known of it that would matter.
    Other,
    /// It cannot matter.
    Irrelevant,
}

/// So far beyond the crossing point, in metres, the rear of most vehicles has left the conflict area.
const LEFT_M: f64 = 16.0;

/// Who is so near the crossing point, in metres, is in the conflict area or cannot keep out of it: the next one on its leg may be
/// right behind it.
const ENTERED_M: f64 = 5.0;

/// Who is nearer to it than this is in there within a second or two.
const SOON_M: f64 = 15.0;

/// Who is farther from it than this, in metres, cannot be there before the unit has passed: it takes 5 s from a stand, and nobody is faster
/// than 16 m/s in a town.
const NEAR_M: f64 = 80.0;

/// Whether a station is the first of all that the unit could meet next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Foremost {
    /// It is one of the [`LEADERS`] just ahead on the unit's own leg.
    Ahead,
    /// It is the next one of another leg into the next conflict area: nobody behind it there comes into the area before it.
    Across,
    /// It is in that area.
    Inside,
    /// None of these.
    No,
}

/// A station that comes by a leg that crosses the unit's to the intersection which the unit comes to next, arrived there before it, and has
/// not left it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Across {
    /// Its leg.
    pub leg: u8,
    /// Its way to the crossing point when it said that, in metres.
    pub way_m: f64,
}

impl Across {
    /// Whether it has entered the conflict area.
    #[must_use]
    pub fn has_entered(self) -> bool {
        self.way_m <= ENTERED_M
    }

    /// Whether it is going to enter so soon that the one behind it matters as much.
    #[must_use]
    pub fn enters_soon(self) -> bool {
        self.way_m <= SOON_M
    }

    /// Whether it is so near that it may be there before the unit has passed.
    #[must_use]
    pub fn is_near(self) -> bool {
        self.way_m <= NEAR_M
    }
}

/// So many of those ahead on the unit's own leg matter before all but the one followed.
pub const LEADERS: usize = 2;

/// A station takes another one's slot only if it is nearer by so many metres, lest two take turns.
const NEARER_M: f64 = 20.0;

impl Rank {
    /// Whether a station of this rank takes the slot of one of that rank. One that is leaving is soon gone anyway.
    #[must_use]
    pub fn displaces(self, other: Self) -> bool {
        match (self, other) {
            (
                Self::Meets { after, behind, apart_m, .. },
                Self::Meets { after: later, behind: back, arriving, apart_m: far_m },
            ) if (after, behind) == (later, back) => arriving && apart_m + NEARER_M < far_m,
            _ => self < other,
        }
    }
}

/// An intersection ahead.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ahead {
    /// Its number in messages.
    pub id: u8,
    /// The unit's leg there.
    pub leg: u8,
    /// The legs whose ways cross the unit's: bit `n` is leg `n`.
    pub crossed: u8,
    /// The way to it from where the unit sets out, in metres.
    pub at_m: f64,
}

/// What the unit says of itself.
#[derive(Clone, Debug, Default)]
pub struct Course {
    /// The intersections of the unit's way.
    crossings: Vec<Ahead>,
    route: Option<Route>,
    /// Whom the driver told it to follow.
    told: Option<StationHash>,
    followed: Option<StationHash>,
}

impl Course {
    /// A way through those intersections.
    #[must_use]
    pub fn through(crossings: Vec<Ahead>) -> Self {
        Self { crossings, ..Self::default() }
    }

    /// The way of a string, behind that station.
    #[must_use]
    pub fn behind(station: StationHash) -> Self {
        Self { told: Some(station), followed: Some(station), ..Self::default() }
    }

    /// Takes in one of the unit's own messages.
    pub fn take(&mut self, said: &Said) {
        match said {
            Said::Route(route) => self.route = Some(*route),
            Said::DrivingParameters(parameters) => {
                self.followed = match parameters.predecessor {
                    Predecessor::Station(station) => Some(station),
                    // Who waits for a first message names nobody, and has to hear whom it waits for.
                    Predecessor::None | Predecessor::Unknown => self.told,
                }
            }
            _ => {}
        }
    }

    /// Whether the unit is on a way through intersections.
    #[must_use]
    pub fn is_on_route(&self) -> bool {
        !self.crossings.is_empty()
    }

    /// Whom the unit says it follows.
    #[must_use]
    pub fn followed(&self) -> Option<StationHash> {
        self.followed
    }

    /// The rank of a station that is now on that route, if it says so, and that many steps up the chain, if it is there; and
    /// whether it is foremost.
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

    /// A station that comes by a leg that crosses the unit's to the intersection which the unit comes to next, arrived there before it,
    /// and has not left it.
    #[must_use]
    pub fn across(&self, other: &Route) -> Option<Across> {
        let next = self.next()?;
        let across = Across { leg: other.leg, way_m: other.distance.get().to_num() };
        let is_crossing = other.intersection == next.id
            && self.comes_before(other)
            && next.crossed & 1u8.checked_shl(other.leg.into())? != 0;
        (is_crossing && across.way_m > -LEFT_M).then_some(across)
    }

    /// Whether a station at the same intersection arrived there no later than the unit. One that arrived later lets the unit pass: it
    /// knows of it, or else that it does not know of everybody.
    #[must_use]
    pub fn comes_before(&self, other: &Route) -> bool {
        self.route.is_none_or(|own| {
            own.intersection != other.intersection || !Arrival(own.arrival).is_before(Arrival(other.arrival))
        })
    }

    /// The intersection that the unit comes to next.
    #[must_use]
    pub fn next(&self) -> Option<Ahead> {
        self.crossings.get(self.here()?).copied()
    }

    /// The way from where the unit said it was to the crossing point of that intersection, in metres.
    #[must_use]
    pub fn way_m(&self) -> Option<f64> {
        Some(self.route?.distance.get().to_num())
    }

    /// How far ahead of where the unit said it is now, on its own leg, a station was when it said that; less than nothing where the
    /// unit has driven past that place since.
    #[must_use]
    pub fn on_leg(&self, other: &Route) -> Option<f64> {
        let (there, own_m) = self.way_to(other.intersection)?;
        (self.crossings[there].leg == other.leg).then(|| own_m - other.distance.get().to_num::<f64>())
    }

    /// The place on the unit's way, and the way there, of an intersection that it has still to cross.
    fn way_to(&self, intersection: u8) -> Option<(usize, f64)> {
        let here = self.here()?;
        let here_m = self.route.map_or(self.crossings[0].at_m, |own| own.distance.get().to_num());
        let there = self.place(intersection).filter(|there| *there >= here)?;
        Some((there, here_m + self.crossings[there].at_m - self.crossings[here].at_m))
    }

    fn place(&self, id: u8) -> Option<usize> {
        self.crossings.iter().position(|named| named.id == id)
    }

    /// The intersection that the unit comes to next. Before it says where it is, it is where it set out.
    fn here(&self) -> Option<usize> {
        if self.crossings.is_empty() { None } else { self.route.map_or(Some(0), |own| self.place(own.intersection)) }
    }

    fn meets(&self, other: &Route, way_m: f64) -> Option<Rank> {
        let here = self.here()?;
        let (there, own_m) = self.way_to(other.intersection)?;
        let is_on_lane = there == here && self.route.is_none_or(|own| own.leg == other.leg);
        // By what it said: the unit waits for one that is silent, wherever that may have gone meanwhile. On the unit's own leg
        // nobody waits: who is beyond the crossing point matters as one that leads, or not at all.
        let has_gone = other.distance.get().to_num::<f64>() < -CLEAR_M;
        let (behind, arriving) = (way_m > own_m, way_m >= 0.0 || is_on_lane);
        (!has_gone).then(|| Rank::Meets { after: there - here, behind, arriving, apart_m: (way_m - own_m).abs() })
    }
}
