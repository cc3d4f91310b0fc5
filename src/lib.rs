//! **holdover** keeps a connected vehicle's cooperative control running while its V2X link is late or silent.
//!
//! `unit.rs` has the picture of a frame's way and of a tick, and ARCHITECTURE.md the layers.
//!
//! The two doors are [`OnboardUnit::receive`] and [`OnboardUnit::tick`]. Time is an argument, frames are
//! [`embedded_can::Frame`]s; there is no clock, no bus, no allocator and no global in here. Same input, same output,
//! bit for bit, on every target.
#![cfg_attr(not(test), no_std)]
#![forbid(unsafe_code)]
#![deny(missing_docs)]
#![cfg_attr(
    not(test),
    deny(
        clippy::unwrap_used,
        clippy::expect_used,
        clippy::panic,
        clippy::indexing_slicing,
        clippy::arithmetic_side_effects,
        clippy::cast_possible_truncation,
        clippy::cast_possible_wrap,
        clippy::cast_sign_loss,
        clippy::float_arithmetic
    )
)]

pub mod clock;
pub mod config;
pub mod controller;
pub mod coordination;
pub mod dynamics;
pub mod envelope;
pub mod estimator;
pub mod fixed;
pub mod fusion;
pub mod health;
mod held;
pub mod lockstep;
pub mod model;
pub mod parameters;
pub mod passes;
pub mod peers;
#[cfg(test)]
mod polynomial;
pub mod time;
mod unit;
pub mod units;
pub mod wire;

pub use config::{Config, ConfigError};
pub use coordination::MapError;
pub use lockstep::LockStep;
pub use unit::{Answer, Estimate, MAX_FRAMES, OnboardUnit, Reception};

/// The Rust of the README, which the tests of the documentation compile and run.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
pub struct Readme;
