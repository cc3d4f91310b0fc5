//! How much a station matters to the unit: what the unit says of itself and what the station says enter, a rank leaves.
//!
//! First comes whom the unit says it follows. On a route, next are the stations that name an intersection which the unit has
//! still to cross: the one that it comes to first before the next one, there those ahead before those behind, and of these
//! the nearest. Then those whom the one followed follows, and so on along the chain, because a unit predicts its target by
//! them; then everyone else. For a unit on a route, a station that names no intersection of the way that is left, or that
//! has long crossed by another leg, does not matter at all: the unit could not tell where on its lane it is.

use holdover::wire::route::Route;
use holdover::wire::{Predecessor, Said, StationHash};

/// A station that has crossed by another leg matters until it is so far beyond, in metres: a bus has then left any
/// conflict area.
const CLEAR_M: f64 = 40.0;

/// How much a station matters; the less, the more.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub enum Rank {
    /// The unit follows it.
    Followed,
    /// It comes to an intersection that the unit comes to.
    Meets {
        /// How many intersections the unit crosses before that one.
        after: usize,
        /// It is farther from the crossing point than the unit.
        behind: bool,
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

/// A station takes another one's slot only if it is nearer by so many metres, lest two take turns.
const NEARER_M: f64 = 20.0;

impl Rank {
    /// Whether a station of this rank takes the slot of one of that rank.
    #[must_use]
    pub fn displaces(self, other: Self) -> bool {
        match (self, other) {
            (Self::Meets { after, behind, apart_m }, Self::Meets { after: later, behind: back, apart_m: far_m })
                if (after, behind) == (later, back) =>
            {
                apart_m + NEARER_M < far_m
            }
            _ => self < other,
        }
    }
}

/// An intersection ahead: its number in messages and the way to it from where the unit sets out, in metres.
pub type Ahead = (u8, f64);

/// What the unit says of itself.
#[derive(Clone, Debug, Default)]
pub struct Course {
    /// The intersections of the unit's way, each with the way to it.
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
            Said::Intent(intent) => {
                self.followed = match intent.predecessor {
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

    /// The rank of a station that is now on that route, if it says so, and that many steps up the chain, if it is there.
    #[must_use]
    pub fn rank(&self, station: StationHash, route: Option<(Route, f64)>, steps: Option<usize>) -> Rank {
        if self.followed == Some(station) {
            return Rank::Followed;
        }
        let chain = steps.map_or(Rank::Other, Rank::OnChain);
        if self.crossings.is_empty() {
            return chain;
        }
        let meets = route.and_then(|(other, way_m)| self.meets(&other, way_m));
        meets.unwrap_or(if chain == Rank::Other { Rank::Irrelevant } else { chain })
    }

    fn meets(&self, other: &Route, way_m: f64) -> Option<Rank> {
        let place = |id: u8| self.crossings.iter().position(|(named, _)| *named == id);
        // Before the unit says where it is, it is where it set out.
        let here = self.route.map_or(Some(0), |own| place(own.intersection))?;
        let here_m = self.route.map_or(self.crossings[0].1, |own| own.distance.get().to_num());
        let there = place(other.intersection).filter(|there| *there >= here)?;
        let own_m = here_m + self.crossings[there].1 - self.crossings[here].1;
        let is_on_lane = there == here && self.route.is_none_or(|own| own.leg == other.leg);
        let has_gone = way_m < -CLEAR_M && !is_on_lane;
        (!has_gone).then(|| Rank::Meets { after: there - here, behind: way_m > own_m, apart_m: (way_m - own_m).abs() })
    }
}
