//! How much of the bus the catalogue takes at worst: a choice of its lines enters, parts per million leave.

use super::Identifiers;
use super::catalogue::{CATALOGUE, Line};

#[cfg(feature = "fd")]
pub mod fd;

/// Bits that an 8-byte frame takes up at worst. With 11 bits: 1 start, 11 identifier, 3 control (RTR, IDE, r0), 4 length, 64 data and 15
/// CRC make 98 bits that are stuffed, at worst a bit after the first 5 and then after every 4: `(98 - 1) / 4 = 24`. CRC delimiter,
/// acknowledge slot and delimiter, 7 end of frame: 10 that are not. 3 bits of interframe space. With 29 bits 20 more are stuffed: 18 of
/// the identifier, SRR and r1.
#[must_use]
#[allow(clippy::arithmetic_side_effects)] // small numbers
pub const fn worst_frame_bits(is_extended: bool) -> u32 {
    let stuffed = if is_extended { 118 } else { 98 };
    stuffed + (stuffed - 1) / 4 + 10 + 3
}

/// Worst-case load of the bus in parts per million: all lines that `counted` accepts, at their cycles, with so many
/// peers, where these identifiers place them, at this bit rate (0 bit/s: saturated). What nobody sends takes nothing.
#[must_use]
pub fn load_ppm(bit_rate: u32, peers: u16, identifiers: &Identifiers, counted: impl Fn(&Line) -> bool) -> u32 {
    let bits_per_1000_s = |line: &Line| {
        let speakers = if line.is_per_slot() { u64::from(peers) } else { 1 };
        let frames = speakers.saturating_mul(u64::from(line.frames)).saturating_mul(1_000_000);
        let bits = u64::from(worst_frame_bits(is_extended(identifiers, line)));
        frames.checked_div(u64::from(line.cycle_ms)).unwrap_or(0).saturating_mul(bits)
    };
    let bits = CATALOGUE.iter().filter(|line| counted(line)).map(bits_per_1000_s).fold(0, u64::saturating_add);
    let ppm = bits.saturating_mul(1000).checked_div(u64::from(bit_rate));
    ppm.and_then(|ppm| u32::try_from(ppm).ok()).unwrap_or(u32::MAX)
}

/// Whether a line's frames have 29 bits.
fn is_extended(identifiers: &Identifiers, line: &Line) -> bool {
    identifiers.placement(line.content).is_some_and(|(id, _)| id.is_extended())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wire::Identifier;
    use crate::wire::catalogue::{About, Content, Speaker};

    #[test]
    fn eight_peers_take_less_than_a_quarter_of_the_bus_and_everything_less_than_half() {
        assert_eq!([false, true].map(worst_frame_bits), [135, 160]);
        let peers = load_ppm(500_000, 8, &Identifiers::DEFAULT, Line::is_per_slot);
        let all = load_ppm(500_000, 8, &Identifiers::DEFAULT, |_| true);
        assert!(peers < 250_000 && all < 500_000);
    }

    #[test]
    fn what_nobody_sends_takes_nothing() {
        let of = |content: Content| load_ppm(500_000, 8, &Identifiers::DEFAULT, |line: &Line| line.content == content);
        assert_eq!(of(Content::Said(Speaker::Own, About::Geo)), 0);
        assert_eq!(of(Content::Said(Speaker::Own, About::Route)), 2 * 5 * 135 * 2);
    }

    #[test]
    fn a_line_with_29_bits_takes_160_bits_a_frame_and_the_others_what_they_took() {
        let is_command = |line: &Line| matches!(line.content, Content::Command);
        let id = Identifier::extended(0x0CFF_0210).unwrap();
        let placed = Identifiers::DEFAULT.place(Content::Command, id).unwrap();
        let of = |identifiers: &Identifiers| load_ppm(500_000, 8, identifiers, is_command);
        assert_eq!(of(&placed), of(&Identifiers::DEFAULT) / 135 * 160);
        let others = |identifiers: &Identifiers| load_ppm(500_000, 8, identifiers, |line| !is_command(line));
        assert_eq!(others(&placed), others(&Identifiers::DEFAULT));
    }
}
