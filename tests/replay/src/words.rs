//! The words of a head: 64 bits each, one for every number, so that all numbers of the core have room.

/// Bytes of a word in a file, the lowest first.
pub const WORD: usize = 8;

/// Where words go.
pub type Put<'a> = &'a mut dyn FnMut(i64);

/// Where words come from; `None` at the end.
pub type Take<'a> = &'a mut dyn FnMut() -> Option<i64>;

/// The next word, as a number that it has to fit.
pub fn number<T: TryFrom<i64>>(take: Take) -> Option<T> {
    T::try_from(take()?).ok()
}
