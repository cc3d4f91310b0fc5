//! What the user gives: files enter; scenarios and recordings that have been checked, or an error with its line, leave.

pub mod impairment;
pub mod kind;
pub mod library;
pub mod recording;
pub mod scenario;
