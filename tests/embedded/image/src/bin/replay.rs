//! Replays a log on the ECU: the file `log.bin` of the folder that the emulator runs in enters, all that the unit sends
//! leaves as `sent.bin`.
#![no_std]
#![no_main]

use cortex_m_rt::entry;
use cortex_m_semihosting::debug::{self, EXIT_FAILURE, EXIT_SUCCESS};
use cortex_m_semihosting::hprintln;
use holdover::OnboardUnit;
use holdover_image::file::File;
use holdover_replay::{config, decode, live, refusals};

/// As on the reference ECU.
#[cfg(target_abi = "eabihf")]
const CAPACITY: (usize, usize, usize) = (8, 8, 400);
/// What fits the 16 KiB of the small one.
#[cfg(not(target_abi = "eabihf"))]
const CAPACITY: (usize, usize, usize) = (3, 4, 100);

type Unit = OnboardUnit<{ CAPACITY.0 }, { CAPACITY.1 }, { CAPACITY.2 }>;

#[panic_handler]
fn panicked(info: &core::panic::PanicInfo) -> ! {
    hprintln!("{}", info);
    debug::exit(EXIT_FAILURE);
    loop {}
}

fn replay(unit: &mut Unit) -> Option<()> {
    let mut log = File::open("log.bin\0")?;
    let mut sent = File::create("sent.bin\0")?;
    unit.start(&config(CAPACITY.2)).ok()?;
    while let Some(record) = log.read() {
        let (at, event) = decode(&record)?;
        live(unit, at, &event, |record| sent.write(&record));
    }
    refusals(unit).for_each(|record| sent.write(&record));
    sent.flush();
    Some(())
}

#[entry]
fn main() -> ! {
    static mut UNIT: Unit = Unit::idle();
    let done = replay(UNIT).is_some();
    debug::exit(if done { EXIT_SUCCESS } else { EXIT_FAILURE });
    loop {}
}
