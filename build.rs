//! Linker arguments of the firmware, and the board that it is for, by the target. They stand here and not in
//! `.cargo/config.toml`, because a `RUSTFLAGS` from the environment replaces that file's flags without a word, and an image
//! without its linker script has no vector table.

use std::{env, path::PathBuf};

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    // Set by the check that a panic is found.
    println!("cargo::rustc-check-cfg=cfg(seeded_panic)");
    println!("cargo::rustc-check-cfg=cfg(board, values(\"stm32f405\", \"zynqmp_r5\"))");
    // The linker script: that of cortex-m-rt, which takes in our `memory.x`, or one of ours. The linker looks for either by
    // its name.
    let (board, ours) = match env::var("TARGET").as_deref() {
        Ok("thumbv7em-none-eabihf") => ("stm32f405", "memory.x"),
        Ok("armv7r-none-eabihf") => ("zynqmp_r5", "src/board/zynqmp_r5/link.x"),
        _ => return,
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
