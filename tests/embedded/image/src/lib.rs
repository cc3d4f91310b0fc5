//! What the programs for the emulated ECU share: the calls, the files and the output of the emulator; and for the counts a counter of
//! instructions, the depth of the stack, and a road full of peers that talk.
#![no_std]

#[cfg(machine = "netduinoplus2")]
pub mod bench;
#[cfg(machine = "netduinoplus2")]
pub mod counter;
pub mod file;
#[cfg(machine = "netduinoplus2")]
pub mod float;
pub mod junction;
#[cfg(machine = "netduinoplus2")]
pub mod kalman;
#[cfg(machine = "netduinoplus2")]
#[path = "../../../../src/board/memory.rs"]
mod memory;
pub mod output;
pub mod road;
pub mod semihosting;
#[cfg(machine = "netduinoplus2")]
pub mod stack;
#[cfg(machine = "cortex_r5f")]
mod start;
