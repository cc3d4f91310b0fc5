//! The log of one vehicle's bus: frames with the times of their sending enter, a candump log leaves, by default with the
//! times that they would have on a wire.

use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};

use clap::ValueEnum;
use holdover::time::Instant;

use crate::bus::Frame;
use crate::bus::candump::LogWriter;
use crate::bus::wire::on_wire;
use crate::error::Error;
use crate::sim::time::{EPOCH_US, micros};

/// The times in a log.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Times {
    /// The end of each frame on a bus of 500 kbit/s, one frame after the other
    Wire,
    /// The instant of sending: a simulated node receives a frame in the same instant
    #[default]
    Sent,
}

/// A bus to log.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Candump {
    /// The log.
    pub file: PathBuf,
    /// Index of the vehicle whose bus it is.
    pub vehicle: usize,
    /// Its times.
    pub times: Times,
}

impl Candump {
    /// Writes the frames, which have times of the run. The log has GNSS time.
    ///
    /// # Errors
    /// The log cannot be written.
    pub fn write(&self, frames: &[(f64, Frame)]) -> Result<(), Error> {
        let file: &Path = &self.file;
        let unwritable = |error: &std::io::Error| Error::unwritable(file, error);
        let out = BufWriter::new(File::create(file).map_err(|error| unwritable(&error))?);
        let Some(mut log) = LogWriter::new(out, "can0") else {
            return Err(Error::new("the interface has no name", "report this").in_file(file));
        };
        let instant = |at_s: f64| Instant::from_micros(EPOCH_US.saturating_add_signed(micros(at_s)));
        let sent = frames.iter().map(|(at_s, frame)| (instant(*at_s), *frame)).collect();
        let timed = match self.times {
            Times::Wire => on_wire(sent),
            Times::Sent => sent,
        };
        for (at, frame) in &timed {
            log.write(*at, frame).map_err(|error| unwritable(&error))?;
        }
        log.finish().map(|_| ()).map_err(|error| unwritable(&error))
    }
}
