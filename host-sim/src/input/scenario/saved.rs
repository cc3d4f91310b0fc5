//! A scenario as a file of its own: the text that it came from, what the command line set, and the events of a run enter; a text leaves
//! that `run` reads as the same scenario with these events.

use std::fmt::Write;
use std::path::Path;

use toml::de::{DeTable, DeValue};
use toml::{Table, Value};

use super::Overrides;
use super::event::Event;
use super::keys::Document;
use super::set::Sets;
use crate::error::Error;

/// A run is no shorter than this, in seconds.
const SHORTEST_S: f64 = 2.0;
/// In a corridor vehicles arrive for no shorter time than this.
const SHORTEST_CORRIDOR_S: f64 = 10.0;

/// The text. Of the overrides the seed and what is set count. Recordings are named by their whole paths.
///
/// # Errors
/// The errors of [`Scenario::parse`](super::Scenario::parse), and a recording that has gone.
pub fn text(
    (file, text): (&Path, &str),
    overrides: &Overrides,
    events: &[Event],
    duration_s: f64,
) -> Result<String, Error> {
    let sets = Sets::read(&overrides.set)?;
    let document = Document::new(file, text, &sets);
    let mut table = owned(&document.parse()?)?;
    table.remove("event");
    if let Some(seed) = overrides.seed {
        table.insert("seed".into(), Value::Integer(i64::try_from(seed).map_err(|_| too_large(seed))?));
    }
    let is_corridor = table.get("kind").and_then(Value::as_str) == Some("corridor");
    let shortest_s = if is_corridor { SHORTEST_CORRIDOR_S } else { SHORTEST_S };
    table.insert("duration_s".into(), Value::Float(duration_s.max(shortest_s)));
    for (section, key) in [("leader", "motion"), ("channel", "trace")] {
        let named = table.get_mut(section).and_then(|section| section.get_mut(key));
        if let Some(Value::String(path)) = named {
            let found = file.parent().unwrap_or(Path::new("")).join(&*path);
            let whole = found.canonicalize().map_err(|error| Error::unreadable(&found, &error))?;
            *path = whole.to_string_lossy().into_owned();
        }
    }
    let mut text = toml::to_string(&table).map_err(|error| Error::new(error.to_string(), "report this"))?;
    for event in events {
        let _ = write!(text, "\n{}", event.toml()); // writing to a String cannot fail
    }
    Ok(text)
}

fn too_large(seed: u64) -> Error {
    Error::new(format!("the seed {seed} does not fit into TOML"), format!("give one up to {}", i64::MAX))
}

fn owned(table: &DeTable<'_>) -> Result<Table, Error> {
    table.iter().map(|(key, value)| Ok((key.get_ref().to_string(), value_of(value.get_ref())?))).collect()
}

fn value_of(value: &DeValue<'_>) -> Result<Value, Error> {
    let unread = |text: &str| Error::new(format!("{text} is no number"), "correct it");
    Ok(match value {
        DeValue::String(text) => Value::String(text.to_string()),
        DeValue::Integer(whole) => {
            Value::Integer(i64::from_str_radix(whole.as_str(), whole.radix()).map_err(|_| unread(whole.as_str()))?)
        }
        DeValue::Float(number) => Value::Float(number.as_str().parse().map_err(|_| unread(number.as_str()))?),
        DeValue::Boolean(flag) => Value::Boolean(*flag),
        DeValue::Datetime(time) => Value::Datetime(*time),
        DeValue::Array(list) => {
            Value::Array(list.iter().map(|value| value_of(value.get_ref())).collect::<Result<_, _>>()?)
        }
        DeValue::Table(table) => Value::Table(owned(table)?),
    })
}
