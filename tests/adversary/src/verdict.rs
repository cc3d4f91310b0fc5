//! The verdict on a drive: its checks and its findings.

/// A fault.
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
    /// All faults.
    pub const ALL: [Self; 6] =
        [Self::Collision, Self::Bound, Self::Estimate, Self::Refused, Self::Deadlock, Self::Hurry];

    /// Its name in the output.
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

/// The first occurrence of a fault.
#[derive(Clone, Debug)]
pub struct Finding {
    /// The fault.
    pub fault: Fault,
    /// Time, s.
    pub at: f64,
    /// Size: m/s at impact, m outside, s refused.
    pub amount: f64,
    /// Description in words.
    pub text: String,
}

/// The outcome of a drive.
#[derive(Clone, Debug, Default)]
pub struct Outcome {
    /// At most one finding of each fault, in the order of their times.
    pub findings: Vec<Finding>,
    /// Ticks, and those with the true motion outside the bound.
    pub ticks: u64,
    pub outside: u64,
    /// Ticks whose bound was checked.
    pub checked: u64,
}

impl Outcome {
    /// The finding of a fault.
    pub fn of(&self, fault: Fault) -> Option<&Finding> {
        self.findings.iter().find(|finding| finding.fault == fault)
    }

    /// Records a finding. The first one of each fault is kept, with the largest size.
    pub fn find(&mut self, fault: Fault, at: f64, amount: f64, text: impl FnOnce() -> String) {
        match self.findings.iter_mut().find(|finding| finding.fault == fault) {
            Some(finding) => finding.amount = finding.amount.max(amount),
            None => self.findings.push(Finding { fault, at, amount, text: text() }),
        }
    }
}
