//! A bus with a device on it, in memory and in a time of its own that leaps from one event to the next: for trying out the
//! harness where there is no CAN. Frames of the ports enter, the device's answers leave, as late as it is told to be.

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

/// When its time begins.
const START: Instant = Instant::from_micros(1_700_000_000_000_000);
/// How long a frame is on its way.
const TRANSIT: Duration = Duration::from_micros(100);

/// What the device is, and how it behaves.
#[derive(Clone, Debug)]
pub struct Behaviour {
    /// Its configuration.
    pub config: Config,
    /// Whether it ticks by the bus.
    pub lock_step: bool,
    /// How long it takes to answer.
    pub latency: Duration,
    /// When the harness stands still, from the beginning of the bus's time on, and for how long; in this order.
    pub stalls: VecDeque<(Duration, Duration)>,
    /// How often the device and its line stand still, and for how long: nothing is lost, and all of it is late.
    pub pause: Option<(Duration, Duration)>,
    /// When it dies for good, from the beginning of the bus's time on.
    pub dies_after: Option<Duration>,
    /// Changes a frame of the device on its way out.
    pub garble: fn(Frame) -> Frame,
}

impl Behaviour {
    /// A good device, at once.
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
    /// For each port, what it has still to be told.
    inboxes: Vec<VecDeque<(Instant, Event)>>,
    /// What the device is about to send.
    answers: VecDeque<(Instant, Frame)>,
    /// What waits for the device to go on.
    held: Vec<Frame>,
}

/// A port of the bus.
#[derive(Clone)]
pub struct VirtualPort {
    shared: Rc<RefCell<Shared>>,
    index: usize,
}

/// The hands that can pull the device's plug.
pub struct VirtualRig {
    injector: VirtualPort,
}

/// A bus with that device, two ports of it: for the harness, and for its rig.
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
    /// A frame of a port, or of the device, goes to all others.
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

    /// The device receives it.
    fn give(&mut self, at: Instant, frame: Frame) {
        if let Some(answer) = self.device.as_mut().and_then(|device| device.receive(at, &frame)) {
            self.answer(&answer.frames);
        }
    }

    /// When the device goes on, if it stands still.
    fn goes_on(&self) -> Option<Instant> {
        let (every, length) = self.behaviour.pause?;
        let since = Duration::from_micros(self.now.since(START).as_micros().rem_euclid(every.as_micros()));
        (since < length).then(|| self.now.plus(length.minus(since)))
    }

    fn answer(&mut self, frames: &[holdover::wire::Frame]) {
        let at = self.now.plus(self.behaviour.latency);
        self.answers.extend(frames.iter().map(|frame| (at, (self.behaviour.garble)(frame.into()))));
    }

    /// Lets the device do what it does up to then; the time is that of what it did, or `until`.
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
