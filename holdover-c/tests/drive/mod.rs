//! A short drive as a log of CAN frames: what happens enters as a script, rows of `examples/drive.inc` leave, and back. The
//! same rows are an initialiser in C.
#![allow(dead_code)] // each test needs its part

use embedded_can::{ExtendedId, Id, StandardId};
use holdover::time::{GnssTime, Stamp};
use holdover::units::{Acceleration, Distance, FineSeconds, Fraction, Gain, Jerk, Seconds, Speed};
use holdover::wire::driver_request::DriverRequest;
use holdover::wire::driving_parameters::{DrivingParameters, Limits};
use holdover::wire::motion::{Motion, WirePosition};
use holdover::wire::sync::{FollowUp, Sync};
use holdover::wire::{Identifiers, Message, Predecessor, Said, Sender, Slot, StationHash};
use holdover_c::{Config, Frame};

/// A row of the log.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Row {
    pub at_us: u64,
    pub frame: Frame,
}

/// Period of the ticks, which lie between the rows.
pub const TICK_US: u64 = 10_000;
/// When the last tick is.
pub const END_US: u64 = 6_500_000;

/// What differs from the default: as `examples/calibration.c` has it.
pub fn config() -> Config {
    let mut config = std::mem::MaybeUninit::uninit();
    // SAFETY: the place is there, and the call fills it in.
    let mut config = unsafe {
        assert_eq!(holdover_c::holdover_default_config(config.as_mut_ptr()), holdover_c::Status::Ok);
        config.assume_init()
    };
    config.station = 2;
    config.link.holdover_us = 1_000_000;
    config.envelope.engaged = 1;
    config
}

const TARGET: StationHash = StationHash(1);
const EGO: StationHash = StationHash(2);

/// GNSS time when the log begins.
const EPOCH_US: u64 = 1_000_000_000;

fn stamp(at_us: u64) -> Stamp {
    GnssTime::from_micros(EPOCH_US + at_us).stamp()
}

/// A vehicle at 10 m/s that accelerates with 0.5 m/s² from 1 s to 2 s.
fn motion(station: StationHash, start_mm: i64, at_us: u64, tag: u8) -> Motion {
    let (t, since) = (at_us as i64 / 1000, (at_us as i64 / 1000 - 1000).clamp(0, 1000)); // ms
    let speed = 10_000 + since / 2; // mm/s
    let way = 10 * t + since * since / 4000 + (t - 2000).max(0) / 2; // mm
    let acceleration = Acceleration::from_mm_per_s2(if since > 0 && since < 1000 { 500 } else { 0 });
    Motion {
        tag,
        position: WirePosition::from_mm(start_mm + way),
        speed: Speed::from_mm_per_s(speed as i32),
        acceleration,
        demand: acceleration,
        stamp: stamp(at_us),
        position_accuracy: Some(Distance::from_mm(300)),
        speed_accuracy: Some(Speed::from_mm_per_s(100)),
        station,
    }
}

fn parameters() -> DrivingParameters {
    DrivingParameters {
        length: Distance::from_mm(4800),
        standstill: Distance::from_mm(2000),
        predecessor: Predecessor::None,
        target_speed: Speed::from_mm_per_s(11_000),
        catch_up: Fraction::from_milli(200),
        time_gap: Seconds::from_millis(1000),
        gain: Gain::from_milli(500),
        damping: Seconds::from_millis(2000),
        feed_forward: Fraction::ZERO,
        lag: FineSeconds::from_millis(300),
        limits: Limits {
            acceleration: Acceleration::from_mm_per_s2(2500),
            braking: Acceleration::from_mm_per_s2(4000),
            jerk: Jerk::from_mm_per_s3(5000),
            emergency_braking: Acceleration::from_mm_per_s2(8000),
        },
        horizon_tenths: 0,
    }
}

/// What is sent in each millisecond, if the script has something for it.
fn said(ms: u64) -> Vec<Message> {
    let at_us = ms * 1000;
    let mut messages = Vec::new();
    let seconds = ((EPOCH_US + at_us) / 1_000_000) as u32;
    let sequence = (ms / 500 % 16) as u8;
    match ms % 500 {
        3 => messages.push(Message::Sync(Sync { sequence, seconds })),
        7 => {
            let micros = ((EPOCH_US + at_us - 4000) % 1_000_000) as u32;
            messages.push(Message::FollowUp(FollowUp { sequence, micros }));
        }
        _ => {}
    }
    if ms >= 100 && ms % 100 == 1 {
        let engaged = ms < 6200;
        let target_speed = Speed::from_mm_per_s(11_000);
        let predecessor = Predecessor::Station(TARGET);
        messages.push(Message::DriverRequest(DriverRequest { engaged, predecessor, target_speed, time_gap: None }));
    }
    // The own motion begins late and fails once.
    if ms % 20 == 2 && ms >= 300 && !(5000..5200).contains(&ms) {
        messages.push(Message::Ego(Said::Motion(motion(EGO, -20_000, at_us - 1000, (ms / 20 % 4) as u8))));
    }
    // The target is heard 40 ms late, and not at all for 2 s.
    if ms % 100 == 44 && ms >= 500 && !(2000..4000).contains(&ms) {
        messages.push(Message::Peer(Slot(0), Said::Motion(motion(TARGET, 0, at_us - 40_000, (ms / 100 % 4) as u8))));
    }
    if ms % 500 == 45 && ms >= 500 && !(2000..4000).contains(&ms) {
        messages.push(Message::Peer(Slot(0), Said::DrivingParameters(parameters())));
    }
    messages
}

/// The script, with what goes wrong on a bus.
pub fn drive() -> Vec<Row> {
    let mut sender = Sender::<1>::new(Identifiers::DEFAULT);
    let mut rows = Vec::new();
    for ms in 0..END_US / 1000 {
        for message in said(ms) {
            let mut at_us = ms * 1000;
            let emit = &mut |frame: holdover::wire::Frame| {
                at_us += 250; // a frame on the bus
                rows.push(Row { at_us, frame: Frame::from(&frame) });
            };
            sender.send(&message, emit).unwrap();
        }
        let Some(last) = rows.last().copied() else { continue };
        let at_us = ms * 1000 + 900;
        let bad = match ms {
            1502 => Frame { data: last.frame.data.map(|byte| byte ^ 0x10), ..last.frame }, // checksum
            1602 => last.frame,                                                            // repeated
            1702 => Frame { id: 0x7FF, ..last.frame },                                     // foreign
            1802 => Frame { extended: 1, ..last.frame },                                   // foreign
            1902 => Frame { remote: 1, ..last.frame },                                     // length
            1922 => Frame { length: 7, ..last.frame },                                     // length
            1942 => Frame { id: 0x480 + 0x40 + 8 * 8, ..last.frame },                      // slot 8 of 8
            _ => continue,
        };
        rows.push(Row { at_us, frame: bad });
    }
    rows
}

/// A frame that need not be one of the catalogue's, as the core takes it.
pub struct Heard(pub Frame);

impl embedded_can::Frame for Heard {
    fn new(_: impl Into<Id>, _: &[u8]) -> Option<Self> {
        None
    }

    fn new_remote(_: impl Into<Id>, _: usize) -> Option<Self> {
        None
    }

    fn is_extended(&self) -> bool {
        self.0.extended != 0
    }

    fn is_remote_frame(&self) -> bool {
        self.0.remote != 0
    }

    fn id(&self) -> Id {
        if self.is_extended() {
            return Id::Extended(ExtendedId::new(self.0.id).unwrap());
        }
        Id::Standard(StandardId::new(self.0.id as u16).unwrap())
    }

    fn dlc(&self) -> usize {
        usize::from(self.0.length)
    }

    fn data(&self) -> &[u8] {
        &self.0.data[..if self.is_remote_frame() { 0 } else { self.dlc() }]
    }
}

/// The rows as text.
pub fn text(rows: &[Row]) -> String {
    let mut text = String::from(
        "// A short drive: at (us), identifier, extended, remote, length, data. Made by\n\
         // HOLDOVER_WRITE_DRIVE=1 cargo test -p holdover-c --test agreement\n",
    );
    for Row { at_us, frame } in rows {
        let data: Vec<_> = frame.data.iter().map(|byte| format!("{byte:#04x}")).collect();
        let Frame { id, extended, remote, length, .. } = frame;
        text += &format!("{{{at_us}, {{{id:#05x}, {extended}, {remote}, {length}, {{{}}}}}}},\n", data.join(", "));
    }
    text
}

/// The text as rows.
pub fn parse(text: &str) -> Vec<Row> {
    let number = |word: &str| match word.strip_prefix("0x") {
        Some(hex) => u64::from_str_radix(hex, 16).unwrap(),
        None => word.parse().unwrap(),
    };
    let row = |line: &str| {
        let words: Vec<u64> = line.split(['{', '}', ',', ' ']).filter(|word| !word.is_empty()).map(number).collect();
        let [at_us, id, extended, remote, length, data @ ..] = &words[..] else { panic!("{line}") };
        let data: Vec<u8> = data.iter().map(|byte| *byte as u8).collect();
        let [extended, remote, length] = [*extended, *remote, *length].map(|number| number as u8);
        Row { at_us: *at_us, frame: Frame { id: *id as u32, extended, remote, length, data: data.try_into().unwrap() } }
    };
    text.lines().filter(|line| line.starts_with('{')).map(row).collect()
}
