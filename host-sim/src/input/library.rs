//! The scenarios that come with the program: a name or a path enters; the text of a scenario and its kind leave.

use std::path::{Path, PathBuf};

use serde::Serialize;
use toml::de::{DeTable, DeValue};

use crate::error::{Error, quoted};

/// A scenario that comes with the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    /// Its name on the command line.
    pub name: &'static str,
    /// The text of its file.
    pub text: &'static str,
}

macro_rules! entries {
    ($($name:literal),+ $(,)?) => {
        &[$(Entry { name: $name, text: include_str!(concat!("../../scenarios/", $name, ".toml")) }),+]
    };
}

/// All scenarios of the library; the files are in `scenarios/`.
pub const LIBRARY: &[Entry] = entries![
    "paper",
    "corridor",
    "motorway",
    "merge",
    "stop-and-go",
    "storm",
    "wrong-lag",
    "wrong-mass",
    "wrong-grade",
    "wrong-wind",
    "wrong",
    "vans",
    "buses",
    "on-ramp",
    "turns",
];

/// The kind of a scenario.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A string of vehicles.
    String,
    /// Roads that cross.
    Corridor,
}

/// The file at a path, or the scenario of a name: its place, as errors name it, and its text.
///
/// # Errors
/// There is neither, or the file is not text.
pub fn text(named: &Path) -> Result<(PathBuf, String), Error> {
    match std::fs::read(named) {
        Ok(bytes) => {
            let text = String::from_utf8(bytes).map_err(|_| {
                let remedy = "give a scenario in TOML, such as scenarios/paper.toml";
                Error::new("is not a text file", remedy).in_file(named)
            })?;
            Ok((named.to_owned(), text))
        }
        Err(error) => match LIBRARY.iter().find(|entry| named.to_str() == Some(entry.name)) {
            Some(entry) => Ok((PathBuf::from(format!("scenarios/{}.toml", entry.name)), entry.text.to_owned())),
            None => Err(unknown(named).unwrap_or_else(|| Error::unreadable(named, &error))),
        },
    }
}

/// The error of a name that is neither a file nor in the library; `None` for a path.
fn unknown(named: &Path) -> Option<Error> {
    let name = named.to_str().filter(|name| !named.exists() && !name.contains(['/', '.']))?;
    let likeness = |entry: &Entry| strsim::jaro_winkler(name, entry.name);
    let best = LIBRARY.iter().max_by(|a, b| likeness(a).total_cmp(&likeness(b))).filter(|best| likeness(best) > 0.8);
    let names: Vec<&str> = LIBRARY.iter().map(|entry| entry.name).collect();
    let remedy = match best {
        Some(best) => format!("did you mean {}?", quoted(best.name)),
        None => format!("give a file, or one of {}", names.join(", ")),
    };
    Some(Error::new(format!("{} is neither a file nor a scenario of the library", quoted(name)), remedy))
}

/// The scenario of a name in the library, as its file has it.
///
/// # Errors
/// There is none of that name.
pub fn show(name: &str) -> Result<&'static str, Error> {
    let entry = LIBRARY.iter().find(|entry| entry.name == name);
    let refused = || {
        let names: Vec<&str> = LIBRARY.iter().map(|entry| entry.name).collect();
        let remedy = format!("give one of {}", names.join(", "));
        let error = unknown(Path::new(name))
            .unwrap_or_else(|| Error::new(format!("{} is no scenario of the library", quoted(name)), remedy));
        error.in_option("--show")
    };
    entry.map(|entry| entry.text).ok_or_else(refused)
}

/// The kind of a scenario text; a string by default.
///
/// # Errors
/// The text names an unknown kind.
pub fn kind(file: &Path, text: &str) -> Result<Kind, Error> {
    // Text that is not TOML is left to the reader of the scenario, which reports the line.
    let Ok(table) = DeTable::parse(text) else { return Ok(Kind::String) };
    let Some((key, value)) = table.get_ref().get_key_value("kind") else { return Ok(Kind::String) };
    match value.get_ref() {
        DeValue::String(word) if word == "string" => Ok(Kind::String),
        DeValue::String(word) if word == "corridor" => Ok(Kind::Corridor),
        other => {
            let found = other.as_str().map_or("something else".into(), quoted);
            let line = 1 + text.as_bytes()[..key.span().start].iter().filter(|byte| **byte == b'\n').count() as u64;
            let error = Error::new(format!("`kind` is {found}"), "give \"string\" or \"corridor\"");
            Err(error.in_file(file).at_line(line))
        }
    }
}

/// The list of the scenarios, one line each.
#[must_use]
pub fn list() -> String {
    let width = LIBRARY.iter().map(|entry| entry.name.len()).max().unwrap_or(0);
    LIBRARY.iter().map(|entry| format!("{:width$}  {}\n", entry.name, entry.about())).collect()
}

/// A line of the list, as JSON.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Listed {
    /// The name on the command line.
    pub name: &'static str,
    /// What it is.
    pub about: String,
}

/// The list for JSON.
#[must_use]
pub fn listed() -> Vec<Listed> {
    LIBRARY.iter().map(|entry| Listed { name: entry.name, about: entry.about() }).collect()
}

impl Entry {
    /// What it is, as its file says.
    fn about(&self) -> String {
        let table = DeTable::parse(self.text).ok();
        let about = table.as_ref().and_then(|table| table.get_ref().get("about")?.get_ref().as_str());
        about.unwrap_or_default().to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_scenario_of_the_library_has_a_line_that_says_what_it_is() {
        assert_eq!(list().lines().count(), LIBRARY.len());
        assert!(list().lines().all(|line| line.split_whitespace().count() > 4), "{}", list());
    }

    #[test]
    fn a_kind_that_is_none_is_refused_in_its_line() {
        let file = Path::new("x.toml");
        assert_eq!(kind(file, "seed = 1"), Ok(Kind::String));
        assert_eq!(kind(file, "kind = \"corridor\""), Ok(Kind::Corridor));
        let error = kind(file, "seed = 1\nkind = \"ring\"").unwrap_err();
        assert_eq!(error.to_string(), "x.toml:2: `kind` is \"ring\"; give \"string\" or \"corridor\"");
    }
}
