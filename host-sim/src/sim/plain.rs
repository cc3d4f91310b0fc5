//! The law on the newest message as it stands: what a vehicle without an estimate does. A message and the own motion enter, the demanded
//! acceleration leaves.

use holdover::Config;

/// A message: the time at which it was true, and what it says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Time of the run.
    pub at_s: f64,
    /// Front bumper along the lane.
    pub position_m: f64,
    /// Speed along the lane.
    pub speed_mps: f64,
    /// The demand in force. Of a vehicle that is driven by hand, its acceleration.
    pub demand_mps2: f64,
}

/// Eq. 5 behind a vehicle of this length; without a message, no acceleration. `own`: position and speed.
#[must_use]
pub fn desired(
    config: &Config,
    ahead_length_m: f64,
    (position_m, speed_mps): (f64, f64),
    newest: Option<Sample>,
) -> f64 {
    let (k, damping) = (number(config.law.gain.to_milli()), number(config.law.damping.to_millis()));
    let (standstill_m, time_gap_s): (f64, f64) =
        (config.law.standstill.get().to_num(), config.law.time_gap.get().to_num());
    newest.map_or(0.0, |sample| {
        let error = position_m - sample.position_m + ahead_length_m + standstill_m + speed_mps * time_gap_s;
        -k * (error + damping * (speed_mps - sample.speed_mps))
    })
}

/// What the limits of the unit's controller leave of a desired acceleration. `last_mps2`: the demand a period ago.
#[must_use]
pub fn limited(config: &Config, desired_mps2: f64, last_mps2: f64, period_s: f64) -> f64 {
    let limits = config.limits;
    let slew = number(limits.jerk.to_mm_per_s3()) * period_s;
    let (lowest, highest) = (-number(limits.braking.to_mm_per_s2()), number(limits.acceleration.to_mm_per_s2()));
    desired_mps2.clamp(last_mps2 - slew, last_mps2 + slew).clamp(lowest, highest)
}

fn number(thousandths: i32) -> f64 {
    f64::from(thousandths) / 1e3
}
