//! A chart over two numeric axes: layers, shades and guides enter, an `<svg>` element leaves.

use super::{
    Figure, Interval, Layer, Tone, Width,
    frame::{self, BELOW, TITLE_ROW, Y_SPACING},
    legend::{self, Legend, Swatch},
    scale::{Axis, Extent},
    svg::{Anchor, Area, Svg, TEXT_HEIGHT},
};

/// The most labels at the ends of lines. More cannot be told apart, so a legend replaces them.
const MOST_END_LABELS: usize = 9;

/// A horizontal line at a meaningful value: a limit, a quantile.
#[derive(Debug, Clone, PartialEq)]
pub struct Guide {
    /// The value on the y axis.
    pub at: f64,
    /// Its meaning.
    pub label: String,
}

/// Layers over two numeric axes. Later layers lie on top, and those of the ego above all.
#[derive(Debug, Clone, PartialEq)]
pub struct Chart {
    /// What the figure shows, for a screen reader.
    pub title: String,
    /// A description of what it shows, for a screen reader.
    pub description: String,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// Height of the frame in pixels.
    pub height: f64,
    /// Shaded intervals of x, in order.
    pub shades: Vec<Interval>,
    /// Horizontal lines behind the data.
    pub guides: Vec<Guide>,
    /// The data.
    pub layers: Vec<Layer>,
    /// Whether all names are in the legend, as for lines that end in the middle.
    pub listed: bool,
}

impl Chart {
    /// An empty chart of the usual height.
    pub fn new(title: impl Into<String>, x: Axis, y: Axis) -> Self {
        let (shades, guides, layers) = (Vec::new(), Vec::new(), Vec::new());
        Self {
            title: title.into(),
            description: String::new(),
            x,
            y,
            height: 230.0,
            shades,
            guides,
            layers,
            listed: false,
        }
    }

    fn axes(&self) -> (&Axis, &Axis) {
        (&self.x, &self.y)
    }

    fn extents(&self) -> (Extent, Extent) {
        let (mut x, mut y) = (Extent::EMPTY, Extent::EMPTY);
        self.layers.iter().for_each(|layer| layer.cover(self.axes(), &mut x, &mut y));
        if !y.is_empty() {
            self.guides.iter().filter(|guide| self.y.draws(guide.at)).for_each(|guide| y.include(guide.at));
        }
        (x, y)
    }

    /// Whether lines are labelled at their ends, which they are if there is room. All other names are in the legend.
    fn labels_ends(&self, width: Width) -> bool {
        let lines = self.layers.iter().filter(|l| l.entry().swatch == Swatch::Line && !l.entry().name.is_empty());
        !self.listed && width != Width::Narrow && lines.count() <= MOST_END_LABELS
    }
}

impl Figure for Chart {
    fn draw(&self, id: &str, width: Width) -> String {
        let mut svg = Svg::new(id);
        let pixels = width.pixels();
        let (x_extent, y_extent) = self.extents();

        let at_end = self.labels_ends(width);
        let (ends, listed): (Vec<&Layer>, Vec<&Layer>) =
            self.layers.iter().partition(|layer| at_end && layer.entry().swatch == Swatch::Line);
        let legend = Legend::new(listed.iter().map(|layer| layer.entry()).collect(), 0.0, pixels);

        let top = legend.height() + TITLE_ROW + frame::shade_row(&self.shades);
        let bottom = top + self.height;
        let y = self.y.fit(y_extent, (bottom, top), 0.06);
        let y_ticks = y.ticks(Y_SPACING);
        let names: Vec<String> = ends.iter().map(|layer| layer.entry().name).filter(|name| !name.is_empty()).collect();
        let right = frame::right_margin(legend::label_margin(names.iter().map(String::as_str)), width);
        let left = frame::left_margin(frame::labels(&y_ticks), width);
        let area = Area { left, top, right: pixels - right, bottom };
        let x = self.x.fit(x_extent, (area.left, area.right), 0.0);

        legend.draw(&mut svg);
        frame::draw_shades(&mut svg, &self.shades, &self.x, &x, area);
        frame::draw_y_axis(&mut svg, &self.y.label(&y), &y_ticks, area, legend.height() + 12.0);
        frame::draw_x_axis(&mut svg, &self.x, &x, area);
        svg.plot(area, &frame::described((&self.x, &x), Some((&self.y, &y))), |svg| {
            for guide in self.guides.iter().filter(|guide| self.y.draws(guide.at)) {
                svg.line("guide", (area.left, y.at(guide.at)), (area.right, y.at(guide.at)));
            }
            // A stable order: the vehicle under study last, all others as given.
            let mut layers: Vec<&Layer> = self.layers.iter().collect();
            layers.sort_by_key(|layer| layer.entry().tone == Tone::Ego);
            layers.into_iter().for_each(|layer| layer.draw(svg, self.axes(), &x, &y, area));
        });
        // A label that would lie on another one is left out.
        let mut labelled: Vec<f64> = Vec::new();
        for guide in self.guides.iter().filter(|guide| self.y.draws(guide.at)) {
            let at = y.at(guide.at);
            if (area.top - 0.5..=area.bottom + 0.5).contains(&at) {
                let baseline = if at - area.top < 14.0 { at + 12.0 } else { at - 4.0 };
                if !guide.label.is_empty() && labelled.iter().all(|other| (other - baseline).abs() > TEXT_HEIGHT + 2.0)
                {
                    svg.text("guide-label", Anchor::Start, (area.left + 6.0, baseline), &guide.label);
                    labelled.push(baseline);
                }
            }
        }
        let ends = ends.iter().filter(|layer| !layer.entry().name.is_empty());
        let ends = ends.filter_map(|layer| Some((layer.end(self.axes(), &x, &y)?, layer.entry()))).collect();
        legend::label_ends(&mut svg, area, ends);
        if x_extent.is_empty() {
            let middle = ((area.left + area.right) / 2.0, (area.top + area.bottom) / 2.0 + 4.0);
            svg.text("empty", Anchor::Middle, middle, "no data");
        }
        svg.finish(pixels, bottom + BELOW, &self.title, &self.description)
    }

    fn undrawable(&self) -> usize {
        self.layers.iter().map(|layer| layer.undrawable(self.axes())).sum()
    }
}
