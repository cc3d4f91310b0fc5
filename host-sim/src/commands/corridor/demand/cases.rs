//! The conditions under which each amount of traffic is run: a corridor enters; its sides leave, each with its conditions.

use serde::Serialize;

use crate::roads::conditions::Conditions;
use crate::roads::description::{Corridor, Radio};
use crate::roads::experiment::of_sides;

/// Silences that each amount of traffic is run with, in seconds.
pub const SILENCES_S: [f64; 5] = [0.0, 2.0, 4.0, 8.0, 12.0];

/// What a run is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Which {
    /// The scenario, without the envelope.
    Holdover,
    /// The same over links without delay, loss and silence.
    PerfectLink,
    /// The same with vehicles that drive alone while the link to the vehicle just ahead is lost.
    Alone,
    /// The scenario, with the envelope and without passes.
    FirstCome,
    /// The scenario, with the envelope.
    Envelope,
    /// The same over links without delay, loss and silence.
    EnvelopePerfectLink,
    /// The scenario, with the envelope and with silences of another length.
    Silence,
}

impl Which {
    /// Its name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Holdover => "holdover",
            Self::PerfectLink => "perfect link",
            Self::Alone => "drives alone",
            Self::FirstCome => "first come, first served",
            Self::Envelope => "with envelope",
            Self::EnvelopePerfectLink => "with envelope, perfect link",
            Self::Silence => "with envelope, silences of",
        }
    }

    /// Whether it is only there to be compared with: what it does is not judged.
    #[must_use]
    pub const fn is_reference(self) -> bool {
        matches!(self, Self::Alone)
    }
}

/// The sides of a corridor, in the order in which they are shown. The scenario's own silence is that of `Envelope`, and not run twice.
#[must_use]
pub fn sides(corridor: &Corridor) -> Vec<(Which, Conditions)> {
    let [holdover, perfect_link, alone, envelope, envelope_perfect_link, _] = of_sides(corridor);
    let first_come = Conditions { without_passes: 1.0, ..envelope };
    let silence = |dark_s: f64| Conditions { radio: Radio { dark_s, ..envelope.radio }, ..envelope };
    let silences = SILENCES_S.into_iter().filter(|dark_s| *dark_s != envelope.radio.dark_s);
    [
        (Which::Holdover, holdover),
        (Which::PerfectLink, perfect_link),
        (Which::Alone, alone),
        (Which::FirstCome, first_come),
        (Which::Envelope, envelope),
        (Which::EnvelopePerfectLink, envelope_perfect_link),
    ]
    .into_iter()
    .chain(silences.map(|dark_s| (Which::Silence, silence(dark_s))))
    .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::roads::conditions::WhenLost;
    use crate::roads::example;

    #[test]
    fn each_side_is_what_it_is_called() {
        let corridor = example::corridor();
        let sides = sides(&corridor);
        let of = |which: Which| sides.iter().filter(|side| side.0 == which).map(|side| side.1).collect::<Vec<_>>();
        assert!(of(Which::Holdover).iter().chain(&of(Which::Alone)).all(|one| !one.envelope.engaged));
        assert!(of(Which::FirstCome).iter().chain(&of(Which::Envelope)).all(|one| one.envelope.engaged));
        assert_eq!(of(Which::FirstCome)[0].without_passes, 1.0);
        assert_eq!(of(Which::Envelope)[0].without_passes, 0.0);
        assert_eq!(of(Which::Alone)[0].when_lost, WhenLost::Alone);
        for which in [Which::PerfectLink, Which::EnvelopePerfectLink] {
            assert_eq!(of(which)[0].radio, corridor.radio.perfect());
        }
    }

    #[test]
    fn the_silences_are_of_0_to_12_s_and_none_is_run_twice() {
        let silences = |text: &str| -> Vec<f64> {
            let sides = sides(&example::of(text)).into_iter();
            let with = sides.filter(|side| matches!(side.0, Which::Envelope | Which::Silence));
            with.map(|(_, conditions)| conditions.radio.dark_s).collect()
        };
        assert_eq!(silences(example::TEXT), [4.0, 0.0, 2.0, 8.0, 12.0]);
        let longer = example::TEXT.replacen("dark_s = 4.0", "dark_s = 5.0", 1);
        assert_eq!(silences(&longer), [5.0, 0.0, 2.0, 4.0, 8.0, 12.0]);
    }
}
