//! A drive as data: everything that decides what happens in it. A scenario is drawn by `family.rs`, run by `world.rs`, made
//! smaller by `shrink.rs`, and kept as a TOML file.

use serde::{Deserialize, Serialize};

use crate::broken::Assumption;

/// What kind of drive it is.
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
    /// All of them.
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

    /// As on the command line.
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
    /// At one edge or the other, anew each time.
    Edges,
    /// Always at the same edge.
    High,
    Low,
}

/// A sensor of position and speed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sensor {
    /// Published accuracies, m and m/s; none are published if negative.
    pub position: f64,
    pub speed: f64,
    /// How it errs in position.
    pub error: Error,
    /// How it errs in speed.
    pub speed_error: Error,
}

/// The vehicle with the unit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Ego {
    /// Where its front bumper is at time 0, m, and how fast it is, m/s.
    pub position: f64,
    pub speed: f64,
    /// The speed that the driver wants, m/s, and the time gap, s.
    pub wanted: f64,
    pub gap: f64,
    /// Configured lag, s, and the true one's ratio to it.
    pub lag: f64,
    pub lag_factor: f64,
    /// What its road allows, m/s².
    pub road: f64,
    /// Its own sensors.
    pub sensor: Sensor,
    /// What the reported acceleration is off by, m/s².
    pub acceleration_off: f64,
    /// When the driver engages the unit, s.
    pub engages: f64,
    /// The unit's clock when the drive begins, µs, and its drift, ppm.
    pub clock: u64,
    pub drift: f64,
    /// When the unit is started, s.
    pub starts: f64,
    /// Whether the envelope is on.
    pub envelope: bool,
    /// Whether the unit has 400 steps.
    pub long: bool,
}

/// The link between stations.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Radio {
    /// Least delay and mean of what is added, s.
    pub delay: f64,
    pub jitter: f64,
    /// Share of messages that take up to `tail` seconds, so that they are overtaken.
    pub tails: f64,
    pub tail: f64,
    /// Fraction that is lost, and mean number that is lost in a row.
    pub loss: f64,
    pub burst: f64,
}

/// The vehicle's own bus.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Bus {
    /// Share of single frames that are lost, and that come twice.
    pub loss: f64,
    pub twice: f64,
    /// Largest error of the time at which a synchronisation is received, µs.
    pub jitter: f64,
}

/// Another vehicle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Peer {
    /// Its hash; 0 has no V2X.
    pub station: u8,
    /// The slot that the modem gives it.
    pub slot: u8,
    /// Bumper to bumper, m, true and published.
    pub length: f64,
    /// Published hardest braking and acceleration, m/s².
    pub braking: f64,
    pub pulling: f64,
    /// Front bumper ahead of the ego's at time 0, m, and speed, m/s.
    pub ahead: f64,
    pub speed: f64,
    /// Whether it is on the ego's lane.
    pub on_lane: bool,
    /// Whether it publishes its limits.
    pub intends: bool,
    /// Its sensors.
    pub sensor: Sensor,
    /// What its clock is ahead of GNSS time, µs.
    pub clock: f64,
    /// When in a period it speaks, s; 0 to 0.1.
    pub phase: f64,
    /// Acceleration at first, m/s².
    pub demand: f64,
}

/// The range sensor.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Range {
    /// Whether there is one.
    pub fitted: bool,
    /// How far it sees, m.
    pub sees: f64,
    /// Its accuracies and how it errs.
    pub sensor: Sensor,
    /// Age of what it says, s.
    pub age: f64,
    /// Share of views that it misses.
    pub misses: f64,
}

/// What happens at an instant. `peer` is the number of a peer in its list.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", tag = "what")]
pub enum What {
    /// Demands an acceleration; beyond its published limits it takes the limit. -99 is "as hard as it may".
    Drive { peer: usize, demand: f64 },
    /// Publishes other limits, and drives by them as soon as it may.
    Limits { peer: usize, braking: f64, pulling: f64 },
    /// Publishes another length, not less than the true one.
    Length { peer: usize, published: f64 },
    /// Says nothing for so long.
    Mute { peer: usize, seconds: f64 },
    /// The ego's modem hears nobody.
    Deaf { seconds: f64 },
    /// No time synchronisation.
    NoTime { seconds: f64 },
    /// The `MotionA` (or `B`) of its next message is lost on the bus, and then it is not heard for so many messages.
    Torn { peer: usize, half: u8, messages: u32 },
    /// Its next message is held back until one with the same tag comes, and the `MotionA` (or `B`) of it is lost on the bus.
    Overtaken { peer: usize, half: u8 },
    /// The modem puts it in another slot.
    Slot { peer: usize, slot: u8 },
    /// It takes another identity.
    Station { peer: usize, station: u8 },
    /// The driver names whom to follow; 0: nobody.
    Follow { station: u8 },
    /// The driver wants another speed.
    Wanted { speed: f64 },
    /// It comes onto the ego's lane as soon as there is room.
    CutIn { peer: usize },
    /// It leaves the ego's lane.
    Leave { peer: usize },
    /// The range sensor sees nothing.
    Blind { seconds: f64 },
    /// The modem says its next message again so many times; if it is to be off, one that its station never sent, off by so much.
    Copies { peer: usize, count: u32, off: f64 },
    /// So many frames of garbage: bad lengths, bad checksums.
    Garbage { count: u32 },
    /// So many messages that its station never sent, off by so many metres, with good checksums.
    Forged { peer: usize, count: u32, off: f64 },
    /// A motion of another station appears in its slot so many times.
    Intruder { peer: usize, station: u8, count: u32 },
    /// A synchronisation comes so much later than it says (or earlier, if negative), s.
    SyncOff { seconds: f64 },
    /// So many ticks do not happen.
    Missed { ticks: u32 },
    /// No `EgoMotion`.
    NoEgo { seconds: f64 },
    /// Everything is well from here on.
    Well,
}

/// An event.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Event {
    /// When, s.
    pub at: f64,
    /// What.
    #[serde(flatten)]
    pub what: What,
}

/// A drive.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Scenario {
    /// Its kind.
    pub family: Family,
    /// What it breaks, and by how much, in the assumption's own measure.
    pub broken: Option<Assumption>,
    #[serde(default)]
    pub amount: f64,
    /// How far ahead of itself the checker takes the truth to be, m: a fault of its own, to show that it is found.
    #[serde(default)]
    pub shifted: f64,
    /// Of everything that is drawn while it runs.
    pub seed: u64,
    /// How long it lasts, s.
    pub length: f64,
    /// GNSS time at its beginning, µs.
    pub epoch: i64,
    /// Whom the driver tells the unit to follow at first; 0: nobody.
    pub follow: u8,
    pub ego: Ego,
    pub radio: Radio,
    pub bus: Bus,
    pub range: Range,
    /// At an intersection: where each of the other vehicles comes from.
    #[serde(default)]
    pub crossing: Vec<crate::crossing::Comer>,
    #[serde(default)]
    pub peer: Vec<Peer>,
    #[serde(default)]
    pub event: Vec<Event>,
}

impl Scenario {
    /// As a file.
    pub fn to_text(&self) -> String {
        toml::to_string(self).expect("a scenario is a table")
    }

    /// From a file.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn from_text(text: &str) -> Result<Self, String> {
        toml::from_str(text).map_err(|error| error.to_string())
    }
}
