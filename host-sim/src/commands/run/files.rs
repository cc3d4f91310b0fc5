//! The file of a run's trace: the trace enters, a CSV of every tick leaves.

use std::io::Write;
use std::path::Path;

use crate::draft::Draft;
use crate::error::Error;
use crate::input::scenario::Scenario;
use crate::measure::figures::{mode_name, papers};
use crate::sim::world::Trace;

/// Writes every tick of the measured vehicle as its follower estimates it, with the bound on the bus and the follower's
/// command. `limited` is 1 where the envelope changed that command.
pub fn write_trace(file: &Path, scenario: &Scenario, trace: &Trace) -> Result<(), Error> {
    let mut out = Draft::of(file)?;
    write_rows(&mut out, scenario, trace).map_err(|error| Error::unwritable(file, &error))?;
    out.finish()
}

fn write_rows(out: &mut impl Write, scenario: &Scenario, trace: &Trace) -> std::io::Result<()> {
    writeln!(
        out,
        "t_s,true_position_m,true_speed_mps,true_acceleration_mps2,estimated_position_m,estimated_speed_mps,age_s,mode,\
         command_mps2,paper_position_m,gap_m,lowest_position_m,highest_position_m,lowest_speed_mps,highest_speed_mps,\
         limited"
    )?;
    let (measured, by) = (&trace.vehicles[trace.measured.vehicle], &trace.vehicles[trace.measured.by]);
    let length_m = scenario.vehicles[trace.measured.vehicle].length_m;
    let papers = papers(trace);
    for (tick, at_s) in trace.times_s.iter().enumerate() {
        let (truth, seen) = (&measured[tick], &by[tick]);
        let field = |value: Option<f64>| value.map_or(String::new(), |value| format!("{value:.6}"));
        let bound = seen.target.and_then(|target| target.bound);
        writeln!(
            out,
            "{at_s:.6},{:.6},{:.6},{:.6},{},{},{},{},{:.6},{},{:.6},{},{},{},{},{}",
            truth.position_m,
            truth.speed_mps,
            truth.acceleration_mps2,
            field(seen.target.map(|target| target.position_m)),
            field(seen.target.map(|target| target.speed_mps)),
            field(seen.target.map(|target| target.age_s)),
            mode_name(seen.mode),
            seen.command_mps2,
            field(papers(tick)),
            truth.position_m - length_m - seen.position_m,
            field(bound.map(|bound| bound.lowest_position_m)),
            field(bound.map(|bound| bound.highest_position_m)),
            field(bound.map(|bound| bound.lowest_speed_mps)),
            field(bound.map(|bound| bound.highest_speed_mps)),
            u8::from(seen.limited),
        )?;
    }
    Ok(())
}
