//! The engine: a scenario and what the pages ask for enter; scenes leave. One thread drives the world in fixed steps, as fast as the clock
//! and the pace say. What the world does depends on the scenario and its events alone, so a run up to any time can be played again.

use std::io;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::time::{Duration, Instant};

use serde::Serialize;
use tokio::sync::{oneshot, watch};

use super::order::Order;
use super::scene::{Pulse, rounded};
use super::snapshots::Snapshots;
use super::stage::{Play, Stage};
use crate::commands::interruption::Interruption;
use crate::error::Error;
use crate::input::scenario::Event;

/// Scenes a second.
const SCENE_EVERY: Duration = Duration::from_millis(30);
/// While time stands still, a scene so often shows that the engine is there.
const SCENE_EVERY_AT_REST: Duration = Duration::from_millis(500);
/// The world goes on for no longer than this before the pages are heard again.
const HEAR_EVERY: Duration = Duration::from_millis(25);
/// What the clock is ahead by more than this, in seconds of the run, is given up.
const MOST_BEHIND_S: f64 = 0.2;

/// What a page asks the engine.
pub enum Ask {
    /// To do something.
    Do(Order, oneshot::Sender<Result<(), Error>>),
    /// What has been driven and changed up to now, and the number of ticks.
    Journal(oneshot::Sender<(Vec<Event>, u64)>),
    /// The newest frames on the bus of a vehicle, as JSON.
    Frames(usize, oneshot::Sender<Option<String>>),
}

/// The engine.
pub struct Engine<'p, P: Play> {
    play: &'p P,
    snapshots: Snapshots<P::Stage<'p>>,
    /// The events of this run.
    events: Vec<Event>,
    is_playing: bool,
    pace: f64,
    asks: Receiver<Ask>,
    scenes: watch::Sender<Arc<str>>,
}

/// Why the play ends.
enum Cut {
    /// Time goes back, to so many ticks.
    Back(u64),
    /// The world begins anew.
    Anew,
    /// The program is to end.
    End,
}

impl<'p, P: Play> Engine<'p, P> {
    /// An engine at rest at the start of the scenario.
    #[must_use]
    pub fn new(play: &'p P, asks: Receiver<Ask>, scenes: watch::Sender<Arc<str>>) -> Self {
        let (snapshots, events) = (Snapshots::of_period(play.period_s()), play.events().to_vec());
        Self { play, snapshots, events, is_playing: true, pace: 1.0, asks, scenes }
    }

    /// Drives the world until the program is to end. Returns the events, and the number of ticks.
    ///
    /// # Errors
    /// A configuration that the units refuse, and errors of the buses.
    pub fn run(mut self, end: &Interruption) -> io::Result<(Vec<Event>, u64)> {
        let (mut stage, mut until) = (self.play.begin(&self.events)?, 0);
        loop {
            match self.play(&mut stage, until, end)? {
                Cut::Back(ticks) => {
                    until = ticks;
                    stage = match self.snapshots.before(ticks) {
                        Some(mut stage) => {
                            stage.expect(&self.events);
                            stage
                        }
                        None => self.play.begin(&self.events)?,
                    };
                }
                Cut::Anew => {
                    until = 0;
                    self.snapshots.clear();
                    stage = self.play.begin(&self.events)?;
                }
                Cut::End => return Ok((self.so_far(&stage), stage.ticks())),
            }
        }
    }

    fn step(&mut self, stage: &mut P::Stage<'p>) -> io::Result<()> {
        stage.step()?;
        self.snapshots.note(stage);
        Ok(())
    }

    fn play(&mut self, stage: &mut P::Stage<'p>, until: u64, end: &Interruption) -> io::Result<Cut> {
        let mut shown = Instant::now();
        while stage.ticks() < until.max(1) {
            self.step(stage)?;
            if shown.elapsed() > 4 * SCENE_EVERY {
                shown = Instant::now();
                self.show(stage, 0.0);
            }
            if end.is_asked() {
                return Ok(Cut::End);
            }
        }
        self.show(stage, self.pace);
        let period_s = self.play.period_s();
        let (mut clock, mut due_s, mut rate) = (Instant::now(), 0.0, Rate::new(stage.ticks()));
        while !end.is_asked() {
            let passed_s = clock.elapsed().as_secs_f64();
            clock = Instant::now();
            self.is_playing &= !stage.is_over();
            due_s = if self.is_playing { due_s + passed_s * self.pace } else { 0.0 };
            while due_s >= period_s && clock.elapsed() < HEAR_EVERY && !stage.is_over() {
                self.step(stage)?;
                due_s -= period_s;
            }
            due_s = due_s.min(MOST_BEHIND_S.max(period_s));
            rate.note(stage.ticks(), period_s);
            if shown.elapsed() >= if self.is_playing { SCENE_EVERY } else { SCENE_EVERY_AT_REST } {
                shown = Instant::now();
                self.show(stage, rate.of_late);
            }
            let wait = if due_s >= period_s { Duration::ZERO } else { Duration::from_millis(4) };
            match self.asks.recv_timeout(wait) {
                Ok(ask) => {
                    if let Some(cut) = self.answer(stage, ask)? {
                        return Ok(cut);
                    }
                    shown -= SCENE_EVERY_AT_REST; // what was asked for shows at once
                }
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => return Ok(Cut::End),
            }
        }
        Ok(Cut::End)
    }

    fn answer(&mut self, stage: &mut P::Stage<'p>, ask: Ask) -> io::Result<Option<Cut>> {
        // A page that has gone does not wait for its answer.
        match ask {
            Ask::Journal(to) => {
                let _ = to.send((self.so_far(stage), stage.ticks()));
            }
            Ask::Frames(vehicle, to) => {
                let _ = to.send(stage.frames(vehicle).and_then(|rows| serde_json::to_string(&rows).ok()));
            }
            Ask::Do(order, to) => match order.event(stage.next_s()) {
                Some(event) => {
                    let checked = self.play.check(&event).and_then(|()| is_there(stage, &event));
                    let is_possible = checked.is_ok();
                    let _ = to.send(checked);
                    if is_possible {
                        self.change(stage, event);
                    }
                }
                None => {
                    let cut = self.steer(stage, order)?;
                    self.show(stage, self.pace);
                    let _ = to.send(Ok(()));
                    return Ok(cut);
                }
            },
        }
        Ok(None)
    }

    /// An event happens at the next tick; what was to happen later, after a way back, does not.
    fn change(&mut self, stage: &mut P::Stage<'p>, event: Event) {
        self.events = self.so_far(stage);
        self.events.push(event);
        stage.add(event);
    }

    fn steer(&mut self, stage: &mut P::Stage<'p>, order: Order) -> io::Result<Option<Cut>> {
        match order {
            Order::Pause {} => self.is_playing = false,
            Order::Play {} => self.is_playing = true,
            Order::Pace { factor } => self.pace = factor,
            Order::Step { ticks } => {
                self.is_playing = false;
                for _ in 0..ticks {
                    if !stage.is_over() {
                        self.step(stage)?;
                    }
                }
            }
            Order::Back { seconds } => {
                let ticks = (seconds / self.play.period_s()).round() as u64;
                return Ok(Some(Cut::Back(stage.ticks().saturating_sub(ticks))));
            }
            Order::Restart {} => {
                self.events = self.play.events().to_vec();
                return Ok(Some(Cut::Anew));
            }
            _ => {}
        }
        Ok(None)
    }

    /// The events that have happened.
    fn so_far(&self, stage: &P::Stage<'p>) -> Vec<Event> {
        let next_s = stage.next_s();
        let has_happened = |event: &&Event| event.at_s < next_s - 1e-9 || stage.ticks() == 0;
        // What is due at the next tick has been decided too.
        let is_due = |event: &&Event| (event.at_s - next_s).abs() <= 1e-9;
        self.events.iter().filter(|event| has_happened(event) || is_due(event)).copied().collect()
    }

    fn show(&self, stage: &P::Stage<'p>, rate: f64) {
        let events = [self.so_far(stage).len(), self.events.len()];
        let rate = rounded(rate);
        let pulse = Pulse { ticks: stage.ticks(), is_playing: self.is_playing, pace: self.pace, rate, events };
        if let Some(text) = text(&stage.scene(&pulse)) {
            self.scenes.send_replace(text);
        }
    }
}

/// Whether the vehicle that an event is of is there now.
fn is_there(stage: &impl Stage, event: &Event) -> Result<(), Error> {
    let absent = event.vehicle.filter(|vehicle| !stage.has(*vehicle));
    let cause = |vehicle: usize| format!("vehicle {vehicle} is not on the road now");
    absent.map_or(Ok(()), |vehicle| Err(Error::new(cause(vehicle), "choose one that the page shows")))
}

/// As JSON.
pub(super) fn text(value: &impl Serialize) -> Option<Arc<str>> {
    serde_json::to_string(value).ok().map(Arc::from)
}

/// How fast time has passed of late.
struct Rate {
    since: Instant,
    ticks: u64,
    of_late: f64,
}

impl Rate {
    fn new(ticks: u64) -> Self {
        Self { since: Instant::now(), ticks, of_late: 0.0 }
    }

    fn note(&mut self, ticks: u64, period_s: f64) {
        let passed_s = self.since.elapsed().as_secs_f64();
        if passed_s >= 0.5 {
            self.of_late = ticks.saturating_sub(self.ticks) as f64 * period_s / passed_s;
            (self.since, self.ticks) = (Instant::now(), ticks);
        }
    }
}
