//! `run`: checked options enter; a table or JSON on stdout, a report, a trace and a candump log leave; and the verdict.

pub mod arguments;
pub mod candump;
mod collided;
mod files;
pub mod options;
mod page;
mod table;

use crate::commands::mcap_file::McapFile;
use crate::error::Error;
use crate::measure::figures::failures;
use crate::measure::simulate::simulate_beside;
use crate::measure::trajectories::{Moves, Seen, Trajectories};
use crate::progress::Progress;
use crate::sim::world::{Tick, Trace};
use crate::verdict::Verdict;
use candump::Candump;
use files::TraceFile;
use options::RunOptions;

/// Runs the scenario and writes the output that the options ask for.
///
/// # Errors
/// A scenario that the units refuse, and output that cannot be written.
pub fn run(options: &RunOptions) -> Result<Verdict, Error> {
    options.destination.warn();
    let scenario = &options.scenario;
    let progress = Progress::of_time(scenario.duration_s);
    let logged = options.candump.as_ref().map(|candump| candump.vehicle);
    let mut traced = options.trace.as_ref().map(|file| TraceFile::of(file, scenario)).transpose()?;
    let mut trajectories = options.trajectories.as_ref().map(Trajectories::of).transpose()?;
    let mut mcap = options.mcap.as_ref().map(|file| McapFile::of(file, scenario)).transpose()?;
    let mut candump = options.candump.as_ref().map(Candump::begin).transpose()?;
    let each = |at_s: f64, trace: &mut Trace, paper_m| {
        if let Some(file) = &mut traced {
            file.note(at_s, &trace.latest, paper_m);
        }
        if let Some(file) = &mut trajectories {
            file.note(at_s, string(&trace.latest));
        }
        if let Some(file) = &mut mcap {
            file.note(at_s, &trace.latest, paper_m);
        }
        if let Some(log) = &mut candump {
            log.note(&trace.log);
            trace.log.clear();
        }
    };
    let (trace, summary) =
        simulate_beside(scenario, scenario.seed, logged, each, |share| progress.at_s(share * scenario.duration_s))?;
    progress.finish();
    let failures = failures(scenario, &summary);
    let text = table::text(scenario, &summary, &failures);
    let page = || page::report(options, &trace, &summary, &failures).page();
    // One file that cannot be written does not keep the others away.
    let delivered = options.destination.deliver(&summary, &text, &text, page);
    let traced = traced.map_or(Ok(()), TraceFile::finish);
    let recorded = trajectories.map_or(Ok(()), Trajectories::finish);
    let kept = mcap.map_or(Ok(()), McapFile::finish);
    let logged = candump.map_or(Ok(()), |mut log| {
        log.note(&trace.log);
        log.finish()
    });
    delivered.and(traced).and(recorded).and(kept).and(logged)?;
    Ok(Verdict::of(&failures))
}

/// The vehicles of a string at a tick. Each follows the one before it, on a lane to the east.
fn string(ticks: &[Tick]) -> impl Iterator<Item = Seen> {
    let moves = |tick: &Tick| Moves { position_m: tick.position_m, speed_mps: tick.speed_mps };
    ticks.iter().enumerate().map(move |(vehicle, tick)| {
        let ahead = vehicle.checked_sub(1).and_then(|ahead| Some((ahead, moves(ticks.get(ahead)?))));
        Seen {
            vehicle,
            road: 0,
            place_m: (tick.position_m, 0.0),
            heading_deg: 90.0,
            moves: moves(tick),
            acceleration_mps2: tick.acceleration_mps2,
            command_mps2: tick.command_mps2,
            mode: tick.mode,
            limited: tick.limited,
            target: ahead,
            belief: tick.target,
        }
    })
}
