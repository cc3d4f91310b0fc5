//! Independent random streams: a seed and a purpose enter, a generator leaves.
//!
//! ChaCha8 has 2⁶⁴ streams per seed. With a stream of its own for each purpose, nothing that is drawn for one thing
//! depends on how often, or in which order, something else was drawn.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// What the numbers are for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// Start of the vehicle with that index.
    InitialState(u32),
    /// The V2X link between two vehicles.
    Link {
        /// Index of the sender.
        from: u16,
        /// Index of the receiver.
        to: u16,
    },
    /// Faults on the bus of the vehicle with that index.
    BusFaults(u32),
    /// When the clock of the unit with that index started.
    ClockOffset(u32),
    /// Errors of the range sensor of the vehicle with that index.
    RangeSensor(u32),
    /// Whether the vehicle with that index has a range sensor, and the faults of that sensor.
    RangeFaults(u32),
    /// Arrivals by the road with that index, and what is drawn of those who arrive.
    Arrivals(u32),
    /// Whether the vehicle with that index makes an emergency stop, and where.
    Emergency(u32),
    /// Whether the vehicle with that index has a fault, which one, and from when on.
    Fault(u32),
    /// Whether the vehicle with that index keeps passes.
    Passes(u32),
}

/// The generator for that purpose under that seed.
#[must_use]
pub fn stream(seed: u64, purpose: Purpose) -> ChaCha8Rng {
    let (kind, which) = match purpose {
        Purpose::InitialState(vehicle) => (1, vehicle),
        Purpose::Link { from, to } => (2, u32::from(from) << 16 | u32::from(to)),
        Purpose::BusFaults(vehicle) => (3, vehicle),
        Purpose::ClockOffset(vehicle) => (4, vehicle),
        Purpose::RangeSensor(vehicle) => (5, vehicle),
        Purpose::Arrivals(road) => (6, road),
        Purpose::RangeFaults(vehicle) => (7, vehicle),
        Purpose::Emergency(vehicle) => (8, vehicle),
        Purpose::Fault(vehicle) => (9, vehicle),
        Purpose::Passes(vehicle) => (10, vehicle),
    };
    let mut generator = ChaCha8Rng::seed_from_u64(seed);
    generator.set_stream(kind << 32 | u64::from(which));
    generator
}

/// A number uniform in [0, 1) by steps of 2⁻⁵³.
pub fn unit(generator: &mut ChaCha8Rng) -> f64 {
    let mantissa = (generator.next_u64() >> 11) as f64;
    mantissa / (1u64 << 53) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_seed_and_purpose_give_the_same_numbers() {
        let draw = || unit(&mut stream(7, Purpose::InitialState(2)));
        assert_eq!(draw().to_bits(), draw().to_bits());
    }

    #[test]
    fn seeds_and_purposes_have_numbers_of_their_own() {
        let purposes = [
            Purpose::InitialState(1),
            Purpose::InitialState(2),
            Purpose::BusFaults(1),
            Purpose::Link { from: 1, to: 2 },
            Purpose::Link { from: 2, to: 1 },
        ];
        let mut first: Vec<u64> =
            [3, 4].iter().flat_map(|&seed| purposes.map(|p| stream(seed, p).next_u64())).collect();
        first.sort_unstable();
        first.dedup();
        assert_eq!(first.len(), 2 * purposes.len());
    }
}
