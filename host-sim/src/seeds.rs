//! The seeds of a command: the first and how many enter; all of them, or an error that says what to give, leave.

use std::ops::RangeInclusive;

use crate::error::Error;

/// The most seeds: what their runs leave is held at once.
pub const MOST: u64 = 10_000;

/// As many as `--seeds` says from the first on.
///
/// # Errors
/// None of them, more than [`MOST`], and what [`from`] refuses.
pub fn checked(first: u64, count: u64) -> Result<RangeInclusive<u64>, Error> {
    if !(1..=MOST).contains(&count) {
        let remedy = format!("give a number from 1 to {MOST}");
        return Err(Error::new(format!("is {count}"), remedy).in_option("--seeds"));
    }
    from(first, count)
}

/// So many from the first on, however their number was given.
///
/// # Errors
/// A first one with too few above it.
pub fn from(first: u64, count: u64) -> Result<RangeInclusive<u64>, Error> {
    first.checked_add(count.saturating_sub(1)).map(|last| first..=last).ok_or_else(|| {
        let cause = format!("from {first} on there are fewer than {count} seeds: the last one is {}", u64::MAX);
        Error::new(cause, "give a smaller first seed").in_option("--seed")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_seed_there_is_can_be_had_and_none_beyond_it() {
        assert_eq!(checked(u64::MAX, 1).unwrap().collect::<Vec<_>>(), [u64::MAX]);
        assert!(checked(u64::MAX, 2).is_err() && checked(1, 0).is_err() && checked(1, MOST + 1).is_err());
        assert_eq!(checked(7, MOST).unwrap().count(), 10_000);
    }
}
