//! What `record` writes of all that happens on a bus, and how it ends.

use std::collections::VecDeque;
use std::io;

use embedded_can::{ExtendedId, Id, StandardId};
use holdover::time::Instant;
use holdover_sim::bus::Frame;
use holdover_sim::bus::candump::LogWriter;
use holdover_sim::bus::port::{BusError, Event, Port};
use holdover_sim::commands::interruption::Interruption;
use holdover_sim::commands::record::{Recorded, record};

/// A port with these events. After the last one it asks for the end of the recording.
struct Events(VecDeque<Event>, Interruption);

impl Port for Events {
    fn now(&self) -> Instant {
        Instant::from_micros(1_500_000)
    }

    fn send(&mut self, _: Frame) -> io::Result<()> {
        Ok(())
    }

    fn send_error(&mut self, _: BusError) -> io::Result<()> {
        Ok(())
    }

    fn wait(&mut self, _: Instant) -> io::Result<Option<(Instant, Event)>> {
        if self.0.is_empty() {
            self.1.ask();
        }
        Ok(self.0.pop_front().map(|event| (self.now(), event)))
    }
}

#[test]
fn every_frame_is_recorded_can_fd_too_and_a_signal_ends_it_with_a_complete_log() {
    let standard = Id::Standard(StandardId::new(0x123).unwrap());
    let extended = Id::Extended(ExtendedId::new(0x123).unwrap());
    let events = [
        Event::Received(Frame::standard(0x123, &[0xAB]).unwrap()),
        Event::Received(Frame::fd(standard, 5, &[0xAA, 0xBB, 0xCC]).unwrap()),
        Event::Received(Frame::fd(extended, 0x14, &[0x11; 64]).unwrap()),
        Event::Error(BusError::BUS_OFF),
    ];
    let interruption = Interruption::default();
    let mut port = Events(events.into(), interruption.clone());
    let mut log = Vec::new();
    let writer = LogWriter::new(&mut log, "can0").unwrap();
    let recorded = record(&mut port, writer, None, &interruption).unwrap();
    assert_eq!(recorded, Recorded { frames: 4, fd: 2 });
    assert_eq!(recorded.to_string(), "4 frames recorded, 2 of them CAN FD");
    let lines = ["123#AB", "123##5AABBCC", &format!("00000123##4{}", "11".repeat(64)), "20000040#0000000000000000"];
    let expected: String = lines.map(|line| format!("(0000000001.500000) can0 {line}\n")).concat();
    assert_eq!(String::from_utf8(log).unwrap(), expected);
}
