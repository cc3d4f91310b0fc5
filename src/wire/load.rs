//! How much of the bus the catalogue takes at worst: a choice of its lines enters, parts per million leave.

use super::catalogue::{CATALOGUE, Line};

#[cfg(feature = "fd")]
pub mod fd;

/// Bits that an 8-byte standard frame takes up at worst: 1 start, 11 identifier, 3 control (RTR, IDE, r0), 4 length, 64
/// data and 15 CRC make 98 bits that are stuffed, at worst a bit after the first 5 and then after every 4:
/// `(98 - 1) / 4 = 24`. CRC delimiter, acknowledge slot and delimiter, 7 end of frame: 10 that are not. 3 bits of
/// interframe space.
pub const WORST_FRAME_BITS: u32 = 98 + (98 - 1) / 4 + 10 + 3;

/// Worst-case load of the bus in parts per million: all lines that `counted` accepts, at their cycles, with so many
/// peers, at this bit rate (0 bit/s: saturated).
#[must_use]
pub fn load_ppm(bit_rate: u32, peers: u16, counted: impl Fn(&Line) -> bool) -> u32 {
    let frames_per_1000_s = |line: &Line| {
        let speakers = if line.is_per_slot() { u64::from(peers) } else { 1 };
        let frames = speakers.saturating_mul(u64::from(line.frames)).saturating_mul(1_000_000);
        frames.checked_div(u64::from(line.cycle_ms)).unwrap_or(u64::MAX)
    };
    let frames = CATALOGUE.iter().filter(|line| counted(line)).map(frames_per_1000_s).fold(0, u64::saturating_add);
    let ppm = frames.saturating_mul(u64::from(WORST_FRAME_BITS)).saturating_mul(1000).checked_div(u64::from(bit_rate));
    ppm.and_then(|ppm| u32::try_from(ppm).ok()).unwrap_or(u32::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eight_peers_take_less_than_a_quarter_of_the_bus_and_everything_less_than_half() {
        assert_eq!(WORST_FRAME_BITS, 135);
        let peers = load_ppm(500_000, 8, Line::is_per_slot);
        let all = load_ppm(500_000, 8, |_| true);
        assert!(peers < 250_000 && all < 500_000);
    }
}
