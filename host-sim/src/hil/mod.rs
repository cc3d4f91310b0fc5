//! `hil`: hardware in the loop. A scenario and a CAN interface with a device on it enter; a verdict on the device, a table
//! or JSON on stdout and a report leave.

pub mod deviation;
pub mod fault;
pub mod judge;
pub mod monitor;
pub mod outcome;
pub mod recovery;
pub mod rig;
pub mod said;
pub mod session;
pub mod spread;
pub mod table;
pub mod talk;
pub mod twin;
pub mod villain;
pub mod virtual_bus;
