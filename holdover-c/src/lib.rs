//! The C interface of **holdover**: memory, frames and times of a C program enter, status codes and answers leave.
//!
//! ```text
//! holdover_init(memory, size, &config)           once
//! holdover_receive(unit, at_us, &frame)          for every CAN frame
//! holdover_tick(unit, now_us, &answer)           every period; answer.frames are to be sent
//! holdover_note(unit, incident, times)           what the platform around the unit met with
//! holdover_set_out(unit, &way, map, size)        on a way through intersections
//! ```
//!
//! The unit lives in memory of the caller; there is no allocator and no global. `doors` holds the functions, `pointer`, `memory`,
//! `room` and `map` all there is of `unsafe` besides them, and the other modules the plain values that cross. `holdover.h` is made
//! from these files; `HOLDOVER_WRITE_HEADER=1 cargo test -p holdover-c --test header` writes it anew.
#![cfg_attr(target_os = "none", no_std)]
#![deny(missing_docs, unsafe_op_in_unsafe_fn)]
#![deny(clippy::undocumented_unsafe_blocks, clippy::missing_safety_doc)]
#![cfg_attr(
    not(test),
    deny(
        clippy::unwrap_used,
        clippy::expect_used,
        clippy::panic,
        clippy::indexing_slicing,
        clippy::arithmetic_side_effects,
        clippy::cast_possible_truncation,
        clippy::float_arithmetic
    )
)]

mod answer;
mod config;
mod doors;
mod frame;
mod incident;
mod map;
mod memory;
#[cfg(target_os = "none")]
mod panic;
mod pointer;
mod room;
mod status;

pub use answer::{Answer, Cause, Command, Effort, Estimate, HOLDOVER_MAX_FRAMES, Mode};
pub use config::{
    Body, Config, Envelope, HOLDOVER_EXTENDED, HOLDOVER_STANDARD, Identifiers, Law, Limits, Link, Model,
    PeerIdentifiers, Prediction,
};
pub use doors::*;
pub use frame::Frame;
pub use incident::Incident;
pub use map::{Approach, Crossing, Intersection, Itinerary, Path, Scale, Segment};
pub use memory::{HOLDOVER_HISTORY, HOLDOVER_PEERS, HOLDOVER_STEPS, HOLDOVER_UNIT_ALIGN, HOLDOVER_UNIT_SIZE};
pub use status::Status;

/// The Rust of the manual, which the tests of the documentation compile and run.
#[cfg(doctest)]
#[doc = include_str!("../../docs/INTEGRATION.md")]
pub struct Manual;
