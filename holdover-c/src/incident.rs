//! What the platform around a unit meets with: C's numbers enter and the core's incidents leave.

use holdover::health;

use crate::status::Status;

/// What the platform around the unit has met with.
#[repr(i32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Incident {
    /// The receive queue was full.
    ReceiveOverflow = 0,
    /// The bus controller lost a frame.
    Overrun = 1,
    /// A frame was lost before the bus: the transmit queue was full, or it waited until it was too old or a newer one was there.
    TransmitOverflow = 2,
    /// The bus controller left the bus, or could not be put onto it.
    BusOff = 3,
    /// The watchdog restarted the unit.
    Restart = 4,
    /// A period has passed without a tick; one for each, so that the count has the length of a gap.
    MissedPeriod = 5,
    /// The crystal did not start, and a less accurate clock is in its place.
    ClockFailed = 6,
}

/// The core's incident of a number.
///
/// # Errors
/// [`Status::NoIncident`].
pub fn incident(number: i32) -> Result<health::Incident, Status> {
    const ALL: [(Incident, health::Incident); 7] = [
        (Incident::ReceiveOverflow, health::Incident::ReceiveOverflow),
        (Incident::Overrun, health::Incident::Overrun),
        (Incident::TransmitOverflow, health::Incident::TransmitOverflow),
        (Incident::BusOff, health::Incident::BusOff),
        (Incident::Restart, health::Incident::Restart),
        (Incident::MissedPeriod, health::Incident::MissedPeriod),
        (Incident::ClockFailed, health::Incident::ClockFailed),
    ];
    ALL.iter().find(|(own, _)| *own as i32 == number).map(|(_, incident)| *incident).ok_or(Status::NoIncident)
}
