//! Linker arguments of the firmware. They stand here and not in `.cargo/config.toml`, because a `RUSTFLAGS` from the
//! environment replaces that file's flags without a word, and an image without `link.x` has no vector table.

use std::{env, fs, path::PathBuf};

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=memory.x");
    // Set by the check that a panic is found.
    println!("cargo::rustc-check-cfg=cfg(seeded_panic)");
    if env::var("CARGO_CFG_TARGET_OS").as_deref() != Ok("none") {
        return;
    }
    // `link.x` of cortex-m-rt includes `memory.x` by name, so the linker has to find it beside its own files.
    let out = PathBuf::from(env::var("OUT_DIR").expect("cargo sets OUT_DIR for build scripts"));
    fs::copy("memory.x", out.join("memory.x")).expect("memory.x lies beside build.rs and OUT_DIR can be written");
    println!("cargo::rustc-link-search={}", out.display());
    println!("cargo::rustc-link-arg-bins=-Tlink.x");
    if env::var_os("CARGO_FEATURE_LOG").is_some() {
        println!("cargo::rustc-link-arg-bins=-Tdefmt.x");
    }
    // Sections need not be aligned to the pages of a system that has none.
    println!("cargo::rustc-link-arg-bins=--nmagic");
}
