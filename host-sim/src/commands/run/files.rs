//! The file of a run's trace: the run enters tick by tick, a CSV of every tick leaves.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use crate::draft::Draft;
use crate::error::Error;
use crate::input::scenario::Scenario;
use crate::measure::figures::mode_name;
use crate::sim::world::{Measured, Tick};

const HEADER: &str = "t_s,true_position_m,true_speed_mps,true_acceleration_mps2,estimated_position_m,estimated_speed_mps,age_s,mode,\
                      command_mps2,paper_position_m,gap_m,lowest_position_m,highest_position_m,lowest_speed_mps,highest_speed_mps,\
                      limited";

/// The file, as far as it is written.
pub struct TraceFile {
    file: PathBuf,
    out: Draft,
    measured: Measured,
    length_m: f64,
    /// The first failure. After it nothing more is written, and the run goes on.
    written: io::Result<()>,
}

impl TraceFile {
    /// A file with its header.
    ///
    /// # Errors
    /// A file that cannot be created.
    pub fn of(file: &Path, scenario: &Scenario) -> Result<Self, Error> {
        let measured = Measured::of(scenario);
        let mut out = Draft::of(file)?;
        let written = writeln!(out, "{HEADER}");
        Ok(Self {
            file: file.to_owned(),
            out,
            measured,
            length_m: scenario.vehicles[measured.vehicle].length_m,
            written,
        })
    }

    /// Writes the tick of the measured vehicle as its follower estimates it, with the bound on the bus and the follower's command.
    /// `limited` is 1 where the envelope changed that command.
    pub fn note(&mut self, at_s: f64, ticks: &[Tick], paper_m: Option<f64>) {
        if self.written.is_ok() {
            self.written = self.row(at_s, &ticks[self.measured.vehicle], &ticks[self.measured.by], paper_m);
        }
    }

    /// Ends the file.
    ///
    /// # Errors
    /// A file that could not be written.
    pub fn finish(self) -> Result<(), Error> {
        self.written.map_err(|error| Error::unwritable(&self.file, &error))?;
        self.out.finish()
    }

    fn row(&mut self, at_s: f64, truth: &Tick, seen: &Tick, paper_m: Option<f64>) -> io::Result<()> {
        let field = |value: Option<f64>| value.map_or(String::new(), |value| format!("{value:.6}"));
        let bound = seen.target.and_then(|target| target.bound);
        writeln!(
            self.out,
            "{at_s:.6},{:.6},{:.6},{:.6},{},{},{},{},{:.6},{},{:.6},{},{},{},{},{}",
            truth.position_m,
            truth.speed_mps,
            truth.acceleration_mps2,
            field(seen.target.map(|target| target.position_m)),
            field(seen.target.map(|target| target.speed_mps)),
            field(seen.target.map(|target| target.age_s)),
            mode_name(seen.mode),
            seen.command_mps2,
            field(paper_m),
            truth.position_m - self.length_m - seen.position_m,
            field(bound.map(|bound| bound.lowest_position_m)),
            field(bound.map(|bound| bound.highest_position_m)),
            field(bound.map(|bound| bound.lowest_speed_mps)),
            field(bound.map(|bound| bound.highest_speed_mps)),
            u8::from(seen.limited),
        )
    }
}
