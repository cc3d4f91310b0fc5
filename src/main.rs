//! The firmware of the ECU: frames enter from the board's bus, one call each, and what the unit answers every period
//! leaves on it. On a host the same program prints what the CAN messages are, for those who connect to the unit.
#![cfg_attr(target_os = "none", no_std, no_main)]
#![deny(clippy::undocumented_unsafe_blocks)]

#[cfg(target_os = "none")]
mod board;

/// The shell around the unit. It holds no logic of its own: receive, tick, transmit.
#[cfg(target_os = "none")]
mod firmware {
    use crate::board::{self, Board};
    use holdover::wire::StationHash;
    use holdover::{Config, OnboardUnit};

    type Unit = OnboardUnit<8, 8, 400>;

    /// What an integrator calibrates.
    const CONFIG: Config = Config::car(StationHash(1));

    #[cortex_m_rt::entry]
    fn start() -> ! {
        // The entry attribute hands this static out as `&'static mut`, once. `ci.sh` finds it by its name, and the size
        // of the unit with it.
        static mut UNIT: Unit = Unit::idle();
        let unit = UNIT;
        if unit.start(&CONFIG).is_err() {
            board::stop();
        }
        let mut board = Board::start();
        loop {
            while let Some((at, frame)) = board.receive() {
                // A refusal is counted in the unit, and its Health message tells.
                let _ = unit.receive(at, &frame);
            }
            if let Some(now) = board.tick() {
                for frame in &unit.tick(now).frames {
                    board.transmit(frame);
                }
            }
        }
    }
}

#[cfg(not(target_os = "none"))]
fn main() -> std::io::Result<()> {
    use std::io::{ErrorKind, Write, stdout};
    // A reader that has seen enough (`| head`) is no error.
    stdout().write_all(catalogue().as_bytes()).or_else(|error| match error.kind() {
        ErrorKind::BrokenPipe => Ok(()),
        _ => Err(error),
    })
}

/// The messages, a line each: those of peers for slot 0, with the distance to the next slot below the table. Where the
/// fields lie in the frame, and their scale and range, stands in `holdover.dbc`.
#[cfg(not(target_os = "none"))]
fn catalogue() -> String {
    use holdover::wire::catalogue::{BaseId, CATALOGUE, SLOT_STRIDE, SLOTS, data_id};
    let mut table = String::from("   id  data id  name                 sender   cycle  timeout  frames  fields\n");
    for line in &CATALOGUE {
        let id = BaseId::DEFAULT.plus(line.offset);
        let fields: Vec<_> = line.fields.iter().map(|field| field.name).collect();
        table += &format!(
            "{id:#05x}   {:#06x}  {:<19}  {:<7} {:>3} ms  {:>4} ms  {:>6}  {}\n",
            data_id(line.offset),
            line.name,
            format!("{:?}", line.sender),
            line.cycle_ms,
            line.timeout_ms,
            line.frames,
            fields.join(" ")
        );
    }
    table + &format!("{{slot}}: 0 to {}, {SLOT_STRIDE} identifiers and data ids apart\n", SLOTS - 1)
}
