//! The time before a vehicle appears: what is in the air enters, and a unit that knows its surroundings leaves.

use std::io;

use super::Vehicle;
use crate::sim::air::Arrived;

/// For so long a unit has been engaged when its vehicle appears, so that its first message already says how it will drive.
const ENGAGED_S: f64 = 0.25;

impl Vehicle {
    /// A tick before it appears: it comes up at constant speed and will be `there_m` after `before_s`; its sensors and its
    /// time base speak.
    ///
    /// # Errors
    /// The bus's.
    pub fn approach(&mut self, there_m: f64, (at_s, before_s): (f64, f64), period_s: f64) -> io::Result<()> {
        self.plant.position_m = there_m - self.plant.speed_mps * before_s;
        self.speak(at_s, period_s, None)
    }

    /// The time before it appears, as every real unit knows it: it has power and ticks, its time base and its sensors
    /// speak, the driver drives at constant speed and engages it only a moment before the end, and it hears what arrives of the
    /// others. It ends before the tick at `until_s`, with the vehicle where it was.
    ///
    /// # Errors
    /// The bus's.
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
        Ok(())
    }
}
