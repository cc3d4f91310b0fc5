//! The emergency stops of a corridor: a seed enters; vehicles that brake as hard as they have published leave, each at a random place of
//! its way, whatever its unit commands.
//!
//! The place is drawn, and not the time. So a vehicle may brake on the road, before a conflict area or in it, and while it is silent. Its
//! unit goes on telling the others of the drive that it commands: nothing that they hear tells of the stop but the motion itself.

use super::Traffic;
use crate::input::kind::Kind;
use crate::roads::description::Emergencies;
use crate::roads::lane::Lane;
use crate::streams::{Purpose, stream, unit};

/// No vehicle brakes on the first metres of its way, where a newcomer behind it has not heard it for long.
const FROM_M: f64 = 30.0;

/// Slower than this, in m/s, a vehicle stands.
const STANDING_MPS: f64 = 1e-3;

/// The emergency stop of a vehicle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Emergency {
    /// Where its front is when it begins, from the beginning of the road.
    from_m: f64,
    /// How long the vehicle stands.
    stands_s: f64,
    phase: Phase,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Phase {
    Ahead,
    Braking,
    StandingUntil(f64),
    Over,
}

impl Emergency {
    /// That of the vehicle with this index, if it makes one. A vehicle that makes one at a share makes the same at every larger share.
    pub fn of(emergencies: &Emergencies, seed: u64, index: usize, lane: &Lane) -> Option<Self> {
        let mut generator = stream(seed, Purpose::Emergency(u32::try_from(index).unwrap_or(u32::MAX)));
        let [draw, place] = [(); 2].map(|()| unit(&mut generator));
        let first_m = lane.entry_m + FROM_M;
        (draw < emergencies.share).then_some(Self {
            from_m: first_m + place * (lane.exit_m - first_m),
            stands_s: emergencies.stands_s,
            phase: Phase::Ahead,
        })
    }

    /// Whether the vehicle brakes or stands because of it.
    pub const fn is_under_way(&self) -> bool {
        matches!(self.phase, Phase::Braking | Phase::StandingUntil(_))
    }

    /// Whether the vehicle brakes or stands now, with its front at `way_m`, and whether that begins now.
    fn at(&mut self, at_s: f64, way_m: f64, speed_mps: f64) -> (bool, bool) {
        let before = self.phase;
        self.phase = match before {
            Phase::Ahead if way_m >= self.from_m => Phase::Braking,
            Phase::Braking if speed_mps <= STANDING_MPS => Phase::StandingUntil(at_s + self.stands_s),
            Phase::StandingUntil(until_s) if at_s >= until_s => Phase::Over,
            same => same,
        };
        let is_braking = self.is_under_way();
        (is_braking, is_braking && before == Phase::Ahead)
    }
}

impl Traffic<'_> {
    /// Lets the vehicles brake that are in an emergency. A vehicle that has left is in none.
    pub(super) fn brake_in_emergencies(&mut self, at_s: f64) {
        for traveller in self.travellers.values_mut().filter(|traveller| !traveller.has_left()) {
            let way_m = traveller.way_m();
            let Some(emergency) = &mut traveller.emergency else { continue };
            let (is_braking, begins) = emergency.at(at_s, way_m, traveller.vehicle.plant.speed_mps);
            self.remains.emergencies += u64::from(begins);
            if is_braking {
                traveller.vehicle.override_with(-hardest_mps2(self.trips[traveller.trip].kind));
            }
        }
    }
}

/// The hardest braking that vehicles of this kind publish.
pub(super) fn hardest_mps2(kind: Kind) -> f64 {
    kind.limits().emergency_braking.get().to_num()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::roads::conditions::Conditions;
    use crate::roads::example;
    use crate::roads::experiment::Experiment;
    use crate::roads::watch::{Sighting, Watch};

    #[test]
    fn one_in_so_many_makes_one_anywhere_on_its_way_behind_the_first_metres() {
        let experiment = Experiment::new(example::corridor());
        let lane = &experiment.network.lanes[0];
        let of = |share: f64| {
            let emergencies = Emergencies { share, stands_s: 10.0, ..Emergencies::NONE };
            (0..2_000).filter_map(|index| Emergency::of(&emergencies, 1, index, lane)).collect::<Vec<_>>()
        };
        let (few, all) = (of(0.05), of(1.0));
        assert!((70..=130).contains(&few.len()), "{}", few.len());
        assert!(few.iter().all(|one| all.contains(one)) && all.len() == 2_000 && of(0.0).is_empty());
        let (first_m, last_m) = (lane.entry_m + FROM_M, lane.exit_m);
        assert!(all.iter().all(|one| (first_m..last_m).contains(&one.from_m)));
        let mean_m = all.iter().map(|one| one.from_m).sum::<f64>() / 2_000.0;
        assert!((mean_m - (first_m + last_m) / 2.0).abs() < 0.03 * (last_m - first_m), "{mean_m}");
    }

    /// The speeds of the only vehicle, tick by tick.
    #[derive(Default)]
    struct Speeds(Vec<f64>);

    impl Watch for Speeds {
        fn tick(&mut self, _: f64, sightings: &[Sighting]) {
            self.0.extend(sightings.first().map(|one| one.speed_mps));
        }
        fn left(&mut self, _: f64, _: usize) {}
    }

    #[test]
    fn it_brakes_as_hard_as_it_has_published_stands_for_the_time_and_drives_on() {
        let experiment = Experiment::new(example::corridor());
        let Experiment { corridor, network, itineraries } = &experiment;
        let trips = [example::trip(2)];
        let emergencies = Emergencies { share: 1.0, stands_s: 10.0, ..Emergencies::NONE };
        let conditions = Conditions { emergencies, ..Conditions::of(corridor) };
        let mut speeds = Speeds::default();
        let traffic = Traffic::new(corridor, network, itineraries, &trips, conditions, 1);
        let remains = traffic.run(&mut [&mut speeds], &mut Vec::new()).unwrap();
        assert_eq!((remains.unserved, remains.emergencies), (0, 1));
        let standing = speeds.0.iter().filter(|speed_mps| **speed_mps <= STANDING_MPS).count();
        assert!((990..=1_100).contains(&standing), "{standing} ticks of 10 ms");
        let hardest = trips[0].kind.limits().emergency_braking.get().to_num::<f64>();
        let braking = speeds.0.windows(2).map(|pair| (pair[0] - pair[1]) / 0.01).fold(0.0, f64::max);
        assert!((0.9 * hardest..=hardest + 1e-6).contains(&braking), "{braking} of {hardest}");
    }
}
