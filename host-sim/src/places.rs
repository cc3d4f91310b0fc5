//! Places for output: a name from the command line enters; an error leaves if nothing can be written there.

use std::path::{Path, PathBuf};

use crate::error::{Error, quoted};

/// That the report's folder is not a file; missing folders are created when it is written.
///
/// # Errors
/// It is a file, or has no name.
pub fn can_be_folder(folder: &Path) -> Result<(), Error> {
    let cause = if folder.as_os_str().is_empty() {
        "is an empty name".to_owned()
    } else if folder.exists() && !folder.is_dir() {
        format!("{} is a file", quoted(&folder.to_string_lossy()))
    } else {
        return Ok(());
    };
    Err(Error::new(cause, "name a folder for the report, or give --no-report").in_option("--out"))
}

/// That a file can be written there, without losing an input or another output.
///
/// # Errors
/// It is a folder or in none, is taken, or has no name.
pub fn can_be_file(option: &str, file: &Path, taken: &[&Path]) -> Result<(), Error> {
    let name = quoted(&file.to_string_lossy());
    let (cause, remedy) = if file.as_os_str().is_empty() {
        ("is an empty name".to_owned(), "name a file")
    } else if file.is_dir() {
        (format!("{name} is a folder"), "name a file in it")
    } else {
        match resolved(file) {
            None => (format!("{name} is in a folder that does not exist"), "create the folder first"),
            Some(path) if taken.iter().any(|other| resolved(other).as_ref() == Some(&path)) => {
                (format!("{name} is also another file of this command"), "give each a name of its own")
            }
            Some(_) => return Ok(()),
        }
    };
    Err(Error::new(cause, remedy).in_option(option))
}

/// One path for all names of a file, which need not exist yet; `None` if its folder does not exist.
fn resolved(file: &Path) -> Option<PathBuf> {
    if let Ok(path) = file.canonicalize() {
        return Some(path);
    }
    let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    Some(folder.canonicalize().ok()?.join(file.file_name()?))
}
