//! The SVG writer: shapes in pixels enter; one element with title and description leaves.

use std::fmt::Write;

use crate::report::markup::escape;

/// Height of a line of text in a figure, in pixels.
pub(super) const TEXT_HEIGHT: f64 = 12.0;

/// An upper estimate of the width of `text`, in pixels, because fonts differ.
pub(super) fn text_width(text: &str) -> f64 {
    7.0 * text.chars().count() as f64
}

/// The position of a text relative to its own coordinate.
#[derive(Debug, Clone, Copy)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

impl Anchor {
    fn keyword(self) -> &'static str {
        match self {
            Self::Start => "start",
            Self::Middle => "middle",
            Self::End => "end",
        }
    }
}

/// A rectangle in pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Area {
    pub left: f64,
    pub top: f64,
    pub right: f64,
    pub bottom: f64,
}

impl Area {
    pub fn width(&self) -> f64 {
        self.right - self.left
    }

    pub fn height(&self) -> f64 {
        self.bottom - self.top
    }
}

/// An SVG element that is built shape by shape.
pub(super) struct Svg {
    id: String,
    body: String,
}

/// `value` in pixels to a tenth, in its shortest form.
pub(super) fn pixel(value: f64) -> String {
    let tenths = (value * 10.0).round() as i64;
    match (tenths / 10, (tenths % 10).abs()) {
        (whole, 0) => whole.to_string(),
        (0, tenth) if tenths < 0 => format!("-.{tenth}"),
        (0, tenth) => format!(".{tenth}"),
        (whole, tenth) => format!("{whole}.{tenth}"),
    }
}

/// The same to a hundredth, for what is looked at more closely.
pub(super) fn fine(value: f64) -> String {
    let hundredths = (value * 100.0).round() as i64;
    if hundredths % 10 == 0 {
        return pixel(value);
    }
    let (whole, rest) = (hundredths.abs() / 100, hundredths.abs() % 100);
    let sign = if hundredths < 0 { "-" } else { "" };
    if whole == 0 { format!("{sign}.{rest:02}") } else { format!("{sign}{whole}.{rest:02}") }
}

impl Svg {
    pub fn new(id: &str) -> Self {
        Self { id: escape(id), body: String::new() }
    }

    // Writing to a String cannot fail, so the results of `write!` below are ignored.

    pub fn rectangle(&mut self, class: &str, area: Area) {
        let (x, y) = (pixel(area.left), pixel(area.top));
        let (width, height) = (pixel(area.width().max(0.0)), pixel(area.height().max(0.0)));
        let _ = writeln!(self.body, r#"<rect class="{class}" x="{x}" y="{y}" width="{width}" height="{height}"/>"#);
    }

    /// A rectangle that says `told` to a pointer that rests on it.
    pub fn telling(&mut self, class: &str, area: Area, told: &str) {
        self.rectangle(class, area);
        let end = self.body.trim_end().len() - "/>".len();
        self.body.truncate(end);
        let _ = writeln!(self.body, "><title>{}</title></rect>", escape(told));
    }

    /// A straight line from `a` to `b`.
    pub fn line(&mut self, class: &str, a: (f64, f64), b: (f64, f64)) {
        self.path(class, &format!("M{},{}L{},{}", pixel(a.0), pixel(a.1), pixel(b.0), pixel(b.1)));
    }

    /// A path with the given data; an empty one draws nothing.
    pub fn path(&mut self, class: &str, data: &str) {
        if !data.is_empty() {
            let _ = writeln!(self.body, r#"<path class="{class}" d="{data}"/>"#);
        }
    }

    /// A path that a script reads values from, by this name.
    pub fn named_path(&mut self, class: &str, name: &str, data: &str) {
        if !data.is_empty() {
            let _ = writeln!(self.body, r#"<path class="{class}" d="{data}" data-name="{}"/>"#, escape(name));
        }
    }

    /// A dot that a script moves along `way`, hidden where it is not `shown`.
    pub fn mover(&mut self, class: &str, shown: Option<(f64, f64)>, radius: f64, from: f64, way: &str) {
        let at = match shown {
            Some((x, y)) => format!(r#"cx="{}" cy="{}""#, pixel(x), pixel(y)),
            None => r#"style="display:none""#.to_owned(),
        };
        let data = format!(r#"r="{radius}" data-from="{from:.2}" data-way="{way}""#);
        let _ = writeln!(self.body, r#"<circle class="{class}" {at} {data}/>"#);
    }

    /// A group of this class with what `content` draws.
    pub fn group(&mut self, class: &str, content: impl FnOnce(&mut Self)) {
        let _ = writeln!(self.body, r#"<g class="{class}">"#);
        content(self);
        self.body.push_str("</g>\n");
    }

    /// `text`, which is escaped here, with its baseline at `y`.
    pub fn text(&mut self, class: &str, anchor: Anchor, (x, y): (f64, f64), text: &str) {
        let (x, y, anchor, text) = (pixel(x), pixel(y), anchor.keyword(), escape(text));
        let _ = writeln!(self.body, r#"<text class="{class}" x="{x}" y="{y}" text-anchor="{anchor}">{text}</text>"#);
    }

    /// Draws the data, `content`, cut off half a dot beyond the edge of `area`, so that marks on its edges are not cut. A
    /// script finds in `axes` what the axes mean, as attributes.
    pub fn plot(&mut self, area: Area, axes: &str, content: impl FnOnce(&mut Self)) {
        let id = &self.id;
        let _ = write!(self.body, r#"<clipPath id="{id}-clip">"#);
        self.rectangle("clip", Area { left: area.left - 3.0, right: area.right + 3.0, ..area });
        let [left, top, right, bottom] = [area.left, area.top, area.right, area.bottom].map(pixel);
        let _ = write!(
            self.body,
            r#"</clipPath><g class="plot" data-area="{left} {top} {right} {bottom}"{axes} clip-path="url(#{}-clip)">"#,
            self.id
        );
        content(self);
        self.body.push_str("</g>\n");
    }

    /// The finished element of `width` by `height` pixels, with the title and the description for a screen reader.
    pub fn finish(self, width: f64, height: f64, title: &str, description: &str) -> String {
        let Self { id, body } = self;
        let (width, height) = (pixel(width), pixel(height));
        let (title, description) = (escape(title), escape(description));
        format!(
            concat!(
                r#"<svg xmlns="http://www.w3.org/2000/svg" id="{id}" role="img" viewBox="0 0 {width} {height}" "#,
                r#"aria-labelledby="{id}-title" aria-describedby="{id}-desc">"#,
                "\n",
                r#"<title id="{id}-title">{title}</title><desc id="{id}-desc">{description}</desc>"#,
                "\n{body}</svg>\n"
            ),
            id = id,
            width = width,
            height = height,
            title = title,
            description = description,
            body = body
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_are_spelled_shortly() {
        for (value, expected) in
            [(0.0, "0"), (-0.04, "0"), (0.25, ".3"), (-0.25, "-.3"), (12.0, "12"), (-3.12, "-3.1"), (99.96, "100")]
        {
            assert_eq!(pixel(value), expected);
        }
        for (value, expected) in [
            (0.0, "0"),
            (-0.004, "0"),
            (0.25, ".25"),
            (-0.25, "-.25"),
            (-0.5, "-.5"),
            (12.0, "12"),
            (-3.124, "-3.12"),
            (99.996, "100"),
        ] {
            assert_eq!(fine(value), expected);
        }
    }
}
