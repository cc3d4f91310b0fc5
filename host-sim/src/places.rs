//! Places for output: a name from the command line enters; an error leaves if nothing can be written there. Commands ask before they
//! work, so that no results are lost for a place.

use std::fs;
use std::path::{Path, PathBuf};

use crate::draft::{draft_in, folder_of, is_straight};
use crate::error::{Error, plain, quoted};

/// That files can be written into the folder that this option or argument names, with this remedy. Missing folders are created when they
/// are written.
///
/// # Errors
/// It is a file or below one, has no name, or cannot be written.
pub fn can_be_folder(option: &str, folder: &Path, remedy: &str) -> Result<(), Error> {
    let name = |path: &Path| quoted(&path.to_string_lossy());
    let existing = folder.ancestors().find(|path| path.as_os_str().is_empty() || path.exists());
    let existing = existing.filter(|path| !path.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let cause = if folder.as_os_str().is_empty() {
        "is an empty name".to_owned()
    } else if !existing.is_dir() {
        format!("{} is a file", name(existing))
    } else if folder.join("index.html").is_dir() {
        format!("{} is a folder, and is to be a file", name(&folder.join("index.html")))
    } else if let Err(error) = draft_in(existing) {
        format!("{} cannot be written ({})", name(folder), plain(&error))
    } else {
        return Ok(());
    };
    Err(Error::new(cause, remedy).in_option(option))
}

/// That a file can be written there, without losing an input or another output.
///
/// # Errors
/// It is a folder or in none, is taken, is write-protected, has no name, or its folder cannot be written.
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
            Some(_) if is_straight(file) => return Ok(()),
            Some(path) if fs::metadata(&path).is_ok_and(|there| there.permissions().readonly()) => {
                (format!("{name} is write-protected"), "give another name, or take the protection away")
            }
            Some(path) => match draft_in(&folder_of(&path)) {
                Ok(_) => return Ok(()),
                Err(error) => (
                    format!("{name} cannot be written ({})", plain(&error)),
                    "name a file in a folder that you may write",
                ),
            },
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
