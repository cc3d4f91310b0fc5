//! Typed access to a TOML document: keys enter; checked values leave with their lines. A key that was never asked for
//! is an unknown key.

use super::Span;
use super::set::{SET_LINE, SET_OFFSET, Sets};
use crate::error::{Error, quoted, shown};
use std::ops::{Range, RangeInclusive};
use std::path::{Path, PathBuf};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// A number that a scenario can give.
pub struct Number {
    /// Its key.
    pub key: &'static str,
    /// Its unit, for the remedy.
    pub unit: &'static str,
    /// Its allowed range.
    pub limits: RangeInclusive<f64>,
    /// Its default.
    pub default: f64,
}

impl Number {
    /// The number if it is in its range; otherwise an error without a place in the file.
    pub fn check(&self, number: f64) -> Result<f64, Error> {
        if self.limits.contains(&number) {
            return Ok(number);
        }
        Err(Error::new(format!("`{}` is {}", self.key, shown(number)), format!("give {}", self.wanted())))
    }

    fn wanted(&self) -> String {
        let (low, high) = self.limits.clone().into_inner();
        let unit = if self.unit.is_empty() { "a number".to_owned() } else { self.unit.to_owned() };
        format!("{unit} from {low} to {high}")
    }
}

/// A value and its line.
#[derive(Clone, Copy, Debug)]
pub struct Found<T> {
    /// The value.
    pub value: T,
    /// Its line; `None`: it is the default.
    pub line: Option<u64>,
}

/// Two numbers that belong together.
pub type Pair = Found<[f64; 2]>;

/// A file and its text, for the errors.
#[derive(Clone, Copy)]
pub struct Document<'a> {
    file: &'a Path,
    text: &'a str,
    sets: &'a Sets,
}

/// A table of the document, with the keys that have been asked for.
pub struct Section<'a> {
    document: Document<'a>,
    header: String,
    line: Option<u64>,
    table: Option<&'a DeTable<'a>>,
    known: Vec<&'static str>,
}

impl<'a> Document<'a> {
    /// The text of a file, and what the command line sets in it.
    pub fn new(file: &'a Path, text: &'a str, sets: &'a Sets) -> Self {
        // An editor's byte order mark is not part of the document.
        Self { file, text: text.strip_prefix('\u{feff}').unwrap_or(text), sets }
    }

    /// The document as a table of tables.
    pub fn parse(&self) -> Result<DeTable<'a>, Error> {
        let table = DeTable::parse(self.text).map_err(|error| {
            let cause = format!("is not TOML ({})", error.message().lines().collect::<Vec<_>>().join(", "));
            self.error(error.span(), cause, "correct this line")
        })?;
        let mut table = table.into_inner();
        self.sets.put_into(&mut table)?;
        Ok(table)
    }

    pub fn top(&self, table: &'a DeTable<'a>) -> Section<'a> {
        Section { document: *self, header: String::new(), line: None, table: Some(table), known: Vec::new() }
    }

    /// A section in which every value is the default.
    pub fn nothing(&self) -> Section<'a> {
        Section { document: *self, header: String::new(), line: None, table: None, known: Vec::new() }
    }

    /// An error at a value that was found, or in the whole file if the value is a default.
    pub fn error_at(&self, line: Option<u64>, cause: impl Into<String>, remedy: impl Into<String>) -> Error {
        let error = Error::new(cause, remedy);
        self.place(error, line)
    }

    /// Adds the place in this file to an error.
    pub fn place(&self, error: Error, line: Option<u64>) -> Error {
        if line.is_some_and(|line| line == SET_LINE) {
            return error.in_option("--set");
        }
        let error = if self.file.as_os_str().is_empty() { error } else { error.in_file(self.file) };
        line.map_or(error.clone(), |line| error.at_line(line))
    }

    fn error(&self, span: Option<Range<usize>>, cause: impl Into<String>, remedy: impl Into<String>) -> Error {
        self.error_at(span.map(|span| self.line_of(&span)), cause, remedy)
    }

    /// The line of a place in the file; [`SET_LINE`] for one in what the command line sets.
    fn line_of(&self, span: &Range<usize>) -> u64 {
        if span.start >= SET_OFFSET {
            return SET_LINE;
        }
        let before = self.text.as_bytes().iter().take(span.start);
        1 + before.filter(|&&byte| byte == b'\n').count() as u64
    }
}

impl<'a> Section<'a> {
    /// The line of its header.
    pub fn line(&self) -> Option<u64> {
        self.line
    }

    /// The number, or its default.
    pub fn number(&mut self, number: &Number) -> Result<Found<f64>, Error> {
        match self.value(number.key) {
            None => Ok(Found { value: number.default, line: None }),
            Some(value) => {
                let found = self.float(number, value)?;
                Ok(Found { value: found, line: self.line_of(value) })
            }
        }
    }

    /// The number or the range `[low, high]`, if given.
    pub fn span(&mut self, number: &Number) -> Result<Option<Found<Span>>, Error> {
        let Some(value) = self.value(number.key) else { return Ok(None) };
        let span = match value.get_ref().as_array() {
            None => {
                let only = self.float(number, value)?;
                Span { low: only, high: only }
            }
            Some(array) => {
                let [low, high] = self.pair(number, array.iter(), value)?;
                if low > high {
                    let cause = format!("`{}` runs from {low} down to {high}", number.key);
                    return Err(self.error(value, cause, "give the smaller number first"));
                }
                Span { low, high }
            }
        };
        Ok(Some(Found { value: span, line: self.line_of(value) }))
    }

    /// A list of pairs of numbers, each with its line, if given.
    pub fn pairs(&mut self, number: &Number) -> Result<Option<Found<Vec<Pair>>>, Error> {
        let Some(value) = self.value(number.key) else { return Ok(None) };
        let wrong = |at| self.mismatch(number.key, at, "a list of pairs such as [[4, 6]]");
        let array = value.get_ref().as_array().ok_or_else(|| wrong(value))?;
        let pairs = array.iter().map(|entry| {
            let pair = entry.get_ref().as_array().ok_or_else(|| wrong(entry))?;
            Ok(Found { value: self.pair(number, pair.iter(), entry)?, line: self.line_of(entry) })
        });
        Ok(Some(Found { value: pairs.collect::<Result<_, _>>()?, line: self.line_of(value) }))
    }

    /// A list of two numbers, if given.
    pub fn two(&mut self, number: &Number) -> Result<Option<Pair>, Error> {
        let Some(value) = self.value(number.key) else { return Ok(None) };
        let wrong = || self.mismatch(number.key, value, "a list of two numbers");
        let array = value.get_ref().as_array().ok_or_else(wrong)?;
        Ok(Some(Found { value: self.pair(number, array.iter(), value)?, line: self.line_of(value) }))
    }

    /// A text, if given; it must not be empty.
    pub fn text(&mut self, key: &'static str) -> Result<Option<Found<String>>, Error> {
        let Some(value) = self.value(key) else { return Ok(None) };
        let words = value.get_ref().as_str().filter(|words| !words.trim().is_empty());
        let words = words.ok_or_else(|| self.mismatch(key, value, "words in quotes"))?;
        Ok(Some(Found { value: words.to_owned(), line: self.line_of(value) }))
    }

    /// A whole number, at least 0, if given.
    pub fn whole(&mut self, key: &'static str) -> Result<Option<Found<u64>>, Error> {
        let Some(value) = self.value(key) else { return Ok(None) };
        let wanted = format!("a whole number from 0 to {}", u64::MAX);
        let number = whole(value).ok_or_else(|| self.mismatch(key, value, &wanted))?;
        Ok(Some(Found { value: number, line: self.line_of(value) }))
    }

    /// A truth value, if given.
    pub fn flag(&mut self, key: &'static str) -> Result<Option<Found<bool>>, Error> {
        let Some(value) = self.value(key) else { return Ok(None) };
        let flag = value.get_ref().as_bool().ok_or_else(|| self.mismatch(key, value, "true or false"))?;
        Ok(Some(Found { value: flag, line: self.line_of(value) }))
    }

    /// The path of a file, if given. A relative path starts from the folder of this document.
    pub fn path(&mut self, key: &'static str) -> Result<Option<Found<PathBuf>>, Error> {
        let Some(value) = self.value(key) else { return Ok(None) };
        let named = value.get_ref().as_str().filter(|path| !path.is_empty());
        let path = named.ok_or_else(|| self.mismatch(key, value, "the path of a file in quotes"))?;
        let folder = self.document.file.parent().unwrap_or(Path::new(""));
        Ok(Some(Found { value: folder.join(path), line: self.line_of(value) }))
    }

    /// The value as it is in the document, for keys of several types.
    pub fn value(&mut self, key: &'static str) -> Option<&'a Spanned<DeValue<'a>>> {
        self.known.push(key);
        self.table?.get(key)
    }

    /// The section `[key]`; empty if there is none.
    pub fn section(&mut self, key: &'static str) -> Result<Section<'a>, Error> {
        let header = format!("[{key}]");
        let (document, mut section) = (self.document, None);
        if let Some(value) = self.value(key) {
            section = Some(value.get_ref().as_table().ok_or_else(|| self.mismatch(key, value, &header))?);
        }
        let line = self.table.and_then(|table| Some(document.line_of(&table.get_key_value(key)?.0.span())));
        Ok(Section { document, header, line, table: section, known: Vec::new() })
    }

    /// The sections `[[key]]`, if there are any.
    pub fn sections(&mut self, key: &'static str) -> Result<Option<Vec<Section<'a>>>, Error> {
        let header = format!("[[{key}]]");
        let wanted = format!("one {header} per {key}");
        let Some(value) = self.value(key) else { return Ok(None) };
        let array = value.get_ref().as_array().ok_or_else(|| self.mismatch(key, value, &wanted))?;
        let sections = array.iter().map(|entry| {
            let table = entry.get_ref().as_table().ok_or_else(|| self.mismatch(key, entry, &wanted))?;
            let (document, header) = (self.document, header.clone());
            Ok(Section { document, header, line: self.line_of(entry), table: Some(table), known: Vec::new() })
        });
        sections.collect::<Result<_, _>>().map(Some)
    }

    /// Checks that every key in this section has been asked for.
    pub fn finish(self) -> Result<(), Error> {
        let unknown = self.table.iter().flat_map(|table| table.keys());
        let unknown = unknown.filter(|key| !self.known.contains(&key.get_ref().as_ref()));
        let Some(key) = unknown.min_by_key(|key| key.span().start) else { return Ok(()) };
        let place = if self.header.is_empty() { String::new() } else { format!(" in {}", self.header) };
        let remedy = match nearest(key.get_ref(), &self.known) {
            Some(known) => format!("write `{known}`"),
            None => format!("remove it, or use one of {}", self.known.join(", ")),
        };
        Err(self.document.error(Some(key.span()), format!("unknown key {}{place}", quoted(key.get_ref())), remedy))
    }

    /// The error of a value of the wrong type or range.
    pub fn mismatch(&self, key: &str, value: &Spanned<DeValue<'_>>, wanted: &str) -> Error {
        let found = match value.get_ref() {
            DeValue::String(text) => quoted(text),
            DeValue::Integer(number) => number.as_str().to_owned(),
            DeValue::Float(number) => number.as_str().to_owned(),
            DeValue::Boolean(flag) => flag.to_string(),
            DeValue::Datetime(_) => "a date or time".to_owned(),
            DeValue::Array(_) => "a list".to_owned(),
            DeValue::Table(_) => "a table".to_owned(),
        };
        self.error(value, format!("`{key}` is {found}"), format!("give {wanted}"))
    }

    /// The line of a value.
    pub fn line_of(&self, value: &Spanned<DeValue<'_>>) -> Option<u64> {
        Some(self.document.line_of(&value.span()))
    }

    fn float(&self, number: &Number, value: &Spanned<DeValue<'_>>) -> Result<f64, Error> {
        let found = match value.get_ref() {
            DeValue::Float(text) => text.as_str().parse().ok(),
            DeValue::Integer(text) => i64::from_str_radix(text.as_str(), text.radix()).ok().map(|whole| whole as f64),
            _ => None,
        };
        let found = found.ok_or_else(|| self.mismatch(number.key, value, &number.wanted()))?;
        number.check(found).map_err(|error| self.document.place(error, self.line_of(value)))
    }

    fn pair<'v>(
        &self,
        number: &Number,
        mut values: impl Iterator<Item = &'v Spanned<DeValue<'v>>>,
        list: &Spanned<DeValue<'_>>,
    ) -> Result<[f64; 2], Error> {
        let (Some(low), Some(high), None) = (values.next(), values.next(), values.next()) else {
            let cause = format!("`{}` is a list that has not two numbers", number.key);
            return Err(self.error(list, cause, "give two numbers such as [9, 11]"));
        };
        Ok([self.float(number, low)?, self.float(number, high)?])
    }

    fn error(&self, value: &Spanned<DeValue<'_>>, cause: impl Into<String>, remedy: impl Into<String>) -> Error {
        self.document.error(Some(value.span()), cause, remedy)
    }
}

/// The value as a whole number, if it is one and at least 0.
pub fn whole(value: &Spanned<DeValue<'_>>) -> Option<u64> {
    let number = value.get_ref().as_integer()?;
    u64::from_str_radix(number.as_str(), number.radix()).ok()
}

/// The known key that is most similar to an unknown one, if any is similar enough.
fn nearest<'k>(unknown: &str, known: &[&'k str]) -> Option<&'k str> {
    let likeness = |key: &str| strsim::jaro_winkler(unknown, key);
    let best = known.iter().copied().max_by(|a, b| likeness(a).total_cmp(&likeness(b)))?;
    (likeness(best) > 0.8).then_some(best)
}
