//! A recorded vehicle over a recorded link: both enter, comparisons at every tick leave.

use holdover::ConfigError;

use super::listener::Listener;
use super::options::Recording;
use super::publisher::{Published, Publisher};
use super::sample::{Outcome, Sample};
use super::timeline::{Timeline, seconds};
use crate::input::recording::ChannelTrace;
use crate::measure::baseline::Estimate;
use crate::sim::channel::OLDEST_S;
use crate::sim::modem::V2xMessage;
use crate::sim::quantities::metres;
use crate::sim::time::micros;

/// The messages that arrive at one time.
struct Arrival {
    at_us: i64,
    sampled_us: i64,
    /// The predecessor's message comes first.
    messages: Vec<V2xMessage>,
}

/// Compares at every tick, from the first delivery to the last sample or the last send, whichever is earlier. `advance`
/// is called after every second.
///
/// # Errors
/// An error of the unit's configuration.
pub fn evaluate(
    recording: &Recording,
    link: &ChannelTrace,
    step_s: f64,
    advance: &dyn Fn(f64),
) -> Result<Outcome, ConfigError> {
    let (motion, rows) = (&recording.motion, link.rows());
    let timeline = Timeline::around(motion.start_s().max(rows[0].t_s), step_s);
    let end_us = timeline.micros(motion.end_s().min(rows[rows.len() - 1].t_s));
    let mut outcome = Outcome { end_s: timeline.recorded_s(end_us), ..Outcome::default() };
    let arrivals = arrivals(recording, link, timeline, end_us, &mut outcome);
    let mut listener = Listener::new(step_s, &Publisher::first_words(recording, timeline))?;
    let mut pending = arrivals.iter().peekable();
    let mut newest_us: Option<i64> = None;
    let mut told_us = 0;
    for at_us in timeline.ticks(end_us) {
        while let Some(arrival) = pending.next_if(|arrival| arrival.at_us <= at_us) {
            let near = metres(motion.at(timeline.recorded_s(arrival.at_us)).position_m);
            arrival.messages.iter().for_each(|message| listener.hear(arrival.at_us, message, near));
            newest_us = newest_us.max(Some(arrival.sampled_us));
        }
        let at_s = timeline.recorded_s(at_us);
        let truth = motion.at(at_s);
        let beliefs = listener.beliefs(at_us, metres(truth.position_m));
        outcome.unit_ticks += 1;
        if let Some(newest_us) = newest_us {
            let truth = Estimate { position_m: truth.position_m, speed_mps: truth.speed_mps };
            outcome.samples.push(Sample { at_s, age_s: seconds(at_us - newest_us), outage_s: None, truth, beliefs });
        }
        if at_us - told_us >= 1_000_000 {
            advance(seconds(at_us - told_us));
            told_us = at_us;
        }
    }
    outcome.refusals = listener.refusals();
    Ok(outcome)
}

/// All messages that are sent up to the end, in the order of arrival.
fn arrivals(
    recording: &Recording,
    link: &ChannelTrace,
    timeline: Timeline,
    end_us: i64,
    outcome: &mut Outcome,
) -> Vec<Arrival> {
    let (mut target, mut ahead) = Publisher::pair(recording, timeline);
    let mut arrivals = Vec::new();
    for row in link.rows() {
        let sent_us = timeline.micros(row.t_s);
        if sent_us > end_us {
            break;
        }
        let ahead = ahead.as_mut().and_then(|ahead| ahead.publish(sent_us));
        let Some(Published { sampled_us, message }) = target.publish(sent_us) else { continue };
        outcome.sent += 1;
        let at_us = row.delay_s.map(|delay_s| sent_us + micros(delay_s));
        let at_us = at_us.filter(|at_us| !is_expired(sampled_us, *at_us));
        outcome.messages.push((row.t_s, row.delay_s.filter(|_| at_us.is_some())));
        if let Some(at_us) = at_us {
            outcome.delivered += 1;
            // A modem drops each message that is too old on its own, because stamps repeat.
            let ahead = ahead.filter(|ahead| !is_expired(ahead.sampled_us, at_us)).map(|ahead| ahead.message);
            arrivals.push(Arrival { at_us, sampled_us, messages: ahead.into_iter().chain([message]).collect() });
        }
    }
    arrivals.sort_by_key(|arrival| arrival.at_us); // stable: messages that arrive together stay in the order of sending
    arrivals
}

/// Whether the receiving modem drops a message by its stamp, which is in whole tenths of a millisecond.
fn is_expired(sampled_us: i64, at_us: i64) -> bool {
    at_us - (sampled_us + 50).div_euclid(100) * 100 > micros(OLDEST_S)
}
