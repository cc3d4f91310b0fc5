//! Bad input: the place, the cause and the remedy enter; one line for the user leaves.
//!
//! ```text
//! scenario.toml:12: `lag_s` is -0.3; give seconds from 0 to 1.998
//! ```
//! Every error of this type ends the program with exit code 2.

use std::fmt;
use std::io;
use std::path::Path;

/// Why the input (or the place for the output) cannot be used, and what to do about it.
///
/// The parts are kept apart so that tests and other front ends need not take the line to pieces.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Error {
    place: Option<String>,
    line: Option<u64>,
    cause: String,
    remedy: String,
}

impl Error {
    /// What is wrong, and how to put it right. Both are clauses without a full stop.
    #[must_use]
    pub fn new(cause: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self { place: None, line: None, cause: cause.into(), remedy: remedy.into() }
    }

    /// The file cannot be opened or read.
    #[must_use]
    pub fn unreadable(file: &Path, error: &io::Error) -> Self {
        let remedy = match error.kind() {
            io::ErrorKind::NotFound => "check the path",
            io::ErrorKind::PermissionDenied => "make it readable",
            _ => "name a readable file",
        };
        Self::new(format!("cannot be read ({})", plain(error)), remedy).in_file(file)
    }

    /// The file or directory cannot be created or written.
    #[must_use]
    pub fn unwritable(file: &Path, error: &io::Error) -> Self {
        let cause = format!("cannot be written ({})", plain(error));
        Self::new(cause, "name a place that exists, is writable and has room").in_file(file)
    }

    /// The same error, in that file.
    #[must_use]
    pub fn in_file(self, file: &Path) -> Self {
        let place = if file.as_os_str().is_empty() { "\"\"".into() } else { escaped(&file.to_string_lossy()) };
        Self { place: Some(place), ..self }
    }

    /// The same error, in that command line option, such as `--step`.
    #[must_use]
    pub fn in_option(self, option: &str) -> Self {
        Self { place: Some(option.into()), ..self }
    }

    /// The same error, in that line, counted from 1.
    #[must_use]
    pub fn at_line(self, line: u64) -> Self {
        Self { line: Some(line), ..self }
    }

    /// The line in the file, counted from 1.
    #[must_use]
    pub fn line(&self) -> Option<u64> {
        self.line
    }

    /// What is wrong.
    #[must_use]
    pub fn cause(&self) -> &str {
        &self.cause
    }

    /// How to put it right.
    #[must_use]
    pub fn remedy(&self) -> &str {
        &self.remedy
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(place) = &self.place {
            write!(f, "{place}:")?;
            if let Some(line) = self.line {
                write!(f, "{line}:")?;
            }
            write!(f, " ")?;
        }
        write!(f, "{}; {}", self.cause, self.remedy)
    }
}

impl std::error::Error for Error {}

/// The user's own text as it can stand inside a one-line message: quoted, escaped, and cut after 40 characters.
#[must_use]
pub fn quoted(text: &str) -> String {
    const SHOWN: usize = 40;
    let shown: String = text.chars().take(SHOWN).collect();
    let ellipsis = if text.chars().nth(SHOWN).is_some() { "…" } else { "" };
    format!("\"{}{ellipsis}\"", escaped(&shown))
}

/// A number as it can stand inside a message: beyond what anybody means it is short, with its exponent.
#[must_use]
pub fn shown(number: f64) -> String {
    if number.abs() < 1e15 { number.to_string() } else { format!("{number:e}") }
}

/// Without control characters, which could break the line or drive the terminal.
fn escaped(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { c.escape_default().to_string() } else { c.to_string() }).collect()
}

/// The system's words without the error number that `std` appends.
pub(crate) fn plain(error: &io::Error) -> String {
    let text = error.to_string();
    text.split_once(" (os error").map_or(text.clone(), |(words, _)| words.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_is_one_line_with_file_line_cause_and_remedy() {
        let error = Error::new("`lag_s` is -0.3", "give seconds").in_file(Path::new("a.toml")).at_line(12);
        assert_eq!(error.to_string(), "a.toml:12: `lag_s` is -0.3; give seconds");
    }

    #[test]
    fn an_option_takes_the_place_of_the_file() {
        let error = Error::new("is 0", "give seconds").in_option("--step");
        assert_eq!(error.to_string(), "--step: is 0; give seconds");
    }

    #[test]
    fn a_missing_file_is_said_in_plain_words() {
        let file = Path::new("/no/such\nfile");
        let error = Error::unreadable(file, &std::fs::read(file).unwrap_err());
        assert_eq!(error.to_string(), "/no/such\\nfile: cannot be read (No such file or directory); check the path");
    }

    #[test]
    fn quoted_text_stays_short_and_on_one_line() {
        assert_eq!(quoted("a\nb\u{1b}[2J"), "\"a\\nb\\u{1b}[2J\"");
        assert_eq!(quoted(&"x".repeat(99)).chars().count(), 43);
    }
}
