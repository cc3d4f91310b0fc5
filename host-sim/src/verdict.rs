//! The verdict on what was asked: results enter, the process's exit code leaves.

use std::process::ExitCode;

/// What the harness makes of a finished job. Bad input never gets this far; it ends with exit code 2.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Every requirement was met: exit code 0.
    Pass,
    /// A requirement was not met, and the results say which: exit code 1.
    Failed,
    /// The harness itself was late or interrupted, so the results say nothing about the unit: exit code 3.
    Inconclusive,
}

impl Verdict {
    /// Exit code of bad input; the same that the argument parser uses.
    pub const BAD_INPUT: u8 = 2;

    /// Passed unless something failed.
    #[must_use]
    pub fn of<T>(failures: &[T]) -> Self {
        if failures.is_empty() { Self::Pass } else { Self::Failed }
    }

    /// The line that tells it, with its reasons if it did not pass.
    #[must_use]
    pub fn line(self, reasons: &[String]) -> String {
        let reasons = reasons.join("; ");
        match self {
            Self::Pass => "verdict: passed".into(),
            Self::Failed => format!("verdict: FAILED: {reasons}"),
            Self::Inconclusive => format!("verdict: INCONCLUSIVE: {reasons}"),
        }
    }

    /// The exit code of this verdict.
    #[must_use]
    pub const fn code(self) -> u8 {
        match self {
            Self::Pass => 0,
            Self::Failed => 1,
            Self::Inconclusive => 3,
        }
    }
}

impl From<Verdict> for ExitCode {
    fn from(verdict: Verdict) -> Self {
        verdict.code().into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_line_of_a_verdict_has_all_reasons() {
        let reasons = ["late".to_owned(), "wrong".to_owned()];
        assert_eq!(Verdict::Pass.line(&[]), "verdict: passed");
        assert_eq!(Verdict::of(&reasons).line(&reasons), "verdict: FAILED: late; wrong");
        assert_eq!(Verdict::Inconclusive.line(&reasons[..1]), "verdict: INCONCLUSIVE: late");
    }
}
