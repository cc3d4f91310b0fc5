//! Linker arguments and the memory of the emulated machine.

use std::{env, fs, path::PathBuf};

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    let out = PathBuf::from(env::var("OUT_DIR").expect("cargo sets OUT_DIR for build scripts"));
    // netduinoplus2, which is the reference ECU's chip; and the micro:bit, whose Cortex-M0 has no FPU and no wide multiply.
    let memory = match env::var("TARGET").as_deref() {
        Ok("thumbv6m-none-eabi") => {
            "FLASH : ORIGIN = 0x00000000, LENGTH = 256K\nRAM : ORIGIN = 0x20000000, LENGTH = 16K"
        }
        _ => "FLASH : ORIGIN = 0x08000000, LENGTH = 1024K\nRAM : ORIGIN = 0x20000000, LENGTH = 128K",
    };
    fs::write(out.join("memory.x"), format!("MEMORY\n{{\n{memory}\n}}\n")).expect("OUT_DIR can be written");
    println!("cargo::rustc-link-search={}", out.display());
    println!("cargo::rustc-link-arg-bins=-Tlink.x");
    println!("cargo::rustc-link-arg-bins=--nmagic");
}
