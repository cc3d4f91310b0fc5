//! The checks of every recorded table: bytes and column names enter; numbers leave, or errors with their line.

use crate::error::{Error, quoted};
use csv::{ReaderBuilder, StringRecord};
use std::ops::RangeInclusive;
use std::path::Path;

/// A column of numbers.
pub struct Column {
    /// Its name in the header.
    pub name: &'static str,
    /// Its unit, for the remedy.
    pub unit: &'static str,
    /// The allowed range of a number in it.
    pub limits: RangeInclusive<f64>,
}

/// A column that the file has.
pub struct FoundColumn {
    column: &'static Column,
    index: usize,
}

/// A table of text, not yet of numbers.
pub struct Table<'a> {
    file: &'a Path,
    columns: &'static str,
    header: Record,
    records: Vec<Record>,
}

struct Record {
    /// Its line in the file, counted from 1 as in an editor.
    line: u64,
    fields: StringRecord,
}

/// One line of a [`Table`].
pub struct Line<'a> {
    file: &'a Path,
    record: &'a Record,
}

impl<'a> Table<'a> {
    /// Splits a file into header and lines. Errors show `columns`, the expected header.
    pub fn parse(file: &'a Path, bytes: &[u8], columns: &'static str) -> Result<Self, Error> {
        let text = text_of(bytes).ok_or_else(|| {
            Error::new("is not a text file", format!("give a CSV file with the columns {columns}")).in_file(file)
        })?;
        let mut reader = ReaderBuilder::new().has_headers(false).flexible(true).trim(csv::Trim::All).from_reader(text);
        let mut records: Vec<Record> = Vec::new();
        let (mut line, mut counted_to) = (1, 0);
        for fields in reader.records() {
            let fields = fields.map_err(|_| {
                Error::new("is not CSV after this line", "write plain numbers with commas between")
                    .in_file(file)
                    .at_line(line)
            })?;
            // The reader gives as the position of a record where it began to look for it, before any blank lines.
            let looked_from = fields.position().map_or(0, |position| position.byte() as usize);
            let blank = text[looked_from..].iter().take_while(|byte| b"\r\n".contains(byte)).count();
            let starts = looked_from + blank;
            line += text[counted_to..starts].iter().filter(|&&byte| byte == b'\n').count() as u64;
            counted_to = starts;
            // A line of blanks comes out as one empty field.
            if fields.iter().ne([""]) {
                records.push(Record { line, fields });
            }
        }
        if records.is_empty() {
            let remedy = format!("give a CSV file with the columns {columns}");
            return Err(Error::new("is empty", remedy).in_file(file));
        }
        let header = records.remove(0);
        let table = Self { file, columns, header, records };
        table.is_of_commas()?;
        table.is_even()?;
        Ok(table)
    }

    /// Checks that columns are parted by commas, which a header of a single field with another separator in it denies.
    fn is_of_commas(&self) -> Result<(), Error> {
        let header = self.header.fields.iter().collect::<Vec<_>>().join(",");
        let other =
            [(';', "semicolons"), ('\t', "tabs")].into_iter().find(|(separator, _)| header.contains(*separator));
        match other {
            Some((_, separators)) if self.header.fields.len() == 1 => {
                let cause = format!("the header {} has {separators} between its columns", quoted(&header));
                let remedy = "write commas between columns, and decimal points";
                Err(Error::new(cause, remedy).in_file(self.file).at_line(self.header.line))
            }
            _ => Ok(()),
        }
    }

    /// Checks that no line has more fields than there are columns.
    fn is_even(&self) -> Result<(), Error> {
        let columns = self.header.fields.len();
        let longer = |record: &&Record| record.fields.iter().skip(columns).any(|field| !field.is_empty());
        match self.records.iter().find(longer) {
            Some(record) => {
                let cause =
                    format!("has {} under {}", counted(record.fields.len(), "field"), counted(columns, "column"));
                let remedy = "write decimal points, not commas, and one field for each column";
                Err(Error::new(cause, remedy).in_file(self.file).at_line(record.line))
            }
            None => Ok(()),
        }
    }

    /// Finds a column that the file must have once.
    pub fn column(&self, column: &'static Column) -> Result<FoundColumn, Error> {
        if self.header.fields.iter().filter(|name| *name == column.name).count() > 1 {
            let cause = format!("the column {} stands there twice", quoted(column.name));
            return Err(Error::new(cause, "rename or delete one of the two")
                .in_file(self.file)
                .at_line(self.header.line));
        }
        self.optional_column(column).ok_or_else(|| self.lacks(column.name))
    }

    /// The error of a file without this column.
    pub fn lacks(&self, column: &str) -> Error {
        let found = self.header.fields.iter().collect::<Vec<_>>().join(",");
        let cause = format!("no column `{column}` in the header {}", quoted(&found));
        let remedy = format!("name the columns {}", self.columns);
        Error::new(cause, remedy).in_file(self.file).at_line(self.header.line)
    }

    /// Finds a column that the file may have.
    pub fn optional_column(&self, column: &'static Column) -> Option<FoundColumn> {
        let index = self.header.fields.iter().position(|name| name == column.name)?;
        Some(FoundColumn { column, index })
    }

    /// The lines below the header.
    pub fn lines(&self) -> impl Iterator<Item = Line<'_>> {
        self.records.iter().map(|record| Line { file: self.file, record })
    }

    /// Checks that there are enough rows.
    pub fn has_rows(&self, rows: usize, least: usize) -> Result<(), Error> {
        if rows >= least {
            return Ok(());
        }
        let cause = match rows {
            0 => "has a header but no rows".to_owned(),
            1 => "has only one row".to_owned(),
            _ => format!("has only {rows} rows"),
        };
        let line = self.records.last().unwrap_or(&self.header).line;
        let remedy = format!("give a recording of at least {}", counted(least, "row"));
        Err(Error::new(cause, remedy).in_file(self.file).at_line(line))
    }
}

impl Line<'_> {
    /// Its line in the file, counted from 1.
    pub fn number_in_file(&self) -> u64 {
        self.record.line
    }

    /// The number in a column.
    pub fn number(&self, found: &FoundColumn) -> Result<f64, Error> {
        self.number_or_empty(found)?.ok_or_else(|| {
            let remedy = format!("give a number of {}, or delete the line", found.column.unit);
            self.error(format!("`{}` is empty", found.column.name), remedy)
        })
    }

    /// The number in a column; `None` if the field is empty.
    pub fn number_or_empty(&self, found: &FoundColumn) -> Result<Option<f64>, Error> {
        let Column { name, unit, limits } = found.column;
        let Some(text) = self.record.fields.get(found.index) else {
            let cause = format!("has {}, so `{name}` is missing", counted(self.record.fields.len(), "field"));
            return Err(self.error(cause, "complete or delete the line (a comma stands before an empty last field)"));
        };
        if text.is_empty() {
            return Ok(None);
        }
        let number: f64 = text.parse().map_err(|_| {
            self.error(format!("`{name}` is {}, not a number", quoted(text)), format!("give a number of {unit}"))
        })?;
        if limits.contains(&number) {
            return Ok(Some(number));
        }
        let range = format!("give {unit} from {} to {}", limits.start(), limits.end());
        let remedy = if name.starts_with("speed") { format!("{range} (km/h / 3.6)") } else { range };
        Err(self.error(format!("`{name}` is {}", quoted(text)), remedy))
    }

    /// Checks that time increases from line to line.
    pub fn follows(&self, previous_t_s: Option<f64>, t_s: f64) -> Result<(), Error> {
        match previous_t_s {
            Some(previous) if t_s == previous => {
                Err(self.error(format!("time {t_s} s stands there twice"), "delete one of the two lines"))
            }
            _ => self.does_not_precede(previous_t_s, t_s),
        }
    }

    /// Checks that time does not decrease from line to line.
    pub fn does_not_precede(&self, previous_t_s: Option<f64>, t_s: f64) -> Result<(), Error> {
        match previous_t_s {
            Some(previous) if t_s < previous => Err(self.error(
                format!("time runs backwards, from {previous} s to {t_s} s"),
                "sort the lines by t_s, or split the recording here",
            )),
            _ => Ok(()),
        }
    }

    fn error(&self, cause: impl Into<String>, remedy: impl Into<String>) -> Error {
        Error::new(cause, remedy).in_file(self.file).at_line(self.record.line)
    }
}

fn counted(count: usize, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}

/// The bytes without a byte order mark; `None` if they are not text.
fn text_of(bytes: &[u8]) -> Option<&[u8]> {
    let text = std::str::from_utf8(bytes).ok()?;
    if text.contains('\0') {
        return None;
    }
    Some(text.strip_prefix('\u{feff}').unwrap_or(text).as_bytes())
}
