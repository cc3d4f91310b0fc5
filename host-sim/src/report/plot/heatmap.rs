//! A heat map: rows of shades enter; a grid of cells leaves. A larger value is darker.

use super::{
    Figure, Width,
    svg::{Anchor, Area, Svg},
};

/// A cell.
#[derive(Debug, Clone, PartialEq)]
pub struct Shade {
    /// Depth of the shade, from 0 to 1.
    pub share: f64,
    /// Its text.
    pub label: String,
}

/// A grid of cells with a name for each row and column.
#[derive(Debug, Clone, PartialEq)]
pub struct HeatMap {
    /// What the figure shows, for a screen reader.
    pub title: String,
    /// A description of what it shows, for a screen reader.
    pub description: String,
    /// The names of the columns, from the left.
    pub columns: Vec<String>,
    /// The names of the rows, from the top.
    pub rows: Vec<String>,
    /// The rows of cells.
    pub shades: Vec<Vec<Shade>>,
}

const ROW: f64 = 22.0;
const LEFT: f64 = 58.0;
const TOP: f64 = 20.0;
/// Number of depths of shade.
const DEPTHS: f64 = 8.0;

impl Figure for HeatMap {
    fn draw(&self, id: &str, width: Width) -> String {
        let mut svg = Svg::new(id);
        let pixels = width.pixels();
        let pitch = (pixels - LEFT) / self.columns.len().max(1) as f64;
        for (column, name) in self.columns.iter().enumerate() {
            svg.text("tick", Anchor::Middle, (LEFT + pitch * (column as f64 + 0.5), TOP - 6.0), name);
        }
        for (row, (name, shades)) in self.rows.iter().zip(&self.shades).enumerate() {
            let top = TOP + ROW * row as f64;
            svg.text("tick", Anchor::End, (LEFT - 6.0, top + 15.0), name);
            for (column, shade) in shades.iter().take(self.columns.len()).enumerate() {
                let left = LEFT + pitch * column as f64;
                let area = Area { left, top, right: left + pitch - 1.0, bottom: top + ROW - 1.0 };
                let depth = (shade.share.clamp(0.0, 1.0) * DEPTHS).round();
                svg.rectangle(&format!("heat h{depth}"), area);
                svg.text("value", Anchor::Middle, (left + pitch / 2.0, top + 15.0), &shade.label);
            }
        }
        svg.finish(pixels, TOP + ROW * self.rows.len() as f64 + 4.0, &self.title, &self.description)
    }

    fn undrawable(&self) -> usize {
        self.shades.iter().flatten().filter(|shade| !shade.share.is_finite()).count()
    }
}
