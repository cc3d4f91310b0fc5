//! From the keys of a scenario file to a checked [`Scenario`]: text and command line enter; a scenario or an error
//! leaves.

use super::driver::{self, Driver};
use super::keys::{Document, Found, Number, Section, whole};
use super::set::Sets;
use super::{
    Fleet, Leader, MAX_VEHICLES, Overrides, Scenario, SensorShare, Span, Start, Vehicle, bus, envelope, event, plant,
    sensors, start,
};
use crate::error::{Error, quoted};
use crate::input::impairment::{AppliesTo, ChannelModel, Impairment, Window};
use crate::input::recording::{ChannelTrace, Motion};
use holdover::wire::Identifiers;
use std::fs::File;
use std::path::{Path, PathBuf};
use toml::de::DeValue;

// The limits of published values are those of the messages. `scenarios/paper.toml` gives the reasons.
const PROGRAM: Number = Number { key: "program", unit: "seconds and m/s", limits: 0.0..=86_400.0, default: 0.0 };
const DURATION: Number = Number { key: "duration_s", unit: "seconds", limits: 2.0..=86_400.0, default: 20.0 };
const PERIOD: Number = Number { key: "period_s", unit: "seconds", limits: 0.001..=0.1, default: 0.01 };
const STEP: Number = Number { key: "step_s", unit: "seconds", limits: 0.001..=1.0, default: 0.03 };
const RATE: Number = Number { key: "message_rate_hz", unit: "Hz", limits: 0.1..=1000.0, default: 10.0 };
const TARGET: Number = Number { key: "target_speed_mps", unit: "m/s", limits: 0.0..=65.534, default: 11.0 };
const POSITION: Number = Number { key: "position_m", unit: "metres", limits: -1e6..=1e6, default: 0.0 };
const GAP: Number = Number { key: "gap_m", unit: "metres", limits: 0.1..=2000.0, default: 14.0 };
const SPEED: Number = Number { key: "speed_mps", unit: "m/s", limits: 0.0..=65.534, default: 10.0 };
const LENGTH: Number = Number { key: "length_m", unit: "metres", limits: 0.5..=40.95, default: 4.8 };
const LAG: Number = Number { key: "lag_s", unit: "seconds", limits: 0.0..=1.998, default: 0.3 };
const PLANT_LAG: Number = Number { key: "plant_lag_s", unit: "seconds", limits: 0.0..=5.0, default: 0.3 };
const TIME_GAP: Number = Number { key: "time_gap_s", unit: "seconds", limits: 0.1..=3.995, default: 1.0 };
const SILENT_TIME_GAP: Number = Number { key: "silent_time_gap_s", unit: "seconds", limits: 0.1..=3.995, default: 1.8 };
const CATCH_UP: Number = Number { key: "catch_up", unit: "a share", limits: 0.0..=0.75, default: 0.2 };
const FEED_FORWARD: Number = Number { key: "feed_forward", unit: "a share", limits: 0.0..=0.5, default: 0.0 };
const STANDSTILL: Number = Number { key: "standstill_m", unit: "metres", limits: 0.0..=10.23, default: 2.0 };
const DELAY_MEAN: Number = Number { key: "delay_mean_s", unit: "seconds", limits: 0.0..=10.0, default: 0.040 };
const DELAY_STD: Number = Number { key: "delay_std_s", unit: "seconds", limits: 0.0..=10.0, default: 0.0259 };
const LOSS: Number = Number { key: "loss", unit: "a share", limits: 0.0..=1.0, default: 0.1 };
const DUPLICATE: Number = Number { key: "duplicate", unit: "a share", limits: 0.0..=1.0, default: 0.0 };
const OUTAGES: Number = Number { key: "outages", unit: "seconds", limits: 0.0..=86_400.0, default: 0.0 };

pub const PAPER_VEHICLES: usize = 5;
const PAPER_EGO: usize = 2;
const PAPER_GAP: Span = Span { low: 12.0, high: 16.0 };
const PAPER_OUTAGES: [Window; 2] = [Window { from_s: 4.0, to_s: 6.0 }, Window { from_s: 6.0, to_s: 8.0 }];
/// Start speeds are within this of 10 m/s, or of the speed at which a recorded leader starts.
const SPEED_SPREAD_MPS: f64 = 1.0;

pub fn scenario(file: &Path, text: &str, overrides: &Overrides) -> Result<Scenario, Error> {
    let sets = Sets::read(&overrides.set)?;
    let document = Document::new(file, text, &sets);
    let table = document.parse()?;
    let mut top = document.top(&table);
    let _ = (top.value("kind"), top.text("about")?); // the kind has been read already

    let seed = top.whole("seed")?.map_or(1, |seed| seed.value);
    let duration = top.number(&DURATION)?;
    let period = top.number(&PERIOD)?;
    let step = top.number(&STEP)?;
    let rate = top.number(&RATE)?;
    let ego = top.whole("ego")?;
    let leader = leader(&document, top.section("leader")?, overrides)?;
    let vehicles = vehicles(&document, &mut top, leader.motion.as_ref(), overrides.range_sensors)?;
    let channel = top.section("channel")?;
    let line_of_ego = ego.as_ref().and_then(|ego| ego.line);
    let ego = index_of_ego(&document, ego, vehicles.len())?;
    if vehicles[ego].driver != Driver::Unit {
        let cause = format!("vehicle {ego} is the ego, and a person drives it");
        return Err(document.error_at(line_of_ego, cause, "give an `ego` that its unit drives"));
    }
    let channel = self::channel(&document, channel, overrides, ego, vehicles.len())?;
    let envelope = envelope::read(top.section("envelope")?, overrides.envelope)?;
    let bus = bus::read(top.section("bus")?)?;
    let events = top.sections("event")?.unwrap_or_default();
    let events = event::read(&document, events, &Fleet::of(&vehicles, &leader))?;
    top.finish()?;

    if rate.value * period.value > 1.0 {
        let cause = format!("{} messages a second do not fit ticks of {} s", rate.value, period.value);
        let remedy = format!("give `message_rate_hz` up to {}", 1.0 / period.value);
        return Err(document.error_at(rate.line.or(period.line), cause, remedy));
    }
    Ok(Scenario {
        seed: overrides.seed.unwrap_or(seed),
        duration_s: duration_s(&document, duration, leader.motion.as_ref())?,
        period_s: period.value,
        step_s: match overrides.step_s {
            Some(step_s) => STEP.check(step_s).map_err(|error| error.in_option("--step"))?,
            None => step.value,
        },
        message_rate_hz: rate.value,
        leader,
        vehicles,
        ego,
        channel,
        envelope,
        bus,
        events,
        identifiers: Identifiers::DEFAULT,
    })
}

/// Checks a prediction step.
pub fn step(step_s: f64) -> Result<f64, Error> {
    STEP.check(step_s)
}

fn duration_s(document: &Document, given: Found<f64>, motion: Option<&Motion>) -> Result<f64, Error> {
    let Some(motion) = motion else { return Ok(given.value) };
    let recorded = motion.duration_s();
    if given.line.is_none() {
        return Ok(recorded.min(*DURATION.limits.end()));
    }
    if given.value > recorded {
        let cause =
            format!("`duration_s` is {}, and the leader's recorded motion ends after {recorded} s", given.value);
        return Err(document.error_at(given.line, cause, "shorten it, or leave it out to drive the whole recording"));
    }
    Ok(given.value)
}

fn leader(document: &Document, mut section: Section, overrides: &Overrides) -> Result<Leader, Error> {
    let target_speed_mps = section.number(&TARGET)?.value;
    let program = program(document, &mut section)?;
    let named = section.path("motion")?;
    section.finish()?;
    let Some(file) = recording(document, "motion", named, overrides.leader_motion.as_ref())? else {
        return Ok(Leader { target_speed_mps, program, motion: None });
    };
    let motion = Motion::read(&file)?;
    let least = *DURATION.limits.start();
    if motion.duration_s() < least {
        let cause = format!("lasts only {} s", motion.duration_s());
        return Err(Error::new(cause, format!("give the leader a recording of at least {least} s")).in_file(&file));
    }
    Ok(Leader { target_speed_mps, program, motion: Some(motion) })
}

fn program(document: &Document, section: &mut Section) -> Result<Vec<(f64, f64)>, Error> {
    let Some(pairs) = section.pairs(&PROGRAM)? else { return Ok(Vec::new()) };
    let mut program: Vec<(f64, f64)> = Vec::new();
    for Found { value: [at_s, speed_mps], line } in pairs.value {
        let is_later = program.last().is_none_or(|(last_s, _)| at_s > *last_s);
        if !is_later || !TARGET.limits.contains(&speed_mps) {
            let cause = format!("`program` wants {speed_mps} m/s from {at_s} s on");
            let remedy = format!("give later and later times, each with a speed up to {} m/s", TARGET.limits.end());
            return Err(document.error_at(line, cause, remedy));
        }
        program.push((at_s, speed_mps));
    }
    Ok(program)
}

/// The file of a recording: the one that the command line names, or else the one that the scenario names, if it can be
/// read.
fn recording(
    document: &Document,
    key: &str,
    named: Option<Found<PathBuf>>,
    instead: Option<&PathBuf>,
) -> Result<Option<PathBuf>, Error> {
    match (instead, named) {
        (Some(file), _) => Ok(Some(file.clone())),
        (None, None) => Ok(None),
        (None, Some(Found { value: file, line })) => match File::open(&file) {
            Ok(_) => Ok(Some(file)),
            Err(error) => {
                let missing = Error::unreadable(&file, &error);
                let cause = format!("`{key}` names {}, which {}", quoted(&file.to_string_lossy()), missing.cause());
                Err(document.error_at(line, cause, "check the path (a relative one starts from this file's folder)"))
            }
        },
    }
}

fn vehicles(
    document: &Document,
    top: &mut Section,
    motion: Option<&Motion>,
    said: Option<SensorShare>,
) -> Result<Vec<Vehicle>, Error> {
    let recorded_mps = motion.map(|motion| motion.rows()[0].speed_mps.max(0.0));
    let middle = recorded_mps.unwrap_or(SPEED.default);
    let spread =
        Span { low: (middle - SPEED_SPREAD_MPS).max(0.0), high: (middle + SPEED_SPREAD_MPS).min(*SPEED.limits.end()) };
    let sections = match top.sections("vehicle")? {
        Some(sections) => sections,
        None => (0..PAPER_VEHICLES).map(|_| document.nothing()).collect(),
    };
    let lines: Vec<_> = sections.iter().map(Section::line).collect();
    if !(2..=MAX_VEHICLES).contains(&sections.len()) {
        let cause = format!("{} [[vehicle]] make no scenario", sections.len());
        let line = lines.get(MAX_VEHICLES).or(lines.last()).copied().flatten();
        return Err(document.error_at(
            line,
            cause,
            format!("give from 2 to {MAX_VEHICLES}, or none for the paper's five"),
        ));
    }
    let mut vehicles = Vec::new();
    for (index, section) in sections.into_iter().enumerate() {
        let drives = if index > 0 { Drives::Behind } else { Drives::first(motion.is_some()) };
        vehicles.push(vehicle(document, section, drives, spread, said.map(|share| share.has(index)))?);
    }
    start::check(&vehicles).map_err(|start::Misplaced { vehicle, cause, remedy }| {
        document.error_at(lines.get(vehicle).copied().flatten(), cause, remedy)
    })?;
    if let Some(recorded_mps) = recorded_mps {
        vehicles[0].speed_mps = Span { low: recorded_mps, high: recorded_mps };
    }
    Ok(vehicles)
}

/// The motion of a vehicle.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Drives {
    /// It leads on a free road.
    Freely,
    /// It leads on a recording.
    Recording,
    /// It follows another vehicle.
    Behind,
}

impl Drives {
    fn first(is_recorded: bool) -> Self {
        if is_recorded { Self::Recording } else { Self::Freely }
    }
}

fn vehicle(
    document: &Document,
    mut section: Section,
    drives: Drives,
    speeds: Span,
    said: Option<bool>,
) -> Result<Vehicle, Error> {
    let position = section.span(&POSITION)?;
    let gap = section.span(&GAP)?;
    let start = match (position, gap) {
        (Some(position), None) => Start::Position(position.value),
        (None, Some(gap)) if drives != Drives::Behind => {
            let cause = "the leader (vehicle 0) has a `gap_m`, and nobody is ahead of it";
            return Err(document.error_at(gap.line, cause, "give it `position_m`, or neither"));
        }
        (None, Some(gap)) => Start::Gap(gap.value),
        (Some(_), Some(gap)) => {
            let cause = "a vehicle with `position_m` has a `gap_m` too";
            return Err(document.error_at(gap.line, cause, "remove one of the two"));
        }
        (None, None) => Start::Gap(PAPER_GAP),
    };
    let speed_mps = section.span(&SPEED)?.map_or(speeds, |speed| speed.value);
    let kind = plant::kind(&mut section)?;
    let lag_s = section.number(&Number { default: kind.lag_s(), ..LAG })?.value;
    let plant_lag = section.number(&PLANT_LAG)?;
    let vehicle = Vehicle {
        start,
        speed_mps,
        kind,
        length_m: section.number(&Number { default: kind.length_m(), ..LENGTH })?.value,
        lag_s,
        plant_lag_s: if plant_lag.line.is_some() { plant_lag.value } else { lag_s },
        difference: plant::difference(section.section("plant")?)?,
        time_gap_s: section.number(&TIME_GAP)?.value,
        silent_time_gap_s: section.number(&SILENT_TIME_GAP)?.value,
        standstill_m: section.number(&STANDSTILL)?.value,
        catch_up: section.number(&CATCH_UP)?.value,
        feed_forward: section.number(&FEED_FORWARD)?.value,
        driver: driver::driver(document, &mut section, drives == Drives::Behind)?,
        accuracy: sensors::accuracy(&mut section, drives == Drives::Recording)?,
        range_sensor: sensors::range_sensor(document, &mut section, drives == Drives::Behind, said)?,
    };
    section.finish()?;
    Ok(vehicle)
}

fn index_of_ego(document: &Document, given: Option<Found<u64>>, vehicles: usize) -> Result<usize, Error> {
    let last = vehicles - 1;
    let Some(given) = given else { return Ok(PAPER_EGO.min(last)) };
    match usize::try_from(given.value) {
        Ok(ego) if (1..=last).contains(&ego) => Ok(ego),
        _ => {
            let cause = format!("`ego` is {}, which follows nobody", given.value);
            Err(document.error_at(given.line, cause, format!("give an index from 1 to {last} (0 is the leader)")))
        }
    }
}

fn channel(
    document: &Document,
    mut section: Section,
    overrides: &Overrides,
    ego: usize,
    vehicles: usize,
) -> Result<ChannelModel, Error> {
    let delay_mean = section.number(&DELAY_MEAN)?;
    let delay_std = section.number(&DELAY_STD)?;
    let loss = section.number(&LOSS)?;
    let duplicate = section.number(&DUPLICATE)?;
    let outages = outages(document, &mut section)?;
    let trace = section.path("trace")?;
    let applies_to = applies_to(&mut section, ego, vehicles)?;
    section.finish()?;

    let random = [delay_mean.line, delay_std.line, loss.line, duplicate.line, outages.line];
    if let (Some(trace), Some(line)) = (&trace, random.into_iter().flatten().min()) {
        let cause =
            format!("a recorded channel (`trace` in line {}) has no random one beside it", trace.line.unwrap_or(0));
        let remedy = "remove `trace`, or every delay, loss, duplicate and outages";
        return Err(document.error_at(Some(line), cause, remedy));
    }
    let impairment = match recording(document, "trace", trace, overrides.channel_trace.as_ref())? {
        Some(file) => Impairment::Recorded(ChannelTrace::read(&file)?),
        None => Impairment::Random {
            delay_mean_s: delay_mean.value,
            delay_std_s: delay_std.value,
            loss: loss.value,
            duplicate: duplicate.value,
            outages: outages.value,
        },
    };
    Ok(ChannelModel { impairment, applies_to })
}

fn outages(document: &Document, section: &mut Section) -> Result<Found<Vec<Window>>, Error> {
    let Some(pairs) = section.pairs(&OUTAGES)? else {
        return Ok(Found { value: PAPER_OUTAGES.to_vec(), line: None });
    };
    let windows = pairs.value.into_iter().map(|Found { value: [from_s, to_s], line }| {
        if from_s < to_s {
            return Ok(Window { from_s, to_s });
        }
        let cause = format!("an outage runs from {from_s} s to {to_s} s");
        Err(document.error_at(line, cause, "let it end after it begins"))
    });
    Ok(Found { value: windows.collect::<Result<_, _>>()?, line: pairs.line })
}

fn applies_to(section: &mut Section, ego: usize, vehicles: usize) -> Result<AppliesTo, Error> {
    const KEY: &str = "applies_to";
    let Some(value) = section.value(KEY) else { return Ok(AppliesTo::Vehicles(vec![ego])) };
    let wanted = format!("\"ego\", \"all\", or a list of indices from 0 to {}", vehicles - 1);
    match value.get_ref() {
        DeValue::String(word) if word == "ego" => Ok(AppliesTo::Vehicles(vec![ego])),
        DeValue::String(word) if word == "all" => Ok(AppliesTo::All),
        DeValue::Array(list) => {
            let indices = list.iter().map(|entry| {
                let index = whole(entry).and_then(|index| usize::try_from(index).ok());
                index.filter(|&index| index < vehicles).ok_or_else(|| section.mismatch(KEY, entry, &wanted))
            });
            Ok(AppliesTo::Vehicles(indices.collect::<Result<_, _>>()?))
        }
        _ => Err(section.mismatch(KEY, value, &wanted)),
    }
}
