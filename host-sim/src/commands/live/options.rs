//! The options of `live`: typed values enter, checked options or an error leave.

use std::net::SocketAddr;
use std::path::PathBuf;
use std::sync::Arc;

use super::archive::{Archive, Piece};
use super::arguments::LiveArguments;
use super::road::RoadPlay;
use crate::error::Error;
use crate::input::library::{self, Kind};
use crate::input::scenario::{Overrides, Scenario};
use crate::output;
use crate::places::can_be_file;
use crate::roads::read;

/// A live run.
#[derive(Clone, Debug)]
pub struct LiveOptions {
    /// The scenario.
    pub archive: Arc<Archive>,
    /// Where the page is served.
    pub address: SocketAddr,
    /// File of every vehicle's ticks.
    pub mcap: Option<PathBuf>,
    /// Whether a browser is opened.
    pub opens_browser: bool,
}

impl LiveOptions {
    /// Reads and checks the arguments.
    ///
    /// # Errors
    /// An unusable scenario.
    pub fn read(arguments: LiveArguments) -> Result<Self, Error> {
        let overrides = Overrides { seed: arguments.seed, set: arguments.set, ..Overrides::default() };
        let (file, text) = match &arguments.scenario {
            Some(named) => library::text(named)?,
            None => (PathBuf::new(), String::new()),
        };
        if let Some(mcap) = &arguments.mcap {
            can_be_file("--mcap", mcap, &[&file])?;
        }
        let piece = match library::kind(&file, &text)? {
            Kind::String => Piece::String(Box::new(Scenario::parse(&file, &text, &overrides)?)),
            Kind::Corridor => Piece::Road(Box::new(RoadPlay::new(read::corridor(&file, &text, &overrides)?))),
        };
        let title = match &arguments.scenario {
            Some(named) => named.file_stem().unwrap_or(named.as_os_str()).to_string_lossy().into_owned(),
            None => "the paper's scenario".into(),
        };
        let archive = Archive::new(piece, (file, text), overrides, title)?;
        archive.findings().iter().for_each(|finding| output::say(&format!("warning: {finding}")));
        Ok(Self {
            archive: Arc::new(archive),
            address: SocketAddr::new(arguments.listen, arguments.port),
            mcap: arguments.mcap,
            opens_browser: !arguments.no_browser,
        })
    }
}
