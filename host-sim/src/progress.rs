//! How far long work has come: what is done enters; a bar leaves on a terminal, and plain lines on stderr where there is none.

use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

use crate::output::say;

/// Time from one line to the next.
const EVERY: Duration = Duration::from_secs(10);
/// The parts of a second that a bar over time counts.
const PARTS: f64 = 1000.0;

/// Work that goes on in small pieces: many short runs, or the time of one run. Where there is no terminal, it says a line every ten
/// seconds.
pub struct Progress {
    bar: ProgressBar,
    counts: Counts,
    since: Instant,
    said: Mutex<Duration>,
}

/// What is counted.
#[derive(Clone, Copy)]
enum Counts {
    Runs,
    Time,
}

impl Progress {
    /// So many runs are to come.
    #[must_use]
    pub fn new(runs: u64) -> Self {
        Self::of(runs, Counts::Runs)
    }

    /// So many seconds of simulated or recorded time are to come.
    #[must_use]
    pub fn of_time(length_s: f64) -> Self {
        Self::of((length_s * PARTS) as u64, Counts::Time)
    }

    fn of(length: u64, counts: Counts) -> Self {
        let bar = match counts {
            Counts::Runs => bar(length, "{pos}/{len} runs"),
            Counts::Time => bar(length, "{percent} %"),
        };
        Self { bar, counts, since: Instant::now(), said: Mutex::new(Duration::ZERO) }
    }

    /// One more run is done.
    pub fn inc(&self) {
        self.bar.inc(1);
        self.tell();
    }

    /// So many more seconds are done.
    pub fn inc_s(&self, more_s: f64) {
        self.bar.inc((more_s * PARTS) as u64);
        self.tell();
    }

    /// Everything up to this time is done.
    pub fn at_s(&self, done_s: f64) {
        self.bar.set_position((done_s * PARTS) as u64);
        self.tell();
    }

    fn tell(&self) {
        if self.bar.is_hidden() {
            self.say(self.since.elapsed(), say);
        }
    }

    fn say(&self, spent: Duration, say: impl Fn(&str)) {
        // Whoever comes while another one says something leaves it to that one.
        let Ok(mut said) = self.said.try_lock() else { return };
        if spent.saturating_sub(*said) < EVERY {
            return;
        }
        *said = spent;
        let (done, length) = (self.bar.position(), self.bar.length().unwrap_or(0));
        let which = format!("{:.0} s", spent.as_secs_f64());
        say(&match self.counts {
            Counts::Runs => line(done as usize, length as usize, &which, spent),
            Counts::Time => {
                let share = done as f64 / length.max(1) as f64;
                // Before anything is done nobody knows how long the rest takes.
                let left = match done {
                    0 => String::new(),
                    _ => format!("; about {:.0} s left", spent.as_secs_f64() * (1.0 - share).max(0.0) / share),
                };
                format!("{:.0} % done ({which}){left}", 100.0 * share)
            }
        });
    }

    /// All is done.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

/// A bar on stderr that tells how much is done.
fn bar(length: u64, done: &str) -> ProgressBar {
    let bar = ProgressBar::new(length);
    // The template is a constant; should it ever be wrong, the usual bar does.
    if let Ok(style) = ProgressStyle::with_template(&format!("{{wide_bar}} {done}, {{eta}} to go")) {
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
        let bar = bar(runs as u64, "{pos}/{len} runs");
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
    fn of_one_long_run_the_share_that_is_done_is_said() {
        let progress = Progress::of_time(86_400.0);
        let said = Mutex::new(Vec::new());
        let say = |spent| progress.say(Duration::from_secs(spent), |line| said.lock().unwrap().push(line.to_owned()));
        say(12);
        progress.at_s(21_600.0);
        say(30);
        progress.inc_s(64_800.0);
        say(120);
        let said = said.into_inner().unwrap();
        assert_eq!(
            said,
            ["0 % done (12 s)", "25 % done (30 s); about 90 s left", "100 % done (120 s); about 0 s left"]
        );
    }
}
