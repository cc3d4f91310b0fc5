//! The frames on the bus of a vehicle, as the page shows them: frames with their times enter; for each identifier the newest frame, and how
//! busy the bus is, leave.

use std::collections::{BTreeMap, VecDeque};
use std::io;

use embedded_can::{Frame as _, Id};
use serde::Serialize;

use crate::bus::memory::MemoryNode;
use crate::bus::wire::length;
use crate::bus::{Bus, Frame};
use crate::sim::vehicle::Vehicle;

/// The load is of so many seconds.
const LOAD_OVER_S: f64 = 1.0;

/// A listener on the bus of a vehicle.
pub struct BusView {
    node: MemoryNode,
    rows: BTreeMap<u32, Newest>,
    /// When each frame of the last second was on the bus, and for how long.
    recent: VecDeque<(f64, f64)>,
}

/// The newest frame of an identifier, as it was on the bus.
#[derive(Clone, Copy)]
struct Newest {
    at_s: f64,
    cycle_s: Option<f64>,
    count: u64,
    frame: Frame,
}

/// The newest frame of an identifier.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// The identifier.
    pub id: u32,
    /// Whether it has 29 bits.
    pub is_extended: bool,
    /// When the frame was on the bus.
    pub at_s: f64,
    /// Time since the one before.
    pub cycle_s: Option<f64>,
    /// How many there were.
    pub count: u64,
    /// The bytes, in hexadecimal digits.
    pub data: String,
}

impl BusView {
    /// Listens from now on.
    #[must_use]
    pub fn of(vehicle: &Vehicle) -> Self {
        Self { node: vehicle.listen(), rows: BTreeMap::new(), recent: VecDeque::new() }
    }

    /// The same on the bus of a copy of the vehicle.
    #[must_use]
    pub fn on(&self, copy: &Vehicle) -> Self {
        Self { node: copy.adopt(&self.node), rows: self.rows.clone(), recent: self.recent.clone() }
    }

    /// Takes in what was on the bus up to now.
    ///
    /// # Errors
    /// Errors of the bus.
    pub fn listen(&mut self, vehicle: &Vehicle, at_s: f64) -> io::Result<()> {
        while let Some((at, frame)) = self.node.receive(vehicle.instant(at_s))? {
            self.note(vehicle.time_of(at), &frame);
        }
        while self.recent.front().is_some_and(|(since_s, _)| *since_s < at_s - LOAD_OVER_S) {
            self.recent.pop_front();
        }
        Ok(())
    }

    fn note(&mut self, at_s: f64, frame: &Frame) {
        self.recent.push_back((at_s, length(frame).as_micros() as f64 * 1e-6));
        let (id, _) = number(frame);
        let before = self.rows.get(&id);
        let (cycle_s, count) = (before.map(|row| at_s - row.at_s), before.map_or(0, |row| row.count) + 1);
        self.rows.insert(id, Newest { at_s, cycle_s, count, frame: *frame });
    }

    /// The share of the last second in which the bus was busy.
    #[must_use]
    pub fn load(&self) -> f64 {
        self.recent.iter().map(|(_, length_s)| length_s).sum::<f64>() / LOAD_OVER_S
    }

    /// The newest frame of every identifier.
    #[must_use]
    pub fn rows(&self) -> Vec<Row> {
        let row = |Newest { at_s, cycle_s, count, frame }: &Newest| {
            let (id, is_extended) = number(frame);
            let data = frame.data().iter().map(|byte| format!("{byte:02x}")).collect();
            Row { id, is_extended, at_s: *at_s, cycle_s: *cycle_s, count: *count, data }
        };
        self.rows.values().map(row).collect()
    }
}

/// The identifier, and whether it has 29 bits.
fn number(frame: &Frame) -> (u32, bool) {
    match frame.id() {
        Id::Standard(id) => (u32::from(id.as_raw()), false),
        Id::Extended(id) => (id.as_raw(), true),
    }
}
