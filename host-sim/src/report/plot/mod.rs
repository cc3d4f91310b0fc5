//! Figures as inline SVG: named data enter; one `<svg>` element leaves, at one of three widths.
//!
//! A page shows the broad drawing on a large screen, the wide one on a small one and on paper, and the narrow one on a phone, so that the
//! letters keep their size. Colour, weight and dashes come from classes, which the page's style defines for a light and a dark appearance.
//!
//! | figure | for |
//! |---|---|
//! | [`Chart`] | lines, bands, dots, rugs and histogram columns over numeric axes, linear or logarithmic |
//! | [`Strip`] | categories over time, a row for each subject |
//! | [`Map`] | vehicles on their roads, which a script plays |
//! | [`Bars`] | numbers of several methods side by side, in groups |
//!
//! A value that is not finite (or not positive, on a logarithmic axis) is never drawn. It interrupts a line, and
//! [`Figure::undrawable`] counts it, so that the page can report it.

mod bars;
mod chart;
mod data;
mod frame;
mod heatmap;
mod layer;
mod legend;
mod map;
mod path;
mod scale;
mod strip;
mod svg;

pub use bars::Bars;
pub use chart::{Chart, Guide};
pub use data::{Bin, cumulative, histogram};
pub use heatmap::{HeatMap, Shade};
pub use layer::Layer;
pub use map::{Map, Mover};
pub use scale::Axis;
pub use strip::{Category, Strip, StripRow};

/// A named series of `(x, y)` points.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Series {
    /// Its name in a legend or label.
    pub name: String,
    /// The points; lines follow their order.
    pub points: Vec<(f64, f64)>,
    /// Points that are farther apart on x are not joined, because data are missing between them; `None`: all are joined.
    pub joined_within: Option<f64>,
}

impl Series {
    /// A series of `points` called `name`.
    pub fn new(name: impl Into<String>, points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        Self { name: name.into(), points: points.into_iter().collect(), joined_within: None }
    }

    /// The same, and points that are farther apart on x than this are not joined.
    #[must_use]
    pub fn joined_within(self, apart: f64) -> Self {
        Self { joined_within: Some(apart), ..self }
    }

    /// The points with a `None` wherever the line is interrupted for want of data.
    pub(super) fn runs(&self) -> Vec<Option<(f64, f64)>> {
        let apart = self.joined_within.unwrap_or(f64::INFINITY);
        let mut runs = Vec::with_capacity(self.points.len());
        for (index, point) in self.points.iter().enumerate() {
            if index > 0 && (point.0 - self.points[index - 1].0).abs() > apart {
                runs.push(None);
            }
            runs.push(Some(*point));
        }
        runs
    }

    /// The ordinates, in order.
    pub fn values(&self) -> Vec<f64> {
        self.points.iter().map(|point| point.1).collect()
    }
}

/// A labelled interval of x, drawn as a shade: a silence of the link. One without a length is a moment: a collision.
#[derive(Debug, Clone, PartialEq)]
pub struct Interval {
    /// Where it begins.
    pub from: f64,
    /// Where it ends.
    pub to: f64,
    /// Its name, shown above the frame where there is room.
    pub label: String,
}

impl Interval {
    /// The interval `[from, to]` called `label`.
    pub fn new(from: f64, to: f64, label: impl Into<String>) -> Self {
        Self { from, to, label: label.into() }
    }
}

/// The meaning of a mark. The page's style decides how it looks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Tone {
    /// The vehicle under study: dark red, dashed.
    Ego,
    /// The unit's result.
    Ours,
    /// The literal paper's result.
    Paper,
    /// One of seven other colours that colour-blind readers can tell apart. The colours repeat after that.
    Other(usize),
    /// Regular operation.
    Calm,
    /// Operation on an estimate.
    Alert,
    /// Something lost or failed.
    Alarm,
    /// No operation.
    Idle,
}

impl Tone {
    /// The class of this tone in the page's style.
    pub fn class(self) -> &'static str {
        const OTHERS: [&str; 7] = ["o0", "o1", "o2", "o3", "o4", "o5", "o6"];
        match self {
            Self::Ego => "ego",
            Self::Ours => "ours",
            Self::Paper => "paper",
            Self::Other(index) => OTHERS[index % OTHERS.len()],
            Self::Calm => "calm",
            Self::Alert => "alert",
            Self::Alarm => "alarm",
            Self::Idle => "idle",
        }
    }
}

/// The width of a figure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Width {
    /// A large screen.
    Broad,
    /// A small screen or a printed page.
    Wide,
    /// A phone held upright.
    Narrow,
}

impl Width {
    /// The width in pixels.
    pub fn pixels(self) -> f64 {
        match self {
            Self::Broad => 1100.0,
            Self::Wide => 820.0,
            Self::Narrow => 380.0,
        }
    }

    /// The class of the element that shows this drawing.
    pub fn class(self) -> &'static str {
        match self {
            Self::Broad => "broad",
            Self::Wide => "wide",
            Self::Narrow => "narrow",
        }
    }
}

/// A figure that can be drawn.
pub trait Figure {
    /// The `<svg>` element at `width`. `id` has to be unique on the page; every id inside starts with it.
    fn draw(&self, id: &str, width: Width) -> String;

    /// The number of values that cannot be drawn.
    fn undrawable(&self) -> usize;
}
