//! The firmware of the ECU: frames enter from the board's bus, one call each, and what the unit answers every period
//! leaves on it. On a host the same program prints what the CAN messages are, for those who connect to the unit.
#![cfg_attr(target_os = "none", no_std, no_main)]
#![deny(clippy::undocumented_unsafe_blocks)]

#[cfg(target_os = "none")]
mod board;

/// The shell around the unit. It holds no logic of its own: receive, tick, transmit.
#[cfg(target_os = "none")]
mod firmware {
    use crate::board::{Board, CanFrame};
    use embedded_can::{Frame, StandardId};
    use holdover::health::{Health, Refusal};
    use holdover::time::Instant;

    #[cortex_m_rt::entry]
    fn start() -> ! {
        // The entry attribute hands this static out as `&'static mut`, once. Its symbol is what `ci.sh cross` sizes.
        static mut UNIT: Unit = Unit::new();
        let mut board = Board::start();
        loop {
            while let Some((at, frame)) = board.receive() {
                UNIT.receive(at, &frame);
            }
            if let Some(now) = board.tick() {
                for frame in UNIT.tick(now) {
                    board.transmit(&frame);
                }
            }
        }
    }

    /// Holds the place of the onboard unit, with its two doors: it counts what it cannot take, and says each period
    /// that it lives.
    struct Unit {
        health: Health,
        ticks: u32,
    }

    impl Unit {
        const fn new() -> Self {
            Self { health: Health::new(), ticks: 0 }
        }

        fn receive(&mut self, _at: Instant, frame: &CanFrame) {
            if frame.data().len() != 8 {
                self.health.count(Refusal::Length);
            }
        }

        fn tick(&mut self, _now: Instant) -> impl Iterator<Item = CanFrame> {
            self.ticks = self.ticks.wrapping_add(1);
            let mut data = [0; 8];
            let (ticks, refused) = data.split_at_mut(4);
            ticks.copy_from_slice(&self.ticks.to_be_bytes());
            refused.copy_from_slice(&self.health.total().to_be_bytes());
            CanFrame::new(StandardId::MAX, &data).into_iter()
        }
    }
}

#[cfg(not(target_os = "none"))]
fn main() -> std::io::Result<()> {
    use std::io::{ErrorKind, Write, stdout};
    // A reader that has seen enough (`| head`) is no error.
    writeln!(stdout(), "{}", catalogue()).or_else(|error| match error.kind() {
        ErrorKind::BrokenPipe => Ok(()),
        _ => Err(error),
    })
}

/// What this program prints on a host.
#[cfg(not(target_os = "none"))]
fn catalogue() -> impl std::fmt::Display {
    use holdover::health::Refusal;
    let causes: Vec<_> = Refusal::ALL.iter().map(|cause| format!("{:>5}  {}", *cause as u8, cause.name())).collect();
    format!("cause  of a refusal, as the Health message numbers it\n{}", causes.join("\n"))
}
