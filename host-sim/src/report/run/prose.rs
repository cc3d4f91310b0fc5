//! The captions of a run's report: series enter; a sentence or two with their numbers leave.

use super::RunReport;
use crate::measure::metrics::{SETTLED_FROM_S, error_statistics_since, percentile_abs};
use crate::report::markup::{count, quantity, significant};
use crate::report::plot::{Series, StripRow};

pub(super) const NOTHING: &str = "There is nothing to show: the run has no samples of this kind.";

impl RunReport {
    fn ego_name(&self) -> &str {
        self.trajectories.get(self.ego).map_or("the ego", |ego| ego.name.as_str())
    }

    /// The vehicle's name in prose.
    pub(super) fn call(&self, name: &str) -> String {
        match name.chars().next() {
            _ if name == self.ego_name() => "the ego".into(),
            Some(first) if first.is_ascii_digit() => format!("vehicle {name}"),
            _ => name.into(),
        }
    }

    /// "Shaded: silence, 4–8 s." for the end of a caption. A few silences are given by their times, many by their
    /// number.
    pub(super) fn say_shades(&self) -> String {
        let times = |s: &super::Interval| format!("{}–{} s", plain(s.from), plain(s.to));
        match self.silences.as_slice() {
            [] => String::new(),
            few if few.len() <= 3 => {
                format!(" Shaded: the link is silent, {}.", few.iter().map(times).collect::<Vec<_>>().join(", "))
            }
            many => {
                let total: f64 = many.iter().map(|silence| silence.to - silence.from).sum();
                format!(" Shaded: {} silences of the link, {} s in all.", many.len(), plain(total))
            }
        }
    }

    pub(super) fn say_trajectories(&self) -> String {
        let Some((first, last)) = self.trajectories.get(self.ego).and_then(ends) else { return NOTHING.into() };
        format!(
            "Front bumpers of {} vehicles; the ego (red, dashed) drives {} in {}.{}",
            self.trajectories.len(),
            quantity(last.1 - first.1, "m"),
            quantity(last.0 - first.0, "s"),
            self.say_shades()
        )
    }

    pub(super) fn say_gaps(&self) -> String {
        let Some((name, at, gap)) = lowest(&self.gaps) else { return NOTHING.into() };
        let mut text =
            format!("The smallest gap of the run is {} ({}, at {} s)", quantity(gap, "m"), self.call(name), plain(at));
        let ego: Vec<Series> = self.gaps.iter().filter(|s| s.name == self.ego_name()).cloned().collect();
        match lowest(&ego) {
            Some((_, at, gap)) if name != self.ego_name() => {
                text.push_str(&format!("; the ego’s own is never below {} (at {} s).", quantity(gap, "m"), plain(at)));
            }
            _ => text.push('.'),
        }
        text + &self.say_shades()
    }

    pub(super) fn say_speeds(&self) -> String {
        let Some((slowest, at, low)) = lowest(&self.speeds) else { return NOTHING.into() };
        let high = self.speeds.iter().flat_map(|s| &s.points).map(|p| p.1).filter(|v| v.is_finite()).reduce(f64::max);
        format!(
            "The lowest speed is {} ({}, at {} s), the highest {}.{}",
            quantity(low, "m/s"),
            self.call(slowest),
            plain(at),
            quantity(high.unwrap_or(low), "m/s"),
            self.say_shades()
        )
    }

    pub(super) fn say_error(&self) -> String {
        let (ours, paper) = (settled(&self.error_ours), settled(&self.error_paper));
        let Some(largest) = ours.max else { return NOTHING.into() };
        let mut text = format!(
            "From {} s on, the follower’s estimate of the ego strays by {} at the most (rms {})",
            plain(SETTLED_FROM_S),
            quantity(largest, "m"),
            quantity(ours.rms.unwrap_or(f64::NAN), "m")
        );
        if let Some(theirs) = paper.max {
            text.push_str(&format!("; the literal paper, on the same messages, by {}", quantity(theirs, "m")));
            if largest > 0.0 && theirs / largest >= 1.5 {
                text.push_str(&format!(", {} times as much", significant(theirs / largest, 2)));
            }
        }
        text.push('.');
        if self.zooms_on_ours() {
            text.push_str(" The lower panel shows ours alone, enlarged.");
        }
        text + &self.say_shades()
    }

    pub(super) fn say_distribution(&self) -> String {
        let (ours, paper) = (settled(&self.error_ours), settled(&self.error_paper));
        let Some(p99) = ours.p99 else { return NOTHING.into() };
        let paper = paper.p99.map(|p99| format!(", of the literal paper’s at most {}", quantity(p99, "m")));
        format!(
            "Of {} samples from {} s on, 99 % of ours are at most {}{}. Further left is better.",
            count(ours.count as u64),
            plain(SETTLED_FROM_S),
            quantity(p99, "m"),
            paper.unwrap_or_default()
        )
    }

    pub(super) fn say_channel(&self) -> String {
        let sent = self.channel.len();
        let delays: Vec<f64> = self.channel.iter().filter_map(|message| message.1).collect();
        if sent == 0 {
            return NOTHING.into();
        }
        let lost = sent - delays.len();
        let share = 100.0 * lost as f64 / sent as f64;
        let mut text = format!("Of {} messages {} were lost", count(sent as u64), count(lost as u64));
        if lost > 0 {
            text.push_str(&format!(" ({} %; strokes at the foot)", significant(share, 3)));
        }
        let percentile = |percent| percentile_abs(&delays, percent).map(|delay| quantity(delay * 1000.0, "ms"));
        if let (Some(median), Some(p99), Some(most)) = (percentile(50.0), percentile(99.0), percentile(100.0)) {
            text.push_str(&format!(
                "; the others took {median} in the median, {p99} at the 99th percentile, {most} at most"
            ));
        }
        text + "." + &self.say_shades()
    }

    pub(super) fn say_modes(&self) -> String {
        let end = self.span().1;
        let Some(track) = self.modes.iter().find(|t| t.vehicle == self.ego_name()).or(self.modes.first()) else {
            return NOTHING.into();
        };
        let mut names: Vec<&str> = Vec::new();
        let changes = track.changes.iter().map(|(at, mode)| {
            let known = names.iter().position(|name| name == mode);
            let index = known.unwrap_or_else(|| {
                names.push(mode);
                names.len() - 1
            });
            (*at, index)
        });
        let spans = StripRow { name: String::new(), changes: changes.collect() }.spans(end);
        let total = |index: usize| spans.iter().filter(|s| s.2 == index).map(|s| s.1 - s.0).sum::<f64>();
        let shares: Vec<String> = names
            .iter()
            .enumerate()
            .filter(|(index, _)| total(*index) > 0.0)
            .map(|(index, name)| format!("{} in {name}", quantity(total(index), "s")))
            .collect();
        let changes = spans.len().saturating_sub(1);
        let changed = match changes {
            0 => "never changing".into(),
            1 => "changing once".into(),
            n => format!("changing {} times", count(n as u64)),
        };
        format!(
            "In this run {} spends {}, {changed}.{}",
            self.call(&track.vehicle),
            shares.join(", "),
            self.say_shades()
        )
    }
}

fn settled(series: &Series) -> crate::measure::metrics::ErrorStatistics {
    let points: Vec<(f64, f64)> = series.points.iter().copied().filter(|point| point.1.is_finite()).collect();
    error_statistics_since(&points, SETTLED_FROM_S)
}

/// The first and the last finite point of a series.
fn ends(series: &Series) -> Option<((f64, f64), (f64, f64))> {
    let mut finite = series.points.iter().copied().filter(|point| point.0.is_finite() && point.1.is_finite());
    let first = finite.next()?;
    Some((first, finite.next_back().unwrap_or(first)))
}

/// Name, time and value of the lowest finite sample.
fn lowest(series: &[Series]) -> Option<(&str, f64, f64)> {
    let samples = series.iter().flat_map(|s| s.points.iter().map(|p| (s.name.as_str(), p.0, p.1)));
    samples.filter(|sample| sample.2.is_finite()).min_by(|a, b| a.2.total_cmp(&b.2))
}

/// A time to hundredths, without trailing zeros.
pub(super) fn plain(seconds: f64) -> String {
    let spelled = format!("{seconds:.2}");
    spelled.trim_end_matches('0').trim_end_matches('.').into()
}
