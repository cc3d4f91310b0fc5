//! The CAN port between its interrupt and the shell: frames that the interrupt takes in enter a lock-free queue with their
//! time of arrival and leave by [`Inbox`]; the shell comes to the port by [`with`], to send.

use super::clocks::Clocks;
use super::{Selected, clock};
use crate::board::port::Port;
use core::cell::RefCell;
use core::sync::atomic::{AtomicU32, Ordering};
use cortex_m::interrupt::{self, Mutex};
use embedded_can::Frame;
use embedded_can::nb::Can;
use heapless::spsc::{Consumer, Producer, Queue};
use holdover::health::Incident;
use holdover::time::Instant;

/// A port that can be selected.
pub trait Select: Port + Sized {
    /// The number of its interrupt.
    const INTERRUPT: i16;
    /// Puts it into operation.
    fn start(clocks: &Clocks) -> Self;
    /// Moves on what is being sent; whether something is left of it.
    fn pump(&mut self) -> bool;
}

/// A frame of the port that was selected.
pub type PortFrame = <Selected as Can>::Frame;
/// Frames that may wait for the shell: 8 ms of a full bus at 500 kbit/s bring 36, and the longest tick takes less.
const WAITING: usize = 64;

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

/// Calls this with the receiver. The interrupt and the shell take turns, so nobody ever finds it borrowed.
fn with_receiver<R>(work: impl FnOnce(&mut Receiver) -> R) -> Option<R> {
    interrupt::free(|token| RECEIVER.borrow(token).try_borrow_mut().ok()?.as_mut().map(work))
}

/// Calls this with the port, interrupts off.
pub fn with<R>(work: impl FnOnce(&mut Selected) -> R) -> Option<R> {
    with_receiver(|receiver| work(&mut receiver.port))
}

/// The port's interrupt: takes in all that has arrived.
pub fn interrupted() {
    with_receiver(|Receiver { port, arrivals }| {
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

/// Starts the port.
pub fn start(clocks: &Clocks, arrivals: &'static mut Arrivals) -> Inbox {
    let (producer, consumer) = arrivals.split();
    let port = Selected::start(clocks);
    interrupt::free(|token| {
        if let Ok(mut receiver) = RECEIVER.borrow(token).try_borrow_mut() {
            *receiver = Some(Receiver { port, arrivals: producer });
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

/// Received frames that were lost since the last call: by the port, and by the queue.
pub fn lost() -> [(Incident, u32); 2] {
    [
        (Incident::Overrun, OVERRUNS.swap(0, Ordering::Relaxed)),
        (Incident::ReceiveOverflow, OVERFLOWS.swap(0, Ordering::Relaxed)),
    ]
}
