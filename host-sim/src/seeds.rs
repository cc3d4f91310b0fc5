//! The seeds of a command: the first and how many enter; all of them, or an error that says what to give, leave.

use std::ops::Range;

use crate::error::Error;

/// The most seeds: what their runs leave is held at once.
pub const MOST: u64 = 10_000;

/// As many as `--seeds` says from the first on.
///
/// # Errors
/// None of them, more than [`MOST`], and what [`from`] refuses.
pub fn checked(first: u64, count: u64) -> Result<Range<u64>, Error> {
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
pub fn from(first: u64, count: u64) -> Result<Range<u64>, Error> {
    first.checked_add(count).map(|end| first..end).ok_or_else(|| {
        let cause = format!("seeds from {first} on end before there are {count}");
        Error::new(cause, "give a smaller first seed").in_option("--seed")
    })
}
