//! A recorded vehicle that falls silent: its recording and lengths of silence enter; comparisons at the end of each
//! length leave.
//!
//! The vehicle sends at 0, 0.1, 0.2, … s from the recording's start, and every message arrives at once. A silence
//! starts at each of these times `t`: the message sent at `t` is the last one that is received. At `t + L`, for each
//! length `L` that ends inside the recording, unit and baselines are compared with the truth. The age of the newest
//! sample is then `L` plus the age that the recording's sample had at `t`.

use holdover::ConfigError;

use super::listener::{Deaf, Listener};
use super::options::Recording;
use super::publisher::Publisher;
use super::sample::{Outcome, Sample};
use super::timeline::{Timeline, seconds};
use crate::input::recording::Motion;
use crate::measure::baseline::Estimate;
use crate::parallel;
use crate::sim::modem::V2xMessage;
use crate::sim::quantities::metres;
use crate::sim::time::micros;

/// Time between two messages, and between the starts of two silences.
const CYCLE_US: i64 = 100_000;
/// Number of silences that are computed together; this many units are in memory at once.
const TOGETHER: usize = 128;

/// The start of a silence.
struct Start {
    at_us: i64,
    sampled_us: i64,
    listener: Deaf,
}

/// Compares at the end of every silence, with the silences in parallel. `advance` is called after every second of the
/// recording.
///
/// # Errors
/// An error of the unit's configuration.
pub fn evaluate(
    recording: &Recording,
    lengths_s: &[f64],
    step_s: f64,
    advance: &dyn Fn(f64),
) -> Result<Outcome, ConfigError> {
    let motion = &recording.motion;
    let timeline = Timeline::from(motion.start_s(), step_s);
    let end_us = timeline.micros(motion.end_s());
    let mut outcome = Outcome { end_s: motion.end_s(), ..Outcome::default() };
    let (mut target, mut ahead) = Publisher::pair(recording, timeline);
    let mut listener = Listener::new(step_s, &Publisher::first_words(recording, timeline))?;
    let mut starts = Vec::with_capacity(TOGETHER);
    let mut ticks = timeline.ticks(end_us).peekable();
    for at_us in (0..).map(|n| n * CYCLE_US).take_while(|at_us| *at_us <= end_us) {
        while let Some(tick_us) = ticks.next_if(|tick_us| *tick_us < at_us) {
            listener.tick(tick_us);
            outcome.unit_ticks += 1;
        }
        let near = metres(motion.at(timeline.recorded_s(at_us)).position_m);
        let ahead: Option<V2xMessage> = ahead.as_mut().and_then(|ahead| Some(ahead.publish(at_us)?.message));
        let Some(published) = target.publish(at_us) else { continue };
        for message in ahead.into_iter().chain([published.message]) {
            listener.hear(at_us, &message, near);
        }
        // The unit takes the message in here, so that not every silence has to do it again.
        listener.beliefs(at_us, near);
        ticks.next_if_eq(&at_us);
        outcome.unit_ticks += 1;
        outcome.sent += 1;
        outcome.delivered += 1;
        outcome.messages.push((timeline.recorded_s(at_us), Some(0.0)));
        starts.push(Start { at_us, sampled_us: published.sampled_us, listener: listener.deafened() });
        if starts.len() == TOGETHER {
            fall_silent(&mut starts, motion, timeline, lengths_s, end_us, &mut outcome);
            advance(seconds(CYCLE_US) * TOGETHER as f64);
        }
    }
    fall_silent(&mut starts, motion, timeline, lengths_s, end_us, &mut outcome);
    outcome.refusals = listener.refusals();
    Ok(outcome)
}

fn fall_silent(
    starts: &mut Vec<Start>,
    motion: &Motion,
    timeline: Timeline,
    lengths_s: &[f64],
    end_us: i64,
    outcome: &mut Outcome,
) {
    for (samples, ticks) in parallel::each(starts.drain(..), |start| start.last(motion, timeline, lengths_s, end_us)) {
        outcome.samples.extend(samples);
        outcome.unit_ticks += ticks;
    }
}

impl Start {
    /// Ticks on without messages, and compares at each length that ends in time. The unit ticks at every step after the
    /// last message. If the length is no multiple of the step, it also ticks at the length's end.
    fn last(mut self, motion: &Motion, timeline: Timeline, lengths_s: &[f64], end_us: i64) -> (Vec<Sample>, u64) {
        let mut ends: Vec<(i64, f64)> =
            lengths_s.iter().map(|&length_s| (self.at_us + micros(length_s), length_s)).collect();
        ends.retain(|(end, _)| *end <= end_us);
        ends.sort_by_key(|(end, _)| *end);
        let last_us = ends.last().map_or(i64::MIN, |(end, _)| *end - self.at_us);
        let mut steps = timeline.ticks(last_us).skip(1).map(|since_us| self.at_us + since_us).peekable();
        let (mut samples, mut ticks) = (Vec::with_capacity(ends.len()), 0);
        for (end, length_s) in ends {
            while let Some(at_us) = steps.next_if(|at_us| *at_us < end) {
                self.listener.tick(at_us);
                ticks += 1;
            }
            steps.next_if_eq(&end);
            let at_s = timeline.recorded_s(end);
            let state = motion.at(at_s);
            samples.push(Sample {
                at_s,
                age_s: seconds(end - self.sampled_us),
                outage_s: Some(length_s),
                truth: Estimate { position_m: state.position_m, speed_mps: state.speed_mps },
                beliefs: self.listener.beliefs(end, metres(state.position_m)),
            });
            ticks += 1;
        }
        (samples, ticks)
    }
}
