//! The CAN port between its interrupt and the shell: frames that the interrupt takes in enter a lock-free queue with their
//! time of arrival and leave by [`Inbox`]; frames to send enter [`Outbox`] and leave as fast as the port takes them.

use super::{Selected, clock};
use crate::board::clocks::Clocks;
use core::cell::RefCell;
use core::sync::atomic::{AtomicU32, Ordering};
use cortex_m::interrupt::{self, Mutex};
use embedded_can::Frame;
use embedded_can::nb::Can;
use heapless::Deque;
use heapless::spsc::{Consumer, Producer, Queue};
use holdover::health::Incident;
use holdover::time::Instant;

/// What the board needs of a CAN port beyond `embedded-can`'s receive and transmit.
pub trait Port: Can + Sized {
    /// The number of its interrupt.
    const INTERRUPT: i16;
    /// Puts it into operation.
    fn start(clocks: &Clocks) -> Self;
    /// Moves on what is being sent; whether something is left of it.
    fn pump(&mut self) -> bool;
    /// Whether the controller has left the bus after too many errors.
    fn is_bus_off(&self) -> bool;
}

/// A frame of the port that was selected.
type PortFrame = <Selected as Can>::Frame;
/// Frames that may wait for the shell: 8 ms of a full bus at 500 kbit/s bring 36, and the longest tick takes less.
const WAITING: usize = 64;
/// Frames that may wait to be sent: twice what one tick sends at most.
const OUTGOING: usize = 32;

/// The queue's memory.
pub type Arrivals = Queue<(Instant, PortFrame), WAITING>;

struct Receiver {
    port: Selected,
    arrivals: Producer<'static, (Instant, PortFrame)>,
}

static RECEIVER: Mutex<RefCell<Option<Receiver>>> = Mutex::new(RefCell::new(None));

/// What was lost since the shell asked last.
static OVERRUNS: AtomicU32 = AtomicU32::new(0);
static OVERFLOWS: AtomicU32 = AtomicU32::new(0);

/// Calls this with the port. The interrupt and the shell take turns, so nobody ever finds it borrowed.
fn with<R>(work: impl FnOnce(&mut Receiver) -> R) -> Option<R> {
    interrupt::free(|token| RECEIVER.borrow(token).try_borrow_mut().ok()?.as_mut().map(work))
}

/// The port's interrupt: takes in all that has arrived.
pub fn interrupted() {
    with(|Receiver { port, arrivals }| {
        loop {
            match port.receive() {
                Ok(frame) => {
                    // The first half is never so; it is what shows the compiler that no length is divided by 0.
                    if arrivals.capacity() == usize::MAX || arrivals.enqueue((clock::now(), frame)).is_err() {
                        OVERFLOWS.fetch_add(1, Ordering::Relaxed);
                    }
                }
                Err(nb::Error::WouldBlock) => return,
                Err(nb::Error::Other(_)) => {
                    OVERRUNS.fetch_add(1, Ordering::Relaxed);
                }
            }
        }
    });
}

/// The shell's end of what arrives.
pub struct Inbox(Consumer<'static, (Instant, PortFrame)>);

/// What waits to be sent.
pub struct Outbox {
    waiting: Deque<PortFrame, OUTGOING>,
    dropped: u32,
    was_off: bool,
}

/// Starts the port.
pub fn start(clocks: &Clocks, arrivals: &'static mut Arrivals) -> (Inbox, Outbox) {
    let (producer, consumer) = arrivals.split();
    let port = Selected::start(clocks);
    interrupt::free(|token| {
        if let Ok(mut receiver) = RECEIVER.borrow(token).try_borrow_mut() {
            *receiver = Some(Receiver { port, arrivals: producer });
        }
    });
    (Inbox(consumer), Outbox { waiting: Deque::new(), dropped: 0, was_off: false })
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

impl Outbox {
    /// Queues a frame. One that finds the queue full is dropped: a later one says the same, but newer.
    pub fn push(&mut self, frame: &impl Frame) {
        let queued =
            PortFrame::new(frame.id(), frame.data()).is_some_and(|frame| self.waiting.push_back(frame).is_ok());
        self.dropped = self.dropped.saturating_add(u32::from(!queued));
    }

    /// Gives the port what it takes; whether something is left.
    pub fn flush(&mut self) -> bool {
        while let Some(frame) = self.waiting.pop_front() {
            let back = match with(|receiver| receiver.port.transmit(&frame)) {
                Some(Ok(back)) => back, // a frame that this one took the place of
                Some(Err(nb::Error::WouldBlock)) => Some(frame),
                Some(Err(nb::Error::Other(_))) | None => None,
            };
            if let Some(back) = back {
                let _ = self.waiting.push_front(back); // there is room: one was taken
                return true;
            }
        }
        with(|receiver| receiver.port.pump()) == Some(true)
    }

    /// What was lost since the last call, and how often.
    pub fn incidents(&mut self) -> [(Incident, u32); 4] {
        let is_off = with(|receiver| receiver.port.is_bus_off()) == Some(true);
        let went_off = is_off && !self.was_off;
        self.was_off = is_off;
        [
            (Incident::Overrun, OVERRUNS.swap(0, Ordering::Relaxed)),
            (Incident::ReceiveOverflow, OVERFLOWS.swap(0, Ordering::Relaxed)),
            (Incident::TransmitOverflow, core::mem::take(&mut self.dropped)),
            (Incident::BusOff, u32::from(went_off)),
        ]
    }
}
