//! The names of drawn items: entries enter; a legend in rows above the frame, or labels at the ends of lines, leave.

use super::{
    Tone,
    path::Point,
    svg::{Anchor, Area, Svg, TEXT_HEIGHT, text_width},
};

const ROW: f64 = 18.0;
const BELOW: f64 = 5.0;
const SWATCH: f64 = 22.0;
const BETWEEN: f64 = 16.0;
const LABEL_PITCH: f64 = TEXT_HEIGHT + 2.0;
const LABEL_OFFSET: f64 = 12.0;
const LABEL_MOST: f64 = 150.0;
/// Factor on the width of labels, because they are bold.
const BOLD: f64 = 1.1;

/// How an entry shows its tone.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Swatch {
    Line,
    Box,
    Band,
    Dot,
    Stroke,
}

/// A name, and the item that it names.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Entry {
    pub name: String,
    pub tone: Tone,
    pub swatch: Swatch,
}

/// A legend laid out in rows.
pub(super) struct Legend {
    placed: Vec<(Point, Entry)>,
    rows: usize,
}

impl Legend {
    /// Lays out `entries` from `left` to `right`, without those that have no name. A new row begins where an entry does
    /// not fit.
    pub fn new(entries: Vec<Entry>, left: f64, right: f64) -> Self {
        let (mut x, mut rows) = (left, 0);
        let mut placed = Vec::new();
        for mut entry in entries.into_iter().filter(|entry| !entry.name.is_empty()) {
            entry.name = shortened(&entry.name, right - left - SWATCH);
            let width = SWATCH + text_width(&entry.name);
            if rows == 0 || x + width > right {
                (x, rows) = (left, rows + 1);
            }
            placed.push(((x, rows as f64 * ROW - ROW / 2.0), entry));
            x += width + BETWEEN;
        }
        Self { placed, rows }
    }

    pub fn height(&self) -> f64 {
        self.rows as f64 * ROW + if self.rows > 0 { BELOW } else { 0.0 }
    }

    /// Draws the rows from the top of the figure down.
    pub fn draw(&self, svg: &mut Svg) {
        for ((x, y), entry) in &self.placed {
            let (x, y, tone) = (*x, *y, entry.tone.class());
            match entry.swatch {
                Swatch::Line => svg.line(&format!("line {tone}"), (x, y), (x + 17.0, y)),
                Swatch::Stroke => svg.line(&format!("rug {tone}"), (x + 8.5, y - 5.0), (x + 8.5, y + 5.0)),
                Swatch::Dot => svg.line(&format!("dots {tone}"), (x + 8.5, y), (x + 8.5, y)),
                Swatch::Box | Swatch::Band => {
                    let kind = if entry.swatch == Swatch::Box { "fill" } else { "band" };
                    let area = Area { left: x + 2.0, top: y - 5.0, right: x + 16.0, bottom: y + 5.0 };
                    svg.rectangle(&format!("{kind} {tone}"), area);
                }
            }
            svg.text("label", Anchor::Start, (x + SWATCH, y + 4.0), &entry.name);
        }
    }
}

/// `text`, cut to about `width` pixels, with an ellipsis if it was cut.
pub(super) fn shortened(text: &str, width: f64) -> String {
    if text_width(text) <= width {
        return text.into();
    }
    let fits = (width / text_width("x")).floor().max(1.0) as usize;
    text.chars().take(fits - 1).chain(['…']).collect()
}

/// The width that labels at the ends of lines need beside the frame.
pub(super) fn label_margin<'a>(names: impl IntoIterator<Item = &'a str>) -> f64 {
    let widest = names.into_iter().map(text_width).fold(0.0, f64::max).min(LABEL_MOST);
    if widest > 0.0 { BOLD * widest + LABEL_OFFSET + 4.0 } else { 0.0 }
}

/// Labels lines at their ends, right of `area`. Each label is as near to its line as the others allow.
pub(super) fn label_ends(svg: &mut Svg, area: Area, mut ends: Vec<(Point, Entry)>) {
    ends.sort_by(|a, b| a.0.1.total_cmp(&b.0.1));
    let desired: Vec<f64> = ends.iter().map(|end| end.0.1.clamp(area.top + 4.0, area.bottom - 2.0)).collect();
    for (((x, y), entry), placed) in ends.into_iter().zip(spread(&desired, area.top + 4.0, area.bottom - 2.0)) {
        let tone = entry.tone.class();
        let y = y.clamp(area.top, area.bottom);
        let turn = area.right + LABEL_OFFSET - 3.0;
        if (y - placed).abs() > 2.0 || x < area.right - 2.0 {
            svg.line("leader", (x, y), (area.right.max(x), y));
            svg.line("leader", (area.right.max(x), y), (turn, placed));
        }
        let at = (area.right + LABEL_OFFSET, placed + 4.0);
        svg.text(&format!("label ink {tone}"), Anchor::Start, at, &shortened(&entry.name, LABEL_MOST));
    }
}

/// Moves ascending positions apart until they are a label's height from one another, within `[top, bottom]` if they
/// fit.
fn spread(desired: &[f64], top: f64, bottom: f64) -> Vec<f64> {
    let mut placed: Vec<f64> = Vec::with_capacity(desired.len());
    for &desired in desired {
        let least = placed.last().map_or(top, |above| above + LABEL_PITCH);
        placed.push(desired.max(least));
    }
    let mut most = bottom;
    for place in placed.iter_mut().rev() {
        *place = place.min(most);
        most = *place - LABEL_PITCH;
    }
    placed
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entry(name: &str) -> Entry {
        Entry { name: name.into(), tone: Tone::Ours, swatch: Swatch::Line }
    }

    #[test]
    fn labels_keep_their_order_and_distance() {
        let placed = spread(&[50.0, 51.0, 51.0, 190.0, 199.0], 0.0, 200.0);
        assert!(placed.windows(2).all(|pair| pair[1] - pair[0] >= LABEL_PITCH - 1e-9), "{placed:?}");
        assert!(placed.iter().all(|place| (0.0..=200.0).contains(place)));
        assert_eq!(spread(&[10.0, 100.0], 0.0, 200.0), [10.0, 100.0]);
    }

    #[test]
    fn a_full_row_breaks() {
        let names = ["constant speed", "constant acceleration", "", "kalman"].map(entry);
        assert_eq!(Legend::new(names.to_vec(), 0.0, 360.0).rows, 2);
        assert_eq!(Legend::new(names.to_vec(), 0.0, 800.0).rows, 1);
        assert_eq!(Legend::new(vec![entry("")], 0.0, 800.0).height(), 0.0);
    }

    #[test]
    fn a_long_name_is_cut_visibly() {
        assert_eq!(shortened("constant acceleration", 64.0), "constant…");
        assert_eq!(shortened("ours", 60.0), "ours");
    }
}
