//! The HTML page: headings, tables, prose and figures enter in order, one self-contained document leaves.
//!
//! The document is well-formed XML as well as HTML, so that any parser can check it. Its script adds values under the
//! pointer, zoom and a map that plays; without it everything is there to be read.

use std::fmt::Write;

use crate::provenance::VERSION;

use super::{
    markup::{count, escape},
    plot::{Figure, Width},
};

/// From so many columns on a table is set smaller.
const MANY_COLUMNS: usize = 7;

/// From so many columns on a row is a block of its own on a phone.
const STACKED_COLUMNS: usize = 4;

/// From so many sections on a page has a list of contents.
const LISTED_SECTIONS: usize = 3;

const STYLE: &str = include_str!("style.css");

const SCRIPT: &str = include_str!("script.js");

/// One cell of a table.
#[derive(Debug, Clone, PartialEq)]
pub struct Cell {
    text: String,
    class: &'static str,
}

impl Cell {
    /// Text, aligned left.
    pub fn text(text: impl Into<String>) -> Self {
        Self { text: text.into(), class: "" }
    }

    /// A number, aligned right.
    pub fn number(text: impl Into<String>) -> Self {
        Self { text: text.into(), class: "number" }
    }

    /// A number that is emphasised.
    pub fn strong(text: impl Into<String>) -> Self {
        Self { text: text.into(), class: "number strong" }
    }

    /// A limit that was met or missed.
    pub fn limit(text: impl Into<String>, met: bool) -> Self {
        Self { text: text.into(), class: if met { "met" } else { "missed" } }
    }

    /// A number that meets or misses a limit.
    pub fn judged(text: impl Into<String>, met: bool) -> Self {
        Self { text: text.into(), class: if met { "number met" } else { "number missed" } }
    }
}

/// A page that is built from top to bottom.
pub struct Page {
    title: String,
    head: String,
    warnings: String,
    body: String,
    sections: Vec<String>,
    figures: usize,
}

impl Page {
    /// A page with this title. The `kicker` above it names the kind of page.
    pub fn new(kicker: &str, title: &str) -> Self {
        let head = format!("<p class=\"kicker\">{}</p>\n<h1>{}</h1>\n", escape(kicker), escape(title));
        Self {
            title: title.into(),
            head,
            warnings: String::new(),
            body: String::new(),
            sections: Vec::new(),
            figures: 0,
        }
    }

    // Writing to a String cannot fail, so the results of `write!` below are ignored.

    /// The verdict with its reasons.
    pub fn verdict(&mut self, passed: bool, reasons: &[String]) {
        let (class, word) = if passed { ("passed", "Passed") } else { ("failed", "Failed") };
        let _ = write!(self.body, "<div class=\"verdict {class}\"><b>{word}</b>");
        match reasons {
            [] => {}
            [only] => {
                let _ = write!(self.body, "<p>{}</p>", escape(only));
            }
            several => {
                self.body.push_str("<ul>");
                several.iter().for_each(|reason| self.item(reason));
                self.body.push_str("</ul>");
            }
        }
        self.body.push_str("</div>\n");
    }

    /// What there is to say of the input. It stands above everything but the title.
    pub fn warn(&mut self, warnings: &[String]) {
        if warnings.is_empty() {
            return;
        }
        let items: String = warnings.iter().map(|warning| format!("<li>{}</li>", escape(warning))).collect();
        let _ = writeln!(self.warnings, "<div class=\"verdict warned\"><b>Warning</b><ul>{items}</ul></div>");
    }

    /// A heading.
    pub fn section(&mut self, title: &str) {
        self.sections.push(title.to_owned());
        let _ = writeln!(self.body, "<h2 id=\"section-{}\">{}</h2>", self.sections.len(), escape(title));
    }

    /// A paragraph.
    pub fn paragraph(&mut self, text: &str) {
        let _ = writeln!(self.body, "<p>{}</p>", escape(text));
    }

    /// A bulleted list.
    pub fn list(&mut self, items: &[String]) {
        self.body.push_str("<ul>");
        items.iter().for_each(|item| self.item(item));
        self.body.push_str("</ul>\n");
    }

    fn item(&mut self, text: &str) {
        let _ = write!(self.body, "<li>{}</li>", escape(text));
    }

    /// A command line, to be copied.
    pub fn command(&mut self, command: &str) {
        let _ = writeln!(self.body, "<pre><code>{}</code></pre>", escape(command));
    }

    /// Names with their values.
    pub fn facts(&mut self, facts: &[(String, String)]) {
        self.body.push_str("<dl>");
        for (name, value) in facts {
            let _ = write!(self.body, "<div><dt>{}</dt><dd>{}</dd></div>", escape(name), escape(value));
        }
        self.body.push_str("</dl>\n");
    }

    /// A table. The first cell of each row is its heading. A column is aligned like its cell in the first row.
    pub fn table(&mut self, caption: &str, header: &[&str], rows: &[Vec<Cell>]) {
        // A table of many columns is set smaller, so that all of them are seen on a screen and on paper.
        let class = match header.len() {
            MANY_COLUMNS.. => " class=\"many stacked\"",
            STACKED_COLUMNS.. => " class=\"stacked\"",
            _ => "",
        };
        let caption = escape(caption);
        let _ = write!(self.body, "<div class=\"scroll\"><table{class}><caption>{caption}</caption><thead><tr>");
        for (index, name) in header.iter().enumerate() {
            let number = rows.first().and_then(|row| row.get(index)).is_some_and(|c| c.class.starts_with("number"));
            let class = if number { " class=\"number\"" } else { "" };
            let _ = write!(self.body, "<th scope=\"col\"{class}>{}</th>", escape(name));
        }
        self.body.push_str("</tr></thead>\n<tbody>\n");
        for row in rows {
            self.body.push_str("<tr>");
            for (index, cell) in row.iter().enumerate() {
                let (open, close) = if index == 0 { ("th scope=\"row\"", "th") } else { ("td", "td") };
                let class = if cell.class.is_empty() { String::new() } else { format!(" class=\"{}\"", cell.class) };
                // Where a row is a block, each cell says what it is.
                let label = header.get(index).filter(|label| !label.is_empty() && header.len() >= STACKED_COLUMNS);
                let label = label.map_or(String::new(), |label| format!(" data-label=\"{}\"", escape(label)));
                let _ = write!(self.body, "<{open}{class}{label}>{}</{close}>", escape(&cell.text));
            }
            self.body.push_str("</tr>\n");
        }
        self.body.push_str("</tbody></table></div>\n");
    }

    /// A numbered figure of one or more panels, one above the other, with its title and its caption.
    pub fn figure(&mut self, title: &str, caption: &str, panels: &[&dyn Figure]) {
        self.figures += 1;
        let _ = writeln!(self.body, "<figure id=\"figure-{}\">", self.figures);
        for width in [Width::Broad, Width::Wide, Width::Narrow] {
            let _ = writeln!(self.body, "<div class=\"{}\">", width.class());
            for (index, panel) in panels.iter().enumerate() {
                let id = format!("figure-{}-{}-{}", self.figures, width.class(), index + 1);
                self.body.push_str(&panel.draw(&id, width));
            }
            self.body.push_str("</div>\n");
        }
        let number = self.figures;
        let _ = write!(self.body, "<figcaption><span class=\"figure\">Figure {number}. {}.</span> ", escape(title));
        self.body.push_str(&escape(caption));
        match panels.iter().map(|panel| panel.undrawable()).sum::<usize>() {
            0 => {}
            1 => self.body.push_str(" One value is not drawn because it is not finite or not on the axis."),
            n => {
                let n = count(n as u64);
                let _ = write!(self.body, " {n} values are not drawn because they are not finite or not on the axis.");
            }
        }
        self.body.push_str("</figcaption>\n</figure>\n");
    }

    fn contents(&self) -> String {
        if self.sections.len() < LISTED_SECTIONS {
            return String::new();
        }
        let item = |(index, title): (usize, &String)| {
            format!("<li><a href=\"#section-{}\">{}</a></li>", index + 1, escape(title))
        };
        let items: String = self.sections.iter().enumerate().map(item).collect();
        format!("<nav aria-label=\"Contents\"><ul>{items}</ul></nav>\n")
    }

    /// The finished document.
    pub fn finish(self) -> String {
        let contents = self.contents();
        let Self { title, head, warnings, body, .. } = self;
        format!(
            concat!(
                "<!DOCTYPE html>\n<html lang=\"en\" xmlns=\"http://www.w3.org/1999/xhtml\">\n<head>\n",
                "<meta charset=\"utf-8\"/>\n",
                "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n",
                "<meta name=\"color-scheme\" content=\"light dark\"/>\n",
                "<title>{title}</title>\n<style>\n{style}</style>\n</head>\n<body>\n<main>\n{head}{warnings}{contents}{body}</main>\n",
                "<footer>Written by holdover-sim {version}. This file is complete in itself; it loads nothing.</footer>\n",
                "<script>//<![CDATA[\n{script}//]]></script>\n</body>\n</html>\n"
            ),
            title = escape(&title),
            style = STYLE,
            script = SCRIPT,
            contents = contents,
            head = head,
            warnings = warnings,
            body = body,
            version = VERSION
        )
    }
}
