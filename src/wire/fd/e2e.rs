//! AUTOSAR E2E Profile 5: data enter and are protected in place; received data enter, and whether they may be used leaves.
//!
//! The CRC stands in bytes 0 and 1, low byte first: polynomial 0x1021, initial value 0xFFFF, final xor 0, over the rest of
//! the data and then the data id, low byte first. The counter, 0 to 255, stands in byte 2. The receiver is the
//! specification's `E2E_P05Check` with the state machine for a window of one check: the first intact frame ever is not used,
//! because its counter cannot be judged; after that, each one that is new and not after too many that are missing.

use crate::health::Cause;
use crate::wire::catalogue::LIMITS;

/// Bits of CRC and counter.
pub const HEADER_BITS: u16 = 24;
/// Largest step of the counter: as many frames may be missing as on classic CAN.
#[allow(clippy::arithmetic_side_effects)] // in const
pub const MAX_DELTA_COUNTER: u8 = LIMITS.max_delta_counter_init + 1;

/// Fills in the counter and the CRC of at least 3 bytes.
pub fn protect(data: &mut [u8], data_id: u16, counter: u8) {
    if let Some(place) = data.get_mut(2) {
        *place = counter;
    }
    let [low, high] = crc(data_id, data).to_le_bytes();
    if let [first, second, ..] = data {
        (*first, *second) = (low, high);
    }
}

/// Whether the CRC fits the rest.
#[must_use]
pub fn is_intact(data_id: u16, data: &[u8]) -> bool {
    data.first_chunk() == Some(&crc(data_id, data).to_le_bytes())
}

fn crc(data_id: u16, data: &[u8]) -> u16 {
    let step = |register: u16, byte: &u8| {
        let [low, high] = register.to_le_bytes();
        let entry = TABLE.get(usize::from(high ^ byte)).copied().unwrap_or(0); // the table has all 256 entries
        u16::from(low).wrapping_shl(8) ^ entry
    };
    let rest = data.get(2..).unwrap_or_default();
    data_id.to_le_bytes().iter().fold(rest.iter().fold(0xFFFF, step), step)
}

static TABLE: [u16; 256] = table();

#[allow(clippy::indexing_slicing, clippy::arithmetic_side_effects, clippy::cast_possible_truncation)] // in const
const fn table() -> [u16; 256] {
    let mut table = [0; 256];
    let mut byte = 0;
    while byte < 256 {
        let mut register = (byte as u16) << 8;
        let mut bit = 0;
        while bit < 8 {
            register = if register & 0x8000 != 0 { (register << 1) ^ 0x1021 } else { register << 1 };
            bit += 1;
        }
        table[byte] = register;
        byte += 1;
    }
    table
}

/// The receiver's state of one identifier.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Check {
    /// Counter of the last intact frame.
    last: u8,
    heard_first: bool,
}

impl Check {
    /// Nothing received yet.
    #[must_use]
    pub const fn new() -> Self {
        Self { last: 0, heard_first: false }
    }

    /// Judges data that arrived; their counter if they may be used.
    ///
    /// # Errors
    /// `Checksum`, `NotYetTrusted`, `Repeated`, `CounterGap`; `Checksum` also for fewer than 3 bytes.
    pub fn receive(&mut self, data_id: u16, data: &[u8]) -> Result<u8, Cause> {
        let [_, _, counter, ..] = *data else { return Err(Cause::Checksum) };
        if !is_intact(data_id, data) {
            return Err(Cause::Checksum);
        }
        let delta = counter.wrapping_sub(self.last);
        let heard_first = core::mem::replace(&mut self.heard_first, true);
        self.last = counter;
        match delta {
            _ if !heard_first => Err(Cause::NotYetTrusted),
            0 => Err(Cause::Repeated),
            1..=MAX_DELTA_COUNTER => Ok(counter),
            _ => Err(Cause::CounterGap),
        }
    }
}

impl Default for Check {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(counter: u8) -> [u8; 64] {
        let mut data = core::array::from_fn(|place| (place as u8).wrapping_mul(7));
        protect(&mut data, 0x4840, counter);
        data
    }

    #[test]
    fn frames_are_those_of_an_independent_implementation() {
        let vectors = include_str!("../../../tests/vectors/e2e_p05.csv");
        let mut count = 0;
        for line in vectors.lines().skip(1) {
            let (data_id, data) = line.split_once(',').unwrap();
            let data_id = u16::from_str_radix(data_id, 16).unwrap();
            let byte = |place: usize| u8::from_str_radix(&data[2 * place..2 * place + 2], 16).unwrap();
            let bytes: Vec<u8> = (0..data.len() / 2).map(byte).collect();
            let mut made = bytes.clone();
            made[..3].fill(0xEE);
            protect(&mut made, data_id, bytes[2]);
            assert_eq!(made, bytes, "{line}");
            count += 1;
        }
        assert!(count >= 1000);
    }

    #[test]
    fn the_crc_of_nine_digits_is_that_of_the_literature() {
        // CRC-16/IBM-3740 of "123456789" is 0x29B1; here the data id is the last two digits.
        assert_eq!(crc(u16::from_le_bytes(*b"89"), b"??1234567"), 0x29B1);
    }

    #[test]
    fn counters_are_judged_as_the_specification_does() {
        let mut check = Check::new();
        let mut hear = |counter| check.receive(0x4840, &frame(counter));
        assert_eq!(hear(200), Err(Cause::NotYetTrusted));
        assert_eq!([hear(201), hear(202), hear(202)], [Ok(201), Ok(202), Err(Cause::Repeated)]);
        // Two frames are missing, and then three.
        assert_eq!([hear(205), hear(209), hear(210)], [Ok(205), Err(Cause::CounterGap), Ok(210)]);
        // An older one is a gap; the counter wraps.
        assert_eq!([hear(209), hear(255), hear(0)], [Err(Cause::CounterGap), Err(Cause::CounterGap), Ok(0)]);
        assert_eq!(hear(2), Ok(2));
    }

    #[test]
    fn any_one_or_two_wrong_bits_are_found_and_change_nothing() {
        let mut check = Check::new();
        let _ = check.receive(0x4840, &frame(0));
        let (before, good) = (check, frame(1));
        for a in 0..512 {
            for b in a..512 {
                let mut bad = good;
                bad[a / 8] ^= 1 << (a % 8);
                bad[b / 8] ^= if a == b { 0 } else { 1 << (b % 8) };
                assert_eq!(check.receive(0x4840, &bad), Err(Cause::Checksum), "bits {a} and {b}");
            }
        }
        assert_eq!(check, before);
        assert_eq!(check.receive(0x4840, &good), Ok(1));
        assert_eq!([0, 1, 2].map(|length| check.receive(0x4840, &good[..length])), [Err(Cause::Checksum); 3]);
    }
}
