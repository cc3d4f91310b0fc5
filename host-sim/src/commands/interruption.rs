//! The end of a recording by a signal: SIGINT (Ctrl-C) and SIGTERM enter; whether one of them has come leaves.

use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Whether a signal has asked the program to end. A clone is the same answer.
#[derive(Clone, Debug, Default)]
pub struct Interruption(Arc<AtomicBool>);

impl Interruption {
    /// Waits for the first signal from now on. A second one ends the program at once, as it would without this, so that
    /// a log that nobody reads cannot hold it up. It has to be called before the program has a second thread.
    ///
    /// # Errors
    /// Errors of the system.
    #[cfg(target_os = "linux")]
    pub fn awaited() -> io::Result<Self> {
        use nix::sys::signal::{SigSet, Signal};
        let signals = SigSet::from_iter([Signal::SIGINT, Signal::SIGTERM]);
        signals.thread_block()?;
        let awaited = Self::default();
        let flag = awaited.clone();
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
        Ok(awaited)
    }

    /// A signal ends the program as any other; there are CAN interfaces on Linux only.
    ///
    /// # Errors
    /// None.
    #[cfg(not(target_os = "linux"))]
    pub fn awaited() -> io::Result<Self> {
        Ok(Self::default())
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
