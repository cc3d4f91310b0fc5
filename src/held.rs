//! A value that may be missing, whose absence is zero in memory: a value or nothing enters, an `Option` leaves.
//!
//! The unit is tens of kilobytes. Built by value it passes over the stack, and a `static` that starts with anything but
//! zeros has its whole image in flash as well. So an idle unit is zero throughout, lies in `.bss`, and is started where
//! it lies. `Option` cannot promise that: it likes to hide `None` in an invalid value of its content, which is not 0.

/// Like `Option`, with a layout that says where `Nothing` is kept.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u32)] // a tag of its own in front of the value, a whole word, so that words are copied; that of `Nothing` is 0
pub enum Held<T> {
    /// There is none.
    #[default]
    Nothing = 0,
    /// This one.
    Value(T) = 1,
}

impl<T> Held<T> {
    /// The value.
    #[must_use]
    pub const fn as_ref(&self) -> Option<&T> {
        match self {
            Self::Nothing => None,
            Self::Value(value) => Some(value),
        }
    }

    /// Holds this value from now on.
    pub fn set(&mut self, value: T) {
        *self = Self::Value(value);
    }

    /// Holds nothing from now on.
    pub fn clear(&mut self) {
        *self = Self::Nothing;
    }
}

impl<T> From<Option<T>> for Held<T> {
    fn from(value: Option<T>) -> Self {
        value.map_or(Self::Nothing, Self::Value)
    }
}

impl<T: Copy> Held<T> {
    /// A copy of the value.
    #[must_use]
    pub const fn get(&self) -> Option<T> {
        match self {
            Self::Nothing => None,
            Self::Value(value) => Some(*value),
        }
    }
}
