//! Grouped bars: for each group, one number per method enters; bars side by side leave.

use super::{
    Figure, Tone, Width,
    frame::{self, BELOW, TITLE_ROW, Y_SPACING},
    legend::{Entry, Legend, Swatch, shortened},
    scale::{Axis, Extent},
    svg::{Anchor, Area, Svg, text_width},
};
use crate::report::markup::quantity;

/// Numbers of several methods in groups: errors by age class, by length of outage.
#[derive(Debug, Clone, PartialEq)]
pub struct Bars {
    /// What the figure shows, for a screen reader.
    pub title: String,
    /// A description of what it shows, for a screen reader.
    pub description: String,
    /// The meaning of the groups, with the unit.
    pub x_label: String,
    /// The vertical axis. Linear bars start at 0, logarithmic bars at the decade below the smallest value.
    pub y: Axis,
    /// Height of the frame in pixels.
    pub height: f64,
    /// The names of the groups.
    pub groups: Vec<String>,
    /// `(name, tone, a value for each group)`. A value that is absent (an empty class) leaves a gap.
    pub methods: Vec<(String, Tone, Vec<Option<f64>>)>,
}

impl Bars {
    fn values(&self) -> impl Iterator<Item = f64> + '_ {
        self.methods.iter().flat_map(|(_, _, values)| values.iter().take(self.groups.len()).flatten().copied())
    }

    /// The axis on which the bars stand, so that their lengths can be compared.
    fn grounded(&self) -> Axis {
        let smallest = self.values().filter(|&value| self.y.draws(value)).reduce(f64::min);
        let decade = smallest.filter(|smallest| *smallest > 0.0).map(|smallest| (smallest / 1.5).log10().floor());
        match decade {
            Some(decade) if self.y.is_logarithmic() => self.y.clone().including(10f64.powf(decade)),
            _ => self.y.clone().including(0.0),
        }
    }
}

impl Figure for Bars {
    fn draw(&self, id: &str, width: Width) -> String {
        let mut svg = Svg::new(id);
        let pixels = width.pixels();
        let axis = self.grounded();
        let entry =
            |(name, tone, _): &(String, Tone, _)| Entry { name: name.clone(), tone: *tone, swatch: Swatch::Box };
        let legend = Legend::new(self.methods.iter().map(entry).collect(), 0.0, pixels);
        let top = legend.height() + TITLE_ROW;
        let bottom = top + self.height;
        let mut extent = Extent::EMPTY;
        self.values().filter(|value| axis.draws(*value)).for_each(|value| extent.include(value));
        let y = axis.fit(extent, (bottom, top), 0.06);
        let ticks = y.ticks(Y_SPACING);
        let area = Area { left: frame::left_margin(frame::labels(&ticks), width), top, right: pixels - 6.0, bottom };

        legend.draw(&mut svg);
        frame::draw_y_axis(&mut svg, &axis.label(&y), &ticks, area, legend.height() + 12.0);
        let pitch = area.width() / self.groups.len().max(1) as f64;
        let bar = pitch * 0.8 / self.methods.len().max(1) as f64;
        let ground = if axis.draws(0.0) { y.at(0.0).clamp(top, bottom) } else { bottom };
        for (group, name) in self.groups.iter().enumerate() {
            let left = area.left + pitch * group as f64;
            let middle = left + pitch / 2.0;
            svg.text("tick", Anchor::Middle, (middle, bottom + 16.0), &shortened(name, pitch.max(text_width("xx"))));
            for (index, (method, tone, values)) in self.methods.iter().enumerate() {
                let Some(value) = values.get(group).copied().flatten().filter(|value| axis.draws(*value)) else {
                    continue;
                };
                let at = y.at(value).clamp(top, bottom);
                let left = left + pitch * 0.1 + bar * index as f64;
                let (upper, lower) = (at.min(ground), at.max(ground));
                let area =
                    Area { left, top: upper, right: left + (bar - 1.0).max(1.0), bottom: lower.max(upper + 0.5) };
                let told = format!("{method}, {name}: {}", quantity(value, axis.unit()));
                svg.telling(&format!("fill {}", tone.class()), area, told.trim_end());
            }
        }
        svg.line("axis", (area.left, ground), (area.right, ground));
        svg.text("title", Anchor::End, (area.right, bottom + 33.0), &self.x_label);
        if extent.is_empty() {
            let middle = ((area.left + area.right) / 2.0, (top + bottom) / 2.0 + 4.0);
            svg.text("empty", Anchor::Middle, middle, "no data");
        }
        svg.finish(pixels, bottom + BELOW, &self.title, &self.description)
    }

    fn undrawable(&self) -> usize {
        self.values().filter(|value| !self.y.draws(*value)).count()
    }
}
