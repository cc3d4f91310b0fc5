//! A bus with a device, in memory and with a time of its own that jumps from one event to the next. It tests the
//! harness without CAN. Frames of the ports enter; the device's answers leave, as late as the behaviour says.

use std::cell::RefCell;
use std::collections::VecDeque;
use std::io;
use std::rc::Rc;

use holdover::Config;
use holdover::time::{Duration, Instant};

use super::rig::Rig;
use crate::bus::Frame;
use crate::bus::port::{BusError, Event, Port};
use crate::commands::ecu::Ecu;

/// Time at which the bus starts.
const START: Instant = Instant::from_micros(1_700_000_000_000_000);
/// Transmission time of a frame.
const TRANSIT: Duration = Duration::from_micros(100);

/// The device and its behaviour.
#[derive(Clone, Debug)]
pub struct Behaviour {
    /// Its configuration.
    pub config: Config,
    /// Whether it ticks by the time synchronisation of the bus.
    pub lock_step: bool,
    /// Time until its answer.
    pub latency: Duration,
    /// Stalls of the harness, in order: time since the start of the bus, and length.
    pub stalls: VecDeque<(Duration, Duration)>,
    /// Stalls of the device and its connection: their interval and their length. No frame is lost, and all are late.
    pub pause: Option<(Duration, Duration)>,
    /// Time since the start of the bus at which the device dies for good.
    pub dies_after: Option<Duration>,
    /// Changes a frame that the device sends.
    pub garble: fn(Frame) -> Frame,
}

impl Behaviour {
    /// A correct device that answers at once.
    #[must_use]
    pub fn good(config: Config, lock_step: bool) -> Self {
        let latency = Duration::from_micros(300);
        Self {
            config,
            lock_step,
            latency,
            stalls: VecDeque::new(),
            pause: None,
            dies_after: None,
            garble: |frame| frame,
        }
    }
}

struct Shared {
    now: Instant,
    is_up: bool,
    behaviour: Behaviour,
    device: Option<Ecu>,
    /// For each port, the events that it has not received yet.
    inboxes: Vec<VecDeque<(Instant, Event)>>,
    /// The frames that the device is about to send.
    answers: VecDeque<(Instant, Frame)>,
    /// The frames that wait while the device is stalled.
    held: Vec<Frame>,
}

/// A port of the bus.
#[derive(Clone)]
pub struct VirtualPort {
    shared: Rc<RefCell<Shared>>,
    index: usize,
}

/// The rig that can cut the device's power.
pub struct VirtualRig {
    injector: VirtualPort,
}

/// A bus with this device, and two of its ports: for the harness, and for its rig.
#[must_use]
pub fn bench(behaviour: Behaviour) -> (VirtualPort, VirtualRig) {
    let device = Ecu::new(&behaviour.config, behaviour.lock_step).ok();
    let shared = Shared {
        now: START,
        is_up: true,
        behaviour,
        device,
        inboxes: vec![VecDeque::new(), VecDeque::new()],
        answers: VecDeque::new(),
        held: Vec::new(),
    };
    let shared = Rc::new(RefCell::new(shared));
    let port = |index| VirtualPort { shared: Rc::clone(&shared), index };
    (port(0), VirtualRig { injector: port(1) })
}

impl Shared {
    /// Passes a frame of a port, or of the device, to all others.
    fn put(&mut self, from: Option<usize>, frame: Frame) {
        let at = self.now.plus(TRANSIT);
        for (index, inbox) in self.inboxes.iter_mut().enumerate() {
            let event = if Some(index) == from { Event::Sent(frame) } else { Event::Received(frame) };
            inbox.push_back((at, event));
        }
        if from.is_some() {
            if self.goes_on().is_some() { self.held.push(frame) } else { self.give(at, frame) }
        }
    }

    /// Passes a frame to the device.
    fn give(&mut self, at: Instant, frame: Frame) {
        if let Some(answer) = self.device.as_mut().and_then(|device| device.receive(at, &frame)) {
            self.answer(&answer.frames);
        }
    }

    /// The end of the device's stall, if it is stalled.
    fn goes_on(&self) -> Option<Instant> {
        let (every, length) = self.behaviour.pause?;
        let since = Duration::from_micros(self.now.since(START).as_micros().rem_euclid(every.as_micros()));
        (since < length).then(|| self.now.plus(length.minus(since)))
    }

    fn answer(&mut self, frames: &[holdover::wire::Frame]) {
        let at = self.now.plus(self.behaviour.latency);
        self.answers.extend(frames.iter().map(|frame| (at, (self.behaviour.garble)(frame.into()))));
    }

    /// Lets the device act up to `until`. The time is then that of its last act, or `until`.
    fn advance(&mut self, until: Instant) {
        if self.behaviour.dies_after.is_some_and(|after| self.now.since(START) > after) {
            self.device = None;
        }
        if let Some(end) = self.goes_on() {
            self.now = until.min(end);
            return;
        }
        for frame in std::mem::take(&mut self.held) {
            self.give(self.now, frame);
        }
        let answer = self.answers.front().map(|(at, _)| *at);
        let tick = self.device.as_ref().and_then(|device| (!self.behaviour.lock_step).then(|| device.wakes()));
        let tick = tick.map(|wakes| wakes.unwrap_or(self.now));
        let next = [answer, tick].into_iter().flatten().min().filter(|next| *next <= until);
        self.now = self.now.max(next.unwrap_or(until));
        if answer.is_some() && answer == next {
            if let Some((_, frame)) = self.answers.pop_front().filter(|_| self.is_up) {
                self.put(None, frame);
            }
        } else if next.is_some()
            && let Some(answer) = self.device.as_mut().and_then(|device| device.tick(self.now))
        {
            self.answer(&answer.frames);
        }
    }
}

impl Port for VirtualPort {
    fn now(&self) -> Instant {
        self.shared.borrow().now
    }

    fn send(&mut self, frame: Frame) -> io::Result<()> {
        let mut shared = self.shared.borrow_mut();
        if !shared.is_up {
            return Err(io::ErrorKind::NetworkDown.into());
        }
        shared.put(Some(self.index), frame);
        Ok(())
    }

    fn send_error(&mut self, error: BusError) -> io::Result<()> {
        let mut shared = self.shared.borrow_mut();
        let at = shared.now;
        shared.inboxes.iter_mut().for_each(|inbox| inbox.push_back((at, Event::Error(error))));
        Ok(())
    }

    fn wait(&mut self, until: Instant) -> io::Result<Option<(Instant, Event)>> {
        let shared = &mut *self.shared.borrow_mut();
        let now = shared.now;
        let stalls = &mut shared.behaviour.stalls;
        if let Some((_, length)) = stalls.pop_front_if(|(after, _)| now.since(START) > *after) {
            let end = shared.now.plus(length);
            while shared.now < end {
                shared.advance(end);
            }
        }
        loop {
            let now = shared.now;
            if let Some(event) = shared.inboxes[self.index].pop_front_if(|(at, _)| *at <= now) {
                return Ok(Some(event));
            }
            if now >= until {
                return Ok(None);
            }
            let first = shared.inboxes[self.index].front().map_or(until, |(at, _)| (*at).min(until));
            shared.advance(first.max(now));
        }
    }
}

impl Rig for VirtualRig {
    fn power(&mut self, on: bool) -> io::Result<()> {
        let mut shared = self.injector.shared.borrow_mut();
        let Behaviour { config, lock_step, .. } = shared.behaviour;
        shared.device = if on { Ecu::new(&config, lock_step).ok() } else { None };
        shared.answers.clear();
        Ok(())
    }

    fn interface(&mut self, up: bool) -> io::Result<()> {
        let mut shared = self.injector.shared.borrow_mut();
        shared.is_up = up;
        if !up {
            let at = shared.now;
            shared.inboxes.iter_mut().for_each(|inbox| inbox.push_back((at, Event::Down)));
        }
        Ok(())
    }

    fn injector(&mut self) -> io::Result<&mut dyn Port> {
        self.injector.shared.borrow_mut().inboxes[1].clear();
        Ok(&mut self.injector)
    }

    fn has_ended(&mut self) -> Option<String> {
        None
    }
}
