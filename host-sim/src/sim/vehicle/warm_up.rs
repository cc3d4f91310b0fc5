//! The time before a vehicle appears: the messages in the air enter, a unit that knows its surroundings leaves.

use std::io;

use super::Vehicle;
use crate::sim::air::Arrived;

/// A unit is engaged for this time before its vehicle appears, in seconds, so that its first message already says how it
/// will drive.
const ENGAGED_S: f64 = 0.25;

impl Vehicle {
    /// Sensors and time base send in a tick before the vehicle appears. The vehicle drives at constant speed and will
    /// be at `there_m` after `before_s`.
    ///
    /// # Errors
    /// Errors of the bus.
    pub fn approach(&mut self, there_m: f64, (at_s, before_s): (f64, f64), period_s: f64) -> io::Result<()> {
        self.plant.position_m = there_m - self.plant.speed_mps * before_s;
        self.speak(at_s, period_s, None)
    }

    /// The ticks before the vehicle appears. As in every real vehicle, the unit is powered and ticks, its time base and
    /// its sensors send, and it hears the messages of the others. The driver drives at constant speed, and engages the
    /// unit only a moment before the end. The last of these ticks is the one before `until_s`. The vehicle is then back
    /// at its place.
    ///
    /// # Errors
    /// Errors of the bus.
    pub fn warm_up(
        &mut self,
        until_s: f64,
        period_s: f64,
        ticks: u32,
        mut arrived: impl FnMut(f64) -> Option<Arrived>,
    ) -> io::Result<()> {
        let (start_m, engages) = (self.plant.position_m, self.engaged);
        for tick in (1..=ticks).rev() {
            let before_s = f64::from(tick) * period_s;
            self.engaged = engages && before_s <= ENGAGED_S;
            while let Some(Arrived { at_s, message, .. }) = arrived(until_s - before_s) {
                self.hear(at_s, &message)?;
            }
            self.approach(start_m, (until_s - before_s, before_s), period_s)?;
            self.tick(until_s - before_s)?;
        }
        self.plant.position_m = start_m;
        self.engaged = engages;
        self.appear(until_s)
    }
}
