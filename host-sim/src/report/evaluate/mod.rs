//! The report of one evaluation: errors of several methods by class and over time enter, an HTML page leaves.

mod figures;
mod prose;

use crate::measure::baseline::spoken;

use super::{
    markup::{count, significant},
    page::{Cell, Page},
    plot::{Interval, Series, Tone},
};

/// A method of estimation.
#[derive(Debug, Clone, PartialEq)]
pub struct Method {
    /// Its name.
    pub name: String,
    /// Root of the mean square of the position error, in metres.
    pub rms_m: Option<f64>,
    /// 99th percentile of its magnitude.
    pub p99_m: Option<f64>,
    /// Its largest magnitude.
    pub max_m: Option<f64>,
    /// Root of the mean square of the speed error, in m/s.
    pub rms_mps: Option<f64>,
    /// For each class the root of the mean square and the largest magnitude of the position error.
    pub classes: Vec<(Option<f64>, Option<f64>)>,
    /// The position errors whose distribution is shown.
    pub errors: Vec<f64>,
}

/// The kind of the classes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Classes {
    /// Ages of the newest sample.
    Age,
    /// Lengths of silence; the series over time and the distributions are after this one, in seconds.
    Outage(f64),
}

/// One recorded drive.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Drive {
    /// Its name.
    pub name: String,
    /// Its true speed over time.
    pub speed: Series,
    /// The position error over time of the methods that are shown, by their names.
    pub errors: Vec<Series>,
    /// Age of the newest sample over time; empty in silences.
    pub age: Series,
    /// The times in which no message arrived.
    pub silences: Vec<Interval>,
    /// For each message its time of sending, and its delay in seconds; `None` if it was lost. Empty in silences.
    pub messages: Vec<(f64, Option<f64>)>,
}

/// The content of the page. Times are in seconds of the recordings.
#[derive(Debug, Clone, PartialEq)]
pub struct EvaluateReport {
    /// The page's title.
    pub title: String,
    /// What was evaluated: names and values.
    pub facts: Vec<(String, String)>,
    /// The command line that repeats this.
    pub command: String,
    /// The kind of the classes.
    pub classes: Classes,
    /// The names of the classes, and the number of comparisons in each.
    pub class_names: Vec<(String, usize)>,
    /// The methods; the unit is first.
    pub methods: Vec<Method>,
    /// The drives of which nothing could be compared, and why.
    pub failures: Vec<String>,
    /// The drives.
    pub drives: Vec<Drive>,
}

/// The largest number of drives that a page shows individually.
const MOST_DRIVES: usize = 6;

impl EvaluateReport {
    /// The page, as one self-contained HTML document. The same report is always the same bytes.
    pub fn render(&self) -> String {
        self.page().finish()
    }

    /// The page, to which more can be added.
    pub fn page(&self) -> Page {
        let mut page = Page::new("holdover-sim · report of an evaluation", &self.title);
        if !self.failures.is_empty() {
            page.verdict(false, &self.failures);
        }
        page.paragraph(&self.say_result());
        self.list_methods(&mut page);
        page.section("Error by class");
        self.draw_classes(&mut page);
        self.list_classes(&mut page);
        page.section("Error over time");
        self.drives.iter().take(MOST_DRIVES).for_each(|drive| self.draw_drive(drive, &mut page));
        if self.drives.len() > MOST_DRIVES {
            page.paragraph(&format!("{MOST_DRIVES} of {} drives are shown; all count.", self.drives.len()));
        }
        page.section("Distribution");
        self.draw_distribution(&mut page);
        if let Some(longest) = self.longest_link() {
            page.section("Link");
            self.draw_link(longest, &mut page);
        }
        page.section("What was evaluated");
        page.facts(&self.facts);
        page.command(&self.command);
        page.section("Notes");
        page.list(&self.notes());
        page
    }

    /// The drive during which most messages were sent. All drives use the same link from its beginning.
    fn longest_link(&self) -> Option<&Drive> {
        self.drives.iter().filter(|drive| !drive.messages.is_empty()).max_by_key(|drive| drive.messages.len())
    }

    fn list_methods(&self, page: &mut Page) {
        let row = |method: &Method| {
            let best = |of: fn(&Method) -> Option<f64>| is_least(of(method), self.methods.iter().map(of));
            let cell = |of: fn(&Method) -> Option<f64>| number(of(method), best(of));
            vec![
                Cell::text(spoken(&method.name)),
                cell(|method| method.rms_m),
                cell(|method| method.p99_m),
                cell(|method| method.max_m),
                cell(|method| method.rms_mps),
            ]
        };
        let rows: Vec<Vec<Cell>> = self.methods.iter().map(row).collect();
        page.table(self.say_table(), &["Method", "rms, m", "99 %, m", "largest, m", "speed rms, m/s"], &rows);
    }

    fn list_classes(&self, page: &mut Page) {
        let names: Vec<String> = self.class_names.iter().map(|(name, _)| name.clone()).collect();
        let header: Vec<&str> = std::iter::once("Method").chain(names.iter().map(String::as_str)).collect();
        let mut rows: Vec<Vec<Cell>> = Vec::new();
        for method in &self.methods {
            let cells = method.classes.iter().enumerate().map(|(class, (rms_m, _))| {
                let others = self.methods.iter().map(|other| other.classes.get(class).and_then(|class| class.0));
                number(*rms_m, is_least(*rms_m, others))
            });
            rows.push(std::iter::once(Cell::text(spoken(&method.name))).chain(cells).collect());
        }
        if let Some(ours) = self.methods.first() {
            let largest = ours.classes.iter().map(|(_, max_m)| number(*max_m, false));
            rows.push(std::iter::once(Cell::text("holdover, largest")).chain(largest).collect());
        }
        let counts = self.class_names.iter().map(|(_, samples)| Cell::number(count(*samples as u64)));
        rows.push(std::iter::once(Cell::text("comparisons")).chain(counts).collect());
        page.table("Position error, rms, in metres; bold: the least.", &header, &rows);
    }

    /// The colour of a method.
    fn tone(&self, name: &str) -> Tone {
        match (name, self.methods.iter().position(|method| method.name == name)) {
            ("paper", _) => Tone::Paper,
            // The fifth of the other colours is a blue that is too similar to that of the unit.
            (_, Some(5)) => Tone::Other(6),
            (_, Some(0)) => Tone::Ours,
            (_, Some(index)) => Tone::Other(index - 1),
            (_, None) => Tone::Idle,
        }
    }
}

fn is_least(value: Option<f64>, all: impl Iterator<Item = Option<f64>>) -> bool {
    value.is_some() && value == all.flatten().reduce(f64::min)
}

fn number(value: Option<f64>, strong: bool) -> Cell {
    let spelled = value.map_or("–".into(), |value| significant(value, 3));
    if strong { Cell::strong(spelled) } else { Cell::number(spelled) }
}
