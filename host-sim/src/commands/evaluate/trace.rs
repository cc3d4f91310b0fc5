//! The trace: comparisons enter, a CSV file with one line for each leaves.

use std::io::{self, Write};
use std::path::Path;

use super::sample::{NAMES, Outcome, Sample};
use crate::draft::Draft;
use crate::error::Error;

/// Writes all comparisons of all recordings, which are numbered from 0 in the order of the command line.
pub fn write(file: &Path, outcomes: &[Outcome]) -> Result<(), Error> {
    let mut out = Draft::of(file)?;
    write_rows(&mut out, outcomes).map_err(|error| Error::unwritable(file, &error))?;
    out.finish()
}

fn write_rows(out: &mut impl Write, outcomes: &[Outcome]) -> io::Result<()> {
    let baselines: String = NAMES[1..].iter().map(|name| format!(",{name}_position_m,{name}_speed_mps")).collect();
    writeln!(
        out,
        "t_s,true_position_m,true_speed_mps,age_s,outage_s,estimated_position_m,estimated_speed_mps{baselines},recording"
    )?;
    for (number, outcome) in outcomes.iter().enumerate() {
        for sample in &outcome.samples {
            write_row(out, sample)?;
            writeln!(out, ",{number}")?;
        }
    }
    Ok(())
}

fn write_row(out: &mut impl Write, sample: &Sample) -> io::Result<()> {
    let Sample { at_s, age_s, outage_s, truth, beliefs } = sample;
    let outage = outage_s.map_or(String::new(), |outage_s| outage_s.to_string());
    write!(out, "{at_s:.6},{:.6},{:.6},{age_s:.6},{outage}", truth.position_m, truth.speed_mps)?;
    beliefs.iter().try_for_each(|belief| match belief {
        Some(belief) => write!(out, ",{:.6},{:.6}", belief.position_m, belief.speed_mps),
        None => write!(out, ",,"),
    })
}
