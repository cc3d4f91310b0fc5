//! The frame around the data: axes, grid, shades. Mappings and areas in pixels enter, shapes leave.

use super::{
    Interval, Width,
    scale::{Axis, Mapping, Tick},
    svg::{Anchor, Area, Svg, text_width},
};
use crate::report::markup::escape;

/// Room below the frame for the x axis's ticks and title.
pub(super) const BELOW: f64 = 40.0;
/// Room above the frame for the y axis's title.
pub(super) const TITLE_ROW: f64 = 19.0;
/// Room above the frame for the labels of shades.
pub(super) const SHADE_ROW: f64 = 14.0;
/// Pixels between ticks of an x axis.
pub(super) const X_SPACING: f64 = 62.0;
/// Pixels between ticks of a y axis.
pub(super) const Y_SPACING: f64 = 40.0;

/// The margin left of the frame for labels like `names`: tick labels, names of rows. Wide figures have a common least
/// margin, so that figures over the same time are aligned on the page.
pub(super) fn left_margin<'a>(names: impl IntoIterator<Item = &'a str>, width: Width) -> f64 {
    let least = if width == Width::Narrow { 34.0 } else { 68.0 };
    (names.into_iter().map(text_width).fold(0.0, f64::max) + 11.0).max(least)
}

/// The margin right of the frame; `needed` for labels that need more than the common margin.
pub(super) fn right_margin(needed: f64, width: Width) -> f64 {
    let least = if width == Width::Narrow { 16.0 } else { 132.0 };
    needed.max(least)
}

/// The labels of `ticks`.
pub(super) fn labels(ticks: &[Tick]) -> impl Iterator<Item = &str> {
    ticks.iter().filter_map(|tick| tick.label.as_deref())
}

/// The height of the row for the labels of shades; 0 if no shade has a label.
pub(super) fn shade_row(shades: &[Interval]) -> f64 {
    if shades.iter().any(|shade| !shade.label.is_empty()) { SHADE_ROW } else { 0.0 }
}

/// The axes as attributes of a plot, for a script.
pub(super) fn described(x: (&Axis, &Mapping), y: Option<(&Axis, &Mapping)>) -> String {
    let axis = |name: &str, (axis, mapping): (&Axis, &Mapping)| {
        let (title, unit) = (escape(axis.title()), escape(axis.shown_unit(mapping)));
        format!(r#" data-{name}="{}" data-{name}-title="{title}" data-{name}-unit="{unit}""#, mapping.described())
    };
    axis("x", x) + &y.map_or_else(String::new, |y| axis("y", y))
}

/// Draws shades with their labels above `area`, and an interval without a length, a moment, as a stroke. Moments are
/// labelled first. A label that would touch another one is left out.
pub(super) fn draw_shades(svg: &mut Svg, shades: &[Interval], axis: &Axis, x: &Mapping, area: Area) {
    let mut labelled: Vec<(f64, f64)> = Vec::new();
    let (moments, spans): (Vec<&Interval>, Vec<&Interval>) =
        shades.iter().filter(|shade| axis.draws(shade.from) && axis.draws(shade.to)).partition(|s| s.from == s.to);
    for shade in moments.into_iter().chain(spans) {
        let (left, right) = (x.at(shade.from).max(area.left), x.at(shade.to).min(area.right));
        let is_moment = shade.from == shade.to;
        if left > right || (left == right && !is_moment) {
            continue;
        }
        if is_moment {
            svg.rectangle("shade moment", Area { left: left - 1.0, right: left + 1.0, ..area });
        } else {
            svg.rectangle("shade", Area { left, right, ..area });
        }
        let half = text_width(&shade.label) / 2.0;
        let middle = ((left + right) / 2.0).clamp(area.left + half, (area.right - half).max(area.left + half));
        let is_free = |&(from, to): &(f64, f64)| middle + half + 6.0 < from || to < middle - half - 6.0;
        if !shade.label.is_empty() && labelled.iter().all(is_free) {
            svg.text("shade-label", Anchor::Middle, (middle, area.top - 5.0), &shade.label);
            labelled.push((middle - half, middle + half));
        }
    }
}

/// Draws grid, tick labels and title of an x axis below `area`.
pub(super) fn draw_x_axis(svg: &mut Svg, axis: &Axis, x: &Mapping, area: Area) {
    svg.group("ticks-x", |svg| {
        for tick in x.ticks(X_SPACING) {
            let class = if tick.label.is_some() { "grid" } else { "grid minor" };
            svg.line(class, (tick.at, area.top), (tick.at, area.bottom));
            if let Some(label) = tick.label {
                svg.line("axis", (tick.at, area.bottom), (tick.at, area.bottom + 4.0));
                svg.text("tick", Anchor::Middle, (tick.at, area.bottom + 16.0), &label);
            }
        }
    });
    svg.line("axis", (area.left, area.bottom), (area.right, area.bottom));
    svg.text("title", Anchor::End, (area.right, area.bottom + 33.0), &axis.label(x));
}

/// Draws grid, tick labels and, above the frame, the title of a y axis left of `area`.
pub(super) fn draw_y_axis(svg: &mut Svg, title: &str, ticks: &[Tick], area: Area, title_at: f64) {
    svg.group("ticks-y", |svg| {
        for tick in ticks {
            let class = if tick.label.is_some() { "grid" } else { "grid minor" };
            svg.line(class, (area.left, tick.at), (area.right, tick.at));
            if let Some(label) = &tick.label {
                svg.text("tick", Anchor::End, (area.left - 6.0, tick.at + 4.0), label);
            }
        }
    });
    svg.text("title", Anchor::Start, (0.0, title_at), title);
}
