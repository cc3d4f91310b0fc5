//! The ego's passes. Where the ego will be, by its own horizon, enters; the windows that it claims, and whether it may go into the next
//! conflict area, leave. The rules are those of [`crate::passes`].

use core::num::NonZeroU32;

use super::scene::Scene;
use super::scene::passes::whole_steps;
use crate::config::{Config, Envelope};
use crate::fixed::quotient;
use crate::model::{State, catch_up};
use crate::parameters::{POSITION_ROUNDING, SPEED_ROUNDING};
use crate::passes::{Outlook, Rules, Slack, Window};
use crate::peers::Sample;
use crate::time::{Duration, GnssTime, Instant};
use crate::units::{Acceleration, Distance, Position, Speed};
use crate::wire::pass::STEP;

/// With less than this left, more is claimed.
const LEAST: Slack = Slack { before: Duration::from_millis(200), after: Duration::from_millis(400) };
/// A stay that begins sooner than this has to be possible at both ends of what the ego can do.
const AT_ONCE: Duration = Duration::from_millis(1_500);
/// The same for an ego that is slow, and may go on faster than it foresees.
const NEAR: Duration = Duration::from_millis(4_000);
const SLOW: Speed = Speed::from_mm_per_s(4_000);
/// An ego that is slower than this waits, and may wait for so long that its claims become firm.
const WAITING: Speed = Speed::from_mm_per_s(1_000);
const WAITS: Duration = Duration::from_millis(1_000);
/// What is later is not foreseen.
const FORESEEN: Duration = Duration::from_millis(25_000);
/// A slow ego that is farther than this from the area, and does not foresee its stay, is not in the zone.
const ZONE: Distance = Distance::from_mm(40_000);
/// A horizon that ends at less than this says nothing of when the ego gets to a place beyond.
const STANDS: Speed = Speed::from_mm_per_s(500);
/// An ego that would be early brakes by no more than this.
const GENTLE: Acceleration = Acceleration::from_mm_per_s2(-1_500);
/// Twice the braking of an easy stop before the area.
const EASY_TWICE_MM_PER_S2: u32 = 4_000;
/// From where an easy stop begins, an ego that accelerates by 2.5 m/s² instead is in the area after its speed in m/s, divided by this, in
/// seconds.
const FROM_EASY_STOP: u32 = 5;
/// An ego that would have to stop because it is early drives on to its line at this speed.
const TO_THE_LINE: Speed = Speed::from_mm_per_s(3_000);
/// An ego that may leave the area later than so long before the end of its window is late.
const LATE: Duration = Duration::from_millis(200);
/// The acceleration with which a car leaves the area.
const LEAVES: Acceleration = Acceleration::from_mm_per_s2(1_500);

/// The ego at now, from the least to the most that it may be ahead and fast.
#[derive(Clone, Copy, Debug)]
pub(super) struct Range {
    pub now: Instant,
    /// Front bumper.
    pub rearmost: Position,
    pub foremost: Position,
    pub slowest: Speed,
    pub fastest: Speed,
    /// Acceleration that is reached, and the one that is commanded.
    reached: Acceleration,
    commanded: Acceleration,
}

impl Range {
    /// The ego in this state at now, by its newest sample's accuracies.
    pub fn of<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
        scene: &Scene<PEERS, SAMPLES, STEPS>,
        now: Instant,
        state: &State,
    ) -> Option<Self> {
        Some(Self::around(scene, now, state, scene.ego.as_ref()?))
    }

    pub fn around<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
        scene: &Scene<PEERS, SAMPLES, STEPS>,
        now: Instant,
        state: &State,
        sample: &Sample,
    ) -> Self {
        let front = sample.position.ahead(state.position.ahead_of(sample.position.ring()));
        let faster = sample.speed_error().plus(SPEED_ROUNDING);
        let late = sample.speed.plus(faster).over(scene.own_clock_error(sample).seconds());
        let off = sample.position_error().plus(POSITION_ROUNDING).plus(late);
        Self {
            now,
            rearmost: front.ahead(off.negated()),
            foremost: front.ahead(off),
            slowest: state.speed.minus(faster).max(Speed::ZERO),
            fastest: state.speed.plus(faster),
            reached: state.acceleration,
            commanded: state.demand,
        }
    }

    /// How an ego gets faster that goes over to this acceleration `b`: it may be taken to go on at a speed until a time from now on, and to
    /// accelerate with `b` from then on.
    ///
    /// With `a` reached and `u` commanded, neither above 0, the envelope's jerk `j`, its largest lag `τ`, and its delay and a period `d`,
    /// the speed is at least `v + a τ + u d - u² / 2 j + b (t - τ - d - (b - u) / j)`, and it never is below 0. So an ego that would be at
    /// less than 0 is taken to stand until it would not. The time by which `τ + d` is longer than the lag is not counted, as far as it is
    /// no longer than the clearance: nobody else enters within that after the ego's window.
    ///
    /// Commands on their way may be harder than `u`, by `j` times the delay. What that costs is less than `b² / 2 j`, by which the ramp is
    /// better than counted, while the delay is at most `b / j`.
    fn turning(&self, config: &Config, to: Acceleration) -> (Speed, Duration) {
        let limits = config.envelope.as_ref().unwrap_or(&Envelope::CAR);
        let mm_per_s2 = |acceleration: Acceleration| acceleration.to_mm_per_s2().max(0).unsigned_abs();
        let jerk = NonZeroU32::new(limits.jerk.to_mm_per_s3().max(1).unsigned_abs()).unwrap_or(NonZeroU32::MIN);
        let commanded = self.commanded.min(Acceleration::ZERO);
        let braked = mm_per_s2(commanded.negated());
        let ramp_ms = braked.saturating_add(mm_per_s2(to)).saturating_mul(1_000) / jerk;
        let lag = config.lag.plus(config.lag.fraction(limits.lag_tolerance));
        let delay = limits.delay.plus(config.period);
        let turns = Duration::of_fine_seconds(lag).plus(delay);
        let longer = turns.minus(Duration::of_fine_seconds(config.lag));
        let ramp = Speed::from_mm_per_s(i32::try_from(braked.saturating_mul(braked) / jerk / 2).unwrap_or(i32::MAX));
        let fading = self.reached.min(Acceleration::ZERO).over(lag).plus(commanded.over(delay.fine_seconds()));
        let lowest = self.slowest.plus(fading).minus(ramp);
        let stands_ms = lowest.negated().to_mm_per_s().max(0).unsigned_abs().saturating_mul(1_000)
            / NonZeroU32::new(mm_per_s2(to)).unwrap_or(NonZeroU32::MIN);
        let ramp_and_stand = Duration::from_millis(i64::from(ramp_ms.saturating_add(stands_ms)));
        (lowest.max(Speed::ZERO), turns.minus(longer.min(Rules::UNIT.clearance)).plus(ramp_and_stand))
    }
}

/// The acceleration of an ego that leaves: [`LEAVES`], and no more than it has published.
fn leaving<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
    scene: &Scene<PEERS, SAMPLES, STEPS>,
) -> Acceleration {
    scene.config.limits.acceleration.min(LEAVES)
}

/// The next conflict area on the ego's axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Area {
    pub begins: Position,
    /// Where the front bumper is when the rear bumper has left.
    pub is_left_at: Position,
}

impl Area {
    pub fn next<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
        scene: &Scene<PEERS, SAMPLES, STEPS>,
    ) -> Option<Self> {
        let begins = scene.area_begins()?;
        let ends = scene.coordination.end_of(scene.coordination.next())?;
        Some(Self { begins, is_left_at: ends.ahead(scene.config.length) })
    }
}

/// A stay in the area, from now on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stay {
    pub entry: Duration,
    pub exit: Duration,
}

impl Stay {
    /// None at all.
    pub const NONE: Self = Self { entry: Duration::ZERO, exit: Duration::ZERO };

    /// In GNSS time.
    pub fn from(&self, now: GnssTime) -> Window {
        Window { entry: now.plus(self.entry), exit: now.plus(self.exit) }
    }
}

/// The stay in the area at both ends of what the ego may do: it goes there as fast as it may at all, and gets out as slowly as [`leaving`]
/// lets it.
pub(super) fn stay_at_worst<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
    scene: &Scene<PEERS, SAMPLES, STEPS>,
    area: &Area,
    ego: &Range,
) -> Stay {
    let (config, top) = (&scene.config, scene.target_speed());
    // The law drives faster to catch up.
    let fastest = catch_up(top, config.law.catch_up);
    let there =
        Way { length: area.begins.ahead_of(ego.foremost), top: fastest, acceleration: config.limits.acceleration };
    let out = Way { length: area.is_left_at.ahead_of(ego.rearmost), top, acceleration: leaving(scene) };
    let (slowest, turns) = ego.turning(config, out.acceleration);
    Stay { entry: there.within(ego.fastest, Duration::ZERO), exit: out.within(slowest, turns) }
}

/// The demand of an ego that has a pass: no less than what gets it out of the area in time.
pub(super) fn leave_in_time<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
    scene: &Scene<PEERS, SAMPLES, STEPS>,
    ego: &Range,
    stay: &Window,
    demand: Acceleration,
) -> Acceleration {
    let is_late = scene.is_covered_until(ego.now, stay.entry).is_none_or(|exit| stay.exit.plus(LATE) > exit);
    let least = if ego.slowest < scene.target_speed() { leaving(scene) } else { Acceleration::ZERO };
    if is_late { demand.max(least) } else { demand }
}

/// The demand of an ego that could be in the area at `soonest`, before its pass begins. If it comes 0.2 s after that or later at its speed, it
/// may accelerate as far as that stays so. Otherwise it brakes gently: it comes to where an easy stop begins no sooner than it may
/// accelerate from there, so the gate opens there at the latest. If it would have to stop for that, or is past that place, it slows down to
/// 3 m/s, and the envelope stops it at its line. A pass that begins in more than 8 s counts as one that begins then.
pub(super) fn not_early<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
    scene: &Scene<PEERS, SAMPLES, STEPS>,
    area: &Area,
    ego: &Range,
    now: GnssTime,
    soonest: GnssTime,
    demand: Acceleration,
) -> Acceleration {
    if scene.passes.own.reaches(soonest).is_some() {
        return demand;
    }
    let opens = scene.passes.own.claims().map(|claim| claim.window.entry).filter(|entry| *entry > soonest).min();
    let Some(until) = opens.map(|opens| opens.as_micros().saturating_sub(now.as_micros()) / 1_000) else {
        return demand;
    };
    let until = i64::try_from(until).unwrap_or(i64::MAX).min(NEAR.as_millis().saturating_mul(2));
    let way = i64::from(area.begins.ahead_of(ego.foremost).to_mm());
    let speed = ego.fastest.max(Speed::ZERO).to_mm_per_s().unsigned_abs();
    let (stopping, thence) = (speed.saturating_mul(speed) / EASY_TWICE_MM_PER_S2, speed / FROM_EASY_STOP);
    let speed = i64::from(speed);
    // What is left of a way at this speed after a time, in µm.
    let left = |way: i64, time| way.saturating_mul(1_000).saturating_sub(speed.saturating_mul(time));
    let to_make = |left: i64, time: i64| {
        let gained = quotient(left.saturating_mul(2_000), time.saturating_mul(time));
        Acceleration::from_mm_per_s2(crate::fixed::saturate_i32(gained))
    };
    let well_within = until.saturating_add(LEAST.before.as_millis());
    if left(way, well_within) >= 0 {
        return demand.min(to_make(left(way, well_within), well_within));
    }
    let (way, until) = (way.saturating_sub(i64::from(stopping)), until.saturating_sub(i64::from(thence)));
    let most = if way > 0 && until <= 0 {
        Acceleration::ZERO
    } else if way <= 0 || left(way.saturating_mul(2), until) < 0 {
        // On the way in half of the time at its speed it would have to stop.
        Acceleration::in_a_second(TO_THE_LINE.minus(ego.fastest))
    } else {
        to_make(left(way, until), until).min(Acceleration::ZERO)
    };
    demand.min(most.max(GENTLE))
}

/// Claims the time for which the ego foresees to be in the next area, and gives back what it does not need.
pub(super) fn plan<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
    scene: &mut Scene<PEERS, SAMPLES, STEPS>,
    ego: &Range,
    is_by_law: bool,
    is_committed: bool,
) {
    let gnss = scene.pass_time(ego.now);
    scene.passes.turn_to(scene.coordination.next());
    scene.passes.note_time(ego.now, gnss);
    let Some(now) = gnss else { return };
    scene.passes.known.forget(&Rules::UNIT, now);
    if !scene.passes.keeps && !is_committed {
        return scene.passes.own.run_out(now);
    }
    let area = Area::next(scene);
    let outlook = area.and_then(|area| outlook(scene, &area, ego, now, is_by_law, is_committed));
    // What is in use is kept, whatever is foreseen.
    if outlook.is_none() && is_committed {
        return;
    }
    let is_far = area.is_some_and(|area| area.begins.ahead_of(ego.foremost) > ZONE);
    if outlook.is_none() && is_far && ego.fastest < SLOW {
        return scene.passes.own.stay_out();
    }
    // A claim counts from the next time that a message can say.
    scene.plan_passes(whole_steps(now.plus(STEP)), outlook.as_ref());
}

fn outlook<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
    scene: &Scene<PEERS, SAMPLES, STEPS>,
    area: &Area,
    ego: &Range,
    now: GnssTime,
    is_by_law: bool,
    is_committed: bool,
) -> Option<Outlook> {
    let entry = arrives(scene, area.begins, ego, is_by_law)?;
    let exit = arrives(scene, area.is_left_at, ego, is_by_law).filter(|exit| *exit <= FORESEEN)?;
    let mut stay = Window { entry: now.plus(entry), exit: now.plus(exit) };
    let is_slow = ego.fastest < SLOW && entry < NEAR;
    if is_slow || entry < AT_ONCE {
        let worst = stay_at_worst(scene, area, ego).from(now);
        stay = Window { entry: stay.entry.min(worst.entry), exit: stay.exit.max(worst.exit) };
    }
    if ego.fastest < WAITING && !is_committed {
        stay.exit = stay.exit.plus(WAITS);
    }
    let stay = Window { entry: whole_steps(stay.entry), exit: whole_steps(stay.exit.plus(STEP)) };
    Some(Outlook { stay, slack: Slack::of(scene.config.length), least: LEAST, is_committed })
}

/// The time until the ego's front is at a place, by its own horizon; beyond the end of that, at the speed there.
fn arrives<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
    scene: &Scene<PEERS, SAMPLES, STEPS>,
    place: Position,
    ego: &Range,
    is_by_law: bool,
) -> Option<Duration> {
    if ego.rearmost >= place {
        return Some(Duration::ZERO);
    }
    let step = scene.config.prediction.step;
    // It was computed when the ego spoke last.
    let spoken = scene.config.link.period.plus(step.times(2));
    let length = scene.estimator.horizon_length().min(scene.config.prediction.horizon).minus(spoken);
    let read = |after| scene.estimator.read_own(ego.now.plus(after)).filter(|_| is_by_law);
    let way = |length, top| Way { length, top, acceleration: leaving(scene) };
    let Some(last) = read(length) else {
        return Some(way(place.ahead_of(ego.rearmost), scene.target_speed()).within(ego.slowest, Duration::ZERO));
    };
    if last.position < place {
        let further = place.ahead_of(last.position);
        let gains = read(length.minus(step.times(2))).is_some_and(|before| last.speed > before.speed);
        let top = if gains { scene.target_speed() } else { last.speed };
        let then = way(further, top).within(last.speed, Duration::ZERO);
        return (gains || last.speed > STANDS).then(|| length.plus(then));
    }
    let (mut before, mut after) = (Duration::ZERO, length);
    while after.minus(before) > STEP {
        let middle = Duration::from_micros(before.plus(after).as_micros() >> 1);
        let is_there = scene.estimator.is_own_there(ego.now.plus(middle), place);
        (before, after) = if is_there { (before, middle) } else { (middle, after) };
    }
    Some(after)
}

/// A way to make.
struct Way {
    length: Distance,
    /// Up to which speed.
    top: Speed,
    /// How fast the speed grows.
    acceleration: Acceleration,
}

impl Way {
    /// The time in which it is made: at this speed until the actuators have turned, and then faster up to the top. 0 behind, and an hour
    /// where nothing moves.
    fn within(&self, speed: Speed, turns: Duration) -> Duration {
        const NEVER: Duration = Duration::from_millis(3_600_000);
        let (way, speed) = (i64::from(self.length.to_mm()), i64::from(speed.to_mm_per_s()).max(0));
        let top = i64::from(self.top.to_mm_per_s()).max(speed);
        let acceleration = i64::from(self.acceleration.to_mm_per_s2()).max(1);
        if way <= 0 {
            return Duration::ZERO;
        }
        if top == 0 {
            return NEVER;
        }
        let coasted = quotient(speed.saturating_mul(turns.as_micros()), 1_000_000);
        if coasted >= way {
            return Duration::from_micros(quotient(way.saturating_mul(1_000_000), speed.max(1)));
        }
        let (left, squared) = (way.saturating_sub(coasted), |speed: i64| speed.saturating_mul(speed));
        let reached = squared(speed).saturating_add(acceleration.saturating_mul(left).saturating_mul(2));
        let micros = if reached <= squared(top) {
            let then = i64::try_from(reached.unsigned_abs().isqrt()).unwrap_or(top);
            quotient(left.saturating_mul(2_000_000), speed.saturating_add(then).max(1))
        } else {
            let gained = quotient(squared(top).saturating_sub(squared(speed)), acceleration.saturating_mul(2));
            quotient(top.saturating_sub(speed).saturating_mul(1_000_000), acceleration)
                .saturating_add(quotient(left.saturating_sub(gained).saturating_mul(1_000_000), top))
        };
        turns.plus(Duration::from_micros(micros)).min(NEVER)
    }
}

#[cfg(test)]
mod tests;
