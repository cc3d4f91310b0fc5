//! The unit's mode: facts of this tick enter, the mode with its data leaves.
//!
//! # Theory of operation
//!
//! ```text
//!              engaged, own motion known
//!  Standby ---------------------------------> Cooperative <---+  the target's link is on, or the ego leads
//!     ^                                        |   ^           |
//!     | not engaged                   link off |   | link on   | link on: at once, but after Silent for REJOIN
//!     |  (from everywhere)                     v   |           |
//!     |                                      Holdover          |
//!     |                                        |               |
//!     |        silent for longer than a        v               |
//!     |        holdover lasts, no target,     Fallback --------+
//!     |        the range sensor contradicts
//!     |        what is heard; from everywhere:
//!     |        the driver's request is lost
//!     |
//!     +--- Fault  from everywhere while engaged: own motion unknown; left when that has not been so for RECOVER
//! ```
//!
//! The driver's request comes first, then the ego's own state (without it nothing can be commanded but braking), then the
//! target. Cooperative and Holdover drive by the same law on the same estimate, so passing between them changes nothing
//! but what is said; that is why they need no hysteresis beyond the link's own tolerance. Leaving Fallback or Fault
//! changes the law, so it takes the cause to be gone for a while; the controller's limit on jerk leads over.

use crate::time::{Duration, Instant};
use crate::wire::command::ModeCode;

/// Why there is no target to drive by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum FallbackCause {
    /// Nobody said whom to follow.
    NotAssociated = 1,
    /// The target was never heard.
    NeverHeard = 2,
    /// The target has been silent for longer than a holdover lasts.
    Silent = 3,
    /// What the range sensor sees and what is heard of the target exclude one another.
    RangeDisagrees = 4,
    /// The driver's request has stopped coming: the unit hands back.
    RequestLost = 5,
}

/// Why the ego's own motion is unknown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum FaultCause {
    /// It never came.
    EgoMissing = 16,
    /// It has stopped coming.
    EgoStale = 17,
}

/// A target that fell silent has to be heard for this long before it is followed again: three messages at 10 Hz.
pub const REJOIN: Duration = Duration::from_millis(300);

/// A fault has to be gone for this long.
pub const RECOVER: Duration = Duration::from_millis(500);

/// The mode.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)] // so that `Standby` is zero in memory, as an idle unit has to be
pub enum Mode {
    /// Not engaged.
    #[default]
    Standby,
    /// Driving by fresh messages, or leading.
    Cooperative,
    /// Driving by the estimate.
    Holdover {
        /// Since the link went off.
        since: Instant,
    },
    /// Driving by what is certain or seen, or braking.
    Fallback {
        /// Since when.
        since: Instant,
        /// Why.
        cause: FallbackCause,
        /// Since when the target is heard again.
        heard_since: Option<Instant>,
    },
    /// Braking.
    Fault {
        /// Since when.
        since: Instant,
        /// Why.
        cause: FaultCause,
        /// Since when the cause is gone.
        gone_since: Option<Instant>,
    },
}

/// What the unit knows of its target's link in this tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TargetFact {
    /// The ego leads: it needs no target.
    NotNeeded,
    /// Its link is on.
    On,
    /// Its link is off, its estimate is young enough.
    Off,
    /// There is none to drive by.
    Lost(FallbackCause),
}

/// What decides the mode.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Facts {
    /// The driver's request.
    pub engaged: bool,
    /// Whether the ego's own motion is known.
    pub ego: Result<(), FaultCause>,
    /// The target.
    pub target: TargetFact,
}

impl Mode {
    /// Whether the ego drives by the law that it publishes.
    #[must_use]
    pub const fn is_by_law(self) -> bool {
        matches!(self, Self::Cooperative | Self::Holdover { .. })
    }

    /// Whether the unit hands back, because nobody says what is wanted any more.
    #[must_use]
    pub const fn hands_back(self) -> bool {
        matches!(self, Self::Fallback { cause: FallbackCause::RequestLost, .. })
    }

    /// The mode of this tick.
    #[must_use]
    pub fn next(self, facts: &Facts, now: Instant) -> Self {
        if !facts.engaged {
            return Self::Standby;
        }
        if let Err(cause) = facts.ego {
            return self.fault(cause, now);
        }
        if let Some(fault) = self.still_faulty(now) {
            return fault;
        }
        match facts.target {
            TargetFact::NotNeeded => Self::Cooperative,
            TargetFact::On => self.still_falling_back(now).unwrap_or(Self::Cooperative),
            TargetFact::Off => self.hold_over(now),
            TargetFact::Lost(cause) => self.fall_back(cause, now),
        }
    }

    fn fault(self, cause: FaultCause, now: Instant) -> Self {
        match self {
            Self::Fault { since, cause: same, .. } if same == cause => Self::Fault { since, cause, gone_since: None },
            _ => Self::Fault { since: now, cause, gone_since: None },
        }
    }

    /// A fault whose cause is gone, until it has been for long enough.
    fn still_faulty(self, now: Instant) -> Option<Self> {
        let Self::Fault { since, cause, gone_since } = self else { return None };
        let gone = gone_since.unwrap_or(now);
        (now.since(gone) < RECOVER).then_some(Self::Fault { since, cause, gone_since: Some(gone) })
    }

    /// A fallback for silence whose target is heard again, until it has been for long enough.
    fn still_falling_back(self, now: Instant) -> Option<Self> {
        let Self::Fallback { since, cause: FallbackCause::Silent, heard_since } = self else { return None };
        let heard = heard_since.unwrap_or(now);
        let cause = FallbackCause::Silent;
        (now.since(heard) < REJOIN).then_some(Self::Fallback { since, cause, heard_since: Some(heard) })
    }

    /// A target whose link is off: what was falling back goes on falling back until it is heard.
    fn hold_over(self, now: Instant) -> Self {
        match self {
            Self::Holdover { .. } => self,
            Self::Fallback { since, cause: FallbackCause::Silent, .. } => {
                Self::Fallback { since, cause: FallbackCause::Silent, heard_since: None }
            }
            _ => Self::Holdover { since: now },
        }
    }

    fn fall_back(self, cause: FallbackCause, now: Instant) -> Self {
        match self {
            Self::Fallback { since, cause: before, .. } if cause != FallbackCause::RequestLost || before == cause => {
                Self::Fallback { since, cause, heard_since: None }
            }
            _ => Self::Fallback { since: now, cause, heard_since: None },
        }
    }

    /// As it stands on the wire.
    #[must_use]
    pub const fn code(&self) -> ModeCode {
        match self {
            Self::Standby => ModeCode::Standby,
            Self::Cooperative => ModeCode::Cooperative,
            Self::Holdover { .. } => ModeCode::Holdover,
            Self::Fallback { .. } => ModeCode::Fallback,
            Self::Fault { .. } => ModeCode::Fault,
        }
    }

    /// The number of the cause, 0 if there is none.
    #[must_use]
    pub const fn detail(&self) -> u8 {
        match self {
            Self::Standby | Self::Cooperative | Self::Holdover { .. } => 0,
            Self::Fallback { cause, .. } => *cause as u8,
            Self::Fault { cause, .. } => *cause as u8,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FINE: Facts = Facts { engaged: true, ego: Ok(()), target: TargetFact::On };

    fn at(millis: u64) -> Instant {
        Instant::from_micros(millis * 1000)
    }

    #[test]
    fn a_holdover_lasts_from_the_moment_the_link_goes_off_until_it_is_on() {
        let off = Facts { target: TargetFact::Off, ..FINE };
        let mode = Mode::Standby.next(&FINE, at(0)).next(&off, at(10)).next(&off, at(20));
        assert_eq!(mode, Mode::Holdover { since: at(10) });
        assert_eq!(mode.next(&FINE, at(30)), Mode::Cooperative);
    }

    #[test]
    fn without_the_ego_s_own_motion_everything_else_is_beside_the_point() {
        for target in [TargetFact::NotNeeded, TargetFact::On, TargetFact::Off, TargetFact::Lost(FallbackCause::Silent)]
        {
            let facts = Facts { ego: Err(FaultCause::EgoStale), target, ..FINE };
            assert_eq!(Mode::Cooperative.next(&facts, at(5)).code(), ModeCode::Fault);
        }
    }

    #[test]
    fn not_engaged_is_standby_whatever_else_holds() {
        let facts = Facts { engaged: false, ego: Err(FaultCause::EgoMissing), target: TargetFact::On };
        assert_eq!(Mode::Cooperative.next(&facts, at(0)), Mode::Standby);
    }

    #[test]
    fn a_fallback_keeps_its_start_when_its_cause_changes() {
        let lost = |cause| Facts { target: TargetFact::Lost(cause), ..FINE };
        let mode = Mode::Cooperative.next(&lost(FallbackCause::NeverHeard), at(0));
        let mode = mode.next(&lost(FallbackCause::Silent), at(10));
        assert_eq!(mode, Mode::Fallback { since: at(0), cause: FallbackCause::Silent, heard_since: None });
    }

    #[test]
    fn a_silent_target_is_followed_again_when_it_has_been_heard_for_three_messages() {
        let lost = Facts { target: TargetFact::Lost(FallbackCause::Silent), ..FINE };
        let mut mode = Mode::Cooperative.next(&lost, at(0));
        for millis in (10..310).step_by(10) {
            mode = mode.next(&FINE, at(millis));
            assert_eq!(mode.code(), ModeCode::Fallback, "{millis}");
        }
        assert_eq!(mode.next(&FINE, at(310)), Mode::Cooperative);
        // One moment off starts the time anew.
        let again = mode.next(&Facts { target: TargetFact::Off, ..FINE }, at(305)).next(&FINE, at(310));
        assert_eq!(again.code(), ModeCode::Fallback);
    }

    #[test]
    fn a_target_that_was_never_heard_or_is_no_longer_contradicted_is_followed_at_once() {
        for cause in [FallbackCause::NeverHeard, FallbackCause::NotAssociated, FallbackCause::RangeDisagrees] {
            let lost = Facts { target: TargetFact::Lost(cause), ..FINE };
            assert_eq!(Mode::Standby.next(&lost, at(0)).next(&FINE, at(10)), Mode::Cooperative);
        }
    }

    #[test]
    fn a_fault_lasts_until_its_cause_has_been_gone_for_half_a_second() {
        let faulty = Facts { ego: Err(FaultCause::EgoStale), ..FINE };
        let mut mode = Mode::Cooperative.next(&faulty, at(0));
        for millis in (10..510).step_by(10) {
            mode = mode.next(&FINE, at(millis));
            assert_eq!(mode.code(), ModeCode::Fault, "{millis}");
        }
        assert_eq!(mode.next(&FINE, at(510)), Mode::Cooperative);
        assert_eq!(mode.next(&faulty, at(510)).next(&FINE, at(520)).code(), ModeCode::Fault);
    }
}
