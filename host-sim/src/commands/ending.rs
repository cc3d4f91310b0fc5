//! The end of a command: results, their text and their page enter; what the options ask for leaves: a table or JSON on
//! stdout, and a report in its folder. The options for that are the same for every command that measures.

use std::fs;
use std::path::{Path, PathBuf};

use clap::Args;
use serde::Serialize;

use crate::draft::Draft;
use crate::error::Error;
use crate::output;
use crate::places::can_be_folder;
use crate::provenance::{Input, VERSION, command_line};
use crate::report::page::Page;

/// Where the results of a command go, as it is typed. A command with a folder of its own changes the default of `out`.
#[derive(Clone, Debug, Default, Args)]
pub struct OutputArguments {
    /// Print the results as one JSON value on stdout
    #[arg(long)]
    pub json: bool,

    /// Folder for the HTML report; it is created
    #[arg(long, alias = "output", value_name = "DIR", default_value = "holdover-report")]
    pub out: PathBuf,

    /// Write no report
    #[arg(long, conflicts_with = "out")]
    pub no_report: bool,
}

impl OutputArguments {
    /// The same, checked.
    ///
    /// # Errors
    /// An impossible folder.
    pub fn read(self) -> Result<Destination, Error> {
        Destination::new(self.json, (!self.no_report).then_some(self.out))
    }
}

/// The output of a command, and what it says of the input.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Destination {
    /// Whether results are printed as JSON.
    pub json: bool,
    /// Folder of the report; `None`: no report.
    pub report: Option<PathBuf>,
    /// The files that the results come from, for the report.
    inputs: Vec<Input>,
    /// What to say of the input.
    warnings: Vec<String>,
}

impl Destination {
    /// Results as JSON or not, and a report in a folder, if one is given.
    ///
    /// # Errors
    /// An impossible folder.
    pub fn new(json: bool, report: Option<PathBuf>) -> Result<Self, Error> {
        if let Some(folder) = &report {
            can_be_folder("--out", folder, "name a folder for the report, or give --no-report")?;
        }
        Ok(Self { json, report, inputs: Vec::new(), warnings: Vec::new() })
    }

    /// The same for results that come from these files. A name without a file is one of the library, and a pipe can be read only once.
    ///
    /// # Errors
    /// A file that cannot be read any more.
    pub fn with_inputs<'a>(self, files: impl IntoIterator<Item = &'a Path>) -> Result<Self, Error> {
        let files = files.into_iter().filter(|file| file.is_file());
        Ok(Self { inputs: files.map(Input::of).collect::<Result<_, _>>()?, ..self })
    }

    /// The same for results of an input with these findings.
    ///
    /// # Errors
    /// The first of them, if the user is strict.
    pub fn with_findings(self, findings: Vec<Error>, is_strict: bool) -> Result<Self, Error> {
        match findings.into_iter() {
            mut found if is_strict && found.len() > 0 => Err(found.next().unwrap_or_else(|| Error::new("", ""))),
            found => Ok(Self { warnings: found.map(|finding| finding.to_string()).collect(), ..self }),
        }
    }

    /// Says what there is to say of the input, before the work.
    pub fn warn(&self) {
        self.warnings.iter().for_each(|warning| output::say(&format!("warning: {warning}")));
    }

    /// Prints the results as a table, or as JSON with the line `beside_json` on stderr, if there is one. Then it writes
    /// the report. In this order no results are lost if the report cannot be written.
    ///
    /// # Errors
    /// Output that cannot be written.
    pub fn deliver(
        &self,
        results: &impl Serialize,
        table: &str,
        beside_json: &str,
        page: impl FnOnce() -> Page,
    ) -> Result<(), Error> {
        if self.json {
            if !beside_json.is_empty() {
                output::say(beside_json.trim_end());
            }
            output::print(&format!("{}\n", json(results)?))?;
        } else {
            output::print(table)?;
        }
        let Some(folder) = &self.report else { return Ok(()) };
        fs::create_dir_all(folder).map_err(|error| Error::unwritable(folder, &error))?;
        let file = folder.join("index.html");
        Draft::whole(&file, &self.signed(page()).finish())?;
        output::say(&format!("report: {}", file.display()));
        Ok(())
    }

    /// The page with what there is to say of the input, and with where its results come from.
    fn signed(&self, mut page: Page) -> Page {
        page.warn(&self.warnings);
        page.section("Where this comes from");
        page.command(&command_line());
        let version = ("holdover-sim".to_owned(), VERSION.to_owned());
        let inputs = self.inputs.iter().map(|input| (input.path.clone(), format!("SHA-256 {}", input.sha256)));
        page.facts(&std::iter::once(version).chain(inputs).collect::<Vec<_>>());
        page
    }
}

/// Results as one JSON value.
///
/// # Errors
/// Results that JSON cannot represent.
pub fn json(results: &impl Serialize) -> Result<String, Error> {
    serde_json::to_string(results).map_err(|error| Error::new(error.to_string(), "report this"))
}
