//! `holdover-sim`: the command line of the host harness.

fn main() {}
