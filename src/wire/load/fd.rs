//! How much of a bus of CAN FD the catalogue takes at worst: a choice of its lines enters, parts per million leave. Also the
//! lengths of such frames that do not depend on what stands in them.

use super::is_extended;
use crate::wire::Identifiers;
use crate::wire::catalogue::{CATALOGUE, Line};
use crate::wire::fd::layout;

/// Bits of a frame at the lower rate, without stuff bits. With 11 bits: 1 start, 11 identifier, 5 control (RRS, IDE, FDF, res, BRS);
/// with 29 bits also 18 of the identifier, and SRR.
const fn arbitration_bits(is_extended: bool) -> u32 {
    if is_extended { 36 } else { 17 }
}
/// Those at its end: CRC delimiter, acknowledge slot and delimiter, 7 end of frame, 3 bits of interframe space.
const TAIL_BITS: u32 = 1 + 2 + 7 + 3;
/// Bits at the higher rate before the data: error state indicator and length.
const CONTROL_BITS: u32 = 5;

/// The code that stands for so many bytes of data, up to 64, in the frame.
#[must_use]
pub fn code_of(bytes: usize) -> u32 {
    match bytes {
        0..=8 => u32::try_from(bytes).unwrap_or(8),
        9..=12 => 9,
        13..=16 => 10,
        17..=20 => 11,
        21..=24 => 12,
        25..=32 => 13,
        33..=48 => 14,
        _ => 15,
    }
}

/// Bits of the CRC field: 4 of the stuff count and 17 of the CRC, 21 above 16 bytes, with a fixed stuff bit before the first and
/// after every fourth: `21 + 6` or `25 + 7`.
#[must_use]
pub const fn crc_field_bits(bytes: usize) -> u32 {
    if bytes <= 16 { 27 } else { 32 }
}

/// Nanoseconds that a frame with so many bytes takes at worst, with an identifier of 11 or 29 bits, at these bit rates in bit/s; with the
/// interframe space. From its start to its data at worst a bit is stuffed after the first 5 and then after every 4; as many as
/// can be of them are counted at the lower rate.
#[must_use]
#[allow(clippy::arithmetic_side_effects)] // at most 64 bytes, and rates are checked
pub fn worst_nanos(bit_rate: u32, data_bit_rate: u32, is_extended: bool, bytes: usize) -> u32 {
    let arbitration = arbitration_bits(is_extended);
    let fast = CONTROL_BITS + 8 * u32::try_from(bytes.min(64)).unwrap_or(64);
    let stuffed = (arbitration + fast - 1) / 4;
    let slow_stuffed = (arbitration - 1) / 4;
    let slow = u64::from(arbitration + slow_stuffed + TAIL_BITS);
    let fast = u64::from(fast + stuffed - slow_stuffed + crc_field_bits(bytes));
    let nanos = |bits: u64, rate: u32| bits.saturating_mul(1_000_000_000).checked_div(rate.into()).unwrap_or(u64::MAX);
    u32::try_from(nanos(slow, bit_rate).saturating_add(nanos(fast, data_bit_rate))).unwrap_or(u32::MAX)
}

/// Worst-case load of the bus in parts per million: the frames of all lines that `counted` accepts, at the cycles of the lines that
/// begin them, with so many peers, where these identifiers place them, at these bit rates (0 bit/s: saturated). What nobody sends takes
/// nothing.
#[must_use]
pub fn load_ppm(
    (bit_rate, data_bit_rate): (u32, u32),
    peers: u16,
    identifiers: &Identifiers,
    counted: impl Fn(&Line) -> bool,
) -> u32 {
    if bit_rate == 0 || data_bit_rate == 0 {
        return u32::MAX;
    }
    let nanos_per_s = |(place, line): (usize, &Line)| {
        let Some(layout) = layout::of(place).filter(|_| counted(line)) else { return 0 };
        let speakers = if line.is_per_slot() { u64::from(peers) } else { 1 };
        let frame =
            u64::from(worst_nanos(bit_rate, data_bit_rate, is_extended(identifiers, line), layout.bytes.into()));
        speakers.saturating_mul(frame).saturating_mul(1000).checked_div(line.cycle_ms.into()).unwrap_or(0)
    };
    let nanos = CATALOGUE.iter().enumerate().map(nanos_per_s).fold(0, u64::saturating_add);
    u32::try_from(nanos / 1000).unwrap_or(u32::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wire::catalogue::{About, Content, Speaker};
    use crate::wire::load;

    #[test]
    fn everything_over_can_fd_takes_less_than_half_of_what_it_takes_over_classic_can() {
        let (rates, block) = ((500_000, 2_000_000), &Identifiers::DEFAULT);
        // 34 bits of 2 us with 4 stuff bits; 517 bits, 129 stuff bits and 32 of the CRC field of 0.5 us.
        assert_eq!(worst_nanos(500_000, 2_000_000, false, 64), 34 * 2_000 + (517 + 129 + 32) * 500);
        for peers in [1, 8, 16] {
            let [classic, over_fd] =
                [load::load_ppm(500_000, peers, block, |_| true), load_ppm(rates, peers, block, |_| true)];
            assert!(over_fd < classic / 2, "{peers} peers: {over_fd} of {classic}");
        }
        assert!(load_ppm(rates, 8, block, Line::is_per_slot) < 60_000);
        let is_own_place = |line: &Line| line.content == Content::Said(Speaker::Own, About::Geo);
        assert_eq!(load_ppm(rates, 8, block, is_own_place), 0);
        assert_eq!([(0, 1), (1, 0)].map(|rates| load_ppm(rates, 1, block, |_| true)), [u32::MAX; 2]);
    }
}
