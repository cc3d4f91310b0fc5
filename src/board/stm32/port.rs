//! The CAN port between its interrupts and the shell: frames that an interrupt takes in enter a lock-free queue with their
//! time of arrival and leave by [`Inbox`]; what the shell sends waits in the [`Outbox`], out of which the shell and the interrupts
//! give it to the port. So what a tick has sent leaves while the next one runs.

use super::clock;
use crate::board::chip::Selected;
use crate::board::chip::clocks::Clocks;
use crate::board::frame::CanFrame;
use crate::board::outbox::{Outbox, Pass};
use crate::board::port::{Overrun, Port};
use core::cell::RefCell;
use core::sync::atomic::{AtomicU32, Ordering};
use cortex_m::interrupt::{self, Mutex};
use embedded_can::Frame;
use heapless::spsc::{Consumer, Producer, Queue};
use holdover::health::Incident;
use holdover::time::Instant;

/// A port that can be selected.
pub trait Select: Port + Sized {
    /// The numbers of its interrupts.
    const INTERRUPTS: &'static [i16];
    /// Whether one comes when a frame has been sent.
    const TELLS_WHEN_SENT: bool;
    /// Puts it into operation. It lets in what the unit takes in, at least.
    fn start(clocks: &Clocks) -> Self;
}

/// Frames that may wait for the shell: 8 ms of a full bus at 500 kbit/s bring 36, and the longest tick takes less.
const WAITING: usize = 64;

/// The queue's memory.
pub type Arrivals = Queue<(Instant, CanFrame), WAITING>;

struct Line {
    port: Selected,
    arrivals: Producer<'static, (Instant, CanFrame)>,
    outbox: &'static mut Outbox,
}

static LINE: Mutex<RefCell<Option<Line>>> = Mutex::new(RefCell::new(None));

/// What was lost since the shell asked last.
static OVERRUNS: AtomicU32 = AtomicU32::new(0);
static OVERFLOWS: AtomicU32 = AtomicU32::new(0);

/// Calls this with the port and its queues, interrupts off. The interrupts and the shell take turns, so nobody ever finds them
/// borrowed.
fn with<R>(work: impl FnOnce(&mut Line) -> R) -> Option<R> {
    interrupt::free(|token| LINE.borrow(token).try_borrow_mut().ok()?.as_mut().map(work))
}

/// The port's interrupts: takes in all that has arrived, and gives the port what it has room for.
pub fn interrupted() {
    with(|line| {
        line.take_in();
        if Selected::TELLS_WHEN_SENT {
            // It has room for a few frames, so this ends.
            while line.outbox.pass(clock::now(), &mut line.port) == Pass::Taken {}
        }
    });
}

impl Line {
    fn take_in(&mut self) {
        loop {
            match self.port.receive() {
                Ok(Some(frame)) => {
                    // The first half is never so; it is what shows the compiler that no length is divided by 0.
                    if self.arrivals.capacity() == usize::MAX || self.arrivals.enqueue((clock::now(), frame)).is_err() {
                        OVERFLOWS.fetch_add(1, Ordering::Relaxed);
                    }
                }
                Ok(None) => return,
                Err(Overrun) => {
                    OVERRUNS.fetch_add(1, Ordering::Relaxed);
                }
            }
        }
    }
}

/// Queues a frame of the tick at this time.
pub fn send(tick: Instant, frame: &impl Frame) {
    with(|line| line.outbox.push(tick, frame));
}

/// Gives the port the most urgent frame that waits. One at a time, so that interrupts are off for no longer than one takes.
pub fn pass() -> Pass {
    with(|line| line.outbox.pass(clock::now(), &mut line.port)).unwrap_or(Pass::Nothing)
}

/// The shell's end of what arrives.
pub struct Inbox(Consumer<'static, (Instant, CanFrame)>);

/// Starts the port.
pub fn start(clocks: &Clocks, arrivals: &'static mut Arrivals, outbox: &'static mut Outbox) -> Inbox {
    let (producer, consumer) = arrivals.split();
    let port = <Selected as Select>::start(clocks);
    interrupt::free(|token| {
        if let Ok(mut line) = LINE.borrow(token).try_borrow_mut() {
            *line = Some(Line { port, arrivals: producer, outbox });
        }
    });
    Inbox(consumer)
}

impl Inbox {
    /// The next frame, and when it arrived.
    pub fn next(&mut self) -> Option<(Instant, impl Frame + use<>)> {
        self.0.dequeue()
    }

    pub fn is_empty(&self) -> bool {
        !self.0.ready()
    }
}

/// What was lost since the last call, and how often: received frames by the port and by the queue, frames to be sent, and the bus.
pub fn lost() -> [(Incident, u32); 4] {
    let [transmit, bus_off] = with(|line| line.outbox.lost(&mut line.port))
        .unwrap_or([(Incident::TransmitOverflow, 0), (Incident::BusOff, 0)]);
    [
        (Incident::Overrun, OVERRUNS.swap(0, Ordering::Relaxed)),
        (Incident::ReceiveOverflow, OVERFLOWS.swap(0, Ordering::Relaxed)),
        transmit,
        bus_off,
    ]
}
