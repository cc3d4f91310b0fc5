//! The end of a command: results, their text and their page enter; what the options ask for leaves: a table or JSON on
//! stdout, and a report in its folder.

use std::fs;
use std::path::PathBuf;

use serde::Serialize;

use crate::error::Error;
use crate::output;
use crate::places::can_be_folder;

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
        fs::write(&file, page()).map_err(|error| Error::unwritable(&file, &error))?;
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
