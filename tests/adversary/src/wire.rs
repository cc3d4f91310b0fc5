//! Packing of frames: values enter and protected frames leave, for every message that this world sends; frames of the
//! unit enter and values leave. Layouts and data ids are those of `holdover.dbc`. The protection is AUTOSAR E2E Profile
//! 1, variant 1A, implemented independently of the core.

use std::sync::LazyLock;

use embedded_can::{Frame, Id, StandardId};

use crate::dbc::{Dbc, Message, Signal};

/// Number of slots in `holdover.dbc`.
pub const SLOTS: usize = 8;

/// A frame on the bus. Garbage may have any length up to 8.
#[derive(Clone, Copy, Debug)]
pub struct Can {
    /// Identifier of 11 bits.
    pub id: u16,
    /// Its data.
    pub data: [u8; 8],
    /// Number of data bytes.
    pub length: u8,
}

impl Frame for Can {
    fn new(id: impl Into<Id>, data: &[u8]) -> Option<Self> {
        let Id::Standard(id) = id.into() else { return None };
        let mut bytes = [0; 8];
        bytes.get_mut(..data.len())?.copy_from_slice(data);
        Some(Self { id: id.as_raw(), data: bytes, length: data.len() as u8 })
    }
    fn new_remote(_: impl Into<Id>, _: usize) -> Option<Self> {
        None
    }
    fn is_extended(&self) -> bool {
        false
    }
    fn is_remote_frame(&self) -> bool {
        false
    }
    fn id(&self) -> Id {
        Id::Standard(StandardId::new(self.id & 0x7FF).unwrap_or(StandardId::ZERO))
    }
    fn dlc(&self) -> usize {
        self.length.into()
    }
    fn data(&self) -> &[u8] {
        &self.data[..usize::from(self.length)]
    }
}

static CRC: LazyLock<[u8; 256]> = LazyLock::new(|| {
    core::array::from_fn(|byte| (0..8).fold(byte as u8, |crc, _| (crc << 1) ^ (if crc & 0x80 != 0 { 0x1D } else { 0 })))
});

fn crc(data_id: u16, data: &[u8; 8]) -> u8 {
    let table = &*CRC;
    let start = [data_id as u8, (data_id >> 8) as u8];
    start.iter().chain(&data[1..]).fold(0, |crc, byte| table[usize::from(crc ^ byte)])
}

/// A message, with its signals in the order in which they were requested.
#[derive(Clone, Debug)]
pub struct Layout<const N: usize> {
    /// Its identifier.
    pub id: u16,
    data_id: u16,
    /// Its signals.
    pub signals: [Signal; N],
}

impl<const N: usize> Layout<N> {
    fn new(message: &Message, names: [&str; N]) -> Self {
        Self { id: message.id, data_id: message.data_id, signals: names.map(|name| message.signal(name)) }
    }

    /// The 64 bits of an intact frame of this message.
    pub fn open(&self, frame: &impl Frame) -> Option<u64> {
        let data: [u8; 8] = frame.data().try_into().ok()?;
        (frame.id() == Id::Standard(StandardId::new(self.id)?) && data[0] == crc(self.data_id, &data))
            .then_some(u64::from_le_bytes(data))
    }

    /// A frame with these values, in the order of the signals.
    pub fn seal(&self, counters: &mut Counters, values: &[f64; N]) -> Can {
        let mut word = 0;
        for (signal, value) in self.signals.iter().zip(values) {
            signal.put(&mut word, *value);
        }
        self.seal_word(counters, word)
    }

    /// A frame with these bits.
    pub fn seal_word(&self, counters: &mut Counters, word: u64) -> Can {
        let counter = counters.next(self.id);
        let mut data = word.to_le_bytes();
        data[1] = (data[1] & 0xF0) | counter;
        data[0] = crc(self.data_id, &data);
        Can { id: self.id, data, length: 8 }
    }
}

/// A sender's counters, one for each identifier.
#[derive(Clone, Debug)]
pub struct Counters(Vec<u8>);

/// First identifier of the block; and the number of identifiers.
const BASE: u16 = 1152;
const BLOCK: usize = 192;

impl Counters {
    /// Counters that all start at this value.
    pub fn new(start: u8) -> Self {
        Self(vec![start % 15; BLOCK])
    }

    fn next(&mut self, id: u16) -> u8 {
        let counter = &mut self.0[usize::from(id - BASE)];
        *counter = (*counter + 1) % 15;
        *counter
    }
}

/// `MotionA` and `MotionB` of a sender.
#[derive(Clone, Debug)]
pub struct Motion {
    /// Tag, Position, Stamp, Station.
    pub a: Layout<4>,
    /// Tag, Speed, Acceleration, Demand, PositionAccuracy, SpeedAccuracy.
    pub b: Layout<6>,
}

/// `DrivingParameters` of a sender: Tag, Part, and the signals of each part.
#[derive(Clone, Debug)]
pub struct DrivingParameters {
    /// Length, Standstill, PredecessorKind, PredecessorStation, TargetSpeed.
    pub who: Layout<7>,
    /// TimeGap, Gain, Damping, Lag.
    pub law: Layout<6>,
    /// AccelerationLimit, BrakingLimit, JerkLimit, EmergencyBraking, HorizonLength.
    pub limits: Layout<7>,
}

/// The messages of this world.
#[derive(Clone, Debug)]
pub struct Book {
    /// Sequence, Seconds.
    pub sync: Layout<2>,
    /// Sequence, Micros.
    pub follow_up: Layout<2>,
    /// Acceleration, Mode, Limited.
    pub command: Layout<3>,
    /// Engaged, PredecessorKind, PredecessorStation, TargetSpeed, TimeGap.
    pub request: Layout<5>,
    /// Distance, SpeedDifference, DistanceAccuracy, SpeedAccuracy, Age.
    pub range: Layout<5>,
    /// Motion of the ego.
    pub ego: Motion,
    /// Tag, Part, Latitude, Stamp.
    pub place: Layout<4>,
    /// Tag, Part, Longitude, Heading.
    pub heading: Layout<4>,
    /// Tag, Position, Speed, Faster.
    pub estimate_a: Layout<4>,
    /// Tag, Behind, Ahead, Slower.
    pub estimate_b: Layout<4>,
    /// Cause, Count, Mode.
    pub health: Layout<3>,
    /// Messages of each slot.
    pub peers: Vec<(Motion, DrivingParameters)>,
    /// The unit's own messages for other vehicles, by their place in the block of a slot; and the same messages in each
    /// slot.
    pub own: Vec<(Layout<0>, Vec<Layout<0>>)>,
    all: Vec<Layout<0>>,
}

/// The messages of `holdover.dbc`.
pub static BOOK: LazyLock<Book> = LazyLock::new(|| Book::new(&Dbc::parse(include_str!("../../../holdover.dbc"))));

impl Book {
    /// Whether a random frame has a valid checksum.
    pub fn is_intact(&self, frame: &Can) -> bool {
        self.all.iter().any(|layout| layout.open(frame).is_some())
    }

    fn new(dbc: &Dbc) -> Self {
        let peers = (0..SLOTS).map(|slot| {
            let name = format!("Peer{slot}");
            (motion(dbc, &name), parameters(dbc, &name))
        });
        let own = ["MotionA", "MotionB", "Horizon", "DrivingParameters", "Position", "Route"].map(|what| {
            let bare = |name: String| Layout::new(dbc.message(&name), []);
            (bare(format!("Own{what}")), (0..SLOTS).map(|slot| bare(format!("Peer{slot}{what}"))).collect())
        });
        Self {
            sync: Layout::new(dbc.message("TimeSync"), ["Sequence", "Seconds"]),
            follow_up: Layout::new(dbc.message("TimeFollowUp"), ["Sequence", "Micros"]),
            command: Layout::new(dbc.message("MotionCommand"), ["Acceleration", "Mode", "Limited"]),
            request: Layout::new(
                dbc.message("DriverRequest"),
                ["Engaged", "PredecessorKind", "PredecessorStation", "TargetSpeed", "TimeGap"],
            ),
            range: Layout::new(
                dbc.message("RangeSensor"),
                ["Distance", "SpeedDifference", "DistanceAccuracy", "SpeedAccuracy", "Age"],
            ),
            ego: motion(dbc, "Ego"),
            place: Layout::new(dbc.message("EgoPosition"), ["Tag", "Part", "Latitude", "Stamp"]),
            heading: Layout::new(dbc.message("EgoPosition"), ["Tag", "Part", "Longitude", "Heading"]),
            estimate_a: Layout::new(dbc.message("TargetEstimateA"), ["Tag", "Position", "Speed", "Faster"]),
            estimate_b: Layout::new(dbc.message("TargetEstimateB"), ["Tag", "Behind", "Ahead", "Slower"]),
            health: Layout::new(dbc.message("Health"), ["Cause", "Count", "Mode"]),
            peers: peers.collect(),
            own: own.into(),
            all: dbc.messages().map(|message| Layout::new(message, [])).collect(),
        }
    }
}

fn motion(dbc: &Dbc, who: &str) -> Motion {
    let b = ["Tag", "Speed", "Acceleration", "Demand", "PositionAccuracy", "SpeedAccuracy"];
    Motion {
        a: Layout::new(dbc.message(&format!("{who}MotionA")), ["Tag", "Position", "Stamp", "Station"]),
        b: Layout::new(dbc.message(&format!("{who}MotionB")), b),
    }
}

fn parameters(dbc: &Dbc, who: &str) -> DrivingParameters {
    let message = dbc.message(&format!("{who}DrivingParameters"));
    let who = ["Tag", "Part", "Length", "Standstill", "PredecessorKind", "PredecessorStation", "TargetSpeed"];
    let limits = ["Tag", "Part", "AccelerationLimit", "BrakingLimit", "JerkLimit", "EmergencyBraking", "HorizonLength"];
    DrivingParameters {
        who: Layout::new(message, who),
        law: Layout::new(message, ["Tag", "Part", "TimeGap", "Gain", "Damping", "Lag"]),
        limits: Layout::new(message, limits),
    }
}

/// A position as the bus has it: millimetres modulo 2^25, in metres.
pub fn wrapped(position: f64) -> f64 {
    let raw = (position * 1000.0).round() as i64;
    (((raw << 39) >> 39) as f64) / 1000.0
}

/// GNSS time in microseconds as a stamp: 0.1 ms modulo 2^17, in seconds.
pub fn stamp(micros: i64) -> f64 {
    ((micros + 50).div_euclid(100).rem_euclid(1 << 17)) as f64 * 1e-4
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frame_opens_only_with_what_it_was_sealed_with() {
        let mut counters = Counters::new(13);
        let frame = BOOK.range.seal(&mut counters, &[101.5, -3.0, 0.25, 0.3, 0.01]);
        let word = BOOK.range.open(&frame).unwrap();
        assert!((BOOK.range.signals[0].get(word) - 101.5).abs() < 1e-9);
        assert_eq!(frame.data[1] & 0xF, 14);
        assert!(
            BOOK.range
                .open(&Can {
                    data: {
                        let mut d = frame.data;
                        d[5] ^= 4;
                        d
                    },
                    ..frame
                })
                .is_none()
        );
        assert_eq!(BOOK.range.seal(&mut counters, &[1.0; 5]).data[1] & 0xF, 0);
    }

    #[test]
    fn positions_and_stamps_wrap() {
        assert!((wrapped(16_777.216) + 16_777.216).abs() < 1e-9);
        assert!((stamp(13_107_200 + 300) - 0.0003).abs() < 1e-9);
    }
}
