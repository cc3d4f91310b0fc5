//! Where results come from: the version of the program, its command line, and the files that it read, each with its SHA-256. The only
//! date in it is that of the commit, so the same command on the same files says the same.

use std::fmt::Write;
use std::path::Path;

use sha2::{Digest, Sha256};

use crate::error::Error;

/// The version of the package and the commit that it was built from, with its day.
pub const VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), " (commit ", env!("HOLDOVER_COMMIT"), ")");

/// An input file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Input {
    /// Its path, as it was named.
    pub path: String,
    /// Its SHA-256, in hexadecimal digits, as `sha256sum` prints it.
    pub sha256: String,
}

impl Input {
    /// A file as it is now.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub fn of(file: &Path) -> Result<Self, Error> {
        let bytes = std::fs::read(file).map_err(|error| Error::unreadable(file, &error))?;
        let mut sha256 = String::new();
        for byte in Sha256::digest(bytes) {
            let _ = write!(sha256, "{byte:02x}"); // writing to a String cannot fail
        }
        Ok(Self { path: file.display().to_string(), sha256 })
    }
}

/// The command line, as a shell takes it.
#[must_use]
pub fn command_line() -> String {
    let words = std::env::args_os().skip(1).map(|word| shell_word(&word.to_string_lossy()));
    std::iter::once("holdover-sim".to_owned()).chain(words).collect::<Vec<_>>().join(" ")
}

/// A word as a shell takes it.
#[must_use]
pub fn shell_word(word: &str) -> String {
    let is_plain = |c: char| c.is_alphanumeric() || "-_./,:=@+%".contains(c);
    if !word.is_empty() && word.chars().all(is_plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_has_the_hash_that_sha256sum_prints() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("abc");
        std::fs::write(&file, "abc").unwrap();
        let sha256 = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(Input::of(&file).unwrap().sha256, sha256);
        assert!(Input::of(&folder.path().join("none")).is_err());
    }

    #[test]
    fn words_that_a_shell_would_take_apart_are_quoted() {
        assert_eq!(shell_word("--out=a/b-1.5,2"), "--out=a/b-1.5,2");
        assert_eq!(shell_word("it's $1"), r"'it'\''s $1'");
        assert_eq!(shell_word(""), "''");
    }
}
