//! The checks: the world and what the unit says of it enter; the faults leave.

use crate::peer::Motion;
use crate::vehicle::Verdict;
use crate::verdict::Fault;
use crate::wire::wrapped;
use crate::world::World;

/// Rounding on the bus of the target's position, m, and (below) of its speed, m/s, in the unit's estimate.
const TOLERANCE: f64 = 0.0006;
const SPEED_TOLERANCE: f64 = 0.0011;
/// Longest time for which honest samples may be refused, s.
pub const REFUSED: f64 = 1.0;
/// Beyond this distance a motion may be refused, m.
const REACH: f64 = 1_400.0;
/// How much faster than wanted it may get, as a factor and m/s: what is wanted is a cap.
pub const HURRY: (f64, f64) = (1.0, 1.0);
/// How long a request of before counts, s.
pub const WISHED: f64 = 15.0;

/// How long the unit may be in another mode at the end: a sample that is told with the largest error may be refused for that long, s.
const LAPSE: f64 = 1.0;

/// The checks after every tick.
pub fn judge(world: &mut World, now: f64) {
    world.outcome.ticks += 1;
    if world.ego.said.mode == 1 {
        world.cooperative = now;
    }
    collision(world, now);
    bound(world, now);
    hurry(world, now);
}

fn collision(world: &mut World, now: f64) {
    let ego = world.ego.body;
    for other in world.others.iter().filter(|other| other.on_lane) {
        let is_through = ego.position >= other.rear() && ego.position - 4.8 < other.body.position;
        if is_through && ego.speed > 0.0 {
            let impact = (ego.speed - other.body.speed).max(0.0);
            let (station, speed, mode) = (other.station, other.body.speed, world.ego.said.mode);
            world.outcome.find(Fault::Collision, now, impact, || {
                format!("at {impact:.2} m/s with station {station} that drives {speed:.2} m/s, in mode {mode}")
            });
            return;
        }
    }
}

fn bound(world: &mut World, now: f64) {
    let Some(told) = world.ego.said.told else { return };
    let Some(other) = world.others.iter().find(|other| other.station == world.followed && other.station != 0) else {
        return;
    };
    // A range sensor measures the named vehicle only while that is on the lane.
    if world.scenario.range.fitted && !other.on_lane {
        return;
    }
    world.outcome.checked += 1;
    let off = wrapped(other.body.position + world.scenario.shifted - told.position);
    let (behind, ahead) = (-told.behind - off, off - told.ahead);
    let faster = other.body.speed - told.speed;
    let (slow, fast) = (-told.slower - faster, faster - told.faster);
    let outside = behind.max(ahead) - TOLERANCE;
    let too_fast = slow.max(fast) - SPEED_TOLERANCE;
    if outside > 0.0 || too_fast > 0.0 {
        world.outcome.outside += 1;
        let side = if behind > ahead { "behind" } else { "ahead of" };
        world.outcome.find(Fault::Bound, now, outside.max(0.0), || {
            if outside > 0.0 {
                format!("{outside:.3} m {side} it ({:.3} behind, {:.3} ahead)", told.behind, told.ahead)
            } else {
                format!("{too_fast:.3} m/s beyond it ({:.2} slower, {:.2} faster)", told.slower, told.faster)
            }
        });
    }
    let estimate = world.ego.said.estimate_outside;
    if estimate > 0.001 {
        world.outcome.find(Fault::Estimate, now, estimate, || format!("by {estimate:.3} m"));
    }
}

fn hurry(world: &mut World, now: f64) {
    if world.ego.said.mode == 0 {
        return;
    }
    let (before, until) = world.wanted_before;
    let wanted = if now < until + WISHED { before.max(world.wanted) } else { world.wanted };
    let speed = world.ego.body.speed;
    let off = if world.scenario.ego.sensor.speed < 0.0 { 1.5 } else { world.scenario.ego.sensor.speed };
    if speed > wanted * HURRY.0 + HURRY.1 + off {
        let mode = world.ego.said.mode;
        world
            .outcome
            .find(Fault::Hurry, now, speed - wanted, || format!("{speed:.1} m/s, wanted {wanted:.1}, in mode {mode}"));
    }
}

/// Records what became of a motion that a station really sent.
pub fn note_motion(world: &mut World, at: f64, number: usize, motion: &Motion, verdicts: [Verdict; 2]) {
    let front = world.ego.body.position;
    let other = &mut world.others[number];
    let is_far = (other.body.position - front).abs() > REACH;
    let is_newest = motion.stamp > other.newest;
    other.newest = other.newest.max(motion.stamp);
    // A motion may be refused if it is incomplete, overtaken, very old, or from too far away.
    if is_far || verdicts.contains(&Verdict::Lost) || !is_newest || at - motion.at > 1.9 {
        return;
    }
    if verdicts[1] == Verdict::Taken {
        other.refused = None;
        return;
    }
    let (since, count) = other.refused.map_or((at, 1), |(since, count)| (since, count + 1));
    other.refused = Some((since, count));
    if at - since > REFUSED && count >= 6 {
        let station = other.station;
        world.outcome.find(Fault::Refused, at, at - since, || format!("{count} of station {station} in a row"));
    }
}

/// The checks at the end of the drive.
pub fn end(world: &mut World, at: f64) {
    let Some(since) = world.well else { return };
    if world.outcome.of(Fault::Collision).is_some() || at - since < 24.0 {
        return;
    }
    let (speed, mode) = (world.ego.body.speed, world.ego.said.mode);
    let gap = world.nearest().map_or(f64::NAN, |nearest| nearest.rear() - world.ego.body.position);
    // The station that the driver names can be followed if it is the vehicle ahead and within reach.
    let is_there = world.nearest().is_some_and(|nearest| nearest.station == world.followed) && gap < 1_400.0;
    if speed < 2.0 || is_there && at - world.cooperative > LAPSE {
        let told = world.ego.said.told.map_or(f64::NAN, |told| told.behind);
        world.outcome.find(Fault::Deadlock, at, at - since, || {
            format!(
                "{speed:.1} m/s in mode {mode}, gap {gap:.0} m, near end {told:.0} m behind, after {:.0} s",
                at - since
            )
        });
    }
}
