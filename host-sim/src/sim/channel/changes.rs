//! What happens to the links during a run, beside the model of the channel: changes enter with their times; what holds for a link leaves.

use crate::input::impairment::{Link, Window};
use crate::input::scenario::Radio;

/// The changes that hold.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Changes {
    /// For a vehicle or for all, the delay and the loss; the last one that is about a link holds.
    radios: Vec<(Option<usize>, Radio)>,
    /// For a vehicle or for all, when its links are silent.
    outages: Vec<(Option<usize>, Window)>,
}

fn is_about(vehicle: Option<usize>, link: Link) -> bool {
    vehicle.is_none_or(|index| index == link.from || index == link.to)
}

impl Changes {
    /// From now on the links of the vehicle, or all, are like this.
    pub fn set_radio(&mut self, vehicle: Option<usize>, radio: Radio) {
        self.radios.retain(|(other, _)| vehicle.is_some() && *other != vehicle);
        self.radios.push((vehicle, radio));
    }

    /// From now on the links of the vehicle, or all, are silent for so long; 0 ends that.
    pub fn silence(&mut self, vehicle: Option<usize>, at_s: f64, length_s: f64) {
        let ends = |other: Option<usize>| length_s == 0.0 && (vehicle.is_none() || other == vehicle);
        self.outages.retain(|(other, window)| window.to_s > at_s && !ends(*other));
        if length_s > 0.0 {
            self.outages.push((vehicle, Window { from_s: at_s, to_s: at_s + length_s }));
        }
    }

    /// Forgets what was changed for a vehicle that has gone.
    pub fn forget(&mut self, vehicle: usize) {
        self.radios.retain(|(other, _)| *other != Some(vehicle));
        self.outages.retain(|(other, _)| *other != Some(vehicle));
    }

    /// Of a vehicle or of all, the delay and the loss that were set, in the order in which they were: the last one about a link holds.
    #[must_use]
    pub fn radios(&self) -> &[(Option<usize>, Radio)] {
        &self.radios
    }

    /// Delay and loss of a link, if they were changed.
    #[must_use]
    pub fn radio(&self, link: Link) -> Option<Radio> {
        self.radios.iter().rfind(|(vehicle, _)| is_about(*vehicle, link)).map(|(_, radio)| *radio)
    }

    /// Whether what is sent over a link now is lost.
    #[must_use]
    pub fn is_silent(&self, link: Link, at_s: f64) -> bool {
        self.outages
            .iter()
            .any(|(vehicle, window)| is_about(*vehicle, link) && (window.from_s..window.to_s).contains(&at_s))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RADIO: Radio = Radio { delay_mean_s: 0.1, delay_std_s: 0.0, loss: 0.5 };
    const LINK: Link = Link { from: 1, to: 2 };
    const OTHER: Link = Link { from: 0, to: 1 };

    #[test]
    fn the_last_change_that_is_about_a_link_holds() {
        let mut changes = Changes::default();
        assert_eq!(changes.radio(LINK), None);
        changes.set_radio(Some(2), RADIO);
        assert_eq!((changes.radio(LINK), changes.radio(OTHER)), (Some(RADIO), None));
        let perfect = Radio { delay_mean_s: 0.0, loss: 0.0, ..RADIO };
        changes.set_radio(None, perfect);
        assert_eq!((changes.radio(LINK), changes.radio(OTHER)), (Some(perfect), Some(perfect)));
    }

    #[test]
    fn a_silence_ends_by_itself_or_when_it_is_ended() {
        let mut changes = Changes::default();
        changes.silence(Some(2), 1.0, 4.0);
        assert!(changes.is_silent(LINK, 1.0) && !changes.is_silent(LINK, 5.0) && !changes.is_silent(OTHER, 1.0));
        changes.silence(Some(1), 2.0, 0.0);
        assert!(changes.is_silent(LINK, 3.0), "it is of another vehicle");
        changes.silence(Some(2), 3.0, 0.0);
        assert!(!changes.is_silent(LINK, 3.0));
    }
}
