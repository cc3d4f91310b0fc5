//! Logs of other tools: the name and the first line of a file that is no candump log enter; the format with the way to
//! convert it leaves, if it is a known one.

use std::path::Path;

use crate::error::Error;

/// A format: its extension, what it is called, and how its files begin.
struct Format {
    extension: &'static str,
    called: &'static str,
    beginnings: &'static [&'static [u8]],
    /// What the converter needs besides itself.
    needs: &'static str,
}

const FORMATS: [Format; 4] = [
    Format { extension: "asc", called: "an ASC log", beginnings: &[b"date "], needs: "" },
    Format { extension: "blf", called: "a BLF log", beginnings: &[b"LOGG"], needs: "" },
    Format { extension: "trc", called: "a TRC log", beginnings: &[b";$FILEVERSION", b";###"], needs: "" },
    Format { extension: "mf4", called: "an MF4 log", beginnings: &[b"MDF "], needs: " (it needs asammdf)" },
];

/// The error for a log of another format, by its beginning or else by its name.
pub(super) fn named(file: &Path, first_line: &[u8]) -> Option<Error> {
    let extension = file.extension().and_then(|extension| extension.to_str()).unwrap_or_default().to_lowercase();
    let begins = |format: &&Format| format.beginnings.iter().any(|beginning| first_line.starts_with(beginning));
    let is_called = |format: &&Format| format.extension == extension;
    let format = FORMATS.iter().find(begins).or_else(|| FORMATS.iter().find(is_called))?;
    let name = file.to_str().filter(|name| name.bytes().all(|byte| byte.is_ascii_graphic()));
    let (from, to) = match name {
        Some(name) if is_called(&format) => (name.to_owned(), file.with_extension("log").display().to_string()),
        _ => (format!("IN.{}", format.extension), "OUT.log".to_owned()),
    };
    let remedy = format!("convert it with python-can: python -m can.logconvert {from} {to}{}", format.needs);
    Some(Error::new(format!("is {}, and no candump log", format.called), remedy).in_file(file))
}
