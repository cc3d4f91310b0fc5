//! The unit's mode: facts of this tick enter, the mode and since when leave.
//!
//! ```text
//! Standby      not engaged
//! Cooperative  the target's link is on, or the ego leads
//! Holdover     the target's link is off, and its estimate is young enough to drive by
//! Fallback     no target to drive by
//! Fault        the ego's own motion is unknown
//! ```
//!
//! The ego's own state comes first: without it nothing can be commanded but braking. Then the driver's wish, then the
//! target.

use crate::time::Instant;
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
}

/// Why the ego's own motion is unknown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum FaultCause {
    /// It never came.
    EgoMissing = 1,
    /// It has stopped coming.
    EgoStale = 2,
}

/// The mode.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
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
    /// Driving by nothing but caution.
    Fallback {
        /// Since when.
        since: Instant,
        /// Why.
        cause: FallbackCause,
    },
    /// Braking.
    Fault {
        /// Since when.
        since: Instant,
        /// Why.
        cause: FaultCause,
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
    /// The driver's wish.
    pub engaged: bool,
    /// The ego's own motion.
    pub ego: Result<(), FaultCause>,
    /// The target.
    pub target: TargetFact,
}

impl Mode {
    /// The mode of this tick.
    #[must_use]
    pub fn next(self, facts: &Facts, now: Instant) -> Self {
        match (facts.engaged, facts.ego, facts.target) {
            (false, ..) => Self::Standby,
            (true, Err(cause), _) => self.fault(cause, now),
            (true, Ok(()), TargetFact::NotNeeded | TargetFact::On) => Self::Cooperative,
            (true, Ok(()), TargetFact::Off) => self.hold_over(now),
            (true, Ok(()), TargetFact::Lost(cause)) => self.fall_back(cause, now),
        }
    }

    fn fault(self, cause: FaultCause, now: Instant) -> Self {
        match self {
            Self::Fault { since, cause: same } if same == cause => Self::Fault { since, cause },
            _ => Self::Fault { since: now, cause },
        }
    }

    fn hold_over(self, now: Instant) -> Self {
        match self {
            Self::Holdover { .. } => self,
            _ => Self::Holdover { since: now },
        }
    }

    fn fall_back(self, cause: FallbackCause, now: Instant) -> Self {
        match self {
            Self::Fallback { since, .. } => Self::Fallback { since, cause },
            _ => Self::Fallback { since: now, cause },
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
        assert_eq!(mode, Mode::Fallback { since: at(0), cause: FallbackCause::Silent });
    }
}
