//! A drive as data: all that decides what happens in it. A scenario is drawn by `family.rs`, run by `world.rs`, shrunk
//! by `shrink.rs`, and stored as a TOML file.

use serde::{Deserialize, Serialize};

use crate::broken::Assumption;

/// The kind of a drive.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Family {
    Following,
    Closing,
    Stranger,
    CutIn,
    Lorry,
    Silence,
    Restart,
    Slots,
    Garbage,
    Crossing,
}

impl Family {
    /// All families.
    pub const ALL: [Self; 10] = [
        Self::Following,
        Self::Closing,
        Self::Stranger,
        Self::CutIn,
        Self::Lorry,
        Self::Silence,
        Self::Restart,
        Self::Slots,
        Self::Garbage,
        Self::Crossing,
    ];

    /// Its name on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Following => "following",
            Self::Closing => "closing",
            Self::Stranger => "stranger",
            Self::CutIn => "cut-in",
            Self::Lorry => "lorry",
            Self::Silence => "silence",
            Self::Restart => "restart",
            Self::Slots => "slots",
            Self::Garbage => "garbage",
            Self::Crossing => "crossing",
        }
    }
}

/// How a sensor errs, up to its largest error.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Error {
    None,
    Uniform,
    /// At one end of the range or the other, drawn each time.
    Edges,
    /// Always at the same end of the range.
    High,
    Low,
}

/// A sensor of position and speed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sensor {
    /// Published accuracies, m and m/s; not published if negative.
    pub position: f64,
    pub speed: f64,
    /// Error of the position.
    pub error: Error,
    /// Error of the speed.
    pub speed_error: Error,
}

/// The vehicle with the unit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Ego {
    /// Front bumper at time 0, m, and speed, m/s.
    pub position: f64,
    pub speed: f64,
    /// The driver's target speed, m/s, and time gap, s.
    pub wanted: f64,
    pub gap: f64,
    /// Configured lag, s, and the ratio of the true lag to it.
    pub lag: f64,
    pub lag_factor: f64,
    /// Hardest braking that its road allows, m/s².
    pub road: f64,
    /// Its own sensors.
    pub sensor: Sensor,
    /// Error of the reported acceleration, m/s².
    pub acceleration_off: f64,
    /// Time at which the driver engages the unit, s.
    pub engages: f64,
    /// The unit's clock at the beginning of the drive, µs, and its drift, ppm.
    pub clock: u64,
    pub drift: f64,
    /// Time at which the unit is started, s.
    pub starts: f64,
    /// Whether the envelope is engaged.
    pub envelope: bool,
    /// Whether the unit has 400 steps.
    pub long: bool,
}

/// The link between stations.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Radio {
    /// Least delay, and mean of the random delay that is added, s.
    pub delay: f64,
    pub jitter: f64,
    /// Fraction of messages that take up to `tail` seconds, so that later ones overtake them.
    pub tails: f64,
    pub tail: f64,
    /// Fraction of messages that are lost, and mean number of losses in a row.
    pub loss: f64,
    pub burst: f64,
}

/// The vehicle's own bus.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Bus {
    /// Fractions of single frames that are lost, and that come twice.
    pub loss: f64,
    pub twice: f64,
    /// Largest error of the time of reception of a synchronisation, µs.
    pub jitter: f64,
}

/// Another vehicle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Peer {
    /// Its hash; 0 for a vehicle without V2X.
    pub station: u8,
    /// The slot that the modem gives it.
    pub slot: u8,
    /// Length, bumper to bumper, m: true and published.
    pub length: f64,
    /// Published hardest braking and acceleration, m/s².
    pub braking: f64,
    pub pulling: f64,
    /// Distance of its front bumper ahead of the ego's at time 0, m, and speed, m/s.
    pub ahead: f64,
    pub speed: f64,
    /// Whether it is on the ego's lane.
    pub on_lane: bool,
    /// Whether it publishes its driving parameters.
    pub intends: bool,
    /// Its sensors.
    pub sensor: Sensor,
    /// Offset of its clock to GNSS time, µs; positive if ahead.
    pub clock: f64,
    /// Time of its messages within a period, s; 0 to 0.1.
    pub phase: f64,
    /// Acceleration at the beginning, m/s².
    pub demand: f64,
}

/// The range sensor.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Range {
    /// Whether the ego has one.
    pub fitted: bool,
    /// Its range, m.
    pub sees: f64,
    /// Its accuracies and errors.
    pub sensor: Sensor,
    /// Age of its measurements, s.
    pub age: f64,
    /// Fraction of measurements that it misses.
    pub misses: f64,
}

/// An event. `peer` is the index of a peer in the scenario's list.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", tag = "what")]
pub enum What {
    /// The peer demands an acceleration. A demand beyond its published limits becomes the limit. -99 stands for the
    /// hardest braking that is allowed.
    Drive { peer: usize, demand: f64 },
    /// The peer publishes other limits, and drives by them as soon as it may.
    Limits { peer: usize, braking: f64, pulling: f64 },
    /// The peer publishes another length, not less than the true one.
    Length { peer: usize, published: f64 },
    /// The peer is silent for this time.
    Mute { peer: usize, seconds: f64 },
    /// The ego's modem receives nothing.
    Deaf { seconds: f64 },
    /// No time synchronisation.
    NoTime { seconds: f64 },
    /// The `MotionA` (or `B`) of the peer's next message is lost on the bus. Then the peer is not received for this
    /// many messages.
    Torn { peer: usize, half: u8, messages: u32 },
    /// The peer's next message is held back until one with the same tag comes. The `MotionA` (or `B`) of that message
    /// is lost on the bus.
    Overtaken { peer: usize, half: u8 },
    /// The modem puts the peer into another slot.
    Slot { peer: usize, slot: u8 },
    /// The peer takes another station.
    Station { peer: usize, station: u8 },
    /// The driver names the station to follow; 0: none.
    Follow { station: u8 },
    /// The driver requests another speed.
    Wanted { speed: f64 },
    /// The peer comes onto the ego's lane as soon as there is room.
    CutIn { peer: usize },
    /// The peer leaves the ego's lane.
    Leave { peer: usize },
    /// The range sensor sees nothing.
    Blind { seconds: f64 },
    /// The modem repeats the peer's next message this many times. If `off` is not 0, it repeats a message that the
    /// station never sent, wrong by this much.
    Copies { peer: usize, count: u32, off: f64 },
    /// This many frames of garbage: wrong lengths, wrong checksums.
    Garbage { count: u32 },
    /// This many messages that the station never sent, wrong by this many metres, with valid checksums.
    Forged { peer: usize, count: u32, off: f64 },
    /// A motion of another station appears in the peer's slot this many times.
    Intruder { peer: usize, station: u8, count: u32 },
    /// A synchronisation comes later than it says by this time, s (earlier, if negative).
    SyncOff { seconds: f64 },
    /// The unit misses this many ticks.
    Missed { ticks: u32 },
    /// No `EgoMotion`.
    NoEgo { seconds: f64 },
    /// From now on no fault is injected.
    Well,
}

/// An event and its time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Event {
    /// Time, s.
    pub at: f64,
    /// The event.
    #[serde(flatten)]
    pub what: What,
}

/// A drive.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Scenario {
    /// Its kind.
    pub family: Family,
    /// The broken assumption, and by how much it is broken, in that assumption's own measure.
    pub broken: Option<Assumption>,
    #[serde(default)]
    pub amount: f64,
    /// An error of the checker itself, to show that it is found: how far ahead of its true place it takes a vehicle to
    /// be, m.
    #[serde(default)]
    pub shifted: f64,
    /// Seed of everything that is drawn during the run.
    pub seed: u64,
    /// Length, s.
    pub length: f64,
    /// GNSS time at its beginning, µs.
    pub epoch: i64,
    /// The station that the driver names at first; 0: none.
    pub follow: u8,
    pub ego: Ego,
    pub radio: Radio,
    pub bus: Bus,
    pub range: Range,
    /// At an intersection: the approaches of the other vehicles.
    #[serde(default)]
    pub crossing: Vec<crate::crossing::Comer>,
    #[serde(default)]
    pub peer: Vec<Peer>,
    #[serde(default)]
    pub event: Vec<Event>,
}

impl Scenario {
    /// The scenario as a file.
    pub fn to_text(&self) -> String {
        toml::to_string(self).expect("a scenario is a table")
    }

    /// Reads the scenario from a file.
    ///
    /// # Errors
    /// The reason why it cannot be read.
    pub fn from_text(text: &str) -> Result<Self, String> {
        toml::from_str(text).map_err(|error| error.to_string())
    }
}
