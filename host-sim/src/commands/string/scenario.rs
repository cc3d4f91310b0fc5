//! The scenario of a string: time gap, link, disturbance, kinds and drivers enter; the scenario leaves, in which every vehicle starts at
//! the gap that it keeps, and at the same speed.

use std::path::Path;

use super::disturbance::{CRUISE_MPS, Disturbance};
use super::mixture::Mixture;
use crate::error::Error;
use crate::input::kind::Kind;
use crate::input::scenario::{Driver, MAX_VEHICLES, Overrides, Scenario, SensorShare};
use crate::sim::person::Manner;

/// The place of a row: time gap, delay and loss.
pub type Place = (f64, f64, f64);

/// Speed that the vehicles want on a free road, as behind every recorded leader.
const FREE_MPS: f64 = 50.0;
/// Gap at rest.
const STANDSTILL_M: f64 = 2.0;
/// Time gap of a person.
const PERSONS_GAP_S: f64 = 1.5;
/// Time gap of a unit that sees the vehicle ahead, and never hears it: that of its cruise control, unless its own is larger.
const UNHEARD_GAP_S: f64 = 1.8;

/// The scenario.
///
/// # Errors
/// None for values within the options' limits.
pub fn scenario(
    (time_gap_s, delay_s, loss): Place,
    disturbance: Disturbance,
    sensors: SensorShare,
    kinds: &[Kind],
    mixture: &Mixture,
) -> Result<Scenario, Error> {
    let duration_s = disturbance.duration_s();
    let common = format!("speed_mps = {CRUISE_MPS}\nposition_accuracy_m = 0.05\nspeed_accuracy_mps = 0.02\n");
    let kind = |vehicle: usize| kinds[(vehicle - 1) % kinds.len()];
    let by_hand = |driver: &str| {
        let manner = Manner { wanted_mps: FREE_MPS, time_gap_s: PERSONS_GAP_S, standstill_m: STANDSTILL_M };
        let gap_m = manner.steady_gap_m(CRUISE_MPS);
        format!("driver = \"{driver}\"\ngap_m = {gap_m}\ntime_gap_s = {PERSONS_GAP_S}\n")
    };
    let by_unit = |vehicle: usize, kept_s: f64| {
        let feed_forward = kind(vehicle).feed_forward(sensors.has(vehicle));
        let gap_m = STANDSTILL_M + CRUISE_MPS * kept_s;
        format!("gap_m = {gap_m}\ntime_gap_s = {time_gap_s}\nfeed_forward = {feed_forward}\n")
    };
    let follower = |vehicle: usize| {
        let is_unheard = mixture.driver(vehicle - 1) == Driver::Unequipped;
        let drives = match mixture.driver(vehicle) {
            Driver::Unequipped => by_hand("unequipped"),
            Driver::Person => by_hand("person"),
            Driver::Unit if is_unheard => by_unit(vehicle, time_gap_s.max(UNHEARD_GAP_S)),
            Driver::Unit => by_unit(vehicle, time_gap_s),
        };
        format!("[[vehicle]]\nkind = \"{}\"\n{drives}{common}", kind(vehicle).name())
    };
    let ego = mixture.first_unit().unwrap_or(1);
    let followers: String = (1..MAX_VEHICLES).map(follower).collect();
    let text = format!(
        "duration_s = {duration_s}\nego = {ego}\n[leader]\ntarget_speed_mps = {CRUISE_MPS}\n[[vehicle]]\n{common}{followers}[channel]\n\
         applies_to = \"all\"\ndelay_mean_s = {delay_s}\ndelay_std_s = 0\nloss = {loss}\noutages = []\n",
    );
    let overrides = Overrides { range_sensors: Some(sensors), ..Overrides::MESSAGES_ALONE };
    let mut scenario = Scenario::parse(Path::new("string"), &text, &overrides)?;
    scenario.leader.motion = Some(disturbance.motion(scenario.period_s));
    Ok(scenario)
}
