//! A serial CAN adapter as a CAN port: frames enter and leave as lines of text over USART1.

use super::clocks::Clocks;
use super::line::{self, Line, Text};
use super::serial::{self, Serial};
use crate::board::frame::CanFrame;
use crate::board::port::{Fate, Overrun, Port};
use crate::board::stm32::port::Select;

/// The adapter.
pub struct Slcan {
    serial: Serial,
    line: Line,
    /// What is being sent, last byte first.
    outgoing: Text,
}

impl Slcan {
    /// Moves on what is being sent; whether something is left of it.
    fn pump(&mut self) -> bool {
        while let Some(&byte) = self.outgoing.last() {
            if !self.serial.write(byte) {
                return true;
            }
            self.outgoing.pop();
        }
        false
    }
}

impl Select for Slcan {
    const INTERRUPTS: &'static [i16] = &[serial::INTERRUPT];
    /// An interrupt for every byte would cost the tick more than it gains: an adapter has a queue of its own.
    const TELLS_WHEN_SENT: bool = false;

    /// An adapter passes everything: what it would take to filter differs from one to the next.
    fn start(clocks: &Clocks) -> Self {
        // It is shorter than the longest line.
        let mut outgoing = Text::from_slice(line::OPENING).unwrap_or_default();
        outgoing.reverse();
        Self { serial: Serial::start(clocks), line: Line::new(), outgoing }
    }
}

impl Port for Slcan {
    /// Half a line would be taken for the beginning of the next one.
    const TAKES_BACK: bool = false;

    fn receive(&mut self) -> Result<Option<CanFrame>, Overrun> {
        loop {
            match self.serial.read() {
                Ok(None) => return Ok(None),
                Ok(Some(byte)) => {
                    if let Some(frame) = self.line.take(byte) {
                        return Ok(Some(frame));
                    }
                }
                Err(overrun) => {
                    self.line.spoil();
                    return Err(overrun);
                }
            }
        }
    }

    /// Begins to send a frame, if the one before it has gone.
    fn load(&mut self, frame: &CanFrame) -> Option<usize> {
        if self.pump() {
            return None;
        }
        self.outgoing = line::encode(frame);
        self.outgoing.reverse();
        self.pump();
        Some(0)
    }

    /// It is sent when the adapter has it; what the adapter does with it nobody can tell.
    fn fate(&mut self, _: usize) -> Fate {
        if self.pump() { Fate::Underway } else { Fate::Sent }
    }

    fn recall(&mut self, _: usize) {}

    /// The adapter keeps the state of its bus to itself.
    fn left_bus(&mut self) -> bool {
        false
    }
}
