//! What `replay.c` has to print, by the Rust core and without the C interface: `drive.inc` enters, the frames that a unit
//! sends and what it refused leave.

#[path = "../tests/drive/mod.rs"]
mod drive;

use drive::Heard;
use holdover::health::Cause;
use holdover::time::Instant;
use holdover::wire::StationHash;
use holdover::{Config, OnboardUnit, time::Duration};

fn main() {
    let mut config = Config::car(StationHash(2));
    config.link.holdover = Duration::from_millis(1000);
    let mut unit = OnboardUnit::<8, 8, 400>::new(&config).unwrap();

    let rows = drive::parse(include_str!("drive.inc"));
    let mut rows = rows.iter().peekable();
    for now in (0..=drive::END_US).step_by(drive::TICK_US as usize) {
        while let Some(row) = rows.next_if(|row| row.at_us < now) {
            let _ = unit.receive(Instant::from_micros(row.at_us), &Heard(row.frame)); // counted, and printed below
        }
        for frame in &unit.tick(Instant::from_micros(now)).frames {
            let data: String = frame.data.iter().map(|byte| format!("{byte:02x}")).collect();
            println!("{now} {:x} {data}", frame.id.number());
        }
    }
    for cause in Cause::ALL {
        println!("{} {}", -64 - cause as i32, unit.health().of(cause));
    }
}
