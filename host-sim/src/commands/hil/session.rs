//! A run in real time: the world goes on by the bus's clock, frames go to the device and its twin, and the device's
//! commands move the ego. A setup, a port and a rig enter; the outcome leaves.
//!
//! Order within a tick: the device's commands up to now move the ego; the world sends at the tick's own time, however
//! late the harness is, so that lateness makes messages older and never wrong; the units of the other vehicles tick.
//! Between ticks the harness listens to the bus. Every wait has an end, so the run also ends if the device never
//! answers or falls silent.

use std::io;

use holdover::time::{Duration, Instant};
use holdover::wire::catalogue::Node;
use holdover::wire::{Identifiers, Transport};
use holdover::{Config, ConfigError};

use super::content::{EgoMotion, line_of};
use super::deviation::Deviation;
use super::fault::Fault;
use super::fault_injector::{FaultInjector, Played};
use super::lateness::Lateness;
use super::monitor::{Monitor, News};
use super::outcome::{Cut, Outcome};
use super::record::Record;
use super::rig::Rig;
use super::said::Said;
use super::talk::Talk;
use super::twin::Twin;
use crate::bus::memory::MemoryNode;
use crate::bus::port::{Event, Port};
use crate::bus::{Bus, Frame};
use crate::input::scenario::Scenario;
use crate::sim::stages::Stages;
use crate::sim::station::station;
use crate::sim::vehicle::Alias;
use crate::sim::world::World;

/// Time for which the world sends before the run, in seconds. A time base needs two synchronisations, half a second
/// apart, that are trusted.
const WARM_UP_S: f64 = 2.0;
/// A device that is silent for longer, without a fault, counts as gone; in seconds.
const GONE_S: f64 = 2.0;
/// Longest wait for the echoes of the last frames.
const ECHO_PATIENCE: Duration = Duration::from_millis(1000);
/// The commands of the device that are kept of a run that nobody judges.
const LATEST: usize = 1000;
/// Time after a fault in which effects are attributed to it, in seconds.
pub const AFTERMATH_S: f64 = 5.0;

/// The setup of a run.
#[derive(Clone, Debug)]
pub struct Setup {
    /// The world; its ego is the device's vehicle.
    pub scenario: Scenario,
    /// The device.
    pub config: Config,
    /// Longest wait for its first frame.
    pub wait: Duration,
    /// Longest time from the vehicle's motion to the command that rests on it, except for one command in 100, in
    /// milliseconds.
    pub latency_p99_ms: f64,
    /// The faults to inject.
    pub faults: Vec<Fault>,
    /// The most ticks that the trace keeps: of a longer run every second, every fourth and so on. Figures are of every tick.
    pub most_ticks: usize,
}

impl Setup {
    /// The names on the device's bus: the device's vehicle has the device's own station.
    #[must_use]
    pub fn alias(&self) -> Alias {
        Alias::between(station(self.scenario.ego), self.config.station)
    }

    /// Whether an event at this time is attributed to a fault.
    #[must_use]
    pub fn is_excused(&self, at_s: f64) -> bool {
        self.faults.iter().any(|fault| (fault.from_s..fault.to_s + AFTERMATH_S).contains(&at_s))
    }
}

/// The listener on the bus.
pub(super) struct BusListener {
    identifiers: Identifiers,
    config: Config,
    seat: MemoryNode,
    pub monitor: Monitor,
    twin: Twin,
    told: Option<(Said, Duration)>,
    pub deviation: Deviation,
    pub foreign: u64,
    pub bus_errors: u64,
    /// Whether the device is compared with its twin, from the beginning to the end.
    is_judged: bool,
    last_beat: Option<Instant>,
    motion: EgoMotion,
}

impl BusListener {
    pub fn new(config: &Config, seat: MemoryNode) -> Result<Self, ConfigError> {
        Ok(Self {
            identifiers: config.identifiers,
            config: *config,
            seat,
            monitor: Monitor::new(config.identifiers, config.period).over(config.transport),
            twin: Twin::new(config)?,
            told: None,
            deviation: Deviation::new(config.period),
            foreign: 0,
            bus_errors: 0,
            is_judged: true,
            last_beat: None,
            motion: EgoMotion::default(),
        })
    }

    /// The same in a run that nobody judges, and that may last for days.
    fn unjudged(self) -> Self {
        Self { monitor: self.monitor.keeping(LATEST), is_judged: false, ..self }
    }

    /// The device was powered up anew, and so is its twin.
    fn restart(&mut self) {
        if let Ok(twin) = Twin::new(&self.config) {
            self.twin = twin;
        }
    }

    /// Takes in an event on the bus. `local` converts a time of the bus to one of the run and one of the vehicle's own
    /// clock.
    pub fn hear(&mut self, at: Instant, event: Event, local: impl Fn(Instant) -> (f64, Instant)) -> io::Result<()> {
        match event {
            Event::Sent(frame) => {
                if let Some(motion) = self.motion.take(&self.identifiers, &frame) {
                    self.monitor.input(at, motion.stamp);
                }
                self.twin.hear(at, frame);
            }
            Event::Received(frame) => match line_of(&self.identifiers, &frame) {
                Some(line) if line.sender == Node::Unit => self.device(at, &frame, local)?,
                line => {
                    self.foreign += u64::from(line.is_some());
                    self.twin.hear(at, frame);
                }
            },
            Event::Error(_) => self.bus_errors += 1,
            Event::Down => {}
        }
        Ok(())
    }

    fn device(&mut self, at: Instant, frame: &Frame, local: impl Fn(Instant) -> (f64, Instant)) -> io::Result<()> {
        let (at_s, own) = local(at);
        self.seat.send(own, *frame)?;
        match self.monitor.hear(at, frame) {
            News::Command(command, is_new) => {
                if is_new {
                    self.restart();
                }
                // Before the run, device and twin may have been powered up at different times.
                let gap = self.last_beat.map_or(self.config.period, |last| at.since(last));
                let window =
                    gap.max(Duration::from_micros(self.config.period.as_micros() + self.monitor.lag().as_micros()));
                self.last_beat = Some(at);
                self.told = self.twin.tick(at).map(|said| (said, window));
                if let Some((said, window)) = self.told.filter(|_| at_s >= 0.0 && self.is_judged) {
                    self.deviation.command(at_s, &command, &said, window);
                }
            }
            News::Estimate(device) => {
                // Over CAN FD there is no tag: an estimate is that of the command before it.
                let is_of = |tick: u8, tag: u8| self.config.transport == Transport::Fd || tick % 4 == tag;
                if let Some((Said { command, estimate: Some(twin) }, window)) =
                    self.told.filter(|_| at_s >= 0.0 && self.is_judged)
                    && self.monitor.commands().last().is_some_and(|beat| is_of(beat.tick, device.tag))
                    && is_of(command.tick, twin.tag)
                {
                    self.deviation.estimate(at_s, &device, &twin, window);
                }
            }
            News::Other => {}
        }
        Ok(())
    }
}

/// Someone who looks at a run, and may change what happens in its world.
pub trait Onlooker {
    /// The world at its start, before anything is sent in it.
    ///
    /// # Errors
    /// What keeps it from looking.
    fn begin(&mut self, _world: &mut World<'_>) -> io::Result<()> {
        Ok(())
    }

    /// The world at a tick. Returns whether the run goes on.
    ///
    /// # Errors
    /// Errors of the buses.
    fn see(&mut self, _world: &mut World<'_>, _at_s: f64) -> io::Result<bool> {
        Ok(true)
    }

    /// Whether the run is judged at its end, for which every command is kept.
    fn judges(&self) -> bool {
        true
    }
}

/// Nobody looks.
struct Nobody;

impl Onlooker for Nobody {}

/// Runs the setup. `progress` gets the time of the run from time to time.
///
/// # Errors
/// Errors of the port. A configuration that the unit refuses counts as one.
pub fn run<P: Port>(setup: &Setup, port: P, rig: &mut dyn Rig, progress: impl FnMut(f64)) -> io::Result<Outcome> {
    run_before(setup, port, rig, &mut Nobody, progress)
}

/// The same before the eyes of an onlooker.
///
/// # Errors
/// As for [`run`].
pub fn run_before<P: Port>(
    setup: &Setup,
    port: P,
    rig: &mut dyn Rig,
    onlooker: &mut dyn Onlooker,
    mut progress: impl FnMut(f64),
) -> io::Result<Outcome> {
    let Setup { scenario, config, .. } = setup;
    let mut world = World::new(scenario, scenario.seed, None).map_err(io::Error::other)?;
    if !onlooker.judges() {
        world = world.unrecorded();
    }
    let seat = world.give_seat(scenario.ego, setup.alias());
    let mut listener = BusListener::new(config, seat).map_err(io::Error::other)?;
    if !onlooker.judges() {
        listener = listener.unjudged();
    }
    let mut talk = Talk::new(port, config.identifiers);
    onlooker.begin(&mut world)?;
    let mut record = Record::of(&world, setup, onlooker.judges());
    let mut injector = FaultInjector::new(&setup.faults, config.identifiers).over(config.transport);
    rig.power(true)?;
    let mut cut = wait_for_device(setup, &mut talk, &mut listener, rig)?;
    let period = config.period;
    let warm_up = i64::from(world.warm_up_ticks(WARM_UP_S));
    talk.begin_at(talk.now().plus(period.times(warm_up + 2)));
    let ticks = i64::try_from(world.ticks()).unwrap_or(i64::MAX);
    let mut lateness = Lateness::new(period, warm_up);
    for tick in -warm_up..=ticks {
        if cut.is_some() {
            break;
        }
        let time = |tick: i64| tick as f64 * scenario.period_s;
        let (at_s, due) = (time(tick), talk.instant(time(tick)));
        while talk.now() < due {
            let pause = injector.act(talk.time_of(talk.now()), rig);
            let until = pause.map_or(due, |pause| due.min(talk.now().plus(pause)));
            listen(&mut talk, &mut listener, &world, scenario.ego, until)?;
        }
        if onlooker.judges() {
            lateness.note(talk.now().since(due));
        }
        injector.note_altered(talk.altered());
        if injector.switch(at_s, rig) {
            listener.restart();
        }
        talk.clock_error_us = injector.clock_error_us(at_s);
        talk.spoiled = injector.spoils();
        if tick > 0 {
            world.drive(time(tick - 1))?;
        } else if tick == 0 {
            world.begin()?;
        }
        if tick == ticks {
            break;
        }
        if tick < 0 {
            world.approach(at_s)?
        } else {
            world.speak(at_s)?
        }
        let own = world.vehicles()[scenario.ego].instant(at_s);
        while let Some((_, frame)) = listener.seat.receive(own)? {
            injector.overhear(&frame);
            talk.send(frame);
        }
        if tick < 0 {
            world.answer(at_s)?
        } else {
            world.act(at_s)?;
            record.note(&world, at_s)?;
            if !onlooker.see(&mut world, at_s)? {
                break;
            }
        }
        cut = gone(setup, &talk, &listener, rig, at_s);
        if tick % 100 == 0 {
            progress(at_s);
        }
    }
    // The echoes of the last frames come back.
    let end = talk.now().plus(ECHO_PATIENCE);
    while talk.now() < end && !talk.counts().is_complete() {
        let pause = talk.now().plus(Duration::from_millis(10));
        listen(&mut talk, &mut listener, &world, scenario.ego, pause)?;
    }
    injector.note_altered(talk.altered());
    injector.stop(rig);
    let faults = injector.played(cut.is_none());
    finished(world, record, &talk, listener, lateness, faults, cut)
}

fn finished<P: Port>(
    world: World<'_>,
    record: Record<'_>,
    talk: &Talk<P>,
    listener: BusListener,
    lateness: Lateness,
    faults: Vec<Played>,
    cut: Option<Cut>,
) -> io::Result<Outcome> {
    Ok(Outcome {
        recorded: record.finish(world, 1.0)?,
        monitor: listener.monitor,
        deviation: listener.deviation,
        steps: None,
        lateness,
        counts: talk.counts(),
        foreign: listener.foreign,
        bus_errors: listener.bus_errors,
        origin: talk.instant(0.0),
        faults,
        cut,
    })
}

fn listen<P: Port>(
    talk: &mut Talk<P>,
    listener: &mut BusListener,
    world: &World<'_>,
    ego: usize,
    until: Instant,
) -> io::Result<()> {
    let mut heard = Ok(());
    let origin = talk.instant(0.0);
    let local = |at: Instant| {
        let at_s = at.since(origin).as_micros() as f64 * 1e-6;
        (at_s, world.vehicles()[ego].instant(at_s))
    };
    talk.pump(until, |at, event| {
        if heard.is_ok() {
            heard = listener.hear(at, event, local);
        }
    })?;
    heard
}

/// Waits for the first frame of the device, which it sends without having received anything.
fn wait_for_device<P: Port>(
    setup: &Setup,
    talk: &mut Talk<P>,
    listener: &mut BusListener,
    rig: &mut dyn Rig,
) -> io::Result<Option<Cut>> {
    let end = talk.now().plus(setup.wait);
    while talk.now() < end {
        let (mut heard, until) = (false, talk.now().plus(Duration::from_millis(20)).min(end));
        let identifiers = listener.identifiers;
        talk.pump(until, |_, event| {
            heard |= matches!(event, Event::Received(frame)
                if line_of(&identifiers, &frame).is_some_and(|line| line.sender == Node::Unit));
        })?;
        if heard {
            return Ok(None);
        }
        if let Some(ended) = rig.has_ended() {
            return Ok(Some(Cut::Silent { waited: setup.wait, ended: Some(ended) }));
        }
    }
    Ok(Some(Cut::Silent { waited: setup.wait, ended: None }))
}

/// Whether the device has fallen silent for good, without a fault.
fn gone<P: Port>(setup: &Setup, talk: &Talk<P>, listener: &BusListener, rig: &mut dyn Rig, at_s: f64) -> Option<Cut> {
    let last_s = talk.time_of(listener.monitor.commands().last()?.at);
    let is_gone = at_s - last_s > GONE_S && !setup.is_excused(at_s);
    is_gone.then(|| Cut::Gone { at_s: last_s, ended: rig.has_ended() })
}
