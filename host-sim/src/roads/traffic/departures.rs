//! The departures from a corridor: vehicles at the end of their way enter. Having left, they drive on by sight, and
//! stay on the air until every vehicle that they could matter to has heard that they left. Then they vanish.

use std::io;

use holdover::controller::Mode;

use super::{Traffic, Traveller};
use crate::bus::Frame;
use crate::input::impairment::Window;
use crate::roads::alone;
use crate::roads::network::RUN_OUT_M;
use crate::roads::watch::{Sighting, Watch};
use crate::sim::vehicle::Vehicle;

/// A vehicle that has left stays on the air until every vehicle that depends on it could hear it for this time since it
/// left, in seconds. Every vehicle falls silent once, so this takes at most two silences longer.
const HEARD_OF_S: f64 = 2.0;

impl Traffic<'_> {
    /// Drives by sight the vehicles that have left and have lost their target. The target vanishes without a message,
    /// and as far as the unit knows it may stand there. So each such unit would wait for it, and all vehicles behind
    /// would wait too, back onto the way. With the envelope, all vehicles that have left drive by sight, because the
    /// envelope goes by the bound of the vehicle ahead. A vehicle whose receiver is dead does so from its last conflict
    /// area on: it would wait there for a vehicle that it heard before.
    pub(super) fn run_out(&mut self, at_s: f64) {
        let is_lost = |vehicle: &Vehicle| matches!(vehicle.unit.mode(), Mode::Fallback { .. });
        let by_sight = |traveller: &Traveller| {
            let has_left = traveller.has_left() && (self.conditions.envelope.engaged || is_lost(&traveller.vehicle));
            has_left || traveller.is_deaf(at_s) && self.has_crossed(traveller)
        };
        let all: Vec<usize> =
            self.travellers.values().filter(|one| by_sight(one)).map(|traveller| traveller.trip).collect();
        if all.is_empty() {
            return;
        }
        let sightings: Vec<Sighting> = self.travellers.values().map(|traveller| self.sight(0.0, traveller)).collect();
        for traveller in self.travellers.values_mut().filter(|traveller| all.contains(&traveller.trip)) {
            let Some(own) = sightings.iter().find(|own| own.trip == traveller.trip) else { continue };
            let wanted = alone::demand(own, &sightings, self.network, &self.corridor.traffic, true);
            traveller.vehicle.override_with(alone::published(wanted, self.trips[own.trip].kind));
        }
    }

    /// Whether its last conflict area is behind it.
    fn has_crossed(&self, traveller: &Traveller) -> bool {
        self.network.lanes[self.trips[traveller.trip].road].stops.last().is_none_or(|stop| {
            let half_m = self.network.junctions[stop.intersection].half_m;
            traveller.way_m() > stop.at_m + half_m + traveller.vehicle.length_m
        })
    }

    /// Marks the vehicles that have reached the end of their way as having left. Removes them a little later.
    pub(super) fn dismiss(
        &mut self,
        at_s: f64,
        watches: &mut [&mut dyn Watch],
        log: &mut Vec<(f64, Frame)>,
    ) -> io::Result<()> {
        let trips = self.trips;
        let beyond_m =
            |traveller: &Traveller| traveller.way_m() - self.network.lanes[trips[traveller.trip].road].exit_m;
        for (index, traveller) in &mut self.travellers {
            if !traveller.has_left() && beyond_m(traveller) >= 0.0 {
                traveller.left_s = Some(at_s);
                traveller.vehicle.let_go(); // nobody drives on beyond the end of the way, where nobody else would pass
                watches.iter_mut().for_each(|watch| watch.left(at_s + self.corridor.period_s, *index));
            }
        }
        let has_gone = |traveller: &Traveller| beyond_m(traveller) >= RUN_OUT_M && self.is_heard_of(at_s, traveller);
        let gone: Vec<usize> =
            self.travellers.iter().filter(|(_, traveller)| has_gone(traveller)).map(|(index, _)| *index).collect();
        for index in gone {
            if let Some(mut traveller) = self.travellers.remove(&index) {
                self.numbers.give_back(at_s, traveller.vehicle.index);
                self.remains.add(&traveller.vehicle);
                traveller.hand_in(log)?;
            }
            self.air.forget(index);
        }
        Ok(())
    }

    /// Whether every vehicle on its way to the last intersection of a vehicle that has left could hear that vehicle for
    /// long enough since. A radio that is dead is not waited for.
    pub(super) fn is_heard_of(&self, at_s: f64, gone: &Traveller) -> bool {
        let Some(left_s) = gone.left_s else { return false };
        let last = self.network.lanes[self.trips[gone.trip].road].stops.last().map(|stop| stop.intersection);
        let minds = |other: &&Traveller| {
            let stops = &self.network.lanes[self.trips[other.trip].road].stops;
            !other.has_left() && stops.iter().any(|stop| Some(stop.intersection) == last)
        };
        let since = Window { from_s: left_s, to_s: at_s };
        let is_cut_off = |other: &Traveller| gone.is_mute(at_s) || other.is_deaf(at_s);
        let has_heard = |other: &Traveller| heard_s(&since, &gone.dark, &other.dark) >= HEARD_OF_S;
        self.travellers.values().filter(minds).all(|other| is_cut_off(other) || has_heard(other))
    }
}

/// Time within `since` in which neither vehicle was silent; a lower bound.
fn heard_s(since: &Window, one: &Window, other: &Window) -> f64 {
    let silent_s = |dark: &Window| (dark.to_s.min(since.to_s) - dark.from_s.max(since.from_s)).max(0.0);
    since.to_s - since.from_s - silent_s(one) - silent_s(other)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_has_left_is_heard_while_neither_is_silent() {
        let window = |from_s: f64, to_s: f64| Window { from_s, to_s };
        let since = window(10.0, 16.0);
        assert_eq!(heard_s(&since, &window(0.0, 4.0), &window(20.0, 24.0)), 6.0);
        assert_eq!(heard_s(&since, &window(8.0, 12.0), &window(20.0, 24.0)), 4.0);
        assert_eq!(heard_s(&since, &window(8.0, 12.0), &window(13.0, 17.0)), 1.0);
    }
}
