//! How far the clocks of a bus may be off, by the way that a controller divides a bit.

/// The tolerance that the clock of every node may have, in millionths, by the two conditions of ISO 11898-1: over the ten bits from one
/// edge to the next at the latest, and over the thirteen from an error to the sample point that judges it. A bit has so many `quanta`, of
/// which so many are `behind` the sample point, and a resynchronisation moves that point by up to `jump`.
pub const fn tolerance(quanta: u32, behind: u32, jump: u32) -> u32 {
    let (edges, errors) = (jump * 1_000_000 / (20 * quanta), behind * 1_000_000 / (2 * (13 * quanta - behind)));
    if edges < errors { edges } else { errors }
}

/// CAN asks for a clock within 0.5 %, and has to bear one.
pub const ASKED: u32 = 5_000;
