//! The tables of keys in `docs/JSON.md`: the Markdown enters; which keys a command's JSON has leaves, and what of a JSON is not as
//! said.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::Value;

/// By heading, the keys of its table, and of which other heading's keys each is an object, if it is.
pub struct Documents(BTreeMap<String, Vec<(String, Option<String>)>>);

impl Documents {
    pub fn read() -> Self {
        let mut sections: BTreeMap<String, Vec<(String, Option<String>)>> = BTreeMap::new();
        let tables = std::fs::read_to_string("../docs/JSON.md").unwrap();
        let mut heading = String::new();
        for line in tables.lines() {
            if let Some(title) = line.strip_prefix('#') {
                heading = title.trim_start_matches('#').replace('`', "").trim().to_owned();
            } else if let Some(row) = line.strip_prefix("| `") {
                let (keys, what) = row.split_once("` | ").unwrap_or_else(|| panic!("{line}"));
                // The words between two backticks; what is between them and the next are commas.
                let keys = keys.split("`, `").map(str::to_owned);
                let section = sections.entry(heading.clone()).or_default();
                section.extend(keys.map(|key| (key, link(what))));
            }
        }
        Self(sections)
    }

    /// All keys under a heading, those of the objects that it refers to included.
    pub fn keys(&self, heading: &str) -> BTreeSet<String> {
        let section = self.0.get(heading).unwrap_or_else(|| panic!("no table under `{heading}`"));
        let of = |(key, object): &(String, Option<String>)| match object {
            Some(object) => self.keys(object).iter().map(|inner| format!("{key}.{inner}")).collect(),
            None => vec![key.clone()],
        };
        section.iter().flat_map(of).collect()
    }
}

/// The heading that `[text](#heading)` leads to.
fn link(what: &str) -> Option<String> {
    let (_, rest) = what.split_once("](")?;
    let (address, _) = rest.split_once(')')?;
    Some(address.split_once('#')?.1.to_owned())
}

/// What of these values is not in the table, and what of the table is in none of them.
pub fn differences(documented: &BTreeSet<String>, values: &[Value]) -> Vec<String> {
    let (mut present, mut empty) = (BTreeSet::new(), BTreeSet::new());
    values.iter().for_each(|value| collect(value, "", &mut present, &mut empty));
    let is_said = |path: &String| documented.iter().any(|key| matches(key, path));
    let begins = |path: &String| documented.iter().any(|key| matches(key, path) || leads_to(path, key));
    let unsaid = present.iter().filter(|path| !is_said(path)).map(|path| format!("{path} is not documented"));
    let unsaid =
        unsaid.chain(empty.iter().filter(|path| !begins(path)).map(|path| format!("{path} is not documented")));
    let is_there = |key: &&String| !present.iter().chain(&empty).any(|path| matches(key, path));
    unsaid.chain(documented.iter().filter(is_there).map(|key| format!("{key} is not in the JSON"))).collect()
}

/// The paths of all values that are not objects or lists of them, and of those that are empty or `null`.
fn collect(value: &Value, path: &str, present: &mut BTreeSet<String>, empty: &mut BTreeSet<String>) {
    match value {
        Value::Object(members) if !members.is_empty() => members.iter().for_each(|(key, inner)| {
            let path = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
            collect(inner, &path, present, empty);
        }),
        Value::Array(items) if items.iter().any(Value::is_object) => {
            items.iter().for_each(|item| collect(item, &format!("{path}[]"), present, empty));
        }
        Value::Object(_) | Value::Null => drop(empty.insert(path.to_owned())),
        Value::Array(items) if items.is_empty() => drop(empty.insert(path.to_owned())),
        _ => drop(present.insert(path.to_owned())),
    }
}

/// Part by part; `<...>` is any name.
fn matches(key: &str, path: &str) -> bool {
    let (keys, parts): (Vec<&str>, Vec<&str>) = (key.split('.').collect(), path.split('.').collect());
    keys.len() == parts.len() && keys.iter().zip(&parts).all(|(key, part)| key.starts_with('<') || key == part)
}

/// Whether a documented key is one of the objects or of the list at that path.
fn leads_to(path: &str, key: &str) -> bool {
    let bare = |part: &str| part.trim_end_matches("[]").to_owned();
    let (keys, parts): (Vec<&str>, Vec<&str>) = (key.split('.').collect(), path.split('.').collect());
    parts.len() <= keys.len()
        && keys.iter().zip(&parts).all(|(key, part)| key.starts_with('<') || bare(key) == bare(part))
}
