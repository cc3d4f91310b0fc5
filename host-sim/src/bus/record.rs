//! Recording of the frames of a node: all frames that it sends and receives are written to a candump log.

use super::{Bus, Frame};
use crate::bus::candump::LogWriter;
use holdover::time::Instant;
use std::io::{self, Write};

/// A node whose traffic is recorded.
#[derive(Debug)]
pub struct Recorder<B, W> {
    bus: B,
    log: LogWriter<W>,
}

impl<B: Bus, W: Write> Recorder<B, W> {
    /// Wraps a node. The log is in the order of calls. That is the order of time if the node receives up to now before
    /// it sends.
    pub fn new(bus: B, log: LogWriter<W>) -> Self {
        Self { bus, log }
    }

    /// Ends the recording.
    ///
    /// # Errors
    /// The buffered rest cannot be written.
    pub fn finish(self) -> io::Result<W> {
        self.log.finish()
    }
}

impl<B: Bus, W: Write> Bus for Recorder<B, W> {
    fn send(&mut self, at: Instant, frame: Frame) -> io::Result<()> {
        self.log.write(at, &frame)?;
        self.bus.send(at, frame)
    }

    fn receive(&mut self, upto: Instant) -> io::Result<Option<(Instant, Frame)>> {
        let received = self.bus.receive(upto)?;
        if let Some((at, frame)) = &received {
            self.log.write(*at, frame)?;
        }
        Ok(received)
    }
}

#[cfg(test)]
mod tests {
    use super::super::memory::MemoryBus;
    use super::*;

    #[test]
    fn sent_and_received_frames_stand_in_the_log_as_candump_writes_them() {
        let bus = MemoryBus::new();
        let (mut other, node) = (bus.node(), bus.node());
        let mut recorded = Recorder::new(node, LogWriter::new(Vec::new(), "can0").unwrap());
        other.send(Instant::from_micros(1_500_000), Frame::standard(0x123, &[0xAB, 1]).unwrap()).unwrap();
        recorded.receive(Instant::from_micros(2_000_000)).unwrap();
        recorded.send(Instant::from_micros(2_000_000), Frame::extended(0x9, &[]).unwrap()).unwrap();
        let log = String::from_utf8(recorded.finish().unwrap()).unwrap();
        assert_eq!(log, "(0000000001.500000) can0 123#AB01\n(0000000002.000000) can0 00000009#\n");
    }
}
