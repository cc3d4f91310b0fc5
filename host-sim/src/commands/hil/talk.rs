//! The harness's side of the bus. Frames of the vehicle and its modem enter, and leave on the port as fast as a bus
//! takes them; the time synchronisation carries the time at which it was really sent. The events on the bus leave in
//! the order of time.

use std::collections::VecDeque;
use std::io::{self, ErrorKind};

use holdover::time::{Duration, Instant};
use holdover::wire::catalogue::Content;
use holdover::wire::sync::{FollowUp, Sync};
use holdover::wire::{Identifiers, Message, Sender, Transport};

use super::content::{counter_of, line_of, payloads, recounted};
use super::fault::Kind;
use crate::bus::Frame;
use crate::bus::port::{Event, Port};
use crate::sim::time::EPOCH_US;

/// Frames sent at once. At 4000 per second the bus is full at 500 kbit/s.
const BURST: u32 = 4;
const BURST_EVERY: Duration = Duration::from_millis(1);
/// Longest wait for the echo of a `Sync`.
const MARK_PATIENCE: Duration = Duration::from_millis(50);

/// Counts of the harness's frames.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Passed to the port.
    pub sent: u64,
    /// Seen on the bus.
    pub confirmed: u64,
    /// Refused, because the interface was down.
    pub refused: u64,
}

impl Counts {
    /// Whether no frame is on its way.
    #[must_use]
    pub fn is_complete(&self) -> bool {
        self.sent <= self.confirmed + self.refused
    }
}

/// What the harness has altered on purpose.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Altered {
    /// Altered frames.
    pub frames: u64,
    /// Wrong time synchronisations.
    pub times: u64,
}

/// The harness's side of the bus.
pub struct Talk<P> {
    port: P,
    identifiers: Identifiers,
    /// The time of the bus at the beginning of the run.
    origin: Instant,
    queue: VecDeque<Frame>,
    /// The earliest time of the next burst, and the frames that are left of this one.
    burst: (Instant, u32),
    /// The last `Sync`, its time of sending, and the time at which it was on the bus.
    mark: Option<(Sync, Instant, Option<Instant>)>,
    /// Whether a follow-up gets the time at which its `Sync` was on the bus; otherwise it is sent unchanged.
    pub dates: bool,
    /// The intended error of the time synchronisation.
    pub clock_error_us: i64,
    /// The intended alteration of frames.
    pub spoiled: Option<Kind>,
    counts: Counts,
    altered: Altered,
}

impl<P: Port> Talk<P> {
    /// The side of the bus at a port, with the catalogue on these identifiers.
    pub fn new(port: P, identifiers: Identifiers) -> Self {
        let now = port.now();
        Self {
            port,
            identifiers,
            origin: now,
            queue: VecDeque::new(),
            burst: (now, BURST),
            mark: None,
            dates: true,
            clock_error_us: 0,
            spoiled: None,
            counts: Counts::default(),
            altered: Altered::default(),
        }
    }

    /// The bus's time.
    pub fn now(&self) -> Instant {
        self.port.now()
    }

    /// Sets the beginning of the run.
    pub fn begin_at(&mut self, origin: Instant) {
        self.origin = origin;
    }

    /// A time of the bus, as a time of the run in seconds.
    pub fn time_of(&self, at: Instant) -> f64 {
        at.since(self.origin).as_micros() as f64 * 1e-6
    }

    /// A time of the run, as a time of the bus.
    pub fn instant(&self, at_s: f64) -> Instant {
        self.origin.plus(Duration::from_micros(crate::sim::time::micros(at_s)))
    }

    /// Counts of the frames.
    pub fn counts(&self) -> Counts {
        self.counts
    }

    /// Counts of intended alterations.
    pub fn altered(&self) -> Altered {
        self.altered
    }

    /// Queues a frame for sending.
    pub fn send(&mut self, frame: Frame) {
        self.queue.push_back(frame);
    }

    /// Whether everything has been sent.
    pub fn is_idle(&self) -> bool {
        self.queue.is_empty()
    }

    /// Sends the queued frames until `until`. Events go to `hear`.
    ///
    /// # Errors
    /// Errors of the port, except for an interface that is down.
    pub fn pump(&mut self, until: Instant, mut hear: impl FnMut(Instant, Event)) -> io::Result<()> {
        self.pump_while(until, |at, event| {
            hear(at, event);
            true
        })
    }

    /// The same, until `hear` returns that it is enough.
    ///
    /// # Errors
    /// The errors of [`Talk::pump`].
    pub fn pump_while(&mut self, until: Instant, mut hear: impl FnMut(Instant, Event) -> bool) -> io::Result<()> {
        loop {
            let wake = self.send_waiting()?.map_or(until, |next| next.min(until));
            match self.port.wait(wake)? {
                Some((at, event)) => {
                    self.note(at, &event);
                    if !hear(at, event) {
                        return Ok(());
                    }
                    // A bus that is never idle must not stop the clock.
                    if self.port.now() >= until && at > until {
                        return Ok(());
                    }
                }
                None if wake >= until => return Ok(()),
                None => {}
            }
        }
    }

    /// Sends the frames that may be sent now. Returns the time at which there is more to send.
    fn send_waiting(&mut self) -> io::Result<Option<Instant>> {
        while let Some(frame) = self.queue.front().copied() {
            let now = self.port.now();
            let (next, left) = if now >= self.burst.0 { (now.plus(BURST_EVERY), BURST) } else { self.burst };
            if left == 0 {
                return Ok(Some(next));
            }
            let frame = match line_of(&self.identifiers, &frame).map(|line| line.content) {
                Some(Content::Sync) => {
                    let [payload, _] = payloads(&self.identifiers, &frame);
                    self.mark = Some((Sync::decode(&[payload]), now, None));
                    frame
                }
                Some(Content::FollowUp) if self.dates => match self.mark {
                    Some((sync, _, Some(marked))) => {
                        self.altered.times += u64::from(self.clock_error_us != 0);
                        self.dated(&frame, &sync, marked)
                    }
                    Some((_, sent, None)) if now.since(sent) < MARK_PATIENCE => {
                        return Ok(Some(sent.plus(MARK_PATIENCE)));
                    }
                    _ => frame,
                },
                _ => frame,
            };
            self.queue.pop_front();
            self.burst = (next, left - 1);
            self.counts.sent += 1;
            let spoilt = self.spoilt(frame);
            match self.port.send(spoilt.unwrap_or(frame)) {
                Ok(()) => self.altered.frames += u64::from(spoilt.is_some()),
                Err(error) if error.kind() == ErrorKind::NetworkDown => self.counts.refused += 1,
                Err(error) => return Err(error),
            }
        }
        Ok(None)
    }

    fn note(&mut self, at: Instant, event: &Event) {
        let Event::Sent(frame) = event else { return };
        self.counts.confirmed += 1;
        if line_of(&self.identifiers, frame).is_some_and(|line| line.content == Content::Sync)
            && let Some((_, _, marked)) = &mut self.mark
        {
            *marked = Some(at);
        }
    }

    /// The follow-up with the time at which its `Sync` was on the bus.
    fn dated(&self, frame: &Frame, sync: &Sync, marked: Instant) -> Frame {
        let micros = marked.since(self.origin).as_micros().saturating_add(self.clock_error_us);
        let time = EPOCH_US.saturating_add_signed(micros);
        let micros = u32::try_from(time.saturating_sub(u64::from(sync.seconds) * 1_000_000)).unwrap_or(u32::MAX);
        let [payload, _] = payloads(&self.identifiers, frame);
        let follow_up = FollowUp { micros, ..FollowUp::decode(&[payload]) };
        let transport = if frame.is_fd() { Transport::Fd } else { Transport::Classic };
        let mut dated = *frame;
        let sent =
            Sender::<0>::new(self.identifiers).over(transport).send(&Message::FollowUp(follow_up), &mut |made| {
                dated = (&recounted(&self.identifiers, &made, counter_of(frame))).into();
            });
        sent.expect("the catalogue has a line for the time synchronisation");
        dated
    }

    /// The frame to send instead, if it is this frame's turn to be altered.
    fn spoilt(&self, frame: Frame) -> Option<Frame> {
        let kind = self.spoiled.filter(|_| self.counts.sent.is_multiple_of(3))?;
        match kind {
            Kind::Corrupt => Some(frame.with_flipped_bit(usize::try_from(self.counts.sent).unwrap_or(0))),
            Kind::Truncate => Some(frame.cut_to(4)),
            _ => None,
        }
    }
}
