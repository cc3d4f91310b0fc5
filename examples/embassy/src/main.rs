//! The unit as a task of Embassy: frames of FDCAN1 and a ticker enter, frames leave. It compiles in CI, and has run on no board.
//!
//! Two tasks on one executor. `drive` has the unit to itself, so nothing has to be locked: it takes in what the controller's
//! interrupt has queued, with the time of its reception, and ticks. `say` sends. Between the two there is one place: the answer of a
//! tick takes that of the tick before, if it still waits, so nothing stale leaves but a frame in the driver's queue and three in the
//! controller's buffers. The firmware's outbox empties these, too (`src/board/outbox.rs`).
#![no_std]
#![no_main]

use embassy_executor::Spawner;
use embassy_futures::select::{Either, select};
use embassy_stm32::can::frame::Frame;
use embassy_stm32::can::{
    BufferedCanReceiver, BufferedCanSender, CanConfigurator, IT0InterruptHandler, IT1InterruptHandler, RxBuf, TxBuf,
};
use embassy_stm32::peripherals::{FDCAN1, IWDG};
use embassy_stm32::time::Hertz;
use embassy_stm32::wdg::IndependentWatchdog;
use embassy_stm32::{bind_interrupts, rcc};
use embassy_sync::blocking_mutex::raw::CriticalSectionRawMutex;
use embassy_sync::signal::Signal;
use embassy_time::{Duration, Ticker};
use heapless::Vec;
use holdover::health::Incident;
use holdover::time::Instant;
use holdover::wire::StationHash;
use holdover::{Config, MAX_FRAMES, OnboardUnit};
use panic_halt as _;
use static_cell::ConstStaticCell;

type Unit = OnboardUnit<8, 8, 400>;

/// What an integrator calibrates.
const CONFIG: Config = Config::car(StationHash(1));
const PERIOD: Duration = Duration::from_millis(10);

/// The unit. All zero, so it takes no room in flash.
static UNIT: ConstStaticCell<Unit> = ConstStaticCell::new(Unit::idle());
/// Frames that were received and not taken in yet: more than a full bus brings while a tick runs. The driver does not tell of more.
static RECEIVED: ConstStaticCell<RxBuf<64>> = ConstStaticCell::new(RxBuf::new());
static SENDING: ConstStaticCell<TxBuf<1>> = ConstStaticCell::new(TxBuf::new());
/// What the newest tick has to say.
static ANSWER: Signal<CriticalSectionRawMutex, Vec<Frame, MAX_FRAMES>> = Signal::new();

bind_interrupts!(struct Interrupts {
    FDCAN1_IT0 => IT0InterruptHandler<FDCAN1>;
    FDCAN1_IT1 => IT1InterruptHandler<FDCAN1>;
});

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

#[embassy_executor::main]
async fn main(spawner: Spawner) {
    let board = embassy_stm32::init(clocks());
    let mut can = CanConfigurator::new(board.FDCAN1, board.PA11, board.PA12, Interrupts);
    can.set_bitrate(500_000);
    let can = can.into_normal_mode().buffered(SENDING.take(), RECEIVED.take());
    let watchdog = IndependentWatchdog::new(board.IWDG, 50_000);
    let unit = UNIT.take();
    if unit.start(&CONFIG).is_err() {
        return; // and nothing is sent
    }
    if let (Ok(say), Ok(drive)) = (say(can.writer()), drive(unit, can.reader(), watchdog)) {
        spawner.spawn(say);
        spawner.spawn(drive);
    }
    core::future::pending::<()>().await; // the driver is there as long as this
}

#[embassy_executor::task]
async fn say(mut tx: BufferedCanSender) {
    loop {
        for frame in ANSWER.wait().await {
            tx.write(frame).await;
        }
    }
}

#[embassy_executor::task]
async fn drive(unit: &'static mut Unit, rx: BufferedCanReceiver, mut watchdog: IndependentWatchdog<'static, IWDG>) {
    let mut period = Ticker::every(PERIOD);
    let mut last = embassy_time::Instant::now();
    watchdog.unleash();
    loop {
        // A frame comes before a tick that is due at the same time.
        match select(rx.receive(), period.next()).await {
            Either::First(Ok(heard)) => {
                // A refusal is counted in the unit, and its Health message tells.
                let _ = unit.receive(Instant::from_micros(heard.ts.as_micros()), &heard.frame);
            }
            Either::First(Err(_)) => {} // the controller goes on by itself
            Either::Second(()) => {
                let at = embassy_time::Instant::now();
                // The ticker would make up for what was missed in a burst, but commands may change by the jerk in every tick.
                let missed = ((at - last).as_ticks() / PERIOD.as_ticks()).saturating_sub(1);
                if missed > 0 {
                    unit.note(Incident::MissedPeriod, u32::try_from(missed).unwrap_or(u32::MAX));
                    period.reset();
                }
                last = at;
                let now = Instant::from_micros(at.as_micros());
                let unsaid = ANSWER.try_take().map_or(0, |frames| frames.len() as u32);
                unit.note(Incident::TransmitOverflow, unsaid);
                let frames = &unit.tick(now).frames;
                ANSWER.signal(frames.iter().filter_map(|sent| Frame::new_data(sent.id, &sent.data).ok()).collect());
                watchdog.pet();
            }
        }
    }
}
