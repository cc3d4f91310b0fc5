//! Axes: a description and the extent of the data enter; a mapping to pixels, with ticks, leaves.

use crate::report::markup::MILLIMETRES_BELOW_M;

/// A value beyond this cannot be drawn, and on a logarithmic axis neither can a value below its reciprocal. So
/// differences and quotients of two drawn values are finite.
const DRAWABLE_BELOW: f64 = 1e100;

/// The values that some data cover.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Extent {
    pub low: f64,
    pub high: f64,
}

impl Extent {
    pub const EMPTY: Self = Self { low: f64::INFINITY, high: f64::NEG_INFINITY };

    pub fn include(&mut self, value: f64) {
        self.low = self.low.min(value);
        self.high = self.high.max(value);
    }

    pub fn is_empty(&self) -> bool {
        self.low > self.high
    }
}

/// An axis with its title and unit.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    title: String,
    unit: String,
    logarithmic: bool,
    range: Option<(f64, f64)>,
    including: Option<f64>,
}

impl Axis {
    /// A linear axis over the range of the data.
    pub fn linear(title: impl Into<String>, unit: impl Into<String>) -> Self {
        Self { title: title.into(), unit: unit.into(), logarithmic: false, range: None, including: None }
    }

    /// A logarithmic axis, base 10, on which only positive values can be drawn.
    pub fn logarithmic(title: impl Into<String>, unit: impl Into<String>) -> Self {
        Self { logarithmic: true, ..Self::linear(title, unit) }
    }

    /// The same axis over exactly `[low, high]`. These are ignored unless both can be drawn and are in this order.
    pub fn over(mut self, low: f64, high: f64) -> Self {
        self.range = (self.draws(low) && self.draws(high) && low < high).then_some((low, high));
        self
    }

    /// The same axis, which also covers `value`.
    pub fn including(mut self, value: f64) -> Self {
        self.including = self.draws(value).then_some(value);
        self
    }

    /// Title and unit as shown at the axis with this mapping: `gap (m)`.
    pub(super) fn label(&self, mapping: &Mapping) -> String {
        match self.shown_unit(mapping) {
            "" => self.title.clone(),
            unit => format!("{} ({unit})", self.title),
        }
    }

    /// The title alone.
    pub(super) fn title(&self) -> &str {
        &self.title
    }

    /// The unit of its values.
    pub(super) fn unit(&self) -> &str {
        &self.unit
    }

    /// The unit of the labels of its ticks.
    pub(super) fn shown_unit(&self, mapping: &Mapping) -> &str {
        if mapping.milli { "mm" } else { &self.unit }
    }

    /// Whether equal distances on this axis are equal factors.
    pub fn is_logarithmic(&self) -> bool {
        self.logarithmic
    }

    /// Whether `value` can be drawn here.
    pub(super) fn draws(&self, value: f64) -> bool {
        value.abs() < DRAWABLE_BELOW && (!self.logarithmic || value > DRAWABLE_BELOW.recip())
    }

    /// The mapping of the axis onto `[from, to]` pixels, with `margin` (a fraction of the span) around the data.
    pub(super) fn fit(&self, data: Extent, (from, to): (f64, f64), margin: f64) -> Mapping {
        let (low, high) = self.range.unwrap_or_else(|| self.spread(data, margin));
        // In metres such an axis would be all zeros.
        let milli = self.unit == "m" && low.abs().max(high.abs()) < MILLIMETRES_BELOW_M;
        let (low, high) = (self.measure(low), self.measure(high));
        Mapping { logarithmic: self.logarithmic, milli, low, high, from, to }
    }

    fn spread(&self, mut data: Extent, margin: f64) -> (f64, f64) {
        if let Some(value) = self.including {
            data.include(value);
        }
        if data.is_empty() {
            return if self.logarithmic { (0.1, 10.0) } else { (0.0, 1.0) };
        }
        let (low, high) = (self.measure(data.low), self.measure(data.high));
        // A constant also needs a span, and one that its ticks can resolve.
        let widest = low.abs().max(high.abs());
        let least = if self.logarithmic { 0.5 } else { (widest * 1e-6).max(1e-9) };
        let spare = if high - low < least && widest == 0.0 && !self.logarithmic {
            1.0 // nothing but zeros
        } else if high - low < least {
            least.max(widest * 0.1)
        } else {
            (high - low) * margin
        };
        // An end that is the included value itself is a meaningful edge, such as 0. There is no margin beyond it.
        let edge = |end: f64| self.including.is_some_and(|value| self.measure(value) == end) && high - low >= least;
        let low = if edge(low) { low } else { low - spare };
        let high = if edge(high) { high } else { high + spare };
        if self.logarithmic { (10f64.powf(low), 10f64.powf(high)) } else { (low, high) }
    }

    fn measure(&self, value: f64) -> f64 {
        if self.logarithmic { value.log10() } else { value }
    }
}

/// A mark on an axis, in pixels. Minor marks have no label.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Tick {
    pub at: f64,
    pub label: Option<String>,
}

/// The mapping of values to pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Mapping {
    logarithmic: bool,
    /// Whether metres are shown as millimetres.
    milli: bool,
    low: f64,
    high: f64,
    from: f64,
    to: f64,
}

impl Mapping {
    /// The pixel of `value`, which the axis has to be able to draw. Far outside the axis, the pixel is limited to what
    /// SVG can hold.
    pub fn at(&self, value: f64) -> f64 {
        let measured = if self.logarithmic { value.log10() } else { value };
        self.at_measured(measured)
    }

    fn at_measured(&self, measured: f64) -> f64 {
        (self.from + (measured - self.low) / (self.high - self.low) * (self.to - self.from)).clamp(-1e4, 1e4)
    }

    /// What a script needs to read a value off a pixel: `low high`, as shown, with `log` if these are decades.
    pub fn described(&self) -> String {
        let (low, high) = match (self.logarithmic, self.milli) {
            (_, false) => (self.low, self.high),
            (false, true) => (self.low * 1e3, self.high * 1e3),
            (true, true) => (self.low + 3.0, self.high + 3.0),
        };
        format!("{low:.9} {high:.9}{}", if self.logarithmic { " log" } else { "" })
    }

    /// Ticks about `spacing` pixels apart.
    pub fn ticks(&self, spacing: f64) -> Vec<Tick> {
        let most = ((self.to - self.from).abs() / spacing).max(1.0);
        if self.logarithmic { self.decades(most) } else { self.steps(most) }
    }

    fn steps(&self, most: f64) -> Vec<Tick> {
        let shown = if self.milli { 1e3 } else { 1.0 };
        let (low, high) = (self.low * shown, self.high * shown);
        let raw = (high - low) / most;
        let decade = 10f64.powf(raw.log10().floor());
        let step = [1.0, 2.0, 5.0, 10.0].into_iter().map(|m| m * decade).find(|&s| s >= raw * 0.999).unwrap_or(raw);
        let first = (low / step - 1e-6).ceil();
        let count = ((high / step + 1e-6).floor() - first).clamp(0.0, 100.0) as usize;
        let decimals = (-step.log10()).ceil().clamp(0.0, 9.0) as usize;
        let tick = |index: usize| {
            let value = (first + index as f64) * step;
            Tick { at: self.at_measured(value / shown), label: Some(number(value, decimals)) }
        };
        (0..=count).map(tick).collect()
    }

    fn decades(&self, most: f64) -> Vec<Tick> {
        let (first, last) = (self.low.floor() as i32, self.high.ceil() as i32);
        let stride = (f64::from(last - first) / most).ceil().max(1.0) as i32;
        let few = self.high - self.low < 1.5;
        let mut ticks = Vec::new();
        for decade in first..=last {
            for digit in 1..=9 {
                let measured = f64::from(decade) + f64::from(digit).log10();
                let inside = measured >= self.low - 1e-9 && measured <= self.high + 1e-9;
                let crowded = (stride > 1 && digit > 1) || (stride > 4 && decade % stride != 0);
                if !inside || crowded {
                    continue;
                }
                let named = (digit == 1 && decade % stride == 0) || (few && (digit == 2 || digit == 5));
                let label = named.then(|| power(f64::from(digit), decade + if self.milli { 3 } else { 0 }));
                ticks.push(Tick { at: self.at_measured(measured), label });
            }
        }
        ticks
    }
}

fn number(value: f64, decimals: usize) -> String {
    let spelled = if value.abs() >= 1e7 { format!("{value:e}") } else { format!("{value:.decimals$}") };
    let zero = spelled.trim_start_matches('-').chars().all(|c| matches!(c, '0' | '.'));
    if zero { spelled.trim_start_matches('-').into() } else { spelled.replace('-', "\u{2212}") }
}

fn power(digit: f64, decade: i32) -> String {
    match decade {
        -4..=-1 => format!("{:.*}", decade.unsigned_abs() as usize, digit * 10f64.powi(decade)),
        0..=4 => format!("{:.0}", digit * 10f64.powi(decade)),
        _ if digit == 1.0 => format!("10{}", superscript(decade)),
        _ => format!("{digit:.0}·10{}", superscript(decade)),
    }
}

fn superscript(number: i32) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let raised = |c: char| c.to_digit(10).map_or('⁻', |digit| DIGITS[digit as usize]);
    number.to_string().chars().map(raised).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(mapping: Mapping, spacing: f64) -> Vec<String> {
        mapping.ticks(spacing).into_iter().filter_map(|tick| tick.label).collect()
    }

    #[test]
    fn ticks_are_round_numbers() {
        let axis = Axis::linear("time", "s").over(0.0, 20.0);
        assert_eq!(
            labels(axis.fit(Extent::EMPTY, (0.0, 700.0), 0.0), 70.0),
            ["0", "2", "4", "6", "8", "10", "12", "14", "16", "18", "20"]
        );
        let axis = Axis::linear("error", "m").over(-0.3, 0.1);
        assert_eq!(labels(axis.fit(Extent::EMPTY, (200.0, 0.0), 0.0), 45.0), ["−0.3", "−0.2", "−0.1", "0.0", "0.1"]);
    }

    #[test]
    fn decades_are_named() {
        let axis = Axis::logarithmic("error", "m").over(0.001, 10.0);
        assert_eq!(labels(axis.fit(Extent::EMPTY, (0.0, 400.0), 0.0), 60.0), ["0.001", "0.01", "0.1", "1", "10"]);
        let axis = Axis::logarithmic("error", "m").over(0.1, 1.0);
        assert_eq!(labels(axis.fit(Extent::EMPTY, (0.0, 400.0), 0.0), 60.0), ["0.1", "0.2", "0.5", "1"]);
    }

    #[test]
    fn metres_that_would_be_all_zeros_are_millimetres() {
        let axis = Axis::linear("error", "m");
        let fit = |low, high| axis.fit(Extent { low, high }, (200.0, 0.0), 0.0);
        assert_eq!(axis.label(&fit(-0.02, 0.04)), "error (mm)");
        assert_eq!(labels(fit(-0.02, 0.04), 60.0), ["−20", "0", "20", "40"]);
        assert_eq!(axis.label(&fit(-0.02, 0.4)), "error (m)");
        let axis = Axis::logarithmic("error", "m").over(1e-4, 1e-2);
        assert_eq!(labels(axis.fit(Extent::EMPTY, (0.0, 400.0), 0.0), 60.0), ["0.1", "1", "10"]);
        assert_eq!(axis.fit(Extent::EMPTY, (0.0, 400.0), 0.0).described(), "-1.000000000 1.000000000 log");
    }

    #[test]
    fn every_extent_gets_a_finite_span_with_ticks() {
        let values = [0.0, 1e-12, -3.0, 13.4, 1e9, -1e99];
        for low in values {
            for high in values.into_iter().filter(|high| *high >= low) {
                let mapping = Axis::linear("x", "").fit(Extent { low, high }, (0.0, 300.0), 0.05);
                let (left, right) = (mapping.at(low), mapping.at(high));
                assert!((-1.0..=301.0).contains(&left) && (-1.0..=301.0).contains(&right), "{low} {high}");
                let ticks = mapping.ticks(50.0);
                assert!(!ticks.is_empty() && ticks.len() <= 30, "{low} {high}: {} ticks", ticks.len());
            }
        }
    }

    #[test]
    fn a_logarithmic_axis_has_no_place_for_what_is_not_clearly_positive() {
        let axis = Axis::logarithmic("x", "");
        for value in [f64::NAN, f64::INFINITY, -1.0, 0.0, f64::MIN_POSITIVE, 8.9e-309, 1e101] {
            assert!(!axis.draws(value), "{value}");
        }
        for low in [1e-99, 1e-3, 1.0, 1e99] {
            let mapping = axis.fit(Extent { low, high: 1e99 }, (0.0, 300.0), 0.05);
            assert!((-1.0..=301.0).contains(&mapping.at(low)) && mapping.ticks(50.0).len() < 60, "{low}");
        }
    }

    #[test]
    fn an_included_zero_is_the_edge() {
        let mapping = Axis::linear("gap", "m").including(0.0).fit(Extent { low: 4.0, high: 20.0 }, (0.0, 100.0), 0.05);
        assert_eq!(mapping.at(0.0), 0.0);
        assert!(mapping.at(20.0) < 100.0);
    }

    #[test]
    fn a_range_that_cannot_be_drawn_is_ignored() {
        assert_eq!(Axis::logarithmic("x", "").over(0.0, 1.0), Axis::logarithmic("x", ""));
        assert_eq!(Axis::linear("x", "").over(2.0, 1.0), Axis::linear("x", ""));
        assert_eq!(Axis::linear("x", "").over(f64::NAN, 1.0), Axis::linear("x", ""));
    }
}
