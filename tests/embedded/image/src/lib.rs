//! What the programs for the emulated ECU share: a counter of instructions, the depth of the stack, and a road full of
//! peers that talk.
#![no_std]

pub mod counter;
pub mod file;
#[cfg(target_abi = "eabihf")]
pub mod float;
#[cfg(target_abi = "eabihf")]
pub mod kalman;
pub mod road;
pub mod stack;
