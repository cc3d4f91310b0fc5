//! What is checked of a drive, and what was found.

/// What must not be.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Fault {
    Collision,
    Bound,
    Estimate,
    Refused,
    Deadlock,
    Hurry,
}

impl Fault {
    /// All of them.
    pub const ALL: [Self; 6] =
        [Self::Collision, Self::Bound, Self::Estimate, Self::Refused, Self::Deadlock, Self::Hurry];

    /// In a line of output.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Collision => "collision",
            Self::Bound => "truth outside the bound",
            Self::Estimate => "estimate outside the bound",
            Self::Refused => "honest samples refused",
            Self::Deadlock => "does not drive again",
            Self::Hurry => "faster than wanted",
        }
    }
}

/// The first time that something was found.
#[derive(Clone, Debug)]
pub struct Finding {
    /// What.
    pub fault: Fault,
    /// When, s.
    pub at: f64,
    /// How much: m/s at impact, m outside, s refused.
    pub amount: f64,
    /// In words.
    pub text: String,
}

/// What a drive came to.
#[derive(Clone, Debug, Default)]
pub struct Outcome {
    /// At most one of each kind, in the order in which they were found.
    pub findings: Vec<Finding>,
    /// Ticks, and of them with the truth outside.
    pub ticks: u64,
    pub outside: u64,
    /// Ticks whose bound was checked.
    pub checked: u64,
}

impl Outcome {
    /// The finding of that kind.
    pub fn of(&self, fault: Fault) -> Option<&Finding> {
        self.findings.iter().find(|finding| finding.fault == fault)
    }

    /// Takes note of what was found; the first of each kind is kept, with the largest amount.
    pub fn find(&mut self, fault: Fault, at: f64, amount: f64, text: impl FnOnce() -> String) {
        match self.findings.iter_mut().find(|finding| finding.fault == fault) {
            Some(finding) => finding.amount = finding.amount.max(amount),
            None => self.findings.push(Finding { fault, at, amount, text: text() }),
        }
    }
}
