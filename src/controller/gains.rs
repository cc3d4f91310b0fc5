//! The law's gains, eq. 6: own speed, target speed and headway at the moment of association enter, `{k, γ}` leave.

use crate::config::Law;
use crate::units::{Distance, Gain, Seconds, Speed};

/// The gains of one association.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Gains {
    /// `k`.
    pub gain: Gain,
    /// `γ`.
    pub damping: Seconds,
}

impl Gains {
    /// `{k, γ} = f(v_i(0), v_j(0), r_i(0) - r_j(0))`; so far the same for all of them, as configured.
    #[must_use]
    pub const fn look_up(law: &Law, _own: Speed, _target: Speed, _headway: Distance) -> Self {
        Self { gain: law.gain, damping: law.damping }
    }
}
