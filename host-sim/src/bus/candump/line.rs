//! One line of a candump log: text enters, its content leaves, or the error.

use super::{Content, Entry, Interface};
use crate::bus::Frame;
use crate::error::{Error, quoted};
use embedded_can::{ExtendedId, Frame as _, Id, StandardId};
use holdover::time::Instant;
use std::str::SplitAsciiWhitespace;

/// Linux marks an error frame by this bit of its identifier.
const ERROR_FLAG: u32 = 0x2000_0000;
/// The most bytes of an FD frame.
const FD_BYTES: usize = 64;
const FD_LIMIT: &str = "a CAN FD frame has at most 64; correct the line";
/// Those of an FD frame with a bit rate switch.
const FD_FLAGS: u8 = 5;

/// A line.
#[derive(Debug)]
pub(super) struct Line {
    /// Its content.
    pub(super) entry: Entry,
    /// Whether its time is that of `-t z` or `-t d`, and not since 1970.
    pub(super) is_relative: bool,
}

/// The content of a line; `None` if it is blank.
pub(super) fn parse(line: &str) -> Result<Option<Line>, Error> {
    let mut words = line.split_ascii_whitespace();
    let Some(mut word) = words.next() else { return Ok(None) };
    let (mut at, mut is_relative) = (None, false);
    if let Some(stamp) = word.strip_prefix('(') {
        let stamp = stamp.strip_suffix(')').ok_or_else(|| {
            Error::new(
                format!("the time begins with {}", quoted(word)),
                "record with `candump -l`, or on the screen with -t a, z or d",
            )
        })?;
        at = Some(instant(stamp)?);
        is_relative = is_of_screen(stamp);
        word = words.next().ok_or_else(cut_off)?;
    }
    let interface = Interface::try_from(word)
        .map_err(|_| Error::new(format!("{} is no network interface", quoted(word)), NOT_A_LOG))?;
    let mut word = words.next().ok_or_else(cut_off)?;
    if word == "RX" || word == "TX" {
        // Two flags of one character follow the direction.
        word = words.find(|word| word.len() > 1).ok_or_else(cut_off)?;
    }
    let content = match word.split_once('#') {
        Some((id, data)) => logged(id, data)?,
        None => shown(word, words)?,
    };
    Ok(Some(Line { entry: Entry { at, interface, content }, is_relative }))
}

const NOT_A_LOG: &str = "give a log as `candump -l` writes it";

/// The error of the last line of a log that was being written when the machine stopped.
pub(super) fn cut_off() -> Error {
    Error::new("the line is not complete", "delete it")
}

/// Whether a time has the width of `-t z` and `-t d`: three digits of seconds. `-t z` has more after 1000 s, but then its
/// meaning is known. Seconds since 1970 have ten.
fn is_of_screen(stamp: &str) -> bool {
    stamp.split_once('.').is_some_and(|(seconds, micros)| seconds.len() == 3 && micros.len() == 6)
}

/// The time of `seconds.fraction`, cut off after microseconds.
fn instant(stamp: &str) -> Result<Instant, Error> {
    let micros = || {
        let (seconds, fraction) = stamp.split_once('.')?;
        let digits = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
        if !digits(seconds) || !digits(fraction) {
            return None;
        }
        let fraction = fraction.bytes().chain(std::iter::repeat(b'0')).take(6);
        let fraction = fraction.fold(0, |sum, digit| sum * 10 + u64::from(digit - b'0'));
        seconds.parse::<u64>().ok()?.checked_mul(1_000_000)?.checked_add(fraction)
    };
    micros().map(Instant::from_micros).ok_or_else(|| {
        Error::new(format!("the time is {}", quoted(stamp)), "give seconds since an epoch, such as (1436509052.249713)")
    })
}

/// `id#data`, `id#R`, `id##flags data`, `priority#vcid:flags:type#data`.
fn logged(id: &str, data: &str) -> Result<Content, Error> {
    if data.contains(':') {
        return Ok(Content::Xl);
    }
    let id = Identifier::parse(id)?;
    if let Some(data) = data.strip_prefix('#') {
        let flags = data.chars().next().and_then(|flags| flags.to_digit(16)).ok_or_else(cut_off)?;
        return id.fd(flags as u8, &bytes_of::<FD_BYTES>(&data[1..], FD_LIMIT)?);
    }
    if let Some(dlc) = data.strip_prefix('R') {
        return remote(id, if dlc.is_empty() { "0" } else { dlc });
    }
    // `_9` to `_F` after eight bytes is a raw length code, which also means eight.
    let data = data.split_once('_').map_or(data, |(data, _)| data);
    id.frame(&bytes_of::<8>(data, "a classic frame has at most 8; correct the line")?)
}

/// The bytes of hexadecimal digits.
fn bytes_of<const MOST: usize>(data: &str, limit: &str) -> Result<heapless::Vec<u8, MOST>, Error> {
    let mut bytes = heapless::Vec::new();
    if !data.len().is_multiple_of(2) {
        return Err(Error::new(format!("the data {} has half a byte", quoted(data)), "complete or delete the line"));
    }
    for pair in data.as_bytes().chunks_exact(2) {
        let byte = hex_byte(pair).ok_or_else(|| not_data(data))?;
        bytes.push(byte).map_err(|_| Error::new(format!("{} bytes of data", data.len() / 2), limit))?;
    }
    Ok(bytes)
}

/// `id   [length]  bytes…`
fn shown(id: &str, mut words: SplitAsciiWhitespace) -> Result<Content, Error> {
    let id = Identifier::parse(id)?;
    let length = words.next().ok_or_else(cut_off)?;
    let digits = length.strip_prefix('[').and_then(|length| length.strip_suffix(']'));
    let count = digits.and_then(|digits| digits.parse::<usize>().ok()).filter(|&count| count <= FD_BYTES);
    let (Some(digits), Some(count)) = (digits, count) else {
        return Err(Error::new(format!("{} stands where the length should", quoted(length)), NOT_A_LOG));
    };
    let mut data = words.clone();
    if data.next() == Some("remote") {
        return remote(id, digits);
    }
    let mut bytes = heapless::Vec::<u8, FD_BYTES>::new();
    for word in words.by_ref().take(count) {
        let byte = Some(word.as_bytes()).filter(|word| word.len() == 2).and_then(hex_byte);
        let byte = byte.ok_or_else(|| not_data(word))?;
        bytes.push(byte).map_err(|_| Error::new(format!("{count} bytes of data"), FD_LIMIT))?;
    }
    if bytes.len() < count {
        return Err(cut_off());
    }
    // candump shows the length of FD frames in two digits, and not their flags.
    if digits.len() > 1 {
        return id.fd(FD_FLAGS, &bytes);
    }
    if count > 8 {
        return Err(Error::new(format!("{count} bytes of data"), "a classic frame has at most 8"));
    }
    id.frame(&bytes)
}

fn remote(id: Identifier, dlc: &str) -> Result<Content, Error> {
    let Identifier::Of(id) = id else { return Ok(Content::ErrorFrame) };
    let frame = dlc.parse().ok().and_then(|dlc| Frame::new_remote(id, dlc));
    let wrong = || Error::new(format!("the remote frame's length is {}", quoted(dlc)), "give 0 to 8");
    frame.map(Content::Frame).ok_or_else(wrong)
}

fn not_data(text: &str) -> Error {
    Error::new(format!("the data {} is not hexadecimal", quoted(text)), "complete or delete the line")
}

fn hex_byte(pair: &[u8]) -> Option<u8> {
    let digit = |at: usize| char::from(*pair.get(at)?).to_digit(16);
    u8::try_from(digit(0)? << 4 | digit(1)?).ok()
}

enum Identifier {
    Of(Id),
    Error,
}

impl Identifier {
    fn parse(text: &str) -> Result<Self, Error> {
        let number = Some(text).filter(|text| text.bytes().all(|byte| byte.is_ascii_hexdigit()));
        let number = number.and_then(|text| u32::from_str_radix(text, 16).ok());
        let id = match (text.len(), number) {
            (3, Some(number)) => u16::try_from(number).ok().and_then(StandardId::new).map(Id::Standard),
            (8, Some(number)) if number & ERROR_FLAG != 0 => return Ok(Self::Error),
            (8, Some(number)) => ExtendedId::new(number).map(Id::Extended),
            _ => None,
        };
        id.map(Self::Of).ok_or_else(|| {
            let cause = format!("the identifier is {}", quoted(text));
            Error::new(cause, "give 3 hexadecimal digits up to 7FF, or 8 up to 1FFFFFFF")
        })
    }

    fn fd(self, flags: u8, data: &[u8]) -> Result<Content, Error> {
        let Self::Of(id) = self else { return Ok(Content::ErrorFrame) };
        Frame::fd(id, flags, data).map(Content::Frame).ok_or_else(cut_off)
    }

    fn frame(self, data: &[u8]) -> Result<Content, Error> {
        let Self::Of(id) = self else { return Ok(Content::ErrorFrame) };
        Frame::new(id, data).map(Content::Frame).ok_or_else(cut_off)
    }
}
