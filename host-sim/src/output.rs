//! The two streams of the terminal: results leave by stdout, progress and logs by stderr.
//!
//! `println!` panics when the reader has closed the pipe (`holdover-sim --json | head -c 1`); these two do not.

use crate::error::Error;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::{self, Write};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Prints results on stdout. A reader that has gone has what it wanted: a broken pipe is no error.
///
/// # Errors
/// Anything else that keeps the results from arriving whole, such as a full disk.
pub fn print(results: &str) -> Result<(), Error> {
    print_to(&mut io::stdout().lock(), results)
}

/// Prints a line of progress or of the log on stderr; nothing is owed to a stderr that is closed.
pub fn say(line: &str) {
    let _ = writeln!(io::stderr().lock(), "{line}");
}

fn print_to(out: &mut impl Write, results: &str) -> Result<(), Error> {
    match out.write_all(results.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(Error::unwritable("standard output".as_ref(), &error))
        }
        _ => Ok(()),
    }
}

/// Short runs, of which many are to come: a bar on a terminal, and every ten seconds a line where there is none.
pub struct Progress {
    bar: ProgressBar,
    since: Instant,
    said: Mutex<Duration>,
}

/// Time from one line to the next.
const EVERY: Duration = Duration::from_secs(10);

impl Progress {
    /// So many are to come.
    #[must_use]
    pub fn new(runs: u64) -> Self {
        Self { bar: progress(runs), since: Instant::now(), said: Mutex::new(Duration::ZERO) }
    }

    /// One more is done.
    pub fn inc(&self) {
        self.bar.inc(1);
        if self.bar.is_hidden() {
            self.say(self.since.elapsed(), say);
        }
    }

    fn say(&self, spent: Duration, say: impl Fn(&str)) {
        // Whoever comes while another one says something leaves it to that one.
        let Ok(mut said) = self.said.try_lock() else { return };
        if spent.saturating_sub(*said) >= EVERY {
            *said = spent;
            let (done, runs) = (self.bar.position() as usize, self.bar.length().unwrap_or(0) as usize);
            say(&line(done, runs, &format!("{:.0} s", spent.as_secs_f64()), spent));
        }
    }

    /// All are done.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

/// A bar on stderr that tells how many runs are done, of so many.
fn progress(runs: u64) -> ProgressBar {
    let bar = ProgressBar::new(runs);
    // The template is a constant; should it ever be wrong, the usual bar does.
    if let Ok(style) = ProgressStyle::with_template("{wide_bar} {pos}/{len} runs, {eta} to go") {
        bar.set_style(style);
    }
    bar
}

/// Long runs, of which each says when it is done: a bar on a terminal, and a line for each where there is none.
pub struct LongRuns {
    bar: ProgressBar,
    since: Instant,
    runs: usize,
    done: Mutex<usize>,
}

impl LongRuns {
    /// So many are to come.
    #[must_use]
    pub fn new(runs: usize) -> Self {
        let bar = progress(runs as u64);
        bar.enable_steady_tick(Duration::from_secs(1));
        Self { bar, since: Instant::now(), runs, done: Mutex::new(0) }
    }

    /// One more is done.
    pub fn done(&self, which: &str) {
        // Locked until the line is said, so that the lines come in order.
        let mut done = self.done.lock().unwrap_or_else(PoisonError::into_inner);
        *done += 1;
        self.bar.inc(1);
        if self.bar.is_hidden() {
            say(&line(*done, self.runs, which, self.since.elapsed()));
        }
    }

    /// All are done.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

/// What is done, and what is left if the runs to come take as long as those before them.
fn line(done: usize, runs: usize, which: &str, spent: Duration) -> String {
    let left = runs.saturating_sub(done);
    let each_s = spent.as_secs_f64() / done.max(1) as f64;
    format!("{done} of {runs} runs done ({which}); {left} left, about {:.0} s", each_s * left as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Refuses(io::ErrorKind);

    impl Write for Refuses {
        fn write(&mut self, _: &[u8]) -> io::Result<usize> {
            Err(self.0.into())
        }
        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn a_line_of_progress_says_what_is_done_and_what_is_left() {
        let said = line(3, 8, "30 a minute", Duration::from_secs(60));
        assert_eq!(said, "3 of 8 runs done (30 a minute); 5 left, about 100 s");
        assert_eq!(line(8, 8, "x", Duration::from_secs(9)), "8 of 8 runs done (x); 0 left, about 0 s");
    }

    #[test]
    fn off_a_terminal_a_line_is_said_every_ten_seconds() {
        let progress = Progress::new(100);
        let said = Mutex::new(Vec::new());
        for spent in [1, 9, 10, 11, 19, 20, 35] {
            progress.bar.inc(5);
            progress.say(Duration::from_secs(spent), |line| said.lock().unwrap().push(line.to_owned()));
        }
        let said = said.into_inner().unwrap();
        assert_eq!(said[0], "15 of 100 runs done (10 s); 85 left, about 57 s");
        assert_eq!(said.len(), 3, "{said:?}");
    }

    #[test]
    fn a_reader_that_has_gone_is_no_error_and_a_full_disk_is() {
        assert_eq!(print_to(&mut Refuses(io::ErrorKind::BrokenPipe), "x"), Ok(()));
        let error = print_to(&mut Refuses(io::ErrorKind::StorageFull), "x").unwrap_err();
        assert!(error.to_string().starts_with("standard output: cannot be written"), "{error}");
    }
}
