//! Which parts of the model are used: the whole of it as shipped, or the paper's literal method.

/// Which parts of the prediction model are used. [`Model::HOLDOVER`] is the default. [`Model::PAPER`] is the paper's literal method. Each
/// switch by itself shows the effect of its part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Model {
    /// The actuators' lag, solved exactly.
    pub lag: bool,
    /// The controller's limits on acceleration and jerk.
    pub limits: bool,
    /// The sender's last demand is the start of the jerk limit.
    pub last_demand: bool,
    /// The standstill distance `s_0`.
    pub standstill: bool,
    /// Trapezoidal positions; otherwise forward Euler (eq. 9 as printed).
    pub trapezoid: bool,
    /// Readings between steps are interpolated; otherwise the nearest step is read.
    pub interpolate: bool,
    /// Time stamps: a sample is brought from its stamp to now by the model; otherwise by eqs 10-12.
    pub stamped: bool,
    /// A horizon never runs out; otherwise its last value is held past its end.
    pub endless: bool,
    /// A horizon that the peer computed itself takes precedence.
    pub received: bool,
    /// After a silence the controller is led from the old estimate to the new one, and does not jump.
    pub smooth: bool,
}

impl Model {
    /// All of it.
    pub const HOLDOVER: Self = Self {
        lag: true,
        limits: true,
        last_demand: true,
        standstill: true,
        trapezoid: true,
        interpolate: true,
        stamped: true,
        endless: true,
        received: true,
        smooth: true,
    };
    /// The literal paper.
    pub const PAPER: Self = Self {
        lag: false,
        limits: false,
        last_demand: false,
        standstill: false,
        trapezoid: false,
        interpolate: false,
        stamped: false,
        endless: false,
        received: false,
        smooth: false,
    };
}
