//! The user's input: files enter; checked scenarios and recordings leave, or an error with its line.

pub mod impairment;
pub mod kind;
pub mod library;
pub mod recording;
pub mod scenario;
