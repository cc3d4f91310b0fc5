//! The figures of the bound and of the envelope: the bound around the estimate enters, and the command with the
//! envelope's changes; two figures with their captions leave onto the page.

use super::{
    BoundSample, RunReport,
    figures::unlabelled,
    prose::{NOTHING, plain},
};
use crate::measure::metrics::percentile_abs;
use crate::report::markup::{count, quantity};
use crate::report::page::Page;
use crate::report::plot::{Axis, Guide, Layer, Series, Tone};

/// The enlarged panel is cut off at this many times the usual distance from the estimate to an end of the bound.
const CUT_AT: f64 = 4.0;

/// The panel goes on slightly beyond that, so that the outermost ticks keep clear of the axis's title.
const BEYOND: f64 = 1.15;

/// Samples that are further apart than this many times the usual interval are not joined, because there was no bound
/// between them.
const JOINED_WITHIN: f64 = 1.5;

impl RunReport {
    pub(super) fn draw_bound(&self, page: &mut Page) {
        let (title, caption) = ("What is certain of the position", self.say_bound());
        let mut whole = self.over_time(title, Axis::linear("from the estimate", "m"), &caption);
        whole.height = 200.0;
        whole.guides = vec![Guide { at: 0.0, label: "the estimate".into() }];
        whole.layers = self.bound_layers("certain", "truth");
        let Some(cut_m) = self.cut_m() else {
            page.figure(title, &caption, &[&whole]);
            return;
        };
        let axis = Axis::linear("enlarged", "m").over(-BEYOND * cut_m, BEYOND * cut_m);
        let mut enlarged = self.over_time("What is certain of the position, enlarged", axis, &caption);
        enlarged.height = 160.0;
        enlarged.layers = self.bound_layers("", "");
        enlarged.shades = unlabelled(&self.shades());
        page.figure(title, &caption, &[&whole, &enlarged]);
    }

    fn bound_layers(&self, band: &str, truth: &str) -> Vec<Layer> {
        let apart_s = self.bound.windows(2).map(|pair| pair[1].at_s - pair[0].at_s).collect::<Vec<_>>();
        let joined_s = percentile_abs(&apart_s, 50.0).unwrap_or(0.0) * JOINED_WITHIN;
        let mut layers = Vec::new();
        for (index, run) in self.bound.chunk_by(|a, b| b.at_s - a.at_s <= joined_s).enumerate() {
            let name = if index == 0 { band } else { "" };
            let edges = run.iter().map(|sample| (sample.at_s, sample.lowest_m, sample.highest_m)).collect();
            layers.push(Layer::Band { name: name.into(), edges, tone: Tone::Ours });
        }
        let points = self.bound.iter().map(|sample| (sample.at_s, sample.truth_m));
        layers.push(Layer::line(Series::new(truth, points).joined_within(joined_s), Tone::Ego));
        layers
    }

    /// The end of the enlarged panel; `None` if the usual width can be read in the panel of the whole bound.
    fn cut_m(&self) -> Option<f64> {
        let ends = |sample: &BoundSample| sample.highest_m.max(-sample.lowest_m);
        let ends: Vec<f64> = self.bound.iter().map(ends).filter(|end| end.is_finite()).collect();
        let cut_m = round_above(percentile_abs(&ends, 50.0)? * CUT_AT);
        (cut_m > 0.0 && ends.iter().any(|end| *end > 2.0 * cut_m)).then_some(cut_m)
    }

    fn say_bound(&self) -> String {
        let width = |sample: &BoundSample| sample.highest_m - sample.lowest_m;
        let widest = self.bound.iter().filter(|sample| width(sample).is_finite());
        let Some(widest) = widest.max_by(|a, b| width(a).total_cmp(&width(b))) else { return NOTHING.into() };
        let usual = percentile_abs(&self.bound.iter().map(width).collect::<Vec<_>>(), 50.0).unwrap_or(f64::NAN);
        let is_outside = |s: &&BoundSample| !(s.lowest_m..=s.highest_m).contains(&s.truth_m);
        let outside = self.bound.iter().filter(is_outside).count();
        let ticks = count(self.bound.len() as u64);
        let inside = match outside {
            0 => format!("is inside at every one of {ticks} ticks"),
            n => format!("is outside at {} of {ticks} ticks", count(n as u64)),
        };
        let mut text = format!(
            "The band is where the ego can be at all, seen from the estimate: as far as braking and accelerating \
             as hard as it can would have taken it since it was last heard. Its width is {} in the median and {} at the most \
             (at {} s). The truth (red, dashed) {inside}.",
            quantity(usual, "m"),
            quantity(width(widest), "m"),
            plain(widest.at_s),
        );
        if self.cut_m().is_some() {
            text.push_str(" The lower panel is enlarged and cut off.");
        }
        text + &self.say_shades()
    }

    pub(super) fn draw_drive(&self, page: &mut Page) {
        let (title, caption) = ("Command and acceleration", self.say_drive());
        let mut chart = self.over_time(title, Axis::linear("acceleration", "m/s²").including(0.0), &caption);
        chart.layers = vec![
            Layer::line(Series::new("reached", self.drive.reached.points.iter().copied()), Tone::Other(0)),
            Layer::line(Series::new("commanded", self.drive.command.points.iter().copied()), Tone::Ours),
        ];
        if !self.drive.limited_s.is_empty() {
            let (name, at) = ("limited".into(), self.drive.limited_s.clone());
            chart.layers.insert(0, Layer::Rug { name, at, tone: Tone::Alert });
        }
        page.figure(title, &caption, &[&chart]);
    }

    fn say_drive(&self) -> String {
        let command = self.drive.command.points.iter().filter(|point| point.1.is_finite());
        let Some(hardest) = command.min_by(|a, b| a.1.total_cmp(&b.1)) else { return NOTHING.into() };
        let who = self.call(&self.drive.vehicle);
        let mut text = if hardest.1 < 0.0 {
            let (braking, at) = (quantity(-hardest.1, "m/s²"), plain(hardest.0));
            format!(
                "What the unit of {who}, which makes the estimate, commands: at the hardest it brakes with {braking} (at {at} s)."
            )
        } else {
            format!("What the unit of {who}, which makes the estimate, commands: it never brakes.")
        };
        let (limited, ticks) = (self.drive.limited_s.len(), self.drive.command.points.len());
        text.push_str(&match (self.drive.engaged, limited) {
            (false, _) => " The envelope is not engaged.".to_owned(),
            (true, 0) => " The envelope never has to limit that.".to_owned(),
            (true, _) => {
                let share = quantity(100.0 * limited as f64 / ticks as f64, "%");
                format!(" The envelope limits that for {share} of the time (strokes at the foot).")
            }
        });
        text + &self.say_shades()
    }
}

/// The next of 1, 2, 5, 10, … times a power of ten, so that the axis has a tick there.
fn round_above(value: f64) -> f64 {
    let decade = 10f64.powf(value.log10().floor());
    let round = [1.0, 2.0, 5.0, 10.0].map(|step| step * decade);
    round.into_iter().find(|round| *round >= value).unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_panel_is_cut_at_a_round_number() {
        for (value, above) in [(0.4, 0.5), (0.21, 0.5), (0.12, 0.2), (1.0, 1.0), (7.0, 10.0), (33.0, 50.0)] {
            assert!((round_above(value) - above).abs() < 1e-12, "{value}");
        }
    }
}
