//! Recorded motion and recorded channels: a CSV file enters, checked rows leave.
//!
//! Columns are found by their names in the header line, in any order. Other columns are ignored, and so are a byte
//! order mark, CRLF and blank lines. There are no comments. An unusable file ends with file, line, cause and remedy
//! ([`Error`]); nothing is repaired silently. A file that can be used and tells of what cannot be is read with its
//! findings.

mod columns;
mod findings;

use crate::error::Error;
use columns::{Column, Table};
use std::path::{Path, PathBuf};

/// Columns of a motion recording.
pub const MOTION_COLUMNS: &str = "t_s,position_m,speed_mps[,acceleration_mps2]";
/// Columns of a recording of either kind.
const EITHER_COLUMNS: &str = "t_s,position_m,speed_mps or t_s,delay_s";
/// Columns of a channel recording.
pub const CHANNEL_COLUMNS: &str = "t_s,delay_s";

const TIME: Column = Column { name: "t_s", unit: "s", limits: -1e12..=1e12 };
const POSITION: Column = Column { name: "position_m", unit: "m", limits: -1e9..=1e9 };
/// The message's range ends at 65.534 m/s. A few centimetres per second below zero are the sensor noise of a standing
/// car.
const SPEED: Column = Column { name: "speed_mps", unit: "m/s", limits: -0.5..=65.534 };
const ACCELERATION: Column = Column { name: "acceleration_mps2", unit: "m/s²", limits: -50.0..=50.0 };
const DELAY: Column = Column { name: "delay_s", unit: "s", limits: 0.0..=1e6 };

/// A recording of either kind.
#[derive(Clone, Debug, PartialEq)]
pub enum Recorded {
    /// Of a drive.
    Motion(Motion),
    /// Of a link.
    Channel(ChannelTrace),
}

impl Recorded {
    /// Reads a file whose columns say what it is of.
    ///
    /// # Errors
    /// Those of [`Motion::read`] and [`ChannelTrace::read`].
    pub fn read(file: &Path) -> Result<Self, Error> {
        let bytes = std::fs::read(file).map_err(|error| Error::unreadable(file, &error))?;
        let table = Table::parse(file, &bytes, EITHER_COLUMNS)?;
        match (table.optional_column(&DELAY), table.optional_column(&POSITION)) {
            (Some(_), None) => ChannelTrace::parse_rows(file, &bytes, 2).map(Self::Channel),
            (None, None) => Err(table.lacks(&format!("{}` or `{}", POSITION.name, DELAY.name))),
            (_, Some(_)) => Motion::parse(file, &bytes).map(Self::Motion),
        }
    }
}

/// A sample of a recorded drive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionRow {
    /// Time on the recording's own clock.
    pub t_s: f64,
    /// Distance along the path.
    pub position_m: f64,
    /// Speed along the path, as recorded: noise may take it a little below 0.
    pub speed_mps: f64,
    /// Acceleration along the path, if the file has it.
    pub acceleration_mps2: Option<f64>,
}

/// A recorded drive: at least two rows, time strictly increasing.
#[derive(Clone, Debug)]
pub struct Motion {
    file: PathBuf,
    rows: Vec<MotionRow>,
    findings: Vec<Error>,
}

/// Time over which speeds give an acceleration if the file has none, in seconds.
const SLOPE_WINDOW_S: f64 = 0.5;

/// The motion at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionState {
    /// Distance along the path.
    pub position_m: f64,
    /// Speed along the path.
    pub speed_mps: f64,
    /// Acceleration along the path.
    pub acceleration_mps2: f64,
}

/// Drives with the same samples are the same, wherever they were read.
impl PartialEq for Motion {
    fn eq(&self, other: &Self) -> bool {
        self.rows == other.rows
    }
}

impl Motion {
    /// A drive that was computed: at least two rows, with time strictly increasing.
    pub(crate) fn of(rows: Vec<MotionRow>) -> Self {
        debug_assert!(rows.len() > 1 && rows.windows(2).all(|pair| pair[0].t_s < pair[1].t_s));
        Self { file: PathBuf::new(), rows, findings: Vec::new() }
    }

    /// Reads the file.
    ///
    /// # Errors
    /// The errors of [`Motion::parse`], and a file that cannot be read.
    pub fn read(file: &Path) -> Result<Self, Error> {
        Self::parse(file, &std::fs::read(file).map_err(|error| Error::unreadable(file, &error))?)
    }

    /// Reads the bytes of a file; errors name `file`.
    ///
    /// # Errors
    /// Not text, no row or only one, a missing column, not a number or out of range, time not increasing.
    pub fn parse(file: &Path, bytes: &[u8]) -> Result<Self, Error> {
        let table = Table::parse(file, bytes, MOTION_COLUMNS)?;
        let (t, position, speed) = (table.column(&TIME)?, table.column(&POSITION)?, table.column(&SPEED)?);
        let acceleration = table.optional_column(&ACCELERATION);
        let (mut rows, mut lines): (Vec<MotionRow>, Vec<u64>) = Default::default();
        for line in table.lines() {
            let row = MotionRow {
                t_s: line.number(&t)?,
                position_m: line.number(&position)?,
                speed_mps: line.number(&speed)?,
                acceleration_mps2: acceleration.as_ref().map(|column| line.number(column)).transpose()?,
            };
            line.follows(rows.last().map(|row| row.t_s), row.t_s)?;
            rows.push(row);
            lines.push(line.number_in_file());
        }
        table.has_rows(rows.len(), 2)?;
        Ok(Self { file: file.to_owned(), findings: findings::of_motion(file, &rows, &lines), rows })
    }

    /// The file that it was read from; empty for a drive that was computed.
    #[must_use]
    pub fn file(&self) -> &Path {
        &self.file
    }

    /// What no vehicle does, with file and line; empty for a recording without fault.
    #[must_use]
    pub fn findings(&self) -> &[Error] {
        &self.findings
    }

    /// The samples in the order of time.
    #[must_use]
    pub fn rows(&self) -> &[MotionRow] {
        &self.rows
    }

    /// Time of the first sample on the recording's own clock.
    #[must_use]
    pub fn start_s(&self) -> f64 {
        self.rows[0].t_s
    }

    /// Time of the last sample on the recording's own clock.
    #[must_use]
    pub fn end_s(&self) -> f64 {
        self.rows[self.rows.len() - 1].t_s
    }

    /// The acceleration that a sender knows at a time: the recorded one of the last sample at or before it. If the file
    /// has no accelerations, it is the least-squares slope of the speeds of the last 0.5 s, and 0 with fewer than 3
    /// samples.
    #[must_use]
    pub fn past_slope(&self, t_s: f64) -> f64 {
        let end = self.rows.partition_point(|row| row.t_s <= t_s);
        let Some(newest) = self.rows[..end].last() else { return 0.0 };
        if let Some(recorded) = newest.acceleration_mps2 {
            return recorded;
        }
        // The sample at exactly 0.5 s counts. Differences of decimal fractions are only nearly exact.
        let from_s = newest.t_s - SLOPE_WINDOW_S - 1e-9;
        let start = self.rows[..end].partition_point(|row| row.t_s < from_s);
        slope(&self.rows[start..end])
    }

    /// The longest time between two samples that is no gap.
    #[must_use]
    pub fn longest_interval_s(&self) -> f64 {
        findings::longest(self.rows.windows(2).map(|pair| pair[1].t_s - pair[0].t_s))
    }

    /// Time from the first sample to the last.
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        self.end_s() - self.start_s()
    }

    /// The motion at a time on the recording's own clock. Position and speed are linear between samples. So is the
    /// acceleration if the file has it; otherwise it is the slope of the speed. Before the first sample the first one
    /// holds, after the last sample the last one. The acceleration there is 0 unless recorded.
    #[must_use]
    pub fn at(&self, t_s: f64) -> MotionState {
        let next = self.rows.partition_point(|row| row.t_s <= t_s);
        let (Some(before), Some(after)) = (self.rows.get(next.wrapping_sub(1)), self.rows.get(next)) else {
            let row = self.rows[next.min(self.rows.len() - 1)];
            return MotionState {
                position_m: row.position_m,
                speed_mps: row.speed_mps,
                acceleration_mps2: row.acceleration_mps2.unwrap_or(0.0),
            };
        };
        let step_s = after.t_s - before.t_s;
        let share = (t_s - before.t_s) / step_s;
        let between = |low: f64, high: f64| low + (high - low) * share;
        MotionState {
            position_m: between(before.position_m, after.position_m),
            speed_mps: between(before.speed_mps, after.speed_mps),
            acceleration_mps2: match (before.acceleration_mps2, after.acceleration_mps2) {
                (Some(low), Some(high)) => between(low, high),
                _ => (after.speed_mps - before.speed_mps) / step_s,
            },
        }
    }
}

/// A message of a recorded channel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChannelRow {
    /// Time of sending, on the recording's own clock.
    pub t_s: f64,
    /// Delay; `None`: the message was lost.
    pub delay_s: Option<f64>,
}

/// A recorded channel: at least one row, with time not decreasing (messages may be sent at the same time).
#[derive(Clone, Debug)]
pub struct ChannelTrace {
    file: PathBuf,
    rows: Vec<ChannelRow>,
    findings: Vec<Error>,
}

/// Links with the same messages are the same, wherever they were read.
impl PartialEq for ChannelTrace {
    fn eq(&self, other: &Self) -> bool {
        self.rows == other.rows
    }
}

impl ChannelTrace {
    /// Reads a file of at least two rows: a single message is not a recording of a channel.
    ///
    /// # Errors
    /// The errors of [`ChannelTrace::parse`], a single row, and a file that cannot be read.
    pub fn read(file: &Path) -> Result<Self, Error> {
        Self::parse_rows(file, &std::fs::read(file).map_err(|error| Error::unreadable(file, &error))?, 2)
    }

    /// Reads the bytes of a file; errors name `file`.
    ///
    /// # Errors
    /// Not text, no rows, a missing column, not a number or negative, time decreasing.
    pub fn parse(file: &Path, bytes: &[u8]) -> Result<Self, Error> {
        Self::parse_rows(file, bytes, 1)
    }

    fn parse_rows(file: &Path, bytes: &[u8], least: usize) -> Result<Self, Error> {
        let table = Table::parse(file, bytes, CHANNEL_COLUMNS)?;
        let (t, delay) = (table.column(&TIME)?, table.column(&DELAY)?);
        let (mut rows, mut lines): (Vec<ChannelRow>, Vec<u64>) = Default::default();
        for line in table.lines() {
            let row = ChannelRow { t_s: line.number(&t)?, delay_s: line.number_or_empty(&delay)? };
            line.does_not_precede(rows.last().map(|row| row.t_s), row.t_s)?;
            rows.push(row);
            lines.push(line.number_in_file());
        }
        table.has_rows(rows.len(), least)?;
        Ok(Self { file: file.to_owned(), findings: findings::of_channel(file, &rows, &lines), rows })
    }

    /// The file that it was read from.
    #[must_use]
    pub fn file(&self) -> &Path {
        &self.file
    }

    /// What no link does, with file and line; empty for a recording without fault.
    #[must_use]
    pub fn findings(&self) -> &[Error] {
        &self.findings
    }

    /// Whether any message arrives.
    #[must_use]
    pub fn delivers(&self) -> bool {
        self.rows.iter().any(|row| row.delay_s.is_some())
    }

    /// Time from the first message to the last.
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        self.rows[self.rows.len() - 1].t_s - self.rows[0].t_s
    }

    /// The messages, in the order of sending.
    #[must_use]
    pub fn rows(&self) -> &[ChannelRow] {
        &self.rows
    }

    /// Time after which the recording starts again; `None` with a single row.
    fn cycle_s(&self) -> Option<f64> {
        let rows = self.rows.len();
        (rows > 1).then(|| self.duration_s() * (rows as f64 / (rows - 1) as f64))
    }

    /// That a run of this length hears the recording more than once, if it does.
    #[must_use]
    pub fn repeats(&self, run_s: f64) -> Option<Error> {
        let cycle_s = self.cycle_s().filter(|cycle_s| run_s > cycle_s + 1e-6)?;
        let cause = format!("lasts {cycle_s:.1} s and the run {run_s:.1} s, so it is repeated from {cycle_s:.1} s on");
        Some(Error::new(cause, "shorten the run by `duration_s`, or give a longer recording").in_file(&self.file))
    }

    /// The delay of a message that is sent this long after the start: the delay of the latest row at or before that
    /// time, counted from the first row. `None`: lost. After its end the recording starts again from its beginning, one
    /// mean interval after its last row. A recording of one row repeats that row for ever.
    #[must_use]
    pub fn delay_at(&self, since_start_s: f64) -> Option<f64> {
        let first = self.rows[0];
        let Some(cycle_s) = self.cycle_s() else { return first.delay_s };
        let t_s = first.t_s + since_start_s.rem_euclid(cycle_s);
        let next = self.rows.partition_point(|row| row.t_s <= t_s);
        self.rows[next.saturating_sub(1)].delay_s
    }
}

/// The least-squares slope of the speeds; 0 with fewer than 3 samples.
fn slope(rows: &[MotionRow]) -> f64 {
    if rows.len() < 3 {
        return 0.0;
    }
    let count = rows.len() as f64;
    let mean = |of: fn(&MotionRow) -> f64| rows.iter().map(of).sum::<f64>() / count;
    let (t, v) = (mean(|row| row.t_s), mean(|row| row.speed_mps));
    let (above, below) = rows.iter().fold((0.0, 0.0), |(above, below), row| {
        (above + (row.t_s - t) * (row.speed_mps - v), below + (row.t_s - t) * (row.t_s - t))
    });
    above / below
}

#[cfg(test)]
mod tests {
    use super::*;

    fn motion(text: &str) -> Motion {
        Motion::parse(Path::new("m.csv"), text.as_bytes()).unwrap()
    }

    #[test]
    fn motion_is_linear_between_samples_and_held_at_its_ends() {
        let drive = motion("t_s,position_m,speed_mps\n5,100,10\n7,122,12\n");
        let at = |t| drive.at(t);
        assert_eq!(at(6.0), MotionState { position_m: 111.0, speed_mps: 11.0, acceleration_mps2: 1.0 });
        assert_eq!(at(5.0), MotionState { position_m: 100.0, speed_mps: 10.0, acceleration_mps2: 1.0 });
        assert_eq!(at(0.0), MotionState { position_m: 100.0, speed_mps: 10.0, acceleration_mps2: 0.0 });
        assert_eq!(at(7.0), MotionState { position_m: 122.0, speed_mps: 12.0, acceleration_mps2: 0.0 });
        assert_eq!((drive.start_s(), drive.end_s(), drive.duration_s()), (5.0, 7.0, 2.0));
    }

    #[test]
    fn a_recorded_acceleration_is_used_instead_of_the_slope() {
        let drive = motion("acceleration_mps2,t_s,position_m,speed_mps\n0.5,0,0,10\n1.5,1,10,10\n");
        assert_eq!(drive.at(0.5).acceleration_mps2, 1.0);
        assert_eq!(drive.at(9.0).acceleration_mps2, 1.5);
    }

    #[test]
    fn a_message_takes_the_latest_row_before_it_and_the_recording_repeats() {
        let trace = ChannelTrace::parse(Path::new("c.csv"), b"t_s,delay_s\n10,0.1\n11,\n12,0.3\n").unwrap();
        let expected = [(0.0, Some(0.1)), (0.9, Some(0.1)), (1.0, None), (2.0, Some(0.3)), (2.9, Some(0.3))];
        for (t, delay) in expected {
            assert_eq!(trace.delay_at(t), delay, "{t}");
            assert_eq!(trace.delay_at(t + 3.0), delay, "{t}, second round");
        }
        let single = ChannelTrace::parse(Path::new("c.csv"), b"t_s,delay_s\n3,0.2").unwrap();
        assert_eq!(single.delay_at(1e6), Some(0.2));
    }
}
