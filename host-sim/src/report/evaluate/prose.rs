//! The captions of an evaluation's report: figures enter; a sentence or two with their numbers leave.

use super::{Classes, Drive, EvaluateReport, Method};
use crate::measure::baseline::spoken;
use crate::report::markup::{count, quantity, significant};

impl EvaluateReport {
    /// The unit beside the best of the other methods, by this figure.
    fn compare(&self, figure: impl Fn(&Method) -> Option<f64>) -> Option<String> {
        let ours = figure(self.methods.first()?)?;
        let others = self.methods.iter().skip(1).filter_map(|method| Some((method, figure(method)?)));
        let (best, least) = others.min_by(|a, b| a.1.total_cmp(&b.1))?;
        let share = match (ours - least) / least * 100.0 {
            even if even.abs() < 0.5 || !even.is_finite() => "the same".into(),
            worse if worse > 0.0 => format!("{} % less than ours", significant(100.0 * (1.0 - least / ours), 2)),
            better => format!("{} % more than ours", significant(-better / (1.0 + better / 100.0), 2)),
        };
        let best = spoken(&best.name);
        Some(format!("{} (rms); the best baseline, {best}, has {}: {share}", quantity(ours, "m"), quantity(least, "m")))
    }

    pub(super) fn say_result(&self) -> String {
        let compared = match self.classes {
            Classes::Age => self
                .compare(|method| method.rms_m)
                .map(|figures| format!("Over the whole link our position error is {figures}.")),
            Classes::Outage(length_s) => {
                let class = self.class_of(length_s);
                self.compare(|method| method.classes.get(class?)?.0)
                    .map(|figures| format!("After {length_s} s without a message our position error is {figures}."))
            }
        };
        compared.unwrap_or("Nothing could be compared: no message arrived in time.".into())
    }

    pub(super) fn say_table(&self) -> &'static str {
        match self.classes {
            Classes::Age => "Error of the estimate at every tick; bold: the least.",
            Classes::Outage(_) => "Error of the estimate after all lengths of silence together; bold: the least.",
        }
    }

    pub(super) fn name_classes(&self) -> String {
        match self.classes {
            Classes::Age => "Position error by age of the newest sample".into(),
            Classes::Outage(_) => "Position error by length of the silence".into(),
        }
    }

    pub(super) fn say_classes(&self) -> String {
        let first = match self.classes {
            Classes::Age => "Every tick belongs to the class of the age of its newest delivered sample.",
            Classes::Outage(_) => "A silence of each length begins at every message of the recordings.",
        };
        let empty: Vec<&str> =
            self.class_names.iter().filter(|(_, n)| *n == 0).map(|(name, _)| name.as_str()).collect();
        match empty.as_slice() {
            [] => format!("{first} Logarithmic: equal distances are equal factors."),
            empty => format!(
                "{first} Logarithmic: equal distances are equal factors. Nothing was that old: {}.",
                empty.join(", ")
            ),
        }
    }

    pub(super) fn say_drive(&self, drive: &Drive) -> String {
        let names: Vec<String> = drive.errors.iter().map(|series| spoken(&series.name)).collect();
        let what = match self.classes {
            Classes::Age => "Estimated minus true position at every tick".to_owned(),
            Classes::Outage(length_s) => {
                format!("Estimated minus true position after {length_s} s of silence, at its end")
            }
        };
        let shades = match drive.silences.len() {
            0 => String::new(),
            1 => " Shaded: nothing arrived for longer than half a second.".into(),
            many => format!(" Shaded: {many} times in which nothing arrived for longer than half a second."),
        };
        format!("{what}: {}. Below: how fast the vehicle really was.{shades}", names.join(", "))
    }

    pub(super) fn say_distribution(&self) -> String {
        let after = match self.classes {
            Classes::Age => String::new(),
            Classes::Outage(length_s) => format!(" after {length_s} s of silence"),
        };
        let samples = self.methods.first().map_or(0, |ours| ours.errors.len());
        format!(
            "Share of the {} comparisons{after} whose error is at or below a magnitude; further left is better.",
            count(samples as u64)
        )
    }

    pub(super) fn say_link(&self, drive: &Drive) -> String {
        let delays: Vec<f64> = drive.messages.iter().filter_map(|message| message.1).collect();
        let lost = drive.messages.len() - delays.len();
        let longest = delays
            .iter()
            .copied()
            .reduce(f64::max)
            .map_or(String::new(), |longest| format!(", the slowest after {}", quantity(longest, "s")));
        let silence = drive.silences.iter().map(|silence| silence.to - silence.from).reduce(f64::max);
        let silence =
            silence.map_or(String::new(), |longest| format!(" The longest silence lasted {}.", quantity(longest, "s")));
        format!(
            "{} messages were sent during {}: {} arrived{longest}, {} were lost.{silence} A dot stands where its message was sent.",
            count(drive.messages.len() as u64),
            drive.name,
            count(delays.len() as u64),
            count(lost as u64)
        )
    }

    pub(super) fn notes(&self) -> Vec<String> {
        let mut notes = vec![
            "All methods work on the same messages as they were decoded from the bus: positions to 1 mm, speeds to 2 mm/s, \
             accelerations to 0.02 m/s². The truth is the recording, linear between its samples."
                .to_owned(),
            "freeze: position held, speed 0. constant speed, constant acceleration: held, until the vehicle stops. Singer's \
             model: the acceleration fades with 1.5 s. Kalman filter: constant acceleration on position and speed. literal \
             paper: its equations as printed; of a vehicle that says nothing of how it drives it assumes that it heads for 13.4 m/s."
                .to_owned(),
        ];
        if let Classes::Outage(_) = self.classes {
            notes.push(
                "Messages come ten times a second without delay. The last message heard is the one sent when the silence begins."
                    .to_owned(),
            );
        }
        notes
    }

    fn class_of(&self, length_s: f64) -> Option<usize> {
        self.class_names.iter().position(|(name, _)| *name == format!("{length_s} s"))
    }
}
