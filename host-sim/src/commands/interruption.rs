//! The end of a command that runs until it is ended: SIGINT (Ctrl-C) and SIGTERM enter; whether one of them has come leaves.

use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::error::Error;

/// Whether a signal has asked the program to end. A clone is the same answer.
#[derive(Clone, Debug, Default)]
pub struct Interruption(Arc<AtomicBool>);

impl Interruption {
    /// A second signal ends the program at once, as it would without this, so that a log that nobody reads cannot hold it up.
    #[cfg(target_os = "linux")]
    fn of_system() -> io::Result<Self> {
        use nix::sys::signal::{SigSet, Signal};
        let signals = SigSet::from_iter([Signal::SIGINT, Signal::SIGTERM]);
        signals.thread_block()?;
        let asked = Self::default();
        let flag = asked.clone();
        std::thread::Builder::new().name("signals".into()).spawn(move || {
            if signals.wait().is_ok() {
                flag.ask();
            }
            // This thread is then the one that a further signal ends, and the program with it.
            let _ = signals.thread_unblock();
            loop {
                std::thread::park();
            }
        })?;
        Ok(asked)
    }

    /// A signal ends the program as any other; there are CAN interfaces on Linux only.
    #[cfg(not(target_os = "linux"))]
    fn of_system() -> io::Result<Self> {
        Ok(Self::default())
    }

    /// Waits for the first signal from now on. It has to be called before the program has a second thread.
    ///
    /// # Errors
    /// Errors of the system.
    pub fn awaited() -> Result<Self, Error> {
        Self::of_system().map_err(|error| {
            let remedy = "report this, with the system's name and version";
            Error::new(format!("signals cannot be awaited ({error})"), remedy)
        })
    }

    /// Asks the program to end.
    pub fn ask(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Whether the program was asked to end.
    #[must_use]
    pub fn is_asked(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}
