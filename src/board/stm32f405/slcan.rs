//! The line protocol of serial CAN adapters: bytes of the serial line enter and frames leave, and the other way round.
//!
//! A frame is one line that ends with a carriage return: `t` and three hexadecimal digits of a standard identifier or
//! `T` and eight of an extended one, a digit for the length, and two digits for each data byte; `r` and `R` are the
//! same for remote frames, without data. Everything else (set-up commands, acknowledgements) is not for the unit.

use super::clocks::Clocks;
use super::port::Select;
use super::serial::{self, Overrun, Serial};
use crate::board::frame::CanFrame;
use crate::board::port::Port;
use embedded_can::nb::Can;
use embedded_can::{Error, ErrorKind, ExtendedId, Frame, Id, StandardId};
use heapless::Vec;

/// The longest line that says anything: an extended frame with 8 bytes of data.
const LONGEST: usize = 1 + 8 + 1 + 2 * 8;

/// A line with its end.
type Text = Vec<u8, { LONGEST + 1 }>;

/// A serial CAN adapter as a CAN port.
pub struct Slcan {
    serial: Serial,
    line: Line,
    /// The line that is being sent, last byte first.
    outgoing: Text,
}

impl Error for Overrun {
    fn kind(&self) -> ErrorKind {
        ErrorKind::Overrun
    }
}

impl Can for Slcan {
    type Frame = CanFrame;
    type Error = Overrun;

    /// Begins to send a frame, if the one before it has gone.
    fn transmit(&mut self, frame: &CanFrame) -> nb::Result<Option<CanFrame>, Overrun> {
        if self.pump() {
            return Err(nb::Error::WouldBlock);
        }
        self.outgoing = encode(frame);
        self.outgoing.reverse();
        self.pump();
        Ok(None)
    }

    fn receive(&mut self) -> nb::Result<CanFrame, Overrun> {
        loop {
            match self.serial.read() {
                Ok(None) => return Err(nb::Error::WouldBlock),
                Ok(Some(byte)) => {
                    if let Some(frame) = self.line.take(byte) {
                        return Ok(frame);
                    }
                }
                Err(overrun) => {
                    self.line.spoil();
                    return Err(nb::Error::Other(overrun));
                }
            }
        }
    }
}

impl Select for Slcan {
    const INTERRUPT: i16 = serial::INTERRUPT;

    fn start(clocks: &Clocks) -> Self {
        Self { serial: Serial::start(clocks), line: Line::new(), outgoing: Text::new() }
    }

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

impl Port for Slcan {
    /// The adapter keeps the state of its bus to itself.
    fn left_bus(&mut self) -> bool {
        false
    }
}

/// The line that is being received. What follows the longest line, up to its end, is dropped with it.
struct Line {
    text: Vec<u8, LONGEST>,
    /// Whether it is longer than any that says something, or a byte of it is lost.
    spoilt: bool,
}

impl Line {
    const fn new() -> Self {
        Self { text: Vec::new(), spoilt: false }
    }

    /// A byte of it is lost.
    fn spoil(&mut self) {
        self.spoilt = true;
    }

    /// The frame that this byte completes.
    fn take(&mut self, byte: u8) -> Option<CanFrame> {
        if byte != b'\r' {
            self.spoilt |= self.text.push(byte).is_err();
            return None;
        }
        let frame = if self.spoilt { None } else { decode(&self.text) };
        *self = Self::new();
        frame
    }
}

fn decode(line: &[u8]) -> Option<CanFrame> {
    let (&kind, rest) = line.split_first()?;
    let digits = if matches!(kind, b't' | b'r') { 3 } else { 8 };
    let (id, rest) = rest.split_at_checked(digits)?;
    let id = hexadecimal(id)?;
    let (length, rest) = rest.split_at_checked(1)?;
    let length = hexadecimal(length)? as usize;
    let id: Id = match kind {
        b't' | b'r' => StandardId::new(u16::try_from(id).ok()?)?.into(),
        b'T' | b'R' => ExtendedId::new(id)?.into(),
        _ => return None,
    };
    if matches!(kind, b'r' | b'R') {
        return CanFrame::new_remote(id, length);
    }
    if rest.len() != 2 * length {
        return None;
    }
    let mut data = Vec::<u8, 8>::new();
    for pair in rest.chunks_exact(2) {
        data.push(u8::try_from(hexadecimal(pair)?).ok()?).ok()?;
    }
    CanFrame::new(id, &data)
}

/// The value of up to 8 hexadecimal digits.
fn hexadecimal(digits: &[u8]) -> Option<u32> {
    digits.iter().try_fold(0u32, |value, &digit| Some(value << 4 | char::from(digit).to_digit(16)?))
}

/// The line of a frame, with its end.
fn encode(frame: &impl Frame) -> Text {
    let mut line = Text::new();
    let (kind, id, digits) = match frame.id() {
        Id::Standard(id) => (b't', u32::from(id.as_raw()), 3),
        Id::Extended(id) => (b'T', id.as_raw(), 8),
    };
    let kind = if frame.is_remote_frame() { kind - 2 } else { kind };
    // No push can fail: the longest frame is what the capacity was computed from.
    let _ = line.push(kind);
    push_hexadecimal(&mut line, id, digits);
    push_hexadecimal(&mut line, frame.dlc() as u32, 1);
    for &byte in frame.data() {
        push_hexadecimal(&mut line, u32::from(byte), 2);
    }
    let _ = line.push(b'\r');
    line
}

fn push_hexadecimal(line: &mut Text, value: u32, digits: u32) {
    for place in (0..digits).rev() {
        let digit = char::from_digit(value >> (4 * place) & 0xf, 16).map_or(b'0', |digit| digit as u8);
        let _ = line.push(digit.to_ascii_uppercase());
    }
}
