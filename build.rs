//! Linker arguments of the firmware, and the board that it is for, by the target. They stand here and not in
//! `.cargo/config.toml`, because a `RUSTFLAGS` from the environment replaces that file's flags without a word, and an image
//! without its linker script has no vector table.

use std::{env, path::PathBuf};

/// Each board with its target, the folder of its chip in `src/board/`, and the linker script there: a `memory.x`, which the `link.x` of
/// cortex-m-rt takes in, or a `link.x` of the chip's own. The linker looks for either by its name, first in the package's root,
/// so that none lies there.
const BOARDS: [(&str, &str, &str, &str); 5] = [
    ("stm32f405", "thumbv7em-none-eabihf", "stm32f405", "memory.x"),
    ("feather_stm32f405", "thumbv7em-none-eabihf", "stm32f405", "memory.x"),
    ("pyboard", "thumbv7em-none-eabihf", "stm32f405", "memory.x"),
    ("nucleo_g474re", "thumbv7em-none-eabihf", "stm32g474", "memory.x"),
    ("zynqmp_r5", "armv7r-none-eabihf", "zynqmp_r5", "link.x"),
];

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-env-changed=HOLDOVER_BOARD");
    // Set by the check that a panic is found.
    println!("cargo::rustc-check-cfg=cfg(seeded_panic)");
    let values = |names: [&str; BOARDS.len()]| names.map(|name| format!("{name:?}")).join(", ");
    println!("cargo::rustc-check-cfg=cfg(board, values({}))", values(BOARDS.map(|(board, ..)| board)));
    println!("cargo::rustc-check-cfg=cfg(chip, values({}))", values(BOARDS.map(|(_, _, chip, _)| chip)));
    // The target's first board, unless one is named.
    let (target, named) = (env::var("TARGET").unwrap_or_default(), env::var("HOLDOVER_BOARD").ok());
    let names = BOARDS.map(|(board, ..)| board);
    if let Some(named) = named.as_ref().filter(|named| !names.contains(&named.as_str())) {
        println!("cargo::error=HOLDOVER_BOARD={named} is no board; there are {}", names.join(", "));
        return;
    }
    let is_meant = |board: &str| named.as_ref().is_none_or(|named| named == board);
    let Some((board, _, chip, script)) = BOARDS.into_iter().find(|(board, of, ..)| *of == target && is_meant(board))
    else {
        return;
    };
    let ours = PathBuf::from(env::var("CARGO_MANIFEST_DIR").expect("cargo sets CARGO_MANIFEST_DIR"))
        .join("src/board")
        .join(chip)
        .join(script);
    println!("cargo::rerun-if-changed={}", ours.display());
    println!("cargo::rustc-cfg=board=\"{board}\"");
    println!("cargo::rustc-cfg=chip=\"{chip}\"");
    // For this image alone: a link search would be handed on to the images of those who use the library, which have a script of their
    // own.
    println!("cargo::rustc-link-arg-bins=-L{}", ours.parent().expect("a file lies in a folder").display());
    println!("cargo::rustc-link-arg-bins=-Tlink.x");
    if env::var_os("CARGO_FEATURE__LOG").is_some() {
        println!("cargo::rustc-link-arg-bins=-Tdefmt.x");
    }
    // Sections need not be aligned to the pages of a system that has none.
    println!("cargo::rustc-link-arg-bins=--nmagic");
}
