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
    use crate::log::Log;
    use embedded_hal::digital::OutputPin;
    use holdover::health::Incident;
    use holdover::wire::StationHash;
    use holdover::{Config, OnboardUnit};

    pub type Unit = OnboardUnit<8, 8, 400>;

    /// What an integrator calibrates.
    pub const CONFIG: Config = Config::car(StationHash(1));

    // What the transmit path still sends is no older than the envelope allows for.
    const _: () = if let Some(envelope) = CONFIG.envelope {
        assert!(crate::board::MOST_AGE.as_micros() <= envelope.delay.as_micros());
    };

    /// Called by the board when it has started.
    pub fn run(unit: &'static mut Unit, board: Option<Board>) -> ! {
        let (Ok(()), Some(board)) = (unit.start(&CONFIG), board) else { board::stop() };
        unit.note(Incident::Restart, board.restarts);
        let mut log = Log::new();
        log.noted(Incident::Restart, board.restarts);
        drive(unit, board, log)
    }

    #[cfg(not(feature = "lock-step"))]
    fn drive(unit: &mut Unit, mut board: Board, mut log: Log) -> ! {
        loop {
            while let Some((at, frame)) = board.receive() {
                // A refusal is counted in the unit, and its Health message tells.
                log.received(unit.receive(at, &frame));
            }
            if let Some(now) = board.tick() {
                for (incident, times) in board.incidents() {
                    unit.note(incident, times);
                    log.noted(incident, times);
                }
                let Ok(()) = board.busy.set_high();
                let answer = unit.tick(now);
                #[cfg(seeded_panic)] // a panic that the check of `no-panic` has to find
                assert!(answer.frames.len() < 16);
                let Ok(()) = board.busy.set_low();
                log.ticked(answer.mode);
                for frame in &answer.frames {
                    board.send(now, frame);
                }
                board.watchdog.feed();
            }
            board.idle();
        }
    }

    /// For hardware in the loop: the bus's time synchronisation ticks the unit, and the timer only feeds the watchdog, since
    /// the bus may be silent for long before it begins. What the board lost before that is no concern of the unit's, and the timer's
    /// periods never are.
    #[cfg(feature = "lock-step")]
    fn drive(unit: &mut Unit, mut board: Board, mut log: Log) -> ! {
        let mut steps = holdover::LockStep::new();
        let mut has_begun = false;
        loop {
            while let Some((at, frame)) = board.receive() {
                let Ok(()) = board.busy.set_high();
                let answer = steps.receive(unit, &frame);
                let Ok(()) = board.busy.set_low();
                let Some(answer) = answer else { continue };
                has_begun = true;
                log.ticked(answer.mode);
                for frame in &answer.frames {
                    board.send(at, frame);
                }
            }
            if board.tick().is_some() {
                for (incident, times) in board.incidents() {
                    let is_its_own = has_begun && incident != Incident::MissedPeriod;
                    unit.note(incident, if is_its_own { times } else { 0 });
                    log.noted(incident, times);
                }
                board.watchdog.feed();
            }
            board.idle();
        }
    }
}

/// What goes into the log: as warnings refusals and incidents, as information changes of the mode. Without the feature `log` or
/// `log-semihosting` nothing does, and nothing is left of this in the image.
#[cfg(target_os = "none")]
mod log {
    use holdover::controller::Mode;
    use holdover::health::Incident;
    #[cfg(not(feature = "lock-step"))]
    use holdover::{Reception, health::Cause};

    pub struct Log {
        mode: Mode,
    }

    impl Log {
        pub fn new() -> Self {
            #[cfg(feature = "_log")]
            defmt::info!("start: holdover {}", env!("CARGO_PKG_VERSION"));
            Self { mode: Mode::Standby }
        }

        #[cfg(not(feature = "lock-step"))] // there the shell does not see what became of a frame
        pub fn received(&mut self, result: Result<Reception, Cause>) {
            #[cfg(feature = "_log")]
            if let Err(cause) = result {
                defmt::warn!("refused: {}", cause);
            }
            #[cfg(not(feature = "_log"))]
            let _ = result;
        }

        pub fn noted(&mut self, incident: Incident, times: u32) {
            #[cfg(feature = "_log")]
            if times > 0 {
                defmt::warn!("{} times: {}", times, incident);
            }
            #[cfg(not(feature = "_log"))]
            let _ = (incident, times);
        }

        pub fn ticked(&mut self, mode: Mode) {
            #[cfg(feature = "_log")]
            if mode.code() != self.mode.code() {
                defmt::info!("mode: {}", mode);
            }
            self.mode = mode;
        }
    }

    #[cfg(feature = "_log")]
    defmt::timestamp!("{=u64:us}", crate::board::now().as_micros());
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
    use holdover::wire::Identifiers;
    use holdover::wire::catalogue::{CATALOGUE, SLOT_STRIDE, SLOTS, data_id};
    let mut table = String::from("   id  data id  name                 sender   cycle  timeout  frames  fields\n");
    for line in &CATALOGUE {
        let id = Identifiers::DEFAULT.at(line.offset).number();
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
