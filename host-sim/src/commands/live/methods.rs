//! The other methods beside a unit on the roads: what the unit knows of its peers enters; where the literal paper's method and the newest
//! message put the vehicle that the unit follows leaves, on the unit's own axis.
//!
//! A vehicle that crosses has an axis of its own, and only the unit knows how to lay it on its own. So both methods get the messages as the
//! unit has laid them, and begin anew when the unit follows another vehicle or comes to another intersection.

use std::collections::BTreeMap;

use holdover::time::Instant;
use holdover::wire::{Predecessor, StationHash};

use crate::measure::baseline::Baseline;
use crate::measure::baseline::paper::Paper;
use crate::measure::heard::{Heard, HeardParameters};
use crate::sim::vehicle::Vehicle;

/// The methods beside one unit.
#[derive(Clone, Default)]
pub struct Methods {
    /// Whom the unit follows, and at which intersection.
    about: Option<(StationHash, Option<u8>)>,
    paper: Option<Paper>,
    /// For each station, the newest message that the paper's method has got.
    told: BTreeMap<u8, Instant>,
    places: Places,
}

/// Where the methods put the vehicle ahead, on the axis of the own odometer.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Places {
    /// The literal paper's.
    pub paper_m: Option<f64>,
    /// The newest message's.
    pub newest_m: Option<f64>,
}

impl Methods {
    /// They look at what the unit knows at a tick.
    pub fn look(&mut self, vehicle: &Vehicle, at_s: f64, step_s: f64) {
        let coordination = vehicle.unit.coordination();
        let target = coordination.choice().target.and_then(|slot| vehicle.unit.peers().get(slot.into()));
        let crossing = coordination.crossing().map(|crossing| crossing.intersection.id);
        let about = target.and_then(|track| track.station()).map(|station| (station, crossing));
        if about != self.about {
            *self = Self { about, ..Self::default() };
            self.paper = about.map(|(station, _)| Paper::new(station.0.into(), step_s));
        }
        let Some(paper) = &mut self.paper else { return };
        for track in vehicle.unit.peers().iter() {
            let Some(newest) = track.newest() else { continue };
            if self.told.insert(newest.station.0, newest.at) == Some(newest.at) {
                continue;
            }
            let parameters = track.parameters().map(|parameters| {
                let ahead = match parameters.predecessor {
                    Predecessor::Station(station) => Some(station.0.into()),
                    Predecessor::None | Predecessor::Unknown => None,
                };
                HeardParameters::from_parameters(parameters, ahead)
            });
            paper.hear(&Heard {
                at_s: vehicle.time_of(newest.received),
                stamp_s: vehicle.time_of(newest.at),
                vehicle: newest.station.0.into(),
                position_m: vehicle.near(newest.position),
                speed_mps: newest.speed.get().to_num(),
                acceleration_mps2: newest.acceleration.get().to_num(),
                demand_mps2: newest.demand.get().to_num(),
                parameters,
            });
        }
        let paper_m = paper.estimate(at_s).map(|estimate| estimate.position_m);
        self.places = Places { paper_m, newest_m: vehicle.newest_ahead().map(|(sample, _)| sample.position_m) };
    }

    /// Where they put the vehicle ahead now.
    #[must_use]
    pub fn places(&self) -> Places {
        self.places
    }
}
