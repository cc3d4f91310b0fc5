//! The foremost stations of each leg: the places that the stations sent last enter, the nearest two of each leg leave.
//!
//! A rank depends on whether no station, one station or several stations are nearer than the station in question. The
//! nearest two of each leg answer that. So a message costs one pass over all stations, not one pass per station.

use super::Placed;
use super::relevance::{Across, Course, Foremost, LEADERS};

/// Legs that a route can name.
const LEGS: usize = 8;

/// The two shortest distances of those added, in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Nearest([f64; LEADERS]);

impl Nearest {
    const NOBODY: Self = Self([f64::INFINITY; LEADERS]);

    fn add(&mut self, way_m: f64) {
        let [first, second] = &mut self.0;
        if way_m < *first {
            (*first, *second) = (way_m, *first);
        } else if way_m < *second {
            *second = way_m;
        }
    }

    /// The shortest distance below `way_m`, and whether it is the only one below. `None`: none is below.
    fn before(&self, way_m: f64) -> Option<(f64, bool)> {
        let [first, second] = self.0;
        (first < way_m).then_some((first, second >= way_m))
    }
}

/// The foremost stations ahead of the unit and on the crossing legs.
#[derive(Clone, Copy, Debug)]
pub(super) struct Front {
    ahead: Nearest,
    across: [Nearest; LEGS],
    newest_s: f64,
}

impl Front {
    /// The foremost of the stations at `places`, for a unit on the way `course`.
    pub fn of(course: &Course, places: &[Placed]) -> Self {
        let mut front = Self { ahead: Nearest::NOBODY, across: [Nearest::NOBODY; LEGS], newest_s: f64::NEG_INFINITY };
        for placed in places {
            front.newest_s = front.newest_s.max(placed.at_s);
            if let Some(ahead_m) = placed.ahead_m(course) {
                front.ahead.add(ahead_m);
            }
            let across = course.across(&placed.route).filter(|across| !across.has_entered());
            if let Some((leg, way_m)) =
                across.and_then(|one| Some((front.across.get_mut(usize::from(one.leg))?, one.way_m)))
            {
                leg.add(way_m);
            }
        }
        front
    }

    /// Time at which a station was last heard.
    pub fn newest_s(&self) -> f64 {
        self.newest_s
    }

    /// The role of a station for the unit.
    pub fn foremost(&self, course: &Course, placed: &Placed) -> Foremost {
        match course.across(&placed.route) {
            _ if self.leads(course, placed) => Foremost::Ahead,
            Some(across) if across.has_entered() => Foremost::Inside,
            Some(across) if self.enters_next(across) => Foremost::Across,
            _ => Foremost::No,
        }
    }

    /// Whether no other station on the same leg enters the unit's next conflict area before this one.
    pub fn is_first(&self, one: Across) -> bool {
        self.before(one).is_none()
    }

    /// Whether a station is the next one of its leg to enter the unit's next conflict area, by the last messages. The
    /// second station counts too if the first one is about to enter.
    fn enters_next(&self, one: Across) -> bool {
        self.before(one).is_none_or(|(way_m, is_only)| is_only && Across { way_m, ..one }.enters_soon())
    }

    fn before(&self, one: Across) -> Option<(f64, bool)> {
        self.across.get(usize::from(one.leg))?.before(one.way_m)
    }

    /// Whether a station is one of the nearest two ahead on the unit's own leg, by the last messages. A silent station
    /// counts with its last place, because vehicles do not overtake on a leg.
    fn leads(&self, course: &Course, placed: &Placed) -> bool {
        placed.ahead_m(course).is_some_and(|ahead_m| self.ahead.before(ahead_m).is_none_or(|(_, is_only)| is_only))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_two_least_ways_say_how_many_are_nearer_as_far_as_two() {
        let ways = [7.0, 3.0, 9.0, 3.0, 1.0, 7.0];
        for taken in 0..=ways.len() {
            let mut nearest = Nearest::NOBODY;
            ways[..taken].iter().for_each(|way_m| nearest.add(*way_m));
            for way_m in [0.5, 1.0, 2.0, 3.0, 5.0, 7.0, 8.0, 10.0] {
                let mut nearer: Vec<f64> = ways[..taken].iter().copied().filter(|other| *other < way_m).collect();
                nearer.sort_by(f64::total_cmp);
                let said = nearest.before(way_m);
                assert_eq!(said, nearer.first().map(|first| (*first, nearer.len() == 1)), "{taken} {way_m}");
            }
        }
    }
}
