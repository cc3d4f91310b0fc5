//! The commands: the command line enters; results on stdout, reports and a verdict leave.
//!
//! ```text
//! cli (what is typed) -> options (what is meant, every input read) -> a command's run -> its table, JSON and page -> ending
//! ```

pub mod braking;
pub mod check;
pub mod cli;
pub mod corridor;
pub mod dbc;
pub mod ecu;
pub mod ending;
pub mod envelope_cost;
pub mod evaluate;
pub mod gains;
pub mod hil;
pub mod identifiers;
pub mod interruption;
pub mod live;
pub mod manual;
pub mod mcap_file;
pub mod mcap_road;
mod mcap_writer;
pub mod mistyped;
pub mod motions;
pub mod options;
pub mod record;
pub mod replay;
pub mod run;
pub mod string;
pub mod sweep;
