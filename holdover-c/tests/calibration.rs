//! The table of the configuration in `docs/INTEGRATION.md`: every field is in it, with its default, and its range is the one
//! that is checked.

use std::ffi::c_void;
use std::mem::MaybeUninit;

use holdover_c::{Config, HOLDOVER_UNIT_SIZE, Status, holdover_default_config, holdover_init};

struct Field {
    name: String,
    get: fn(&Config) -> u64,
    set: fn(&mut Config, u64),
}

macro_rules! fields {
    ($($($part:ident).+),* $(,)?) => {
        vec![$(Field {
            name: stringify!($($part).+).replace(' ', ""),
            get: |config| u64::from(config.$($part).+),
            set: |config, value| config.$($part).+ = value.try_into().expect("the range fits the field"),
        }),*]
    };
}

fn fields() -> Vec<Field> {
    fields![
        station,
        station_id,
        range_sensor,
        base_id,
        period_us,
        length_mm,
        lag_ms,
        limits.acceleration_mm_s2,
        limits.braking_mm_s2,
        limits.jerk_mm_s3,
        limits.emergency_braking_mm_s2,
        body.mass_kg,
        body.ratio_milli,
        body.drag_milli,
        body.friction_milli,
        body.mechanical_n,
        correction,
        passes,
        law.time_gap_ms,
        law.silent_time_gap_ms,
        law.standstill_mm,
        law.gain_table,
        law.gain_milli,
        law.damping_ms,
        law.feed_forward_milli,
        law.free_road_acceleration_mm_s2,
        law.target_speed_mm_s,
        law.catch_up_milli,
        law.max_speed_mm_s,
        prediction.step_us,
        prediction.horizon_us,
        prediction.model.lag,
        prediction.model.limits,
        prediction.model.last_demand,
        prediction.model.standstill,
        prediction.model.trapezoid,
        prediction.model.interpolate,
        prediction.model.stamped,
        prediction.model.endless,
        prediction.model.received,
        prediction.model.smooth,
        link.period_us,
        link.tolerance_us,
        link.stale_us,
        link.future_us,
        link.clock_error_us,
        link.slot_reuse_us,
        link.holdover_us,
        link.ego_timeout_us,
        link.request_timeout_us,
        link.sync_timeout_us,
        link.assumed_delay_us,
        envelope.engaged,
        envelope.acceleration_mm_s2,
        envelope.braking_mm_s2,
        envelope.jerk_mm_s3,
        envelope.speed_mm_s,
        envelope.margin_mm,
        envelope.delay_us,
        envelope.lag_tolerance_milli,
    ]
}

fn default() -> Config {
    let mut config = MaybeUninit::uninit();
    // SAFETY: the place is there, and the call fills it in.
    unsafe {
        assert_eq!(holdover_default_config(config.as_mut_ptr()), Status::Ok);
        config.assume_init()
    }
}

fn check(config: &Config) -> Status {
    let mut memory = vec![0u64; HOLDOVER_UNIT_SIZE / 8];
    // SAFETY: the memory is as large as said.
    unsafe { holdover_init(memory.as_mut_ptr().cast::<c_void>(), HOLDOVER_UNIT_SIZE, config) }
}

/// A row of the table.
struct Row {
    name: String,
    low: u64,
    high: Option<u64>,
    default: u64,
}

fn number(text: &str) -> Option<u64> {
    text.trim().replace(',', "").parse().ok()
}

/// The rows whose first cell is the name of a field.
fn rows() -> Vec<Row> {
    let manual = include_str!("../../docs/INTEGRATION.md");
    let section = manual.split("## Calibration").nth(1).unwrap().split("\n## ").next().unwrap();
    let row = |line: &str| {
        let cells: Vec<_> = line.trim_matches('|').split('|').map(str::trim).collect();
        let [name, _unit, range, default, _meaning] = cells[..] else { return None };
        let name = name.strip_prefix('`')?.strip_suffix('`')?.to_owned();
        let (low, high) = match range.split_once(" to ") {
            Some((low, high)) => (number(low), Some(number(high).unwrap_or_else(|| panic!("{line}")))),
            None => (range.strip_suffix(" and up").and_then(number), None),
        };
        Some(Row { low: low.unwrap_or_else(|| panic!("{line}")), high, default: number(default).unwrap(), name })
    };
    section.lines().filter_map(row).collect()
}

/// A configuration with this value, and with what else has to be different for its whole range to be possible.
fn with(field: &Field, value: u64) -> Config {
    let mut config = default();
    match &*field.name {
        "limits.acceleration_mm_s2" => config.law.free_road_acceleration_mm_s2 = 100,
        "limits.emergency_braking_mm_s2" => (config.limits.braking_mm_s2, config.envelope.engaged) = (1, 0),
        // The envelope has narrower ranges of its own for these two.
        "lag_ms" => config.envelope.engaged = 0,
        "prediction.step_us" => config.prediction.horizon_us = 2_000_000.min(2 * value as u32),
        _ => {}
    }
    (field.set)(&mut config, value);
    config
}

#[test]
fn the_table_has_every_field_once_and_in_its_order() {
    let names: Vec<_> = rows().into_iter().map(|row| row.name).collect();
    let fields: Vec<_> = fields().into_iter().map(|field| field.name).collect();
    assert_eq!(names, fields);
    let header = include_str!("../holdover.h");
    let structs = ["body", "config", "envelope", "law", "limits", "link", "model", "prediction"];
    let is_field = |line: &&str| line.starts_with("  uint") && line.ends_with(';');
    let count = |name: &str| {
        let body = header.split(&format!("typedef struct holdover_{name}_t {{")).nth(1).unwrap();
        body.split('}').next().unwrap().lines().filter(is_field).count()
    };
    assert_eq!(fields.len(), structs.into_iter().map(count).sum::<usize>());
}

#[test]
fn the_table_has_the_defaults() {
    let config = default();
    for (row, field) in rows().iter().zip(fields()) {
        assert_eq!(row.default, (field.get)(&config), "{}", row.name);
    }
    assert_eq!(check(&config), Status::Ok);
}

#[test]
fn a_value_is_taken_at_both_ends_of_its_range_and_refused_beyond() {
    for (row, field) in rows().iter().zip(fields()) {
        assert_eq!(check(&with(&field, row.low)), Status::Ok, "{} = {}", row.name, row.low);
        if row.low > 0 {
            let below = check(&with(&field, row.low - 1)) as i32;
            assert!((-63..=-32).contains(&below), "{} = {}: {below}", row.name, row.low - 1);
        }
        let highest = row.high.unwrap_or(u64::from(u32::MAX));
        assert_eq!(check(&with(&field, highest)), Status::Ok, "{} = {highest}", row.name);
        if let Some(high) = row.high
            && !["station", "station_id"].contains(&&*field.name)
        {
            let above = check(&with(&field, high + 1)) as i32;
            assert!((-63..=-32).contains(&above), "{} = {}: {above}", row.name, high + 1);
        }
    }
}

#[test]
fn the_manual_has_the_sizes() {
    let manual = include_str!("../../docs/INTEGRATION.md");
    let row = |name: &str, size: usize| {
        let row = manual.lines().find(|line| line.starts_with(&format!("| {name}"))).unwrap();
        assert_eq!(row.split('|').nth(2).and_then(|cell| number(cell.split('(').next()?)), Some(size as u64), "{row}");
    };
    row("unit: 8 peers", HOLDOVER_UNIT_SIZE);
    row("`holdover_answer_t`", size_of::<holdover_c::Answer>());
    row("`holdover_config_t`", size_of::<Config>());
}
