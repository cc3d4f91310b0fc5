//! The stages of a tick, in an order that is the same in every world.
//!
//! At time t, the messages that arrived over the air up to t are put on the buses with their time of arrival. Sensors
//! and time base send. Then every unit receives what is whole on its bus by t, and ticks. The observers see the state of the
//! tick. Then the buses carry what was sent, one frame after the other: commands are in force from their arrival on, and
//! modems broadcast. So the vehicles move on to the next tick.
//!
//! So what a sensor sends at t, and what another unit sends at t over a radio without delay, is used in the next tick, as on
//! real buses.

use std::io;

/// A world that advances tick by tick.
pub trait Stages {
    /// Messages arrive; sensors and time base send.
    ///
    /// # Errors
    /// Errors of the buses.
    fn speak(&mut self, at_s: f64) -> io::Result<()>;

    /// The units tick.
    ///
    /// # Errors
    /// Errors of the buses.
    fn act(&mut self, at_s: f64) -> io::Result<()>;

    /// The buses carry what was sent, the modems broadcast, and the vehicles move on to the next tick.
    ///
    /// # Errors
    /// Errors of the buses.
    fn drive(&mut self, at_s: f64) -> io::Result<()>;

    /// The whole tick. `see` gets the world before the vehicles move on.
    ///
    /// # Errors
    /// Errors of the buses, and those of `see`.
    fn tick(&mut self, at_s: f64, see: impl FnOnce(&mut Self) -> io::Result<()>) -> io::Result<()> {
        self.speak(at_s)?;
        self.act(at_s)?;
        see(self)?;
        self.drive(at_s)
    }
}
