//! `check`: files enter; what is found in them leaves on stdout, and the verdict.

pub mod arguments;

use std::fmt::Write;
use std::path::{Path, PathBuf};

use crate::error::Error;
use crate::input::library;
use crate::input::recording::Recorded;
use crate::input::scenario::{Overrides, Scenario};
use crate::output;
use crate::roads::read;
use crate::verdict::Verdict;
use arguments::CheckArguments;

/// The files, each read.
#[derive(Clone, Debug, PartialEq)]
pub struct CheckOptions {
    files: Vec<Result<Checked, Error>>,
}

/// A file that can be used.
#[derive(Clone, Debug, PartialEq)]
struct Checked {
    file: PathBuf,
    what: String,
    findings: Vec<Error>,
}

impl CheckOptions {
    /// Reads the files. One that cannot be used keeps no other from being checked.
    #[must_use]
    pub fn read(arguments: CheckArguments) -> Self {
        Self { files: arguments.files.into_iter().map(Checked::of).collect() }
    }
}

impl Checked {
    fn of(file: PathBuf) -> Result<Self, Error> {
        let (what, findings) = match file.extension() {
            Some(extension) if extension == "toml" => scenario(&file)?,
            _ => recording(&file)?,
        };
        Ok(Self { file, what, findings })
    }
}

fn recording(file: &Path) -> Result<(String, Vec<Error>), Error> {
    Ok(match Recorded::read(file)? {
        Recorded::Motion(motion) => {
            let what = format!("a drive of {:.1} s, {} samples", motion.duration_s(), motion.rows().len());
            (what, motion.findings().to_vec())
        }
        Recorded::Channel(link) => {
            let arrived = link.rows().iter().filter(|row| row.delay_s.is_some()).count();
            let what = format!(
                "a link of {:.1} s, {} messages, of which {arrived} arrive",
                link.duration_s(),
                link.rows().len()
            );
            (what, link.findings().to_vec())
        }
    })
}

fn scenario(file: &Path) -> Result<(String, Vec<Error>), Error> {
    let (file, text) = library::text(file)?;
    match library::kind(&file, &text)? {
        library::Kind::String => {
            let scenario = Scenario::parse(&file, &text, &Overrides::default())?;
            let what = format!("a string of {} vehicles, {} s", scenario.vehicles.len(), scenario.duration_s);
            Ok((what, scenario.findings()))
        }
        library::Kind::Corridor => {
            let corridor = read::corridor(&file, &text, &Overrides::default())?;
            Ok((format!("a corridor of {} roads, {} s", corridor.roads.len(), corridor.duration_s), Vec::new()))
        }
    }
}

/// Prints what was found.
///
/// # Errors
/// A file that cannot be used.
pub fn run(options: &CheckOptions) -> Result<Verdict, Error> {
    let mut text = String::new();
    // Writing to a String cannot fail.
    for Checked { file, what, findings } in options.files.iter().flatten() {
        let _ = writeln!(text, "{}: {what}", file.display());
        findings.iter().for_each(|finding| {
            let _ = writeln!(text, "  {finding}");
        });
    }
    let found: usize = options.files.iter().flatten().map(|checked| checked.findings.len()).sum();
    let findings = if found == 1 { "1 finding".to_owned() } else { format!("{found} findings") };
    let reasons: Vec<String> = (found > 0).then_some(findings).into_iter().collect();
    let mut unusable = options.files.iter().filter_map(|file| file.as_ref().err());
    let last = unusable.next_back();
    if last.is_none() {
        let _ = writeln!(text, "{}", Verdict::of(&reasons).line(&reasons));
    }
    output::print(&text)?;
    unusable.for_each(|error| output::say(&format!("error: {error}")));
    last.map_or(Ok(Verdict::of(&reasons)), |error| Err(error.clone()))
}
