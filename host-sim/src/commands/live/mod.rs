//! `live`: a scenario enters; a page in the browser shows it, and those who look at it drive, break links and go back in time. What was
//! driven and changed leaves as a scenario that `run` repeats bit for bit.
//!
//! ```text
//! page <-> server -> asks -> engine -> stage (the world, and those who look at it) -> scene -> server
//!                    (one thread)  '-> journal of events -> archive: scenario, candump
//! ```

pub mod archive;
pub mod arguments;
pub mod bus_view;
pub mod device;
pub mod engine;
pub mod guard;
pub mod methods;
pub mod onlookers;
pub mod options;
pub mod order;
pub mod page;
pub mod road;
mod road_scene;
pub mod scene;
pub mod server;
pub mod snapshots;
pub mod stage;

use std::io;
use std::net::TcpListener;
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::Arc;
use std::sync::mpsc;

use tokio::sync::watch;

use crate::bus::Port;
use crate::commands::hil::judge::said;
use crate::commands::hil::rig::MachineRig;
use crate::commands::hil::session;
use crate::commands::interruption::Interruption;
use crate::commands::mcap_file::McapFile;
use crate::error::{Error, plain};
use crate::output;
use crate::verdict::Verdict;
use archive::Piece;
use device::Device;
use engine::{Ask, Engine};
use options::{LiveOptions, OnBus};
use server::Desk;

/// Runs the world and serves the page, until it is interrupted.
///
/// # Errors
/// A port that is taken, and a scenario that the units refuse.
pub fn run(options: &LiveOptions) -> Result<Verdict, Error> {
    let LiveOptions { archive, address, mcap, device, opens_browser } = options;
    let address = *address;
    let end = Interruption::awaited()?;
    let unheard = |error: io::Error| match error.kind() {
        io::ErrorKind::AddrInUse => {
            let remedy = "give another one, --port 0 for any that is free, or end the program that has it";
            Error::new(format!("port {} of {} is in use", address.port(), address.ip()), remedy).in_option("--port")
        }
        _ => {
            let remedy = "give an address of this computer, and a port from 1024 on";
            Error::new(format!("{address} cannot be listened on ({})", plain(&error)), remedy).in_option("--listen")
        }
    };
    let port = device.as_ref().map(|device| crate::bus::open(&device.bus)).transpose()?;
    let listener = TcpListener::bind(address).map_err(unheard)?;
    let heard = listener.local_addr().map_err(unheard)?;
    let (asks, asked) = mpsc::channel();
    let (scenes, shown) = watch::channel(Arc::from("{}"));
    server::serve(listener, Desk::new(asks, shown, Arc::clone(archive), heard.ip().is_loopback())).map_err(unheard)?;
    output::print(&format!("http://{heard}/\n"))?;
    if !heard.ip().is_loopback() {
        output::say("note: every computer that reaches this address can drive; without --listen only this one can");
    }
    if *opens_browser {
        open(&format!("http://{heard}/"));
    }
    if let (Some(device), Some(port)) = (device, port) {
        return with_device(device, port, asked, scenes, &end, mcap.as_deref());
    }
    let ended = match &archive.piece {
        Piece::String(scenario) => Engine::new(&**scenario, asked, scenes).run(&end),
        Piece::Road(road) => Engine::new(&**road, asked, scenes).run(&end),
    };
    let (events, ticks) = ended.map_err(|error| {
        Error::new(format!("the simulation ended ({error})"), "change the scenario accordingly, or report this")
    })?;
    match mcap {
        Some(file) => archive.mcap(events, ticks, file).map(|()| Verdict::Pass),
        None => Ok(Verdict::Pass),
    }
}

/// The same with a device in the world, until it is interrupted or the device is gone.
fn with_device(
    OnBus { bus, setup, command }: &OnBus,
    port: impl Port,
    asked: mpsc::Receiver<Ask>,
    scenes: watch::Sender<Arc<str>>,
    end: &Interruption,
    mcap: Option<&Path>,
) -> Result<Verdict, Error> {
    let mut rig = MachineRig::new(bus, command.clone());
    let mcap = mcap.map(|file| McapFile::of(file, &setup.scenario)).transpose()?;
    let mut desk = Device::new(&setup.scenario, asked, scenes, end, mcap);
    let outcome = session::run_before(setup, port, &mut rig, &mut desk, |_| {});
    drop(rig);
    let written = desk.into_mcap().map_or(Ok(()), McapFile::finish);
    let outcome = outcome.map_err(|error| {
        let remedy = "see whether the interface is still there: ip -details link";
        Error::new(format!("the run ended: {error}"), remedy).in_option("--bus")
    })?;
    written?;
    let failures: Vec<String> = outcome.cut.iter().map(said).collect();
    failures.iter().for_each(|failure| output::say(failure));
    Ok(Verdict::of(&failures))
}

/// Opens the page in the user's browser. Where none can be opened, the address has been printed.
fn open(address: &str) {
    let program = if cfg!(target_os = "macos") { "open" } else { "xdg-open" };
    let mut command = if cfg!(windows) { Command::new("explorer") } else { Command::new(program) };
    let started = command.arg(address).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).spawn();
    if started.is_err() {
        output::say("note: no browser could be started; open the address yourself");
    }
}
