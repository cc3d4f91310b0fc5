//! What the page is told: the world as it is at a tick, as JSON. Lengths are in metres, times in seconds, of the run.

use std::collections::BTreeMap;

use serde::Serialize;

use crate::input::scenario::Radio;
use crate::sim::world::TargetBelief;

/// The state at a tick.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Scene {
    /// Time of the run.
    pub at_s: f64,
    /// How time goes on.
    #[serde(flatten)]
    pub pulse: Pulse,
    /// The largest errors of the measured vehicle since the link has settled: of the units, and of the literal paper.
    pub largest_error_m: [Option<f64>; 2],
    /// The pairs of vehicles that run into one another.
    pub hits: Vec<[usize; 2]>,
    /// Of a vehicle or of all, mean and spread of the delay and the loss that were set since the start; the last one about a vehicle holds.
    pub links: Vec<(Option<usize>, [f64; 3])>,
    /// The vehicles.
    pub vehicles: Vec<Seen>,
}

/// How time goes on.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Pulse {
    /// Number of ticks so far.
    pub ticks: u64,
    /// Whether time goes on.
    pub is_playing: bool,
    /// Seconds of the run per second that are asked for.
    pub pace: f64,
    /// Seconds of the run per second of late; less than `pace` on a computer that is too slow.
    pub rate: f64,
    /// Number of things that were driven and changed up to now, and later.
    pub events: [usize; 2],
}

/// A vehicle at a tick.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Seen {
    /// Its index: its place in the string, or in a corridor the index of its trip.
    pub id: usize,
    /// Front bumper, along the lane or along its road.
    pub position_m: f64,
    /// Speed.
    pub speed_mps: f64,
    /// Acceleration.
    pub acceleration_mps2: f64,
    /// Demanded acceleration.
    pub command_mps2: f64,
    /// Mode of its unit.
    pub mode: &'static str,
    /// Whether the envelope changed the command.
    pub is_limited: bool,
    /// Whether a person drives.
    pub is_driven: bool,
    /// Whether it drives without the estimate.
    pub is_plain: bool,
    /// Whether its envelope is engaged.
    pub has_envelope: bool,
    /// Whether its range sensor is at work.
    pub sees: bool,
    /// Whether what the vehicle ahead sends is lost.
    pub is_silent: bool,
    /// Bumper gap to the vehicle ahead.
    pub gap_m: Option<f64>,
    /// Share of its bus that was busy in the last second.
    pub load: f64,
    /// Its unit's estimate of the vehicle ahead.
    pub target: Option<Ghost>,
    /// Where the literal paper's method puts the vehicle ahead.
    pub paper_m: Option<f64>,
    /// Where the newest message puts the vehicle ahead.
    pub newest_m: Option<f64>,
    /// In a corridor.
    #[serde(flatten)]
    pub way: Option<Way>,
}

/// A vehicle in a corridor.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Way {
    /// Its road.
    pub road: usize,
    /// Its kind, by which the cast tells its length and what it is capable of.
    pub kind: &'static str,
    /// Whether it is beyond the end of its way.
    pub has_left: bool,
    /// The intersection that its unit takes for the next one.
    pub next: Option<usize>,
    /// Its place in the order there, from 1 on, as it tells the others; none before it has arrived.
    pub place: Option<usize>,
    /// Distance from its front to the crossing point there.
    pub to_m: Option<f64>,
    /// The vehicle that its unit follows, or yields to.
    pub follows: Option<usize>,
}

/// A vehicle as its follower believes it to be.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Ghost {
    /// Which vehicle that is.
    pub of: usize,
    /// Front bumper, along that vehicle's own road.
    pub position_m: f64,
    /// Speed.
    pub speed_mps: f64,
    /// Age of the newest message.
    pub age_s: f64,
    /// Both ends of the bound of the position.
    pub bound_m: Option<[f64; 2]>,
    /// Estimated less true position.
    pub error_m: f64,
}

impl Ghost {
    /// The belief beside the truth.
    #[must_use]
    pub fn of(belief: &TargetBelief, of: usize, true_m: f64) -> Self {
        Self {
            of,
            position_m: rounded(belief.position_m),
            speed_mps: rounded(belief.speed_mps),
            age_s: rounded(belief.age_s),
            bound_m: belief.bound.map(|bound| [rounded(bound.lowest_position_m), rounded(bound.highest_position_m)]),
            error_m: rounded(belief.position_m - true_m),
        }
    }
}

/// What was set of the links, as the page is told.
#[must_use]
pub fn links(radios: &[(Option<usize>, Radio)]) -> Vec<(Option<usize>, [f64; 3])> {
    radios.iter().map(|(vehicle, radio)| (*vehicle, [radio.delay_mean_s, radio.delay_std_s, radio.loss])).collect()
}

/// To a tenth of a millimetre: more than a screen shows, and short on the wire.
#[must_use]
pub fn rounded(value: f64) -> f64 {
    (value * 1e4).round() / 1e4
}

/// What stays the same over a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Cast {
    /// What the page calls the scenario.
    pub title: String,
    /// Seed.
    pub seed: u64,
    /// Period of the ticks.
    pub period_s: f64,
    /// Index of the vehicle that the figures are about. In a corridor it may be still to come.
    pub ego: usize,
    /// Delay and loss of the links at the start; nothing for a recorded channel.
    pub radio: Option<[f64; 3]>,
    /// Whether the envelopes are engaged at the start.
    pub has_envelope: bool,
    /// Whether the leader drives a recording, so that nobody can take it over.
    pub is_recorded: bool,
    /// The vehicles; none in a corridor, where they come and go.
    pub vehicles: Vec<Role>,
    /// The vehicle that a device drives, in real time.
    pub device: Option<usize>,
    /// The corridor, if it is one.
    #[serde(flatten)]
    pub map: Option<Map>,
}

/// The roads of a corridor. Places are in metres to the east and to the north of the beginning of the first road.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Map {
    /// The roads.
    pub roads: Vec<Street>,
    /// The intersections.
    pub intersections: Vec<Square>,
    /// The kinds of vehicles, by name.
    pub kinds: BTreeMap<&'static str, Role>,
}

/// A road.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Street {
    /// Its name.
    pub name: String,
    /// Its corners: the distance along it, east, north.
    pub points: Vec<[f64; 3]>,
    /// Where vehicles appear, and where their way ends, along it.
    pub ends_m: [f64; 2],
}

/// An intersection.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Square {
    /// Its name.
    pub name: String,
    /// Half the length of its conflict area, along every road.
    pub half_m: f64,
    /// For each leg its road, and the distance along it to the crossing point.
    pub legs: Vec<(usize, f64)>,
}

/// A vehicle of the cast.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Role {
    /// What the page calls it.
    pub name: String,
    /// Length.
    pub length_m: f64,
    /// Whether it has a range sensor.
    pub has_sensor: bool,
    /// Largest acceleration that the pedals ask for.
    pub most_mps2: f64,
    /// Hardest braking that the pedals ask for, as a magnitude.
    pub braking_mps2: f64,
}
