//! The line protocol of serial CAN adapters: bytes enter and frames leave, and the other way round.
//!
//! A frame is one line that ends with a carriage return: `t` and three hexadecimal digits of a standard identifier or
//! `T` and eight of an extended one, a digit for the length, and two digits for each data byte; `r` and `R` are the
//! same for remote frames, without data. Everything else is not for the unit: acknowledgements, and the bell, by which an adapter refuses
//! what it was told.

use crate::board::frame::CanFrame;
use embedded_can::{ExtendedId, Frame, Id, StandardId};
use heapless::Vec;

/// The longest line that says anything: an extended frame with 8 bytes of data.
const LONGEST: usize = 1 + 8 + 1 + 2 * 8;

/// A line with its end.
pub type Text = Vec<u8, { LONGEST + 1 }>;

/// What opens an adapter, whatever was said to it before: the rest of a line ends, the channel is closed, set to 500 kbit/s, and opened.
pub const OPENING: &[u8] = b"\r\rC\rS6\rO\r";

const BELL: u8 = 7;

/// The line that is being received. What follows the longest line, up to its end, is dropped with it. A letter that only begins a
/// frame begins one, whatever was there before: half a line costs no more than itself.
pub struct Line {
    text: Vec<u8, LONGEST>,
    /// Whether it is longer than any that says something, or a byte of it is lost.
    spoilt: bool,
}

impl Line {
    pub const fn new() -> Self {
        Self { text: Vec::new(), spoilt: false }
    }

    /// A byte of it is lost.
    pub fn spoil(&mut self) {
        self.spoilt = true;
    }

    /// The frame that this byte completes.
    pub fn take(&mut self, byte: u8) -> Option<CanFrame> {
        match byte {
            b'\r' => {}
            BELL => {
                *self = Self::new();
                return None;
            }
            _ => {
                if matches!(byte, b't' | b'T' | b'r' | b'R') {
                    *self = Self::new();
                }
                self.spoilt |= self.text.push(byte).is_err();
                return None;
            }
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
pub fn encode(frame: &impl Frame) -> Text {
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
