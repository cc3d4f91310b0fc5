//! The floors of the simulator, as `src/lib.rs` draws them: imports go down only, and no rooms of a floor import one another
//! in a circle.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// From the top; below them are the flat files, which import nothing but one another.
const FLOORS: [&str; 7] = ["commands", "report", "roads", "measure", "sim", "bus", "input"];

/// A file: its path as a module, and its text without comments.
struct File {
    module: Vec<String>,
    text: String,
}

impl File {
    fn floor(&self) -> &str {
        &self.module[0]
    }

    /// The rooms below a floor, or below `crate`, that it names; those of tests too, if they count.
    fn imports(&self, and_tests: bool) -> Vec<Vec<String>> {
        let lines = self.text.lines().filter(|line| and_tests || !line.starts_with(' '));
        lines.flat_map(|line| self.of_line(line)).collect()
    }

    /// The modules in a line: `crate::a::b` as it stands, and `super::b` from where the file is.
    fn of_line(&self, line: &str) -> Vec<Vec<String>> {
        let mut found: Vec<Vec<String>> = line.split("crate::").skip(1).flat_map(paths).collect();
        if let Some(rest) = line.strip_prefix("use super::") {
            let ups = 1 + rest.matches("super::").count();
            let from = &self.module[..self.module.len().saturating_sub(ups)];
            found.extend(paths(&rest.replace("super::", "")).into_iter().map(|path| [from, &path].concat()));
        }
        found
    }
}

/// The paths in front of what follows them, to two modules deep: `a::b::C` and `{a, b::C}`.
fn paths(text: &str) -> Vec<Vec<String>> {
    let ends = |c: char| !(c.is_alphanumeric() || c == '_' || c == ':');
    let path = |text: &str| -> Vec<String> {
        let path = text.trim_start().split(ends).next().unwrap_or("");
        path.split("::").filter(|name| !name.is_empty()).take(2).map(str::to_owned).collect()
    };
    match text.trim_start().strip_prefix('{') {
        Some(several) => several.split(',').map(path).collect(),
        None => vec![path(text)],
    }
}

fn rank(floor: &str) -> usize {
    FLOORS.iter().position(|other| *other == floor).unwrap_or(FLOORS.len())
}

fn source() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src")
}

fn files() -> Vec<File> {
    let (mut folders, mut files) = (vec![source()], Vec::new());
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                files.push(path);
            }
        }
    }
    files.iter().map(|path| of(path)).filter(|file| !["lib", "main"].contains(&file.floor())).collect()
}

fn of(path: &Path) -> File {
    let relative = path.strip_prefix(source()).unwrap().with_extension("");
    let names = relative.iter().map(|name| name.to_str().unwrap().to_owned());
    let text = fs::read_to_string(path).unwrap();
    let code = text.lines().filter(|line| !line.trim_start().starts_with("//")).collect::<Vec<_>>().join("\n");
    File { module: names.filter(|name| name != "mod").collect(), text: code }
}

#[test]
fn imports_go_down_only() {
    let files = files();
    assert!(FLOORS.iter().all(|floor| files.iter().any(|file| file.floor() == *floor)), "a floor is empty");
    for file in &files {
        assert!(!file.text.contains("use crate::{"), "{:?}: name one floor in each import", file.module);
        for path in file.imports(true).iter().filter(|path| !path.is_empty()) {
            let goes_up = rank(&path[0]) < rank(file.floor());
            assert!(!goes_up, "{} imports {}, which is above it", file.module.join("::"), path.join("::"));
        }
    }
}

#[test]
fn no_rooms_of_a_floor_import_one_another_in_a_circle() {
    let files = files();
    for floor in FLOORS {
        let of_floor = || files.iter().filter(|file| file.floor() == floor && file.module.len() > 1);
        let rooms: BTreeSet<&str> = of_floor().map(|file| file.module[1].as_str()).collect();
        let mut needs: BTreeMap<&str, BTreeSet<&str>> = rooms.iter().map(|room| (*room, BTreeSet::new())).collect();
        for file in of_floor() {
            let own = file.module[1].as_str();
            for path in file.imports(false).iter().filter(|path| path.len() == 2 && path[0] == floor) {
                needs.entry(own).or_default().extend(rooms.get(path[1].as_str()).filter(|room| **room != own));
            }
        }
        // Whatever needs nothing of what is left is taken away; a circle is what stays.
        while let Some(free) = needs.iter().find(|(_, others)| others.is_empty()).map(|(room, _)| *room) {
            needs.remove(free);
            needs.values_mut().for_each(|others| {
                others.remove(free);
            });
        }
        assert!(needs.is_empty(), "in {floor} there is a circle among {needs:?}");
    }
}
