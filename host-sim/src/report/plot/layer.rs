//! The shapes of a [`Chart`](super::Chart): data and a frame's mappings enter, SVG shapes leave.

use super::{
    Bin, Series, Tone,
    legend::{Entry, Swatch},
    path::{self, Point},
    scale::{Axis, Extent, Mapping},
    svg::{Area, Svg},
};
use crate::report::markup::significant;

/// One item of a chart. A layer without a name has no entry in the legend.
#[derive(Debug, Clone, PartialEq)]
pub enum Layer {
    /// A line through the points in their order. `marked` adds a dot at each point, for series of few points.
    Line {
        /// The points.
        series: Series,
        /// Its meaning.
        tone: Tone,
        /// Whether each point has a dot.
        marked: bool,
    },
    /// The area between two lines: a bound, or the spread over many runs.
    Band {
        /// Its name.
        name: String,
        /// `(x, lower, upper)`.
        edges: Vec<(f64, f64, f64)>,
        /// Its meaning.
        tone: Tone,
    },
    /// A dot at each point.
    Dots {
        /// The points.
        series: Series,
        /// Its meaning.
        tone: Tone,
    },
    /// A short stroke at the bottom of the frame for each x: events.
    Rug {
        /// Its name.
        name: String,
        /// The x of each event.
        at: Vec<f64>,
        /// Its meaning.
        tone: Tone,
    },
    /// The columns of a histogram, on the x axis.
    Columns {
        /// Its name.
        name: String,
        /// The bins.
        bins: Vec<Bin>,
        /// Its meaning.
        tone: Tone,
    },
}

impl Layer {
    /// A plain line.
    pub fn line(series: Series, tone: Tone) -> Self {
        Self::Line { series, tone, marked: false }
    }

    pub(super) fn entry(&self) -> Entry {
        let (name, tone, swatch) = match self {
            Self::Line { series, tone, .. } => (&series.name, *tone, Swatch::Line),
            Self::Band { name, tone, .. } => (name, *tone, Swatch::Band),
            Self::Dots { series, tone } => (&series.name, *tone, Swatch::Dot),
            Self::Rug { name, tone, .. } => (name, *tone, Swatch::Stroke),
            Self::Columns { name, tone, .. } => (name, *tone, Swatch::Box),
        };
        Entry { name: name.clone(), tone, swatch }
    }

    /// The coordinates of every mark; a mark without a y, as in a rug, has `None`.
    fn coordinates(&self) -> Vec<(f64, Option<f64>)> {
        match self {
            Self::Line { series, .. } | Self::Dots { series, .. } => {
                series.points.iter().map(|&(x, y)| (x, Some(y))).collect()
            }
            Self::Band { edges, .. } => {
                edges.iter().flat_map(|&(x, low, high)| [(x, Some(low)), (x, Some(high))]).collect()
            }
            Self::Rug { at, .. } => at.iter().map(|&x| (x, None)).collect(),
            Self::Columns { bins, .. } => {
                bins.iter().flat_map(|bin| [(bin.from, Some(0.0)), (bin.to, Some(bin.count as f64))]).collect()
            }
        }
    }

    /// Widens the extents by the values of this layer that the axes can show.
    pub(super) fn cover(&self, axes: (&Axis, &Axis), x: &mut Extent, y: &mut Extent) {
        for (across, up) in self.coordinates() {
            if axes.0.draws(across) && up.is_none_or(|up| axes.1.draws(up)) {
                x.include(across);
                up.into_iter().for_each(|up| y.include(up));
            }
        }
    }

    pub(super) fn undrawable(&self, axes: (&Axis, &Axis)) -> usize {
        let drawn = |(x, y): &(f64, Option<f64>)| axes.0.draws(*x) && y.is_none_or(|y| axes.1.draws(y));
        self.coordinates().iter().filter(|coordinate| !drawn(coordinate)).count()
    }

    /// The end of a line, for the label there.
    pub(super) fn end(&self, axes: (&Axis, &Axis), x: &Mapping, y: &Mapping) -> Option<Point> {
        let Self::Line { series, .. } = self else { return None };
        let last = series.points.iter().rev().find(|(across, up)| axes.0.draws(*across) && axes.1.draws(*up))?;
        Some((x.at(last.0), y.at(last.1)))
    }

    pub(super) fn draw(&self, svg: &mut Svg, axes: (&Axis, &Axis), x: &Mapping, y: &Mapping, area: Area) {
        let place =
            |&(across, up): &(f64, f64)| (axes.0.draws(across) && axes.1.draws(up)).then(|| (x.at(across), y.at(up)));
        match self {
            Self::Line { series, tone, marked } => {
                svg.named_path(
                    &format!("line {}", tone.class()),
                    &series.name,
                    &path::line(series.runs().iter().map(|point| place(point.as_ref()?))),
                );
                if *marked {
                    svg.path(
                        &format!("dots big {}", tone.class()),
                        &path::dots(series.points.iter().filter_map(place)),
                    );
                }
            }
            Self::Dots { series, tone } => {
                svg.named_path(
                    &format!("dots {}", tone.class()),
                    &series.name,
                    &path::dots(series.points.iter().filter_map(place)),
                );
            }
            Self::Band { name, edges, tone } => {
                let edge = |&(across, low, high): &(f64, f64, f64)| {
                    let drawn = axes.0.draws(across) && axes.1.draws(low) && axes.1.draws(high);
                    drawn.then(|| (x.at(across), y.at(low), y.at(high)))
                };
                svg.named_path(&format!("band {}", tone.class()), name, &path::band(edges.iter().map(edge)));
            }
            Self::Rug { at, tone, .. } => {
                let mut pixels: Vec<i64> =
                    at.iter().filter(|at| axes.0.draws(**at)).map(|&at| half(x.at(at))).collect();
                pixels.dedup();
                let stroke = |&at: &i64| format!("M{},{:.0}v-10", at as f64 / 2.0, area.bottom);
                svg.path(&format!("rug {}", tone.class()), &pixels.iter().map(stroke).collect::<String>());
            }
            Self::Columns { bins, tone, .. } => {
                for bin in bins.iter().filter(|bin| bin.count > 0 && axes.0.draws(bin.from) && axes.0.draws(bin.to)) {
                    let top = y.at(bin.count as f64).min(area.bottom);
                    let (left, right) = (x.at(bin.from) + 0.5, x.at(bin.to) - 0.5);
                    let column = Area { left, top, right: right.max(left + 0.5), bottom: area.bottom };
                    let told = format!("{} to {}: {}", short(bin.from), short(bin.to), bin.count);
                    svg.telling(&format!("fill {}", tone.class()), column, &told);
                }
            }
        }
    }
}

/// `value` as a pointer is told.
fn short(value: f64) -> String {
    significant(value, 3)
}

/// `value` in half pixels. Strokes that are nearer to one another than that count as one.
fn half(value: f64) -> i64 {
    (value * 2.0).round() as i64
}
