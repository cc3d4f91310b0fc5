//! The collisions of a run: who ran into whom enters, with the gap over time as it was and as it was believed; a table and a figure leave
//! onto the page.

use super::RunReport;
use crate::report::markup::{count, significant};
use crate::report::page::{Cell, Page};
use crate::report::plot::{Axis, Chart, Guide, Layer, Series, Tone};

/// A collision. Vehicles have their names in the trajectories.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Crash {
    /// When the gap fell below 0.
    pub at_s: f64,
    /// The vehicle that ran into another one.
    pub vehicle: String,
    /// The vehicle ahead of it.
    pub into: String,
    /// Its speed.
    pub speed_mps: f64,
    /// The speed of the vehicle ahead.
    pub into_speed_mps: f64,
    /// The gap that its unit believed in.
    pub believed_gap_m: Option<f64>,
    /// The smallest gap that its unit took for possible.
    pub least_gap_m: Option<f64>,
    /// The age of what it knew of the vehicle ahead.
    pub age_s: Option<f64>,
    /// The mode of its unit.
    pub mode: String,
    /// The acceleration that its unit commanded.
    pub command_mps2: f64,
}

/// All collisions of a run, and the first of them over time.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Crashes {
    /// How many there were.
    pub all: usize,
    /// The first of them, one by one; at least one.
    pub list: Vec<Crash>,
    /// The gap around the first one: the least that its unit took for possible, the believed one, the true one.
    pub gaps: Vec<Series>,
    /// The speeds of the two.
    pub speeds: Vec<Series>,
}

impl RunReport {
    /// Nothing without a collision.
    pub(super) fn draw_crashes(&self, page: &mut Page) {
        let Some(crashes) = &self.crashes else { return };
        let Some(first) = crashes.list.first() else { return };
        page.section("Collisions");
        let spelled = |value: Option<f64>| Cell::number(value.map_or("–".into(), |value| significant(value, 3)));
        let row = |crash: &Crash| {
            vec![
                Cell::text(format!("{:.2} s", crash.at_s)),
                Cell::text(format!("{} into {}", crash.vehicle, crash.into)),
                spelled(Some(crash.speed_mps)),
                spelled(Some(crash.into_speed_mps)),
                spelled(crash.believed_gap_m),
                spelled(crash.least_gap_m),
                spelled(crash.age_s),
                Cell::text(crash.mode.clone()),
                spelled(Some(crash.command_mps2)),
            ]
        };
        let header = [
            "When",
            "Who",
            "Speed, m/s",
            "Speed ahead, m/s",
            "Believed gap, m",
            "Least possible gap, m",
            "Age of its data, s",
            "Mode",
            "Command, m/s²",
        ];
        let all = if crashes.all > crashes.list.len() {
            format!("The first {} of {}: who", crashes.list.len(), count(crashes.all as u64))
        } else {
            "Who".to_owned()
        };
        let caption = format!("{all} ran into whom, and what the unit of the one behind believed at that moment.");
        page.table(&caption, &header, &crashes.list.iter().map(row).collect::<Vec<_>>());
        let title = format!("The first collision: {} runs into {}", first.vehicle, first.into);
        let caption = format!(
            "The gap between the two as it was and as the unit of {} believed, and their speeds.",
            first.vehicle
        );
        let chart = |y: Axis, layers| {
            let x = Axis::linear("time", "s");
            Chart { description: caption.clone(), layers, height: 170.0, ..Chart::new(&title, x, y) }
        };
        let tones = [Tone::Other(0), Tone::Ours, Tone::Ego];
        let line = |(series, tone): (&Series, Tone)| Layer::line(series.clone(), tone);
        let mut gaps =
            chart(Axis::linear("gap", "m").including(0.0), crashes.gaps.iter().zip(tones).map(line).collect());
        gaps.guides = vec![Guide { at: 0.0, label: "collision".into() }];
        let tones = [Tone::Other(0), Tone::Ego];
        let speeds =
            chart(Axis::linear("speed", "m/s").including(0.0), crashes.speeds.iter().zip(tones).map(line).collect());
        page.figure(&title, &caption, &[&gaps, &speeds]);
    }
}
