//! The options of `evaluate`: typed values enter; recordings that have been read and fit together leave.

use super::arguments::EvaluateArguments;
use crate::commands::ending::Destination;
use crate::error::{Error, quoted};
use crate::input::recording::{ChannelTrace, Motion};
use crate::places::can_be_file;
use std::path::{Path, PathBuf};

/// The measurement, and where its results go.
#[derive(Clone, Debug, PartialEq)]
pub struct EvaluateOptions {
    /// The recorded vehicles.
    pub recordings: Vec<Recording>,
    /// The link, or the silences.
    pub impairment: Impairment,
    /// Prediction step of the core, and time between two ticks.
    pub step_s: f64,
    /// Where its results go.
    pub destination: Destination,
    /// File for the trace of every tick.
    pub trace: Option<PathBuf>,
}

/// A recorded vehicle.
#[derive(Clone, Debug, PartialEq)]
pub struct Recording {
    /// Its file.
    pub file: PathBuf,
    /// Its drive.
    pub motion: Motion,
    /// The file and the drive of the vehicle that it follows, if that is recorded.
    pub predecessor: Option<(PathBuf, Motion)>,
}

/// What delays or loses messages.
#[derive(Clone, Debug, PartialEq)]
pub enum Impairment {
    /// A recorded link.
    Channel(PathBuf, ChannelTrace),
    /// Silences of these lengths in seconds, in the order in which they were named.
    Outages(Vec<f64>),
}

impl EvaluateOptions {
    /// Reads and checks the command line.
    ///
    /// # Errors
    /// Unusable input, and output that cannot be written.
    pub fn read(arguments: EvaluateArguments) -> Result<Self, Error> {
        if !(0.001..=1.0).contains(&arguments.step) {
            let cause = format!("is {}", arguments.step);
            return Err(Error::new(cause, "give seconds from 0.001 to 1").in_option("--step"));
        }
        let impairment = impairment(&arguments)?;
        let recordings = recordings(&arguments)?;
        if let Impairment::Channel(file, trace) = &impairment {
            recordings.iter().try_for_each(|recording| recording.overlaps(file, trace))?;
        }
        let destination = arguments.output.read()?;
        let inputs = arguments.motion.iter().chain(&arguments.predecessor).chain(&arguments.channel);
        let destination = destination.with_inputs(inputs.map(PathBuf::as_path))?;
        let destination = destination.with_findings(findings(&recordings, &impairment), arguments.strict)?;
        if let Some(file) = &arguments.trace {
            let inputs = arguments.motion.iter().chain(&arguments.predecessor).chain(&arguments.channel);
            can_be_file("--trace", file, &inputs.map(PathBuf::as_path).collect::<Vec<_>>())?;
        }
        let EvaluateArguments { step: step_s, trace, .. } = arguments;
        Ok(Self { recordings, impairment, step_s, destination, trace })
    }

    /// The lengths of the silences, if silences are measured.
    #[must_use]
    pub fn lengths_s(&self) -> Option<&[f64]> {
        match &self.impairment {
            Impairment::Channel(..) => None,
            Impairment::Outages(lengths_s) => Some(lengths_s),
        }
    }
}

/// What the recordings say that cannot be.
fn findings(recordings: &[Recording], impairment: &Impairment) -> Vec<Error> {
    let ahead = |recording: &Recording| recording.predecessor.as_ref().map(|(_, motion)| motion.findings().to_vec());
    let drives = recordings
        .iter()
        .flat_map(|recording| [recording.motion.findings().to_vec(), ahead(recording).unwrap_or_default()].concat());
    match impairment {
        Impairment::Channel(_, link) => drives.chain(link.findings().iter().cloned()).collect(),
        Impairment::Outages(_) => drives.collect(),
    }
}

fn impairment(arguments: &EvaluateArguments) -> Result<Impairment, Error> {
    match (&arguments.channel, &arguments.outage) {
        (Some(file), None) => Ok(Impairment::Channel(file.clone(), ChannelTrace::read(file)?)),
        (None, Some(lengths)) => outages(lengths).map(Impairment::Outages),
        (None, None) => {
            let remedy = "give --channel FILE.csv, or --outage with lengths in seconds such as 0.5,1,2,4";
            Err(Error::new("nothing keeps the messages away", remedy))
        }
        (Some(_), Some(_)) => {
            Err(Error::new("cannot be used together with --channel", "give one of the two").in_option("--outage"))
        }
    }
}

/// The lengths of silences: all different and positive.
fn outages(list: &str) -> Result<Vec<f64>, Error> {
    let mut lengths: Vec<f64> = Vec::new();
    for text in list.split(',').map(str::trim) {
        let error = |cause: &str, remedy: &str| Err(Error::new(cause, remedy).in_option("--outage"));
        let remedy = "give lengths in seconds with commas between, such as 0.5,1,2,4";
        match text.parse::<f64>() {
            Ok(length) if (1e-3..=1e5).contains(&length) => {
                if lengths.contains(&length) {
                    return error(&format!("names {text} s twice"), "name each length once");
                }
                lengths.push(length);
            }
            Ok(_) => return error(&format!("has a length of {} s", quoted(text)), "give seconds from 0.001 to 100000"),
            Err(_) if text.is_empty() => return error("has an empty place", remedy),
            Err(_) => return error(&format!("has {}, which is not a number", quoted(text)), remedy),
        }
    }
    Ok(lengths)
}

fn recordings(arguments: &EvaluateArguments) -> Result<Vec<Recording>, Error> {
    let (motions, predecessors) = (arguments.motion.len(), arguments.predecessor.len());
    if predecessors != 0 && predecessors != motions {
        let cause = format!("names {predecessors} of the vehicles ahead of {motions}");
        return Err(Error::new(cause, "give one file for each --motion, in the same order").in_option("--predecessor"));
    }
    let mut recordings = Vec::new();
    for (index, file) in arguments.motion.iter().enumerate() {
        let predecessor = match arguments.predecessor.get(index) {
            Some(file) => Some((file.clone(), Motion::read(file)?)),
            None => None,
        };
        recordings.push(Recording { file: file.clone(), motion: Motion::read(file)?, predecessor });
    }
    Ok(recordings)
}

impl Recording {
    /// Checks that a message can be sent over the link while the vehicle drives, and while its predecessor does.
    fn overlaps(&self, channel: &Path, trace: &ChannelTrace) -> Result<(), Error> {
        let (first_s, last_s) = (trace.rows()[0].t_s, trace.rows()[trace.rows().len() - 1].t_s);
        let drives = std::iter::once((&self.file, &self.motion)).chain(self.predecessor.as_ref().map(|(f, m)| (f, m)));
        for (file, motion) in drives {
            let (start_s, end_s) = (motion.start_s(), motion.end_s());
            if last_s < start_s || first_s > end_s {
                let other = quoted(&channel.to_string_lossy());
                let cause = format!(
                    "is of {start_s} to {end_s} s, which shares no time with {other} of {first_s} to {last_s} s"
                );
                return Err(Error::new(cause, "give recordings of the same clock (usually from 0 s on)").in_file(file));
            }
        }
        Ok(())
    }
}
