//! AUTOSAR E2E Profile 1, variant 1A: a payload enters and a protected frame leaves; a received frame enters and a
//! [`Status`] leaves.
//!
//! The CRC stands in byte 0: polynomial 0x1D, initial value and final xor 0, over the data id (low byte, high byte: mode
//! BOTH) and bytes 1 to 7. The counter, 0 to 14, stands in the low nibble of byte 1. The receiver is the specification's
//! `E2E_P01Check`. The unit calls it when a frame arrives, so `NoNewData` arises only where a caller polls; silence
//! shows as the age of what was received last.

use crate::health::Cause;

/// What the receiver tolerates on one identifier.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Largest step of the counter right after a good frame; each further check allows one more.
    pub max_delta_counter_init: u8,
    /// How many checks in a row may bring nothing new before the counter has to be trusted anew.
    pub max_no_new_or_repeated: u8,
    /// How many good frames it takes to trust the counter again.
    pub sync_counter_init: u8,
}

/// What a check found; names and meaning as in the specification.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Status {
    /// The next frame.
    Ok,
    /// A newer frame; tolerably many are missing before it.
    OkSomeLost,
    /// The first good frame ever: its counter cannot be judged.
    Initial,
    /// The counter of the last good frame once more.
    Repeated,
    /// Too many frames are missing.
    WrongSequence,
    /// The checksum does not fit.
    WrongCrc,
    /// In sequence, but not trusted yet after an unexpected counter.
    Sync,
    /// Nothing arrived.
    NoNewData,
}

impl Status {
    /// Whether the frame may be used, and if not, why.
    ///
    /// # Errors
    /// The refusal that stands for this status. `NoNewData` has no frame to refuse; it counts as a repetition.
    pub const fn verdict(self) -> Result<(), Cause> {
        match self {
            Self::Ok | Self::OkSomeLost => Ok(()),
            Self::Initial | Self::Sync => Err(Cause::NotYetTrusted),
            Self::Repeated | Self::NoNewData => Err(Cause::Repeated),
            Self::WrongSequence => Err(Cause::CounterGap),
            Self::WrongCrc => Err(Cause::Checksum),
        }
    }
}

/// Number of counter values; 15 is not one.
pub(super) const COUNTERS: u8 = 15;
/// Where the machine's own counters stop.
const CEILING: u8 = 14;

/// Fills in the counter and the CRC.
#[must_use]
pub fn protect(data: [u8; 8], data_id: u16, counter: u8) -> [u8; 8] {
    let [_, first, rest @ ..] = data;
    let counted = (first & 0xF0) | (counter & 0x0F);
    let [b2, b3, b4, b5, b6, b7] = rest;
    let crc = crc(data_id, [counted, b2, b3, b4, b5, b6, b7]);
    [crc, counted, b2, b3, b4, b5, b6, b7]
}

/// The counter of a frame.
#[must_use]
pub(super) const fn counter_of(data: &[u8; 8]) -> u8 {
    let [_, first, ..] = *data;
    first & 0x0F
}

/// The counter that follows.
#[must_use]
pub const fn next(counter: u8) -> u8 {
    if counter >= CEILING { 0 } else { counter.wrapping_add(1) }
}

fn crc(data_id: u16, bytes: [u8; 7]) -> u8 {
    let [low, high] = data_id.to_le_bytes();
    bytes.iter().fold(step(step(low) ^ high), |crc, byte| step(crc ^ byte))
}

/// One byte through the CRC register.
fn step(register: u8) -> u8 {
    TABLE.get(usize::from(register)).copied().unwrap_or(0) // the table has all 256 entries
}

static TABLE: [u8; 256] = table();

#[allow(clippy::indexing_slicing, clippy::arithmetic_side_effects, clippy::cast_possible_truncation)] // in const
const fn table() -> [u8; 256] {
    let mut table = [0; 256];
    let mut byte = 0;
    while byte < 256 {
        let mut register = byte as u8;
        let mut bit = 0;
        while bit < 8 {
            register = if register & 0x80 != 0 { (register << 1) ^ 0x1D } else { register << 1 };
            bit += 1;
        }
        table[byte] = register;
        byte += 1;
    }
    table
}

/// The receiver's state of one identifier, `E2E_P01CheckStateType`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Check {
    last_valid: u8,
    max_delta: u8,
    no_new_or_repeated: u8,
    sync: u8,
    heard_first: bool,
}

impl Check {
    /// Nothing received yet.
    #[must_use]
    pub const fn new() -> Self {
        Self { last_valid: 0, max_delta: 0, no_new_or_repeated: 0, sync: 0, heard_first: false }
    }

    /// Judges the frame that arrived.
    ///
    /// # Errors
    /// The refusal of its [`Status`]; `CounterRange` for a good checksum over counter 15, which the profile excludes.
    pub fn receive(&mut self, limits: &Limits, data_id: u16, data: &[u8; 8]) -> Result<(), Cause> {
        let [received, first, rest @ ..] = *data;
        let [b2, b3, b4, b5, b6, b7] = rest;
        let counter = counter_of(data);
        let intact = received == crc(data_id, [first, b2, b3, b4, b5, b6, b7]);
        if intact && counter > CEILING {
            return Err(Cause::CounterRange);
        }
        self.check(limits, Some(if intact { Ok(counter) } else { Err(()) })).verdict()
    }

    /// `E2E_P01Check`: `None` without a new frame, else the counter of an intact frame or the news that it was not.
    fn check(&mut self, limits: &Limits, arrived: Option<Result<u8, ()>>) -> Status {
        self.max_delta = self.max_delta.saturating_add(1).min(CEILING);
        let counter = match arrived {
            None => {
                self.count_nothing_new();
                return Status::NoNewData;
            }
            Some(Err(())) => return Status::WrongCrc,
            Some(Ok(counter)) => counter,
        };
        if !self.heard_first {
            self.heard_first = true;
            self.accept(limits, counter);
            return Status::Initial;
        }
        let delta = counter.wrapping_add(COUNTERS).wrapping_sub(self.last_valid) % COUNTERS;
        if delta == 0 {
            self.count_nothing_new();
            Status::Repeated
        } else if delta > self.max_delta {
            self.no_new_or_repeated = 0;
            self.sync = limits.sync_counter_init;
            if self.sync > 0 {
                self.accept(limits, counter);
            }
            Status::WrongSequence
        } else {
            self.accept(limits, counter);
            let interrupted = self.no_new_or_repeated > limits.max_no_new_or_repeated;
            self.no_new_or_repeated = 0;
            if interrupted {
                self.sync = limits.sync_counter_init;
                Status::Sync
            } else if self.sync > 0 {
                self.sync = self.sync.saturating_sub(1);
                Status::Sync
            } else if delta == 1 {
                Status::Ok
            } else {
                Status::OkSomeLost
            }
        }
    }

    fn accept(&mut self, limits: &Limits, counter: u8) {
        self.max_delta = limits.max_delta_counter_init;
        self.last_valid = counter;
    }

    fn count_nothing_new(&mut self) {
        self.no_new_or_repeated = self.no_new_or_repeated.saturating_add(1).min(CEILING);
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

    const LIMITS: Limits = Limits { max_delta_counter_init: 2, max_no_new_or_repeated: 3, sync_counter_init: 2 };

    /// What arrives: an intact frame with this counter, a broken one, or nothing.
    #[derive(Clone, Copy)]
    enum In {
        Counter(u8),
        Broken,
        Nothing,
    }
    use In::{Broken, Counter, Nothing};

    fn run(limits: &Limits, steps: &[(In, Status)]) {
        let mut check = Check::new();
        for (place, (input, status)) in steps.iter().enumerate() {
            let arrived = match input {
                Counter(counter) => Some(Ok(*counter)),
                Broken => Some(Err(())),
                Nothing => None,
            };
            assert_eq!(check.check(limits, arrived), *status, "step {place}");
        }
    }

    #[test]
    fn transitions_are_those_of_the_specification() {
        use Status::{Initial, NoNewData, Ok, OkSomeLost, Repeated, Sync, WrongCrc, WrongSequence};
        // WaitForFirstData ends with the first intact frame, whatever its counter; broken ones and silence do not end it.
        run(&LIMITS, &[(Nothing, NoNewData), (Broken, WrongCrc), (Counter(9), Initial), (Counter(10), Ok)]);
        // The counter wraps from 14 to 0.
        run(&LIMITS, &[(Counter(13), Initial), (Counter(14), Ok), (Counter(0), Ok), (Counter(2), OkSomeLost)]);
        // A repeated counter; the next one is good again (NoNewOrRepeated 1 <= 3).
        run(&LIMITS, &[(Counter(4), Initial), (Counter(4), Repeated), (Counter(5), Ok)]);
        // MaxDeltaCounter is Init + 1 at the next check: a step of 3 passes, 4 does not, and then 2 are for sync.
        run(&LIMITS, &[(Counter(0), Initial), (Counter(3), OkSomeLost), (Counter(7), WrongSequence)]);
        let gap = [(Counter(0), Initial), (Counter(6), WrongSequence), (Counter(7), Sync), (Counter(9), Sync)];
        run(&LIMITS, &[&gap[..], &[(Counter(10), Ok), (Counter(11), Ok)]].concat());
        // Every check without a good frame allows one more: 3 checks of nothing, then a step of 6.
        let silence = [(Counter(0), Initial), (Nothing, NoNewData), (Broken, WrongCrc), (Nothing, NoNewData)];
        run(&LIMITS, &[&silence[..], &[(Counter(6), OkSomeLost)]].concat());
        run(&LIMITS, &[&silence[..], &[(Counter(7), WrongSequence)]].concat());
        // More than MaxNoNewOrRepeatedData checks without news: the counter has to be trusted anew.
        let nothing = (Nothing, NoNewData);
        let lull = [(Counter(0), Initial), nothing, nothing, nothing, (Counter(0), Repeated), (Counter(1), Sync)];
        run(&LIMITS, &[&lull[..], &[(Counter(2), Sync), (Counter(3), Sync), (Counter(4), Ok)]].concat());
        // One less is tolerated.
        run(&LIMITS, &[(Counter(0), Initial), nothing, nothing, nothing, (Counter(1), Ok)]);
        // A wrong sequence forgets the repetitions before it.
        let repeated = [(Counter(0), Initial), (Counter(0), Repeated), (Counter(0), Repeated), (Counter(0), Repeated)];
        let after = [(Counter(0), Repeated), (Counter(14), WrongSequence), (Counter(0), Sync), (Counter(1), Sync)];
        run(&LIMITS, &[&repeated[..], &after[..], &[(Counter(2), Ok)]].concat());
        // With SyncCounterInit 0 a wrong sequence moves nothing: the window grows until the counter is inside it.
        let none = Limits { sync_counter_init: 0, ..LIMITS };
        let jump = [(Counter(0), Initial), (Counter(5), WrongSequence), (Counter(6), WrongSequence)];
        run(&none, &[&jump[..], &[(Counter(7), WrongSequence), (Counter(6), OkSomeLost)]].concat());
    }

    #[test]
    fn checksums_are_those_of_an_independent_implementation() {
        let vectors = include_str!("../../tests/vectors/e2e_p01.csv");
        let mut count = 0;
        for line in vectors.lines().skip(1) {
            let mut cells = line.split(',');
            let data_id = u16::from_str_radix(cells.next().unwrap(), 16).unwrap();
            let bytes = u64::from_str_radix(cells.next().unwrap(), 16).unwrap().to_be_bytes();
            let mut blank = bytes;
            blank[0] = 0;
            assert_eq!(protect(blank, data_id, bytes[1] & 0x0F), bytes, "{line}");
            count += 1;
        }
        assert!(count >= 1000);
    }

    #[test]
    fn any_one_or_two_wrong_bits_are_found() {
        let good = protect([0, 0x50, 1, 2, 3, 4, 5, 6], 0x4812, 3);
        for a in 0..64 {
            for b in a..64 {
                let flipped = (u64::from_le_bytes(good) ^ (1 << a) ^ (if a == b { 0 } else { 1 << b })).to_le_bytes();
                let mut check = Check::new();
                assert_eq!(check.receive(&LIMITS, 0x4812, &flipped), Err(Cause::Checksum), "bits {a} and {b}");
            }
        }
    }

    #[test]
    fn counter_15_is_refused_by_its_own_name_and_changes_nothing() {
        let mut check = Check::new();
        let before = check;
        let frame = protect([0; 8], 0x4800, 15);
        assert_eq!(check.receive(&LIMITS, 0x4800, &frame), Err(Cause::CounterRange));
        assert_eq!(check, before);
    }
}
