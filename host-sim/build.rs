//! The version that the program names: the package's version and, where git knows it, the commit that it was built from, with its day.

use std::path::{Path, PathBuf};
use std::process::Command;

fn main() {
    let commit =
        commit().map_or_else(|| "unknown".to_owned(), |commit| commit + if is_modified() { ", modified" } else { "" });
    println!("cargo::rustc-env=HOLDOVER_COMMIT={commit}");
    // What is built changes with these, and whether it is what was committed.
    for path in ["build.rs", "Cargo.toml", "src", "scenarios", "../src", "../Cargo.toml"] {
        println!("cargo::rerun-if-changed={path}");
    }
    for path in [git(&["rev-parse", "--git-path", "logs/HEAD"]), git(&["rev-parse", "--git-path", "HEAD"])] {
        if let Some(path) = path.filter(|path| Path::new(path).exists()) {
            println!("cargo::rerun-if-changed={path}");
        }
    }
}

/// The commit of this source and its day; `None` without git, and where the source only lies in somebody else's repository.
fn commit() -> Option<String> {
    let root = PathBuf::from(git(&["rev-parse", "--show-toplevel"])?).canonicalize().ok()?;
    let own = Path::new(env!("CARGO_MANIFEST_DIR")).parent()?.canonicalize().ok()?;
    if root == own { git(&["log", "-1", "--abbrev=12", "--date=short", "--format=%h of %cd"]) } else { None }
}

fn is_modified() -> bool {
    let paths = ["status", "--porcelain", "--", "src", "scenarios", "Cargo.toml", "../src", "../Cargo.toml"];
    git(&paths).is_none_or(|changes| !changes.is_empty())
}

/// What git says, if there is a git, and it says something here.
fn git(arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").args(arguments).current_dir(env!("CARGO_MANIFEST_DIR")).output().ok()?;
    output.status.success().then(|| String::from_utf8_lossy(&output.stdout).trim().to_owned())
}
