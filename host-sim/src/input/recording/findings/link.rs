//! The findings of a recorded channel: checked rows enter; one finding for each way in which no link is like that leaves.

use std::path::Path;

use super::{GAP_INTERVALS, Worst, median, short};
use crate::error::Error;
use crate::input::recording::ChannelRow;

/// A gap between two messages is longer than five usual intervals and than this, in seconds.
const GAP_S: f64 = 1.0;
/// Usual intervals from here on, in seconds, are taken for milliseconds: no vehicle sends so seldom.
const SELDOM_S: f64 = 10.0;
/// Usual delays from here on, in seconds, are taken for milliseconds.
const LATE_S: f64 = 2.0;

/// The findings of a recorded channel, whose rows stand in these lines of a file.
pub fn of_channel(file: &Path, rows: &[ChannelRow], lines: &[u64]) -> Vec<Error> {
    let found = |at: usize, cause: String, remedy: &str| {
        Error::new(cause, remedy).in_file(file).at_line(lines.get(at).copied().unwrap_or(1))
    };
    let intervals = || rows.windows(2).map(|pair| pair[1].t_s - pair[0].t_s);
    let usual_s = median(intervals());
    let times = (usual_s >= SELDOM_S).then(|| {
        let cause = format!("messages are {} s apart in the median, as if the times were milliseconds", short(usual_s));
        found(0, cause, "give `t_s` in seconds")
    });
    let longest_s = (GAP_INTERVALS * usual_s).max(GAP_S);
    let gaps = intervals().zip(1..).filter(|(length_s, _)| *length_s > longest_s).map(|(length_s, to)| (to, length_s));
    let gap = Worst::of(gaps).filter(|_| times.is_none()).map(|gap| {
        let (length_s, from_s) = (short(gap.value), short(rows[gap.at - 1].t_s));
        let cause = format!("no message is sent for {length_s} s from {from_s} s on{}", gap.among());
        found(gap.at, cause, "give every message that was lost a line with an empty `delay_s`")
    });
    let arrived: Vec<(usize, f64)> = rows.iter().zip(0..).filter_map(|(row, at)| Some((at, row.delay_s?))).collect();
    let late_s = median(arrived.iter().map(|(_, delay_s)| *delay_s));
    let delays = match arrived.first() {
        None => Some(found(0, "no message arrives".into(), "give a recording with a message that has a `delay_s`")),
        Some((at, _)) => (late_s >= LATE_S).then(|| {
            let cause = format!("a message takes {} s in the median, as if delays were milliseconds", short(late_s));
            found(*at, cause, "give `delay_s` in seconds")
        }),
    };
    [times, gap, delays].into_iter().flatten().collect()
}
