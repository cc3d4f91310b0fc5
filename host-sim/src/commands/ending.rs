//! The end of a command: results, the same in words and their page enter; what the options ask for leaves, a table or JSON
//! on stdout and a report in its folder.

use std::fs;
use std::path::PathBuf;

use serde::Serialize;

use crate::error::Error;
use crate::output;
use crate::places::can_be_folder;

/// Where results go.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Destination {
    /// Results as JSON.
    pub json: bool,
    /// Folder of the report; `None`: no report.
    pub report: Option<PathBuf>,
}

impl Destination {
    /// Results as JSON or not, and a report in that folder, if any.
    ///
    /// # Errors
    /// A folder that cannot be one.
    pub fn new(json: bool, report: Option<PathBuf>) -> Result<Self, Error> {
        if let Some(folder) = &report {
            can_be_folder(folder)?;
        }
        Ok(Self { json, report })
    }

    /// Prints the results as a table, or as JSON with a word `beside_json` on stderr, if there is one. Then it writes the
    /// report, so that no results are lost to a report that cannot be written.
    ///
    /// # Errors
    /// Places that cannot be written.
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
/// Results that JSON has no value for.
pub fn json(results: &impl Serialize) -> Result<String, Error> {
    serde_json::to_string(results).map_err(|error| Error::new(error.to_string(), "report this"))
}
