//! The check that the roads and intersections of a description fit together: the description enters; the first misfit
//! leaves, with its part, cause and remedy. The units accept a description without a misfit as their map.

use holdover::coordination::map::LEGS;

use super::description::Corridor;
use super::lane::{Lane, Stop, WIDTH_M, cross};
use super::network::{Network, PASSES_WITHIN_M, RUN_OUT_M};
use super::pavement::{CORNERS_M, same};
use crate::sim::globe::Shift;

/// Least distance between ways that do not cross, in metres.
const LEAST_APART_M: f64 = WIDTH_M;

/// Distance between the places at which ways are compared, in metres. Two ways that meet at too small an angle for a
/// crossing are within [`LEAST_APART_M`] of one another for longer than this.
const EVERY_M: f64 = 5.0;

/// A part of a description, by its number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// A road.
    Road(usize),
    /// An intersection.
    Intersection(usize),
}

/// What does not fit.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Misfit {
    /// The part to change.
    pub part: Part,
    /// The cause.
    pub cause: String,
    /// The remedy.
    pub remedy: String,
}

impl Misfit {
    fn new(part: Part, cause: String, remedy: impl Into<String>) -> Self {
        Self { part, cause, remedy: remedy.into() }
    }
}

/// Checks a description. Every road needs an intersection, and room before and after it. Every intersection needs a
/// road, and not too many. Neither conflict areas nor roads may overlap.
///
/// # Errors
/// The first thing that does not fit.
pub fn check(corridor: &Corridor) -> Result<(), Misfit> {
    let network = Network::of(corridor);
    let lanes = || network.lanes.iter().enumerate();
    lanes().try_for_each(|(road, lane)| ends(corridor, road, lane))?;
    (0..network.junctions.len()).try_for_each(|place| intersection(corridor, &network, place))?;
    lanes().try_for_each(|(road, lane)| areas(corridor, road, lane))?;
    let pairs = |road| lanes().take(road).map(|(other, _)| other);
    lanes().try_for_each(|(road, _)| pairs(road).try_for_each(|other| apart(corridor, &network, road, other)))
}

fn ends(corridor: &Corridor, road: usize, lane: &Lane) -> Result<(), Misfit> {
    let (name, part) = (&corridor.roads[road].name, Part::Road(road));
    if lane.stops.is_empty() {
        let cause = format!("the road \"{name}\" passes no intersection within {PASSES_WITHIN_M} m");
        return Err(Misfit::new(part, cause, "move its `points`, or the `at` of an intersection"));
    }
    let beyond = match lane.stops.as_slice() {
        [first, ..] if lane.entry_m < 0.0 => first,
        [.., last] if lane.exit_m > lane.road.length_m() => last,
        _ => return Ok(()),
    };
    let intersection = &corridor.intersections[beyond.intersection].name;
    let cause = format!("the intersection \"{intersection}\" lies beyond the ends of the road \"{name}\"");
    Err(Misfit::new(part, cause, "let its `points` reach to its intersections"))
}

fn intersection(corridor: &Corridor, network: &Network, place: usize) -> Result<(), Misfit> {
    let (plan, part, legs) =
        (&corridor.intersections[place], Part::Intersection(place), &network.junctions[place].legs);
    if legs.is_empty() {
        let cause = format!("no road passes the intersection \"{}\" within {PASSES_WITHIN_M} m", plan.name);
        return Err(Misfit::new(part, cause, "move its `at`, or remove it"));
    }
    let most =
        legs.iter().map(|leg| leg.movement.leg.max(leg.movement.exit)).max().map_or(0, |most| u16::from(most) + 1);
    if most > u16::from(LEGS) {
        let cause = format!("{most} roads pass the intersection \"{}\"", plan.name);
        return Err(Misfit::new(part, cause, format!("let at most {LEGS} pass it")));
    }
    for other in &corridor.intersections[..place] {
        let (apart_m, least_m) = (Shift::between(plan.at, other.at).length_m(), plan.half_m + other.half_m);
        if apart_m < least_m {
            return Err(overlap(part, [&plan.name, &other.name], apart_m, least_m, ""));
        }
    }
    Ok(())
}

/// Checks that the conflict areas on a road do not overlap.
fn areas(corridor: &Corridor, road: usize, lane: &Lane) -> Result<(), Misfit> {
    for pair in lane.stops.windows(2) {
        let [first, second] = [&pair[0], &pair[1]].map(|stop| &corridor.intersections[stop.intersection]);
        let (apart_m, least_m) = (pair[1].at_m - pair[0].at_m, first.half_m + second.half_m);
        if apart_m < least_m {
            let part = Part::Intersection(pair[0].intersection.max(pair[1].intersection));
            let along = format!(" along the road \"{}\"", corridor.roads[road].name);
            return Err(overlap(part, [&first.name, &second.name], apart_m, least_m, &along));
        }
    }
    Ok(())
}

fn overlap(part: Part, [a, b]: [&String; 2], apart_m: f64, least_m: f64, along: &str) -> Misfit {
    let cause = format!(
        "the conflict areas of \"{a}\" and \"{b}\" overlap: they are {apart_m:.1} m apart{along}, and half of both together is {least_m} m"
    );
    Misfit::new(part, cause, "move one of them, or give both a smaller `half_m`")
}

/// Checks that vehicles of two roads share ground only where the roads cross, or are one.
fn apart(corridor: &Corridor, network: &Network, road: usize, other: usize) -> Result<(), Misfit> {
    let [lane, others] = [road, other].map(|road| &network.lanes[road]);
    let meet = meetings(network, lane, others);
    // Roads that neither join nor part are one road, told twice.
    let is_twice = meet.iter().all(|meeting| meeting.is_one == [true; 2]);
    let shared_m = |way_m: f64| {
        let (place, heading_deg) = lane.road.at(way_m);
        let (there_m, aside_m) = others.road.nearest(place);
        let is_beside = (others.entry_m..=others.exit_m + RUN_OUT_M).contains(&there_m);
        let is_on_other = is_beside && aside_m < LEAST_APART_M && !cross(heading_deg, others.road.at(there_m).1);
        let is_one = || {
            !is_twice && same(&lane.road, way_m, &others.road).is_some()
                || meet.iter().any(|meeting| meeting.is_at(way_m))
        };
        (is_on_other && !is_one()).then_some(aside_m)
    };
    let ways = std::iter::successors(Some(lane.entry_m), |way_m| Some(way_m + EVERY_M));
    let Some(aside_m) = ways.take_while(|way_m| *way_m <= lane.exit_m + RUN_OUT_M).find_map(shared_m) else {
        return Ok(());
    };
    let [name, others_name] = [road, other].map(|road| &corridor.roads[road].name);
    let cause = format!("the roads \"{name}\" and \"{others_name}\" lie on one another, {aside_m:.1} m apart");
    let remedy = format!("move one to the side (`right_m`) until they are {LEAST_APART_M} m apart, or remove one");
    Err(Misfit::new(Part::Road(road), cause, remedy))
}

/// An intersection that two roads pass.
struct Meeting {
    at_m: f64,
    half_m: f64,
    /// Whether the two are one before it, and behind it.
    is_one: [bool; 2],
    conflict: bool,
}

impl Meeting {
    /// Whether the two may share ground there. A corner lies within [`CORNERS_M`].
    fn is_at(&self, way_m: f64) -> bool {
        let beyond_m = way_m - self.at_m;
        let is_before = self.is_one[0] && (-CORNERS_M..=self.half_m).contains(&beyond_m);
        let is_behind = self.is_one[1] && (-self.half_m..=CORNERS_M).contains(&beyond_m);
        is_before || is_behind || self.conflict && beyond_m.abs() <= self.half_m
    }
}

/// The intersections that two roads pass, along the first.
fn meetings(network: &Network, lane: &Lane, others: &Lane) -> Vec<Meeting> {
    let meeting = |stop: &Stop| {
        let there = others.stops.iter().find(|there| there.intersection == stop.intersection)?;
        let junction = &network.junctions[stop.intersection];
        let [own, other] = [stop, there].map(|stop| junction.legs[stop.leg].movement);
        Some(Meeting {
            at_m: stop.at_m,
            half_m: junction.half_m,
            is_one: [own.leg == other.leg, own.exit == other.exit],
            conflict: junction.conflict(stop.leg, there.leg),
        })
    };
    lane.stops.iter().filter_map(meeting).collect()
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use crate::roads::read::corridor;

    /// A map of ten lines: two roads that cross in the middle of the first, and the intersection there.
    const MAP: &str = "kind = \"corridor\"
[[road]]
name = \"north\"
points = [[0.0, 0.0], [0.002, 0.0]]
[[road]]
name = \"east\"
points = [[0.001, -0.001], [0.001, 0.001]]
[[intersection]]
name = \"A\"
at = [0.001, 0.0]
";

    fn refused(text: &str) -> String {
        corridor(Path::new("m.toml"), text, &Default::default()).unwrap_err().to_string()
    }

    /// The error for a third road with these points, in line 11.
    fn refused_road(points: &str) -> String {
        refused(&format!("{MAP}[[road]]\nname = \"new\"\npoints = {points}\n"))
    }

    /// The error for a second intersection at this point, in line 11.
    fn refused_intersection(at: &str) -> String {
        refused(&format!("{MAP}[[intersection]]\nname = \"B\"\nat = {at}\n"))
    }

    #[test]
    fn a_map_that_fits_is_taken() {
        assert!(corridor(Path::new("m.toml"), MAP, &Default::default()).is_ok());
        // The other direction of the street, 3 m away, and an intersection 22 m further on.
        let more = "[[road]]\nname = \"south\"\npoints = [[0.002, 0.0], [0.0, 0.0]]\nright_m = 3.0\n\
                    [[intersection]]\nname = \"B\"\nat = [0.0012, 0.0]\n";
        let text = format!("{MAP}{more}");
        assert!(corridor(Path::new("m.toml"), &text, &Default::default()).is_ok());
    }

    #[test]
    fn an_intersection_that_no_road_passes_is_refused() {
        let said = "m.toml:11: no road passes the intersection \"B\" within 12 m; move its `at`, or remove it";
        assert_eq!(refused_intersection("[10, 20]"), said);
    }

    #[test]
    fn conflict_areas_that_overlap_are_refused() {
        let end = ", and half of both together is 7 m; move one of them, or give both a smaller `half_m`";
        for (at, way) in [
            ("[0.001, 0.0]", "\"B\" and \"A\" overlap: they are 0.0 m apart"),
            ("[0.00105, 0.0]", "\"B\" and \"A\" overlap: they are 5.5 m apart"),
            // Far enough from one another along the road, but side by side.
            ("[0.001, 0.0001]", "\"A\" and \"B\" overlap: they are 0.0 m apart along the road \"north\""),
        ] {
            assert_eq!(refused_intersection(at), format!("m.toml:11: the conflict areas of {way}{end}"));
        }
    }

    #[test]
    fn roads_on_the_same_ground_are_refused() {
        let said = "m.toml:11: the roads \"new\" and \"north\" lie on one another, ";
        for points in [
            "[[0.0, 0.0], [0.002, 0.0]]",
            "[[0.002, 0.0], [0.0, 0.0]]",
            "[[0.0, 0.00002], [0.002, 0.00002]]",
            // The ways meet at 6 degrees, which is not a crossing.
            "[[0.0, -0.0001], [0.002, 0.0001]]",
        ] {
            let error = refused_road(points);
            assert!(error.starts_with(said) && error.contains("`right_m`"), "{error}");
        }
    }

    #[test]
    fn a_road_without_an_intersection_or_that_ends_before_it_is_refused() {
        let said = "m.toml:11: the road \"new\" passes no intersection within 12 m; move its `points`, or the `at` of an \
                    intersection";
        assert_eq!(refused_road("[[1.0, 1.0], [1.001, 1.0]]"), said);
        let said = "m.toml:11: the intersection \"A\" lies beyond the ends of the road \"new\"; let its `points` reach to its \
                    intersections";
        assert_eq!(refused_road("[[0.00236, 0.0], [0.003, 0.0]]"), said);
        assert_eq!(refused_road("[[-0.003, 0.0], [-0.0001, 0.0]]"), said);
    }

    #[test]
    fn too_many_roads_through_an_intersection_are_refused() {
        let road = |number: u32| {
            let (sine, cosine) = (f64::from(number) * 20.0).to_radians().sin_cos();
            let [north, east] = [0.001 * cosine, 0.001 * sine];
            format!("[[road]]\nname = \"{number}\"\npoints = [[{}, {}], [{north}, {east}]]\n", -north, -east)
        };
        let roads: String = (0..9).map(road).collect();
        let text = format!("{roads}[[intersection]]\nname = \"A\"\nat = [0.0, 0.0]\n");
        assert_eq!(refused(&text), "m.toml:28: 9 roads pass the intersection \"A\"; let at most 8 pass it");
    }

    #[test]
    fn too_few_and_too_many_sections_are_refused() {
        let none = "m.toml:1: there is no [[road]], and a corridor needs one; add from 1 to 32";
        assert_eq!(refused("kind = \"corridor\"\n"), none);
        let (roads, _) = MAP.split_once("[[intersection]]").unwrap();
        let none = "m.toml:1: there is no [[intersection]], and a corridor needs one; add from 1 to 16";
        assert_eq!(refused(roads), none);
        let many = "[[intersection]]\nname = \"A\"\nat = [0.001, 0.0]\n".repeat(17);
        assert_eq!(refused(&format!("{roads}{many}")), "m.toml:56: there are 17 [[intersection]]; give at most 16");
    }
}
