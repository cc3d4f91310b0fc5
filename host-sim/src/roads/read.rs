//! A scenario file of roads that cross: TOML enters; a checked [`Corridor`] leaves, or an error with file, line, cause
//! and remedy. `scenarios/corridor.toml` states and explains every key. The roads and intersections have to be in the
//! file; all other keys have a default.

use std::path::Path;

use super::description::{Corridor, Emergencies, IntersectionPlan, Limits, Radio, RoadPlan, Traffic, Wrong};
use super::experiment::of_seed;
use super::fit::{self, Part};
use crate::error::{Error, quoted};
use crate::input::scenario::keys::{Document, Number, Section};
use crate::input::scenario::set::Sets;
use crate::input::scenario::{Fleet, Overrides, Span, bus, envelope, event, sensors};
use crate::sim::globe::Shift;
use crate::sim::ground::Point;
use crate::sim::modem::{ECU_PEERS, PEERS};
use crate::sim::sensors::faults::is_fitted;

const DURATION: Number = Number { key: "duration_s", unit: "seconds", limits: 10.0..=86_400.0, default: 600.0 };
const PERIOD: Number = Number { key: "period_s", unit: "seconds", limits: 0.001..=0.1, default: 0.01 };
const STEP: Number = Number { key: "step_s", unit: "seconds", limits: 0.001..=1.0, default: 0.03 };
const HORIZON: Number = Number { key: "horizon_s", unit: "seconds", limits: 0.5..=10.7, default: 10.7 };
const RATE: Number = Number { key: "message_rate_hz", unit: "Hz", limits: 1.0..=100.0, default: 10.0 };
const EGO_AFTER: Number = Number { key: "ego_after_s", unit: "seconds", limits: 0.0..=86_400.0, default: 60.0 };
const TARGET: Number = Number { key: "target_speed_mps", unit: "m/s", limits: 1.0..=50.0, default: 11.0 };
const ENTRY: Number = Number { key: "entry_speed_mps", unit: "m/s", limits: 1.0..=50.0, default: 10.0 };
const TIME_GAP: Number = Number { key: "time_gap_s", unit: "seconds", limits: 0.1..=3.995, default: 1.0 };
const SILENT_TIME_GAP: Number = Number { key: "silent_time_gap_s", unit: "seconds", limits: 0.1..=3.995, default: 1.8 };
const CATCH_UP: Number = Number { key: "catch_up", unit: "a share", limits: 0.0..=0.75, default: 0.2 };
const FEED_FORWARD: Number = Number { key: "feed_forward", unit: "a share", limits: 0.0..=0.5, default: 0.0 };
const STANDSTILL: Number = Number { key: "standstill_m", unit: "metres", limits: 0.0..=10.23, default: 2.0 };
const HEADWAY: Number = Number { key: "headway_s", unit: "seconds", limits: 1.0..=60.0, default: 2.5 };
const APPEAR: Number = Number { key: "appear_m", unit: "metres", limits: 50.0..=1000.0, default: 180.0 };
const LEAVE: Number = Number { key: "leave_m", unit: "metres", limits: 20.0..=1000.0, default: 40.0 };
const VANS: Number = Number { key: "vans", unit: "a share", limits: 0.0..=1.0, default: 0.15 };
const BUSES: Number = Number { key: "buses", unit: "a share", limits: 0.0..=1.0, default: 0.1 };
const WITHOUT_PASSES: Number = Number { key: "without_passes", unit: "a share", limits: 0.0..=1.0, default: 0.0 };
const DELAY_MEAN: Number = Number { key: "delay_mean_s", unit: "seconds", limits: 0.0..=10.0, default: 0.040 };
const DELAY_STD: Number = Number { key: "delay_std_s", unit: "seconds", limits: 0.0..=10.0, default: 0.0259 };
const LOSS: Number = Number { key: "loss", unit: "a share", limits: 0.0..=1.0, default: 0.1 };
const RANGE: Number = Number { key: "range_m", unit: "metres", limits: 50.0..=5000.0, default: 400.0 };
const DARK: Number = Number { key: "dark_s", unit: "seconds", limits: 0.0..=60.0, default: 4.0 };
const REPEATS: Number = Number { key: "repeats_hz", unit: "Hz", limits: 0.0..=5.0, default: 0.0 };
const MASS: Number = Number { key: "mass_scale", unit: "a factor", limits: 0.5..=2.0, default: 1.0 };
const GRADE: Number = Number { key: "grade", unit: "a share of the way", limits: -0.15..=0.15, default: 0.0 };
const WIND: Number = Number { key: "headwind_mps", unit: "m/s", limits: -30.0..=30.0, default: 0.0 };
const LAG: Number = Number { key: "lag_scale", unit: "a factor", limits: 0.2..=4.0, default: 1.0 };
const EMERGENCIES: Number = Number { key: "share", unit: "a share", limits: 0.0..=1.0, default: 0.05 };
const STANDS: Number = Number { key: "stands_s", unit: "seconds", limits: 0.0..=60.0, default: 10.0 };
const FAULTS: Number = Number { key: "faults", unit: "a share", limits: 0.0..=1.0, default: 0.02 };
const DRIVER: Number = Number { key: "driver_after_s", unit: "seconds", limits: 0.0..=600.0, default: 30.0 };
const RIGHT: Number = Number { key: "right_m", unit: "metres", limits: -8.0..=8.0, default: 0.0 };
const CORNER: Number = Number { key: "corner_m", unit: "metres", limits: 0.0..=50.0, default: 0.0 };
const PER_MINUTE: Number =
    Number { key: "vehicles_per_min", unit: "vehicles a minute", limits: 0.0..=30.0, default: 3.0 };
const HALF: Number = Number { key: "half_m", unit: "metres", limits: 1.0..=5.0, default: 3.5 };
const DEGREES: Number = Number { key: "points", unit: "degrees", limits: -180.0..=180.0, default: 0.0 };

const ERROR_LIMIT: Number = Number { key: "position_error_m", unit: "metres", limits: 0.0..=1000.0, default: 0.0 };
const RATIO_LIMIT: Number = Number { key: "travel_time_ratio", unit: "a factor", limits: 1.0..=100.0, default: 1.0 };

/// One slot for the vehicle just ahead, and one for the vehicle that comes next.
pub const LEAST_SLOTS: usize = 2;
const ROADS: usize = 32;
const INTERSECTIONS: usize = 16;

/// The corridor of a scenario text, with the values that the command line overrides.
///
/// # Errors
/// Text that is not TOML, unknown keys, wrong types, impossible values.
pub fn corridor(file: &Path, text: &str, overrides: &Overrides) -> Result<Corridor, Error> {
    let sets = Sets::read(&overrides.set)?;
    let document = Document::new(file, text, &sets);
    let table = document.parse()?;
    let mut top = document.top(&table);
    let kind_line = top.value("kind").and_then(|kind| top.line_of(kind));
    let _ = top.text("about")?;
    let seed = top.whole("seed")?.map_or(1, |seed| seed.value);
    let (duration, period) = (top.number(&DURATION)?, top.number(&PERIOD)?);
    let (step, horizon, rate) = (top.number(&STEP)?, top.number(&HORIZON)?, top.number(&RATE)?);
    let slots = top.whole("slots")?;
    let (ego_road, ego_after) = (top.text("ego_road")?, top.number(&EGO_AFTER)?);
    let traffic = traffic(&document, top.section("traffic")?)?;
    let radio = radio(top.section("channel")?)?;
    let wrong = wrong(top.section("wrong")?)?;
    let envelope = envelope::read(top.section("envelope")?, overrides.envelope)?;
    let sensors = sensors::fitted(top.section("sensors")?, overrides.range_sensors)?;
    let emergencies = emergencies(top.section("emergencies")?)?;
    let bus = bus::read(top.section("bus")?)?;
    let limits = limits(top.section("limits")?)?;
    let road_sections = counted(&document, "road", top.sections("road")?, ROADS, kind_line)?;
    let intersection_sections =
        counted(&document, "intersection", top.sections("intersection")?, INTERSECTIONS, kind_line)?;
    let [road_lines, intersection_lines] = [&road_sections, &intersection_sections].map(|sections| lines(sections));
    let roads = roads(&document, road_sections, &traffic)?;
    let intersections = intersections(&document, intersection_sections)?;
    let event_sections = top.sections("event")?.unwrap_or_default();
    top.finish()?;

    if rate.value * period.value > 1.0 {
        let cause = format!("{} messages a second do not fit ticks of {} s", rate.value, period.value);
        let remedy = format!("give `message_rate_hz` up to {}", 1.0 / period.value);
        return Err(document.error_at(rate.line.or(period.line), cause, remedy));
    }
    let slots = slots.map_or(Ok(ECU_PEERS), |slots| {
        let given = usize::try_from(slots.value).ok().filter(|given| (LEAST_SLOTS..=PEERS).contains(given));
        let cause = format!("`slots` is {}", slots.value);
        given.ok_or_else(|| document.error_at(slots.line, cause, format!("give from {LEAST_SLOTS} to {PEERS}")))
    })?;
    let ego_road = match &ego_road {
        None => 0,
        Some(name) => roads.iter().position(|road| road.name == name.value).ok_or_else(|| {
            let names: Vec<&str> = roads.iter().map(|road| road.name.as_str()).collect();
            let cause = format!("`ego_road` is {}, and there is no such road", quoted(&name.value));
            document.error_at(name.line, cause, format!("name one of {}", names.join(", ")))
        })?,
    };
    let mut corridor = Corridor {
        seed: overrides.seed.unwrap_or(seed),
        duration_s: duration.value,
        period_s: period.value,
        step_s: match overrides.step_s {
            Some(step_s) => STEP.check(step_s).map_err(|error| error.in_option("--step"))?,
            None => step.value,
        },
        horizon_s: horizon.value,
        message_rate_hz: rate.value,
        slots,
        ego_road,
        ego_after_s: ego_after.value,
        traffic,
        radio,
        wrong,
        envelope,
        sensors,
        emergencies,
        bus,
        events: Vec::new(),
        limits,
        roads,
        intersections,
    };
    fit::check(&corridor).map_err(|misfit| {
        let line = match misfit.part {
            Part::Road(road) => road_lines[road],
            Part::Intersection(intersection) => intersection_lines[intersection],
        };
        document.error_at(line, misfit.cause, misfit.remedy)
    })?;
    if !event_sections.is_empty() {
        corridor.events = event::read(&document, event_sections, &fleet(&corridor))?;
    }
    Ok(corridor)
}

/// What an event of a corridor is checked against: its trips.
#[must_use]
pub fn fleet(corridor: &Corridor) -> Fleet {
    let (trips, _) = of_seed(corridor, corridor.seed);
    Fleet::fitted((0..trips.len()).map(|trip| is_fitted(corridor.sensors.share, corridor.seed, trip as u32)).collect())
}

fn traffic(document: &Document, mut section: Section) -> Result<Traffic, Error> {
    let entry = section.span(&ENTRY)?.map(|entry| entry.value);
    let (vans, buses) = (section.number(&VANS)?, section.number(&BUSES)?);
    let traffic = Traffic {
        target_speed_mps: section.number(&TARGET)?.value,
        entry_speed_mps: entry.unwrap_or(Span { low: 9.0, high: 11.0 }),
        time_gap_s: section.number(&TIME_GAP)?.value,
        silent_time_gap_s: section.number(&SILENT_TIME_GAP)?.value,
        standstill_m: section.number(&STANDSTILL)?.value,
        catch_up: section.number(&CATCH_UP)?.value,
        feed_forward: section.number(&FEED_FORWARD)?.value,
        headway_s: section.number(&HEADWAY)?.value,
        appear_m: section.number(&APPEAR)?.value,
        leave_m: section.number(&LEAVE)?.value,
        vans: vans.value,
        buses: buses.value,
        without_passes: section.number(&WITHOUT_PASSES)?.value,
    };
    section.finish()?;
    if vans.value + buses.value > 1.0 {
        let cause = format!("vans and buses together are {} of all vehicles", vans.value + buses.value);
        return Err(document.error_at(buses.line.or(vans.line), cause, "give shares that come to at most 1"));
    }
    Ok(traffic)
}

fn radio(mut section: Section) -> Result<Radio, Error> {
    let radio = Radio {
        delay_mean_s: section.number(&DELAY_MEAN)?.value,
        delay_std_s: section.number(&DELAY_STD)?.value,
        loss: section.number(&LOSS)?.value,
        range_m: section.number(&RANGE)?.value,
        dark_s: section.number(&DARK)?.value,
        repeats_hz: section.number(&REPEATS)?.value,
    };
    section.finish()?;
    Ok(radio)
}

fn wrong(mut section: Section) -> Result<Wrong, Error> {
    let wrong = Wrong {
        mass_scale: section.number(&MASS)?.value,
        grade: section.number(&GRADE)?.value,
        headwind_mps: section.number(&WIND)?.value,
        lag_scale: section.number(&LAG)?.value,
    };
    section.finish()?;
    Ok(wrong)
}

fn emergencies(mut section: Section) -> Result<Emergencies, Error> {
    let emergencies = Emergencies {
        share: section.number(&EMERGENCIES)?.value,
        stands_s: section.number(&STANDS)?.value,
        faults: section.number(&FAULTS)?.value,
        driver_after_s: section.number(&DRIVER)?.value,
    };
    section.finish()?;
    Ok(emergencies)
}

/// A limit that the file leaves out is not checked.
fn limits(mut section: Section) -> Result<Limits, Error> {
    let error = section.number(&ERROR_LIMIT)?;
    let ratio = section.number(&RATIO_LIMIT)?;
    let limits = Limits {
        position_error_m: error.line.map(|_| error.value),
        travel_time_ratio: ratio.line.map(|_| ratio.value),
        full_stops: section.whole("full_stops")?.map(|most| most.value),
    };
    section.finish()?;
    Ok(limits)
}

fn roads(document: &Document, sections: Vec<Section>, traffic: &Traffic) -> Result<Vec<RoadPlan>, Error> {
    let mut roads: Vec<RoadPlan> = Vec::new();
    for mut section in sections {
        let line = section.line();
        let name = name(document, &mut section)?;
        let points = section.pairs(&DEGREES)?.ok_or_else(|| missing(document, line, "points"))?;
        let (at, points) = (points.line, points.value.iter().map(|pair| point(pair.value)).collect::<Vec<_>>());
        let right_m = section.number(&RIGHT)?.value;
        let corner_m = section.number(&CORNER)?.value;
        let rate = section.number(&PER_MINUTE)?;
        section.finish()?;
        if roads.iter().any(|road| road.name == name) {
            let cause = format!("there is another road {}", quoted(&name));
            return Err(document.error_at(line, cause, "give each a name of its own"));
        }
        let moves = |pair: &[Point]| Shift::between(pair[0], pair[1]).length_m() > 1.0;
        if points.len() < 2 || !points.windows(2).all(moves) || points.iter().any(|point| point.latitude.abs() > 60.0) {
            let remedy = "give two or more points [north, east] in degrees, each more than a metre from the one before, \
                          at up to 60 degrees of latitude";
            return Err(document.error_at(at, format!("`points` of {} make no road", quoted(&name)), remedy));
        }
        let most = 60.0 / traffic.headway_s;
        if rate.value >= most {
            let cause = format!("{} vehicles a minute do not fit a `headway_s` of {}", rate.value, traffic.headway_s);
            return Err(document.error_at(rate.line.or(line), cause, format!("give less than {most:.1}")));
        }
        roads.push(RoadPlan { name, points, right_m, corner_m, vehicles_per_min: rate.value });
    }
    Ok(roads)
}

fn intersections(document: &Document, sections: Vec<Section>) -> Result<Vec<IntersectionPlan>, Error> {
    let mut intersections = Vec::new();
    for mut section in sections {
        let line = section.line();
        let name = name(document, &mut section)?;
        let wanted = "give the two numbers [north, east] in degrees";
        let at = section.two(&Number { key: "at", ..DEGREES })?;
        let at = at.ok_or_else(|| document.error_at(line, format!("{} has no `at`", quoted(&name)), wanted))?;
        let half_m = section.number(&HALF)?.value;
        section.finish()?;
        intersections.push(IntersectionPlan { name, at: point(at.value), half_m });
    }
    Ok(intersections)
}

fn name(document: &Document, section: &mut Section) -> Result<String, Error> {
    let line = section.line();
    section.text("name")?.map(|name| name.value).ok_or_else(|| missing(document, line, "name"))
}

fn missing(document: &Document, line: Option<u64>, key: &str) -> Error {
    document.error_at(line, format!("`{key}` is missing"), "add it; scenarios/corridor.toml shows how")
}

/// The sections of one name, from 1 to `most`. An error of too many names the line of the first one too many. An error
/// of none names the line of the file's kind.
fn counted<'a>(
    document: &Document,
    what: &str,
    sections: Option<Vec<Section<'a>>>,
    most: usize,
    kind_line: Option<u64>,
) -> Result<Vec<Section<'a>>, Error> {
    let sections = sections.unwrap_or_default();
    if (1..=most).contains(&sections.len()) {
        return Ok(sections);
    }
    let line = sections.get(most).map_or(kind_line, Section::line);
    let (cause, remedy) = match sections.len() {
        0 => (format!("there is no [[{what}]], and a corridor needs one"), format!("add from 1 to {most}")),
        many => (format!("there are {many} [[{what}]]"), format!("give at most {most}")),
    };
    Err(document.error_at(line, cause, remedy))
}

fn lines(sections: &[Section]) -> Vec<Option<u64>> {
    sections.iter().map(Section::line).collect()
}

fn point([latitude, longitude]: [f64; 2]) -> Point {
    Point { latitude, longitude }
}
