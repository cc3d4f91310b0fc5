//! The host harness of holdover: scenario -> world of vehicles (plant + the same core as on the ECU) -> V2X channel
//! -> CAN bus -> metrics -> report.

pub mod baseline;
pub mod bus;
pub mod candump;
pub mod capture;
pub mod channel;
pub mod cli;
pub mod corridor;
pub mod ecu;
pub mod error;
pub mod evaluate;
pub mod figures;
pub mod gains;
pub mod ground;
pub mod heard;
pub mod hil;
pub mod metrics;
pub mod modem;
pub mod observer;
pub mod options;
pub mod output;
pub mod plant;
pub mod price;
pub mod recording;
pub mod reference;
pub mod replay;
pub mod report;
pub mod run;
pub mod scenario;
pub mod sensors;
pub mod streams;
pub mod string;
pub mod sweep;
pub mod vehicle;
pub mod verdict;
pub mod world;
