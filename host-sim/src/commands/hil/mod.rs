//! `hil`: hardware in the loop. A scenario enters, and a CAN interface with a device on it. A verdict on the device, a
//! table or JSON on stdout and a report leave.
//!
//! ```text
//! world -> talk -> port (SocketCAN) -> device
//!   ^        `--------> twin            |
//!   `--- seat <- session <- port <------+-> monitor, deviation -> judge -> table, JSON, report
//! ```
//! [`session`] is a run in real time, and [`lock_step`] a run step by step. [`fault_injector`] injects the faults. A
//! [`virtual_bus`] tests all of it without CAN.

pub mod arguments;
pub mod content;
mod deviation;
pub mod fault;
pub mod fault_injector;
pub mod judge;
pub mod lateness;
pub mod lock_step;
pub mod monitor;
pub mod options;
pub mod outcome;
mod page;
pub mod record;
pub mod recovery;
pub mod rig;
pub mod said;
pub mod session;
pub mod spread;
pub mod table;
pub mod talk;
pub mod twin;
pub mod virtual_bus;

use crate::bus;
use crate::commands::mcap_file::McapFile;
use crate::error::Error;
use crate::progress::Progress;
use crate::verdict::Verdict;
use judge::judge;
use options::HilOptions;
use rig::MachineRig;

/// Runs the setup and writes the output that the options ask for.
///
/// # Errors
/// An interface that cannot be used, and output that cannot be written.
pub fn run(options: &HilOptions) -> Result<Verdict, Error> {
    options.destination.warn();
    let port = bus::open(&options.bus)?;
    let mut rig = MachineRig::new(&options.bus, options.device.clone());
    let done = Progress::of_time(options.setup.scenario.duration_s);
    let progress = |at_s: f64| done.at_s(at_s.max(0.0));
    let outcome = if options.lock_step {
        lock_step::run(&options.setup, port, &mut rig, progress)
    } else {
        session::run(&options.setup, port, &mut rig, progress)
    };
    drop(rig);
    done.finish();
    let outcome = outcome.map_err(|error| {
        let cause = format!("the run ended: {error}");
        Error::new(cause, "see whether the interface is still there: ip -details link").in_option("--bus")
    })?;
    let results = judge(&options.setup, &outcome);
    let text = table::text(&results);
    options.destination.deliver(&results, &text, &text, || page::render(options, &outcome, &results))?;
    if let Some(file) = &options.mcap {
        let mut mcap = McapFile::of(file, &options.setup.scenario)?;
        outcome.recorded.trace.each(|at_s, ticks, paper_m| mcap.note(at_s, ticks, paper_m));
        mcap.finish()?;
    }
    Ok(results.code())
}
