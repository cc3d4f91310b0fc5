//! What the command line sets in a scenario: `key=value` enters, as often as it is given; the table of the file with these values leaves.
//! They are checked as if they stood in the file.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::validate::PAPER_VEHICLES;
use crate::error::{Error, quoted};

/// The list of which a file may leave out all.
const VEHICLES: &str = "vehicle";

/// The place of everything that the command line sets, behind every file.
const SPAN: Range<usize> = usize::MAX - 1..usize::MAX;
/// From here on a place is none in the file.
pub const SET_OFFSET: usize = SPAN.start;
/// The line of such a place.
pub const SET_LINE: u64 = u64::MAX;

/// Everything that is set, each as a line of TOML.
#[derive(Clone, Debug, Default)]
pub struct Sets {
    lines: Vec<String>,
}

impl Sets {
    /// Reads `key=value`. A value that is no TOML is a text, so that words need no quotes.
    ///
    /// # Errors
    /// No key, or no value.
    pub fn read(typed: &[String]) -> Result<Self, Error> {
        Ok(Self { lines: typed.iter().map(|typed| line(typed)).collect::<Result<_, _>>()? })
    }

    /// Puts the values into the table of a file, the later ones over the earlier ones.
    ///
    /// # Errors
    /// A key of something that has no such part.
    pub fn put_into<'a>(&'a self, table: &mut DeTable<'a>) -> Result<(), Error> {
        self.lines.iter().try_for_each(|line| {
            let set = DeTable::parse(line).map_err(|_| refused(line))?;
            merge(table, set.into_inner(), line)
        })
    }
}

/// `key=value` as a line of TOML.
fn line(typed: &str) -> Result<String, Error> {
    let (key, value) =
        typed.split_once('=').map(|(key, value)| (key.trim(), value.trim())).ok_or_else(|| refused(typed))?;
    if key == "kind" {
        let remedy = "give another scenario";
        return Err(Error::new("`kind` says what the other keys are, and cannot be set", remedy).in_option("--set"));
    }
    let escaped = value.replace('\\', "\\\\").replace('"', "\\\"");
    let lines = [format!("{key} = {value}"), format!("{key} = \"{escaped}\"")];
    let is_one_key =
        |line: &String| !typed.contains('\n') && DeTable::parse(line).is_ok_and(|table| table.get_ref().len() == 1);
    let found = if value.is_empty() { None } else { lines.into_iter().find(is_one_key) };
    found.ok_or_else(|| refused(typed))
}

fn refused(typed: &str) -> Error {
    Error::new(format!("is {}", quoted(typed)), "give KEY=VALUE, such as channel.loss=0.3").in_option("--set")
}

fn merge<'a>(table: &mut DeTable<'a>, set: DeTable<'a>, line: &str) -> Result<(), Error> {
    for (key, value) in set {
        match table.get_mut(key.get_ref().as_ref()) {
            Some(there) => put(there, value, line)?,
            None => {
                let value = if key.get_ref() == VEHICLES && value.get_ref().is_table() {
                    let mut list = left_out();
                    put(&mut list, value, line)?;
                    list
                } else {
                    placed(value)
                };
                table.insert(Spanned::new(SPAN, key.into_inner()), value);
            }
        }
    }
    Ok(())
}

/// The vehicles that a file leaves out: those of the paper, each with every value its default.
fn left_out<'a>() -> Spanned<DeValue<'a>> {
    let nothing = |_| Spanned::new(SPAN, DeValue::Table(DeTable::new()));
    Spanned::new(SPAN, DeValue::Array((0..PAPER_VEHICLES).map(nothing).collect()))
}

/// Puts a value over another one: a table into a table key by key, and into a list by the index.
fn put<'a>(there: &mut Spanned<DeValue<'a>>, value: Spanned<DeValue<'a>>, line: &str) -> Result<(), Error> {
    match (there.get_mut(), value.into_inner()) {
        (DeValue::Table(old), DeValue::Table(new)) => merge(old, new, line),
        (DeValue::Array(old), DeValue::Table(new)) => {
            for (key, value) in new {
                let count = old.len();
                let index = key.get_ref().parse::<usize>().ok();
                let part = index.and_then(|index| old.get_mut(index)).ok_or_else(|| {
                    let cause = format!("{} names {} of a list of {count}", quoted(line), quoted(key.get_ref()));
                    Error::new(cause, format!("give an index from 0 to {}", count.saturating_sub(1))).in_option("--set")
                })?;
                put(part, value, line)?;
            }
            Ok(())
        }
        (_, new) => {
            *there = placed(Spanned::new(SPAN, new));
            Ok(())
        }
    }
}

/// The same value, with every part of it in the place of what the command line sets.
fn placed(value: Spanned<DeValue<'_>>) -> Spanned<DeValue<'_>> {
    let inner = match value.into_inner() {
        DeValue::Table(table) => DeValue::Table(
            table.into_iter().map(|(key, value)| (Spanned::new(SPAN, key.into_inner()), placed(value))).collect(),
        ),
        DeValue::Array(list) => DeValue::Array(list.into_iter().map(placed).collect()),
        other => other,
    };
    Spanned::new(SPAN, inner)
}
