//! The end of a command: a report's page enters; the file in the folder of the options leaves.

use std::fs;
use std::path::{Path, PathBuf};

use crate::error::Error;

/// Writes a report's page into its folder and says where.
///
/// # Errors
/// A folder or file that cannot be written.
pub fn write_report(folder: &Path, page: &str) -> Result<PathBuf, Error> {
    fs::create_dir_all(folder).map_err(|error| Error::unwritable(folder, &error))?;
    let file = folder.join("index.html");
    fs::write(&file, page).map_err(|error| Error::unwritable(&file, &error))?;
    Ok(file)
}
