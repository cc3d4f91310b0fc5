//! The last gate. What is certain of the peers, what the range sensor sees, and the demand enter; the command that the envelope allows
//! leaves.

use super::lane;
use super::pass::{self, Area, Range, Stay};
use super::scene::Scene;
use crate::config::Envelope;
use crate::envelope::{self, Obstacle, Reckoning, Spare};
use crate::held::Held;
use crate::model::State;
use crate::model::bound::{AccelerationRange, Bound};
use crate::parameters::{DEFAULT_LENGTH, POSITION_ROUNDING, SPEED_ROUNDING};
use crate::peers::Sample;
use crate::time::{Duration, GnssTime, Instant};
use crate::units::{Acceleration, Distance, Position};

/// The gate's memory: the ego as the gate carries it on by the commands alone.
#[derive(Clone, Debug)]
pub(super) struct Gate {
    reckoning: Held<Reckoning>,
    /// Whether firm claims covered the ego's stay in the next conflict area when it could last stop before the area.
    is_covered: bool,
    /// Whether it cannot stop before the area any more, and was covered then, or is in the area.
    is_committed: bool,
    /// Whether the ego could stop before an area at some time since the unit began to drive: since then the gate keeps it out of areas.
    keeps: bool,
    /// The index of that area's intersection on the ego's way.
    crossing: usize,
}

/// The demand of the last tick, and its age. The age is longer than a period where ticks were missed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Last {
    pub demand: Acceleration,
    pub age: Duration,
}

impl Gate {
    /// Nothing is known of the ego: all zero.
    pub const fn new() -> Self {
        Self { reckoning: Held::Nothing, is_covered: false, is_committed: false, keeps: false, crossing: 0 }
    }

    /// Forgets the ego: nothing is known of commands that are not the unit's.
    pub fn forget(&mut self) {
        self.reckoning.clear();
        self.begin();
    }

    /// Another way begins, for which no pass was used.
    pub fn begin(&mut self) {
        (self.is_covered, self.is_committed, self.keeps) = (false, false, false);
    }

    /// Whether the ego goes into the next conflict area by a pass, or is in it.
    pub const fn is_committed(&self) -> bool {
        self.is_committed
    }

    /// Whether the gate keeps the ego out of the next conflict area while no pass covers its stay. It cannot if a person has handed the
    /// vehicle over too near.
    pub const fn keeps_out(&self) -> bool {
        self.keeps
    }

    /// The command as it is encoded, with the ego at the less safe end of its accuracies, and whether the command differs from the
    /// demand.
    pub fn command<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
        &mut self,
        limits: &Envelope,
        scene: &Scene<PEERS, SAMPLES, STEPS>,
        now: Instant,
        demand: Acceleration,
        last: Last,
        ego: Option<&State>,
    ) -> (Acceleration, bool) {
        let sample = scene.ego.get().unwrap_or(Sample::UNKNOWN);
        let state = ego.copied().unwrap_or_default();
        let moved = state.position.ahead_of(sample.position.ring());
        let off = sample.position_error().plus(POSITION_ROUNDING);
        let faster = sample.speed_error().plus(SPEED_ROUNDING);
        let late = sample.speed.plus(faster).over(scene.own_clock_error(&sample).seconds());
        let start = envelope::Start {
            at: sample.at,
            position: sample.position.ahead(off).ahead(late),
            speed: sample.speed.plus(faster),
            acceleration: sample.acceleration,
        };
        let reckoning = Reckoning::carry(&mut self.reckoning, &start, now, last.demand, limits);
        let ego = reckoning.ego(limits, last.demand, scene.config.lag);
        // The ego as far back as it may be: a vehicle that may be inside a conflict area already has to clear it.
        let rearmost = sample.position.ahead(moved).ahead(off.negated()).ahead(late.negated());
        let spare = |obstacle: Obstacle| envelope::spare(limits, &ego, &obstacle);
        let range = Range::around(scene, now, &state, &sample);
        let entrance = self.entrance(limits, scene, &ego, &range);
        let wanted = demand;
        let demand = entrance.demand(scene, &range, demand);
        let mut view = Rearmost { scene, now, rearmost, entrance, stop: None };
        if scene.coordination.itinerary().is_some() {
            view.stop = (0..PEERS).filter_map(|index| view.stop_for(index)).min();
        }
        // At the limit of the braking the ego may be unable to stop for a tick. It does not go in for that, past what it stops for.
        if view.entrance.can_stop && view.is_held() {
            self.is_covered = false;
        }
        let heard = match scene.coordination.itinerary() {
            None => scene.named_ahead(now).map(spare),
            // The driver may name a vehicle that the order does not know of.
            Some(_) => {
                let named = scene.named_ahead(now).filter(|_| !scene.is_decided_by_order()).map(spare);
                [view.spare_on_way(&spare), named].into_iter().flatten().min()
            }
        };
        let seen = view.obstacles_seen().map(spare).min();
        let spare = [heard, seen].into_iter().flatten().min().unwrap_or(Spare::ENDLESS);
        let situation = envelope::Situation { is_fresh: scene.fresh_ego(now).is_some(), spare };
        let command = envelope::gate(limits, demand, &ego, &situation, scene.config.period, last.age);
        (envelope::encodable(limits, command), command != wanted)
    }
}

impl Gate {
    /// Whether the ego may go into the next conflict area (F5): only if firm claims cover its whole stay, both at the earliest entry and
    /// at the latest exit. Once it cannot stop before the area any more, it does not give way.
    fn entrance<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
        &mut self,
        limits: &Envelope,
        scene: &Scene<PEERS, SAMPLES, STEPS>,
        ego: &envelope::Ego,
        range: &Range,
    ) -> Entrance {
        let Some(area) = Area::next(scene).filter(|_| scene.keeps_passes()) else {
            (self.is_covered, self.is_committed) = (false, false);
            return Entrance::NONE;
        };
        if self.crossing != scene.coordination.next() {
            self.crossing = scene.coordination.next();
            self.is_covered = false;
        }
        let (stay, gnss) = (pass::stay_at_worst(scene, &area, range), scene.pass_time(range.now));
        let line = Obstacle::standing(area.begins);
        let is_before = range.rearmost <= area.begins;
        let can_stop = is_before && envelope::is_safe(limits, ego, &line, scene.config.period);
        if can_stop {
            self.keeps = true;
        }
        // Also in the first tick in which it cannot stop: its claims may have been cut since the last one. Then it brakes, and stops within
        // the envelope's margin.
        if can_stop || self.is_covered && !self.is_committed {
            let is_covered = gnss.is_some_and(|now| scene.is_stay_covered(range.now, &stay.from(now)));
            self.is_covered = is_covered && is_left(limits, scene, &area, range);
        }
        let is_open = self.is_covered || !is_before;
        self.is_committed = is_open && !can_stop;
        Entrance { area: Some(area), is_open, is_committed: self.is_committed, can_stop, stay, gnss }
    }
}

/// Whether the ego is certain to get out of the area behind the vehicles ahead on its leg. What it hears or sees ahead of it drives on.
fn is_left<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
    limits: &Envelope,
    scene: &Scene<PEERS, SAMPLES, STEPS>,
    area: &Area,
    range: &Range,
) -> bool {
    let room = range.foremost.ahead_of(range.rearmost).plus(limits.margin);
    let place = area.is_left_at.ahead(room);
    let is_seen = scene.config.range_sensor && scene.ranging.sees_up_to(place, range.now);
    is_seen || lane::is_certain_to_leave(scene, range.now, place)
}

/// The next conflict area, and whether the ego may go into it.
struct Entrance {
    area: Option<Area>,
    is_open: bool,
    is_committed: bool,
    /// Whether it can stop before it.
    can_stop: bool,
    /// The ego's stay in it, at both ends of what the ego may do.
    stay: Stay,
    /// GNSS time, if it is known well enough for passes.
    gnss: Option<GnssTime>,
}

impl Entrance {
    /// No area comes.
    const NONE: Self =
        Self { area: None, is_open: true, is_committed: false, can_stop: false, stay: Stay::NONE, gnss: None };

    fn demand<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
        &self,
        scene: &Scene<PEERS, SAMPLES, STEPS>,
        range: &Range,
        demand: Acceleration,
    ) -> Acceleration {
        let area = self.area.filter(|_| scene.fresh_ego(range.now).is_some());
        let Some((area, now)) = area.zip(self.gnss) else { return demand };
        let stay = self.stay.from(now);
        if self.is_open {
            pass::leave_in_time(scene, range, &stay, demand)
        } else {
            pass::not_early(scene, &area, range, now, stay.entry, demand)
        }
    }

    /// Where the ego has to be able to stop because it has no pass, or because a vehicle is seen in the area at `seen`.
    fn line(&self, seen: Option<Position>) -> Option<Position> {
        let area = self.area?;
        if self.is_committed { seen } else { seen.map(|_| area.begins).or((!self.is_open).then_some(area.begins)) }
    }
}

/// The ego as far back as it may be, and the scene.
struct Rearmost<'a, const PEERS: usize, const SAMPLES: usize, const STEPS: usize> {
    scene: &'a Scene<PEERS, SAMPLES, STEPS>,
    now: Instant,
    /// Front bumper of the ego, as far back as it may be.
    rearmost: Position,
    entrance: Entrance,
    /// Where the ego stops for the peers whose ways cross its own.
    stop: Option<Position>,
}

impl<const PEERS: usize, const SAMPLES: usize, const STEPS: usize> Rearmost<'_, PEERS, SAMPLES, STEPS> {
    /// On an itinerary: what is to spare behind every vehicle that is ahead for certain.
    fn spare_on_way(&self, spare: &impl Fn(Obstacle) -> Spare) -> Option<Spare> {
        let unknown = self.scene.stop_for_unknown(self.now, self.rearmost);
        let stop = [self.stop_at_crossing(), unknown].into_iter().flatten().min();
        let stop = stop.map(Obstacle::standing).map(spare);
        [lane::spare(self.scene, self.now, spare), stop].into_iter().flatten().min()
    }

    /// On an itinerary: where the ego has to be able to stop before the conflict area. It stops for every vehicle whose way crosses the
    /// ego's and which is ahead in the order, or in the area for certain. A vehicle that yielded when it could not stop any more is in
    /// the area all the same. The ego also stops before an area at which it has not arrived because it does not know the time: no vehicle
    /// minds it there.
    fn stop_at_crossing(&self) -> Option<Position> {
        self.stop
            .into_iter()
            .chain(self.entrance.line(self.seen()))
            .chain(self.stop_without_time())
            .chain(self.stop_before_later())
            .min()
    }

    /// Where the range sensor has just seen a vehicle in the area that is not one that was heard in there.
    fn seen(&self) -> Option<Position> {
        self.scene.ranging.crossing(self.now)
    }

    /// Whether the ego has to stop before the area although it has a pass.
    fn is_held(&self) -> bool {
        self.seen().is_some() || self.stop.is_some()
    }

    /// Where the ego stops for a peer whose way crosses its own. A peer that keeps passes is out of the area when the ego's pass begins.
    /// Where the ego's sensor sees whether that is so, it need not wait for what is certain of the peer. But a peer that is in the area,
    /// by what it has just said, is waited for.
    fn stop_for(&self, index: usize) -> Option<Position> {
        let (scene, now) = (self.scene, self.now);
        let stop = scene.stop_before_area(index, now, self.rearmost)?;
        // Once it is committed, it does not stop because the sensor falls silent.
        let ends = scene.coordination.end_of(scene.coordination.next());
        let is_seen = ends.is_some_and(|ends| scene.ranging.sees_up_to(ends, now));
        let sees = scene.config.range_sensor && (self.entrance.is_committed || is_seen);
        let is_trusted = self.entrance.area.is_some() && self.entrance.is_open && sees;
        let then = now.plus(self.entrance.stay.entry);
        let at = (!self.entrance.is_committed).then_some(now);
        (!is_trusted || !scene.has_pass(index, at) || scene.is_in_area_until(index, now, then)).then_some(stop)
    }

    /// Before the intersection after the next one the ego is able to stop in any case. It takes its place in the order there only when it
    /// has left the next one.
    fn stop_before_later(&self) -> Option<Position> {
        let coordination = &self.scene.coordination;
        let later = coordination.itinerary()?.crossings.get(coordination.next().saturating_add(1))?;
        Some(coordination.crossing_point(later)?.ahead(later.intersection.half.negated()))
    }

    fn stop_without_time(&self) -> Option<Position> {
        let coordination = &self.scene.coordination;
        let next = coordination.next_of(coordination.next(), self.rearmost, self.scene.config.length);
        let has_arrived = next == coordination.next() && coordination.registration().is_some();
        if has_arrived || self.scene.is_synchronised(self.now) {
            return None;
        }
        let crossing = coordination.itinerary()?.crossings.get(next)?;
        let point = coordination.crossing_point(crossing)?;
        Some(point.ahead(crossing.intersection.half.negated())).filter(|begins| self.rearmost <= *begins)
    }

    /// The rears of all vehicles that the range sensor has seen and that are not known to be the target. A vehicle that the ego has
    /// passed by more than a vehicle's length is not on its path.
    fn obstacles_seen(&self) -> impl Iterator<Item = Obstacle> {
        let (scene, now, rearmost) = (self.scene, self.now, self.rearmost);
        let target = scene.visible().and_then(|index| scene.whose(index));
        let is_passed = move |rear: &Bound| rearmost.ahead_of(rear.highest_position()) > DEFAULT_LENGTH;
        let ahead = scene.ranging.strangers(now, target).filter(move |rear| !is_passed(rear));
        ahead.map(move |rear| {
            Obstacle::rear(&rear.after(now, &AccelerationRange::WORST), Distance::ZERO, &AccelerationRange::WORST)
        })
    }
}
