//! The rooms of the core in one order: a room imports from those before it and from none after it. Tests keep to it too.

use std::fs;
use std::path::{Path, PathBuf};

/// From the bottom up. Each folder or file of `src/` that the library is made of is one room.
const ORDER: [&str; 21] = [
    "polynomial", // for the proofs alone
    "fixed",
    "units",
    "time",
    "held",
    "health",
    "parameters",
    "wire",
    "clock",
    "model",
    "config",
    "dynamics",
    "envelope",
    "peers",
    "fusion",
    "estimator",
    "controller",
    "coordination",
    "passes",
    "unit",
    "lockstep",
];

/// The rooms that know neither one another nor the estimator.
const APART: [&str; 4] = ["controller", "coordination", "envelope", "estimator"];

fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|end| end == "rs") {
            found.push(path);
        }
    }
}

/// The room of a path below `src/`, or of an import below `crate::`.
fn place(name: &str) -> Option<usize> {
    ORDER.iter().position(|room| *room == name)
}

/// The rooms that a line of code names. Comments may point anywhere.
fn named(line: &str) -> impl Iterator<Item = &str> {
    let code = line.split("//").next().unwrap_or("");
    code.split("crate::")
        .skip(1)
        .map(|rest| rest.split(|c: char| !c.is_alphanumeric() && c != '_').next().unwrap_or(""))
}

#[test]
fn no_room_of_the_core_imports_from_one_above_it() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut found = Vec::new();
    sources(&src, &mut found);
    let (mut wrong, mut seen, mut imports) = (Vec::new(), [false; ORDER.len()], 0);
    for path in found {
        let below = path.strip_prefix(&src).unwrap();
        let room = below.iter().next().unwrap().to_str().unwrap().trim_end_matches(".rs");
        if ["lib", "main", "board"].contains(&room) {
            continue; // the list of the rooms, and the firmware, which is a crate of its own above them
        }
        let Some(own) = place(room) else {
            wrong.push(format!("src/{}: its room has no place in the order", below.display()));
            continue;
        };
        seen[own] = true;
        for (number, line) in fs::read_to_string(&path).unwrap().lines().enumerate() {
            for name in named(line) {
                imports += 1;
                let is_apart =
                    room != "estimator" && room != name && [room, name].iter().all(|one| APART.contains(one));
                if is_apart || place(name).is_none_or(|other| other > own) {
                    wrong.push(format!("src/{}:{}: {room} names crate::{name}", below.display(), number + 1));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "imports that run up, or across:\n{}", wrong.join("\n"));
    assert!(imports > 300, "only {imports} imports were found, so they are not looked for rightly");
    let empty: Vec<_> = ORDER.iter().zip(seen).filter(|(_, seen)| !seen).map(|(room, _)| room).collect();
    assert!(empty.is_empty(), "rooms that are not there: {empty:?}");
}

#[test]
fn an_import_in_code_is_found_and_one_in_a_comment_is_not() {
    assert_eq!(named("use crate::peers::{Sample, Track};").collect::<Vec<_>>(), ["peers"]);
    assert_eq!(
        named("    crate::fixed::quotient(a, crate::units::B) // crate::unit").collect::<Vec<_>>(),
        ["fixed", "units"]
    );
    assert_eq!(named("//! see [`crate::unit`]").count(), 0);
}
