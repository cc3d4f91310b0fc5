//! The stages of a tick, in an order that is the same in every world.
//!
//! At time t, what arrived through the air up to t is put on the buses with its time of arrival, and sensors and time base
//! speak; every unit receives and ticks, and what the units broadcast goes into the air; those who watch see all of it; the
//! bodies move on to the next tick under the commands. So a message that is sent without delay at t is used in the next
//! tick, as on real buses; a microsecond goes by before it is on the bus there.

use std::io;

/// A world that goes on tick by tick.
pub trait Stages {
    /// Messages arrive; sensors and time base speak.
    ///
    /// # Errors
    /// The buses'.
    fn speak(&mut self, at_s: f64) -> io::Result<()>;

    /// The units tick, and their modems broadcast.
    ///
    /// # Errors
    /// The buses'.
    fn act(&mut self, at_s: f64) -> io::Result<()>;

    /// The bodies move on to the next tick.
    ///
    /// # Errors
    /// The buses'.
    fn drive(&mut self, at_s: f64) -> io::Result<()>;

    /// The whole tick; `see` is shown the world before the bodies move on.
    ///
    /// # Errors
    /// The buses', and those of `see`.
    fn tick(&mut self, at_s: f64, see: impl FnOnce(&mut Self) -> io::Result<()>) -> io::Result<()> {
        self.speak(at_s)?;
        self.act(at_s)?;
        see(self)?;
        self.drive(at_s)
    }
}
