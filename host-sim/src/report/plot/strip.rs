//! A strip of categories over time: the changes of each subject enter, coloured spans leave.

use super::{
    Figure, Interval, Tone, Width,
    frame::{self, BELOW},
    legend::{Entry, Legend, Swatch, shortened},
    scale::{Axis, Extent, Mapping},
    svg::{Anchor, Area, Svg, pixel},
};

const ROW: f64 = 26.0;
const ROW_LABEL_MOST: f64 = 110.0;

/// Least width of a span in pixels, so that a short one is still visible.
const NARROWEST: f64 = 0.8;

/// A category with its meaning.
#[derive(Debug, Clone, PartialEq)]
pub struct Category {
    /// Its name.
    pub name: String,
    /// Its meaning.
    pub tone: Tone,
}

/// One subject's categories over time.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct StripRow {
    /// The subject.
    pub name: String,
    /// `(from, index into the strip's categories)`, in order. Each holds until the next change, the last one until the
    /// end of the strip. Successive entries with the same category, as in a sample per tick, count as one.
    pub changes: Vec<(f64, usize)>,
}

/// Categories over x, a row for each subject.
#[derive(Debug, Clone, PartialEq)]
pub struct Strip {
    /// What the figure shows, for a screen reader.
    pub title: String,
    /// A description of what it shows, for a screen reader.
    pub description: String,
    /// The horizontal axis.
    pub x: Axis,
    /// The end of the last spans.
    pub end: f64,
    /// Shaded intervals of x, in order.
    pub shades: Vec<Interval>,
    /// The categories, from the most ordinary to the most severe. Where spans are too narrow to be drawn apart, the
    /// more severe one is drawn.
    pub categories: Vec<Category>,
    /// The subjects, from top to bottom.
    pub rows: Vec<StripRow>,
}

impl StripRow {
    /// The spans `(from, to, category)` up to `end`.
    pub fn spans(&self, end: f64) -> Vec<(f64, f64, usize)> {
        let mut spans: Vec<(f64, f64, usize)> = Vec::new();
        for &(from, category) in self.changes.iter().filter(|change| change.0.is_finite()) {
            match spans.last_mut() {
                Some(last) if last.2 == category => continue,
                Some(last) => last.1 = from,
                None => {}
            }
            spans.push((from, end, category));
        }
        spans.retain(|span| span.0 < span.1);
        spans
    }
}

impl Figure for Strip {
    fn draw(&self, id: &str, width: Width) -> String {
        let mut svg = Svg::new(id);
        let pixels = width.pixels();
        let entry = |c: &Category| Entry { name: c.name.clone(), tone: c.tone, swatch: Swatch::Box };
        let legend = Legend::new(self.categories.iter().map(entry).collect(), 0.0, pixels);
        let top = legend.height() + 6.0 + frame::shade_row(&self.shades);
        let bottom = top + ROW * self.rows.len().max(1) as f64;
        let names: Vec<String> = self.rows.iter().map(|row| shortened(&row.name, ROW_LABEL_MOST)).collect();
        let left = frame::left_margin(names.iter().map(String::as_str), width);
        let area = Area { left, top, right: pixels - frame::right_margin(0.0, width), bottom };
        let mut extent = Extent::EMPTY;
        let starts = self.rows.iter().flat_map(|row| row.changes.iter().map(|change| change.0));
        starts.chain([self.end]).filter(|x| self.x.draws(*x)).for_each(|x| extent.include(x));
        let x = self.x.fit(extent, (area.left, area.right), 0.0);

        legend.draw(&mut svg);
        frame::draw_shades(&mut svg, &self.shades, &self.x, &x, area);
        frame::draw_x_axis(&mut svg, &self.x, &x, area);
        for (index, name) in names.iter().enumerate() {
            let line = top + ROW * index as f64;
            svg.text("label", Anchor::End, (area.left - 8.0, line + ROW / 2.0 + 4.0), name);
        }
        svg.plot(area, &frame::described((&self.x, &x), None), |svg| self.draw_spans(svg, area, &x));
        if self.rows.iter().all(|row| row.changes.is_empty()) {
            let middle = ((area.left + area.right) / 2.0, (top + bottom) / 2.0 + 4.0);
            svg.text("empty", Anchor::Middle, middle, "no data");
        }
        svg.finish(pixels, bottom + BELOW, &self.title, &self.description)
    }

    fn undrawable(&self) -> usize {
        let changes = self.rows.iter().flat_map(|row| &row.changes);
        changes.filter(|change| !self.x.draws(change.0) || change.1 >= self.categories.len()).count()
    }
}

impl Strip {
    fn draw_spans(&self, svg: &mut Svg, area: Area, x: &Mapping) {
        for (index, row) in self.rows.iter().enumerate() {
            let line = area.top + ROW * index as f64;
            let spans = row.spans(self.end);
            for (number, category) in self.categories.iter().enumerate() {
                let mut data: Vec<String> = Vec::new();
                for (from, to, _) in spans.iter().filter(|s| s.2 == number && self.x.draws(s.0) && self.x.draws(s.1)) {
                    let (left, right) = (x.at(*from).max(area.left), x.at(*to).min(area.right));
                    let (wide, high) = (pixel((right - left).max(NARROWEST)), pixel(ROW - 8.0));
                    let drawn = format!("M{},{}h{wide}v{high}h-{wide}z", pixel(left), pixel(line + 4.0));
                    if right > area.left && data.last() != Some(&drawn) {
                        data.push(drawn);
                    }
                }
                let name = format!("{}: {}", row.name, category.name);
                svg.named_path(&format!("fill {}", category.tone.class()), &name, &data.concat());
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_samples_make_one_span() {
        let changes = vec![(0.0, 0), (0.1, 0), (0.2, 1), (f64::NAN, 2), (0.3, 1), (0.4, 0)];
        let row = StripRow { name: String::new(), changes };
        assert_eq!(row.spans(1.0), [(0.0, 0.2, 0), (0.2, 0.4, 1), (0.4, 1.0, 0)]);
        assert!(StripRow::default().spans(1.0).is_empty());
    }

    #[test]
    fn a_change_at_the_end_lasts_no_time() {
        let row = StripRow { name: String::new(), changes: vec![(0.0, 0), (1.0, 1)] };
        assert_eq!(row.spans(1.0), [(0.0, 1.0, 0)]);
    }
}
