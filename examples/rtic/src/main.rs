//! The unit as a task of RTIC: frames of FDCAN1 and a ticker enter, frames leave. It compiles in CI, and has run on no board.
//!
//! The unit is a resource that two tasks share: `hear`, of the higher priority, takes a frame in as soon as the controller's interrupt
//! has queued it, with the time of its reception, and `drive` ticks. RTIC's ceiling lets neither interrupt the other in the unit,
//! which is all that the unit asks for. `say` sends: what a tick answers takes the place of what the tick before has not got rid of, so
//! nothing stale leaves but a frame in the driver's queue and three in the controller's buffers. The firmware's outbox empties these,
//! too (`src/board/outbox.rs`).
#![no_std]
#![no_main]

use panic_halt as _;

#[rtic::app(device = embassy_stm32::pac, peripherals = false, dispatchers = [SPI1, SPI2, SPI3])]
mod app {
    use embassy_stm32::can::frame::Frame;
    use embassy_stm32::can::{
        BufferedCan, BufferedCanReceiver, BufferedCanSender, CanConfigurator, IT0InterruptHandler, IT1InterruptHandler,
        RxBuf, TxBuf,
    };
    use embassy_stm32::peripherals::{FDCAN1, IWDG};
    use embassy_stm32::time::Hertz;
    use embassy_stm32::wdg::IndependentWatchdog;
    use embassy_stm32::{bind_interrupts, rcc};
    use embassy_time::{Duration, Ticker};
    use heapless::Deque;
    use holdover::health::Incident;
    use holdover::time::Instant;
    use holdover::wire::StationHash;
    use holdover::{Config, MAX_FRAMES, OnboardUnit};

    type Unit = OnboardUnit<8, 8, 400>;
    const PERIOD: Duration = Duration::from_millis(10);

    /// What an integrator calibrates.
    const CONFIG: Config = Config::car(StationHash(1));

    bind_interrupts!(struct Interrupts {
        FDCAN1_IT0 => IT0InterruptHandler<FDCAN1>;
        FDCAN1_IT1 => IT1InterruptHandler<FDCAN1>;
    });

    #[shared]
    struct Shared {
        unit: &'static mut Unit,
        /// What the newest tick has to say, and has not said yet.
        waiting: Deque<Frame, MAX_FRAMES>,
    }

    #[local]
    struct Local {
        rx: BufferedCanReceiver,
        tx: BufferedCanSender,
        watchdog: IndependentWatchdog<'static, IWDG>,
        /// The driver is there as long as this.
        _can: BufferedCan<'static, 1, 64>,
    }

    /// Of frames that were received more may wait than a full bus brings while a tick runs. The driver does not tell of more.
    #[init(local = [
        unit: Unit = Unit::idle(),
        received: RxBuf<64> = RxBuf::new(),
        sending: TxBuf<1> = TxBuf::new(),
    ])]
    fn init(context: init::Context) -> (Shared, Local) {
        let board = embassy_stm32::init(clocks());
        let mut can = CanConfigurator::new(board.FDCAN1, board.PA11, board.PA12, Interrupts);
        can.set_bitrate(500_000);
        let can = can.into_normal_mode().buffered(context.local.sending, context.local.received);
        let (tx, rx) = (can.writer(), can.reader());
        let watchdog = IndependentWatchdog::new(board.IWDG, 50_000);
        let unit = context.local.unit;
        if unit.start(&CONFIG).is_ok() {
            // Neither runs yet, so there is room for both.
            let _ = (hear::spawn(), drive::spawn());
        }
        (Shared { unit, waiting: Deque::new() }, Local { rx, tx, watchdog, _can: can })
    }

    /// The core at 170 MHz, and the CAN controller by the crystal itself.
    fn clocks() -> embassy_stm32::Config {
        let mut config = embassy_stm32::Config::default();
        config.rcc.hse = Some(rcc::Hse { freq: Hertz(24_000_000), mode: rcc::HseMode::Oscillator });
        config.rcc.pll = Some(rcc::Pll {
            source: rcc::PllSource::HSE,
            prediv: rcc::PllPreDiv::DIV6,
            mul: rcc::PllMul::MUL85,
            divp: None,
            divq: None,
            divr: Some(rcc::PllRDiv::DIV2),
        });
        config.rcc.sys = rcc::Sysclk::PLL1_R;
        config.rcc.boost = true;
        config.rcc.mux.fdcansel = rcc::mux::Fdcansel::HSE;
        config
    }

    #[task(priority = 2, local = [rx], shared = [unit])]
    async fn hear(mut context: hear::Context) {
        loop {
            let heard = context.local.rx.receive().await;
            context.shared.unit.lock(|unit| {
                // After an error the controller goes on by itself.
                if let Ok(heard) = heard {
                    // A refusal is counted in the unit, and its Health message tells.
                    let _ = unit.receive(Instant::from_micros(heard.ts.as_micros()), &heard.frame);
                }
            });
        }
    }

    #[task(priority = 1, local = [watchdog], shared = [unit, waiting])]
    async fn drive(mut context: drive::Context) {
        let mut period = Ticker::every(PERIOD);
        let mut last = embassy_time::Instant::now();
        let watchdog = context.local.watchdog;
        watchdog.unleash();
        loop {
            period.next().await;
            let at = embassy_time::Instant::now();
            let now = Instant::from_micros(at.as_micros());
            let missed = ((at - last).as_ticks() / PERIOD.as_ticks()).saturating_sub(1);
            // The ticker would make up for what was missed in a burst, but commands may change by the jerk in every tick.
            if missed > 0 {
                period.reset();
            }
            last = at;
            let unsaid = context.shared.waiting.lock(|waiting| waiting.len() as u32);
            let answer = context.shared.unit.lock(|unit| {
                unit.note(Incident::TransmitOverflow, unsaid);
                unit.note(Incident::MissedPeriod, u32::try_from(missed).unwrap_or(u32::MAX));
                unit.tick(now)
            });
            context.shared.waiting.lock(|waiting| {
                waiting.clear();
                for sent in &answer.frames {
                    // There is room for an answer.
                    let _ = Frame::new_data(sent.id, &sent.data).map(|frame| waiting.push_back(frame));
                }
            });
            // If it still is at the answer before, it goes on with this one.
            let _ = say::spawn();
            watchdog.pet();
        }
    }

    #[task(priority = 3, local = [tx], shared = [waiting])]
    async fn say(mut context: say::Context) {
        while let Some(frame) = context.shared.waiting.lock(Deque::pop_front) {
            context.local.tx.write(frame).await;
        }
    }
}
