//! What a board needs of a CAN port beyond `embedded-can`'s receive and transmit.

use embedded_can::nb::Can;

/// A CAN controller, or a serial CAN adapter.
pub trait Port: Can {
    /// Whether the controller has left the bus since the last call, after too many errors, or could not be put onto it. To be
    /// called every period: a controller that does not come back by itself is brought back by this.
    fn left_bus(&mut self) -> bool;
}
