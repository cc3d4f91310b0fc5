//! The end of a command: results, their text and their page enter; what the options ask for leaves: a table or JSON on
//! stdout, and a report in its folder. The options for that are the same for every command that measures.

use std::fs;
use std::path::PathBuf;

use clap::Args;
use serde::Serialize;

use crate::draft::Draft;
use crate::error::Error;
use crate::output;
use crate::places::can_be_folder;

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

/// The output of a command.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Destination {
    /// Whether results are printed as JSON.
    pub json: bool,
    /// Folder of the report; `None`: no report.
    pub report: Option<PathBuf>,
}

impl Destination {
    /// Results as JSON or not, and a report in a folder, if one is given.
    ///
    /// # Errors
    /// An impossible folder.
    pub fn new(json: bool, report: Option<PathBuf>) -> Result<Self, Error> {
        if let Some(folder) = &report {
            can_be_folder(folder)?;
        }
        Ok(Self { json, report })
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
        page: impl FnOnce() -> String,
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
        Draft::whole(&file, &page())?;
        output::say(&format!("report: {}", file.display()));
        Ok(())
    }
}

/// Results as one JSON value.
///
/// # Errors
/// Results that JSON cannot represent.
pub fn json(results: &impl Serialize) -> Result<String, Error> {
    serde_json::to_string(results).map_err(|error| Error::new(error.to_string(), "report this"))
}
