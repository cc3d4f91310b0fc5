//! Linker arguments of the firmware, and the board that it is for, by the target. They stand here and not in
//! `.cargo/config.toml`, because a `RUSTFLAGS` from the environment replaces that file's flags without a word, and an image
//! without its linker script has no vector table.

use std::{env, path::PathBuf};

/// Each board with its target and its linker script: a `memory.x`, which the `link.x` of cortex-m-rt takes in, or a `link.x` of
/// the board's own. The linker looks for either by its name, first in the package's root, so that none lies there.
const BOARDS: [(&str, &str, &str); 2] = [
    ("stm32f405", "thumbv7em-none-eabihf", "src/board/stm32f405/memory.x"),
    ("zynqmp_r5", "armv7r-none-eabihf", "src/board/zynqmp_r5/link.x"),
];

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-env-changed=HOLDOVER_BOARD");
    // Set by the check that a panic is found.
    println!("cargo::rustc-check-cfg=cfg(seeded_panic)");
    println!(
        "cargo::rustc-check-cfg=cfg(board, values({}))",
        BOARDS.map(|(board, ..)| format!("{board:?}")).join(", ")
    );
    // The target's first board, unless one is named.
    let (target, named) = (env::var("TARGET").unwrap_or_default(), env::var("HOLDOVER_BOARD").ok());
    let is_meant = |board: &str| named.as_ref().is_none_or(|named| named == board);
    let Some((board, _, ours)) = BOARDS.into_iter().find(|(board, of, _)| *of == target && is_meant(board)) else {
        return;
    };
    let ours = PathBuf::from(env::var("CARGO_MANIFEST_DIR").expect("cargo sets CARGO_MANIFEST_DIR")).join(ours);
    println!("cargo::rerun-if-changed={}", ours.display());
    println!("cargo::rustc-cfg=board=\"{board}\"");
    println!("cargo::rustc-link-search={}", ours.parent().expect("a file lies in a folder").display());
    println!("cargo::rustc-link-arg-bins=-Tlink.x");
    if env::var_os("CARGO_FEATURE_LOG").is_some() {
        println!("cargo::rustc-link-arg-bins=-Tdefmt.x");
    }
    // Sections need not be aligned to the pages of a system that has none.
    println!("cargo::rustc-link-arg-bins=--nmagic");
}
