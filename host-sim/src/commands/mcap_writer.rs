//! A file of MCAP with JSON channels: schemas, channels and messages enter; a file leaves, whole or not at all.
//!
//! Times are GNSS time of the run, as in a log of its bus. Nothing is compressed, so the file needs no C library.

use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};

use mcap::records::MessageHeader;
use mcap::write::NoSeek;
use mcap::{McapError, WriteOptions, Writer};
use serde::Serialize;
use serde_json::{Value, json};

use crate::draft::Draft;
use crate::error::Error;
use crate::sim::time::gnss;

/// The file, as far as it is written.
pub struct McapWriter {
    file: PathBuf,
    writer: Writer<NoSeek<Draft>>,
    sequence: u32,
    /// The first failure. After it nothing more is written, and the run goes on.
    written: Result<(), McapError>,
}

impl McapWriter {
    /// An empty file.
    ///
    /// # Errors
    /// A file that cannot be created.
    pub fn of(file: &Path) -> Result<Self, Error> {
        let options = WriteOptions::new().compression(None).disable_seeking(true).library("holdover-sim");
        let draft = NoSeek::new(Draft::of(file)?);
        let writer = options.create(draft).map_err(|error| unwritable(file, error))?;
        Ok(Self { file: file.to_owned(), writer, sequence: 0, written: Ok(()) })
    }

    /// A channel with this schema: the names of its values and what they are.
    pub fn channel(&mut self, schema: &str, properties: &Value, topic: &str) -> u16 {
        let text = json!({ "title": schema, "type": "object", "properties": properties }).to_string();
        // The same schema is written once.
        let added = self.writer.add_schema(schema, "jsonschema", text.as_bytes());
        let added = added.and_then(|schema| self.writer.add_channel(schema, topic, "json", &BTreeMap::new()));
        self.kept(added).unwrap_or_default()
    }

    /// A message.
    pub fn write(&mut self, channel_id: u16, at_s: f64, message: &impl Serialize) {
        if self.written.is_err() {
            return;
        }
        let at = gnss(at_s).as_micros() * 1_000;
        let header = MessageHeader { channel_id, sequence: self.sequence, log_time: at, publish_time: at };
        let data = serde_json::to_vec(message).map_err(|error| io::Error::other(error).into());
        let written = data.and_then(|data| self.writer.write_to_known_channel(&header, &data));
        self.kept(written);
    }

    /// The messages from now on are of the next tick.
    pub fn next(&mut self) {
        self.sequence = self.sequence.wrapping_add(1);
    }

    /// Ends the file.
    ///
    /// # Errors
    /// A file that could not be written.
    pub fn finish(self) -> Result<(), Error> {
        let Self { file, mut writer, written, .. } = self;
        written.and_then(|()| writer.finish()).map_err(|error| unwritable(&file, error))?;
        writer.into_inner().into_inner().finish()
    }

    fn kept<T>(&mut self, result: Result<T, McapError>) -> Option<T> {
        match result {
            Ok(value) => Some(value),
            Err(error) => {
                self.written = std::mem::replace(&mut self.written, Ok(())).and(Err(error));
                None
            }
        }
    }
}

/// What a schema says of these names; a number that is not known is null.
pub fn properties(names: &[&str]) -> Value {
    let kind = |name: &str| match name {
        "mode" => json!({ "type": "string" }),
        "limited" => json!({ "type": "boolean" }),
        _ => json!({ "type": ["number", "null"] }),
    };
    names.iter().map(|name| ((*name).to_owned(), kind(name))).collect()
}

/// The name of the schema of a place on a map.
pub const FIX: &str = "foxglove.LocationFix";

/// Its properties.
pub fn location_fix() -> Value {
    let number = json!({ "type": "number" });
    let time =
        json!({ "type": "object", "properties": { "sec": { "type": "integer" }, "nsec": { "type": "integer" } } });
    json!({
        "timestamp": time,
        "frame_id": { "type": "string" },
        "latitude": number,
        "longitude": number,
        "altitude": number,
        "position_covariance": { "type": "array", "items": number },
        "position_covariance_type": { "type": "integer" },
    })
}

/// A place on a map.
pub fn fix(at_s: f64, latitude: f64, longitude: f64) -> Value {
    let micros = gnss(at_s).as_micros();
    json!({
        "timestamp": { "sec": micros / 1_000_000, "nsec": micros % 1_000_000 * 1_000 },
        "frame_id": "earth",
        "latitude": latitude,
        "longitude": longitude,
        "altitude": 0.0,
        "position_covariance": [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        "position_covariance_type": 0,
    })
}

fn unwritable(file: &Path, error: McapError) -> Error {
    let error = match error {
        McapError::Io(error) => error,
        other => io::Error::other(other.to_string()),
    };
    Error::unwritable(file, &error)
}
