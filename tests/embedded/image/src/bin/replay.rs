//! Replays a log on the ECU: the file `log.bin` of the folder that the emulator runs in enters, all that the unit sends
//! leaves as `sent.bin`.
#![no_std]
#![no_main]

use holdover_image::file::File;
use holdover_image::semihosting::end;
use holdover_replay::{Head, Room, Unit, decode, live, refusals};

static mut UNIT: Unit = Unit::idle();
static mut ROOM: Room = Room::new();

fn replay(unit: &mut Unit, room: &'static mut Room) -> Option<()> {
    let mut log = File::open("log.bin\0")?;
    let mut sent = File::create("sent.bin\0")?;
    Head::take(&mut || log.read().map(i64::from_le_bytes), room)?.start(unit)?;
    while let Some(record) = log.read() {
        let (at, event) = decode(&record)?;
        let _ = live(unit, at, &event, |record| sent.write(&record)); // what it refuses is counted
    }
    refusals(unit).for_each(|record| sent.write(&record));
    sent.flush();
    Some(())
}

#[allow(static_mut_refs)] // they are the only ones
#[cfg_attr(machine = "cortex_r5f", unsafe(export_name = "main"))]
#[cfg_attr(not(machine = "cortex_r5f"), cortex_m_rt::entry)]
fn main() -> ! {
    // SAFETY: the start-up code comes here once, and nothing else names the two.
    let (unit, room) = unsafe { (&mut UNIT, &mut ROOM) };
    end(replay(unit, room).is_some())
}
