//! Linker arguments, and the emulated machine that a program is for, by its target.

use std::{env, fs, path::PathBuf};

/// Each machine with its target and its memory. `netduinoplus2` has the reference ECU's chip; the `cortex_m0`, which has no FPU and no
/// wide multiply, is that of a `microbit` with more memory than the board has; the `cortex_r5f` stands alone in memory from 0 on.
const MACHINES: [(&str, &str, Memory); 3] = [
    (
        "netduinoplus2",
        "thumbv7em-none-eabihf",
        Memory::Regions("FLASH : ORIGIN = 0x08000000, LENGTH = 1024K\nRAM : ORIGIN = 0x20000000, LENGTH = 128K"),
    ),
    (
        "cortex_m0",
        "thumbv6m-none-eabi",
        Memory::Regions("FLASH : ORIGIN = 0x00000000, LENGTH = 256K\nRAM : ORIGIN = 0x20000000, LENGTH = 128K"),
    ),
    ("cortex_r5f", "armv7r-none-eabihf", Memory::Script("../../../src/board/zynqmp_r5/link.x")),
];

/// What the linker is told of a machine's memory.
enum Memory {
    /// The regions, for the `link.x` of cortex-m-rt.
    Regions(&'static str),
    /// The whole linker script, from this package on.
    Script(&'static str),
}

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!(
        "cargo::rustc-check-cfg=cfg(machine, values({}))",
        MACHINES.map(|(machine, ..)| format!("{machine:?}")).join(", ")
    );
    let target = env::var("TARGET").unwrap_or_default();
    let Some((machine, _, memory)) = MACHINES.into_iter().find(|(_, of, _)| *of == target) else { return };
    println!("cargo::rustc-cfg=machine=\"{machine}\"");
    match memory {
        Memory::Regions(regions) => {
            let out = PathBuf::from(env::var("OUT_DIR").expect("cargo sets OUT_DIR for build scripts"));
            fs::write(out.join("memory.x"), format!("MEMORY\n{{\n{regions}\n}}\n")).expect("OUT_DIR can be written");
            println!("cargo::rustc-link-search={}", out.display());
            println!("cargo::rustc-link-arg-bins=-Tlink.x");
        }
        Memory::Script(script) => {
            let here = PathBuf::from(env::var("CARGO_MANIFEST_DIR").expect("cargo sets CARGO_MANIFEST_DIR"));
            let script = here.join(script);
            println!("cargo::rerun-if-changed={}", script.display());
            println!("cargo::rustc-link-arg-bins=-T{}", script.display());
        }
    }
    println!("cargo::rustc-link-arg-bins=--nmagic");
}
