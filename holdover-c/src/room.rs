//! Room for what a unit keeps of a map: the caller's memory enters, and places in it leave, one behind the other.

use core::ffi::c_void;
use core::mem::{self, MaybeUninit};
use core::ops::Range;
use core::slice;

use crate::pointer;
use crate::status::Status;

/// What is left of the memory.
pub struct Room {
    left: &'static mut [MaybeUninit<u8>],
}

impl Room {
    /// # Errors
    /// [`Status::Null`].
    ///
    /// # Safety
    /// Memory that is not null has to be there, as large as said, for as long as anything that was put into it is used, and nobody
    /// else may use it meanwhile.
    pub unsafe fn new(memory: *mut c_void, size: usize) -> Result<Self, Status> {
        let memory = memory.cast::<MaybeUninit<u8>>();
        pointer::check(memory)?;
        // SAFETY: not null, and the caller vouches for the rest; `MaybeUninit` may hold anything.
        Ok(Self { left: unsafe { slice::from_raw_parts_mut(memory, size) } })
    }

    /// The addresses of what is left.
    pub fn addresses(&self) -> Range<usize> {
        let begin = self.left.as_ptr().addr();
        begin..begin.saturating_add(self.left.len())
    }

    /// Keeps so many values, each as it is made, which may keep others.
    ///
    /// # Errors
    /// [`Status::MapTooSmall`], or what keeps a value from being made.
    pub fn keep<T: Copy>(
        &mut self,
        count: usize,
        mut make: impl FnMut(&mut Self, usize) -> Result<T, Status>,
    ) -> Result<&'static [T], Status> {
        let places = self.places(count).ok_or(Status::MapTooSmall)?;
        for (number, place) in places.iter_mut().enumerate() {
            place.write(make(self, number)?);
        }
        // SAFETY: each of them was written.
        Ok(unsafe { slice::from_raw_parts(places.as_ptr().cast(), count) })
    }

    /// Keeps one.
    ///
    /// # Errors
    /// As [`keep`](Self::keep).
    pub fn keep_one<T: Copy>(&mut self, value: T) -> Result<&'static T, Status> {
        self.keep(1, |_, _| Ok(value))?.first().ok_or(Status::MapTooSmall)
    }

    fn places<T: Copy>(&mut self, count: usize) -> Option<&'static mut [MaybeUninit<T>]> {
        let left = mem::take(&mut self.left);
        let (_, left) = left.split_at_mut_checked(left.as_ptr().align_offset(align_of::<T>()))?;
        let (part, left) = left.split_at_mut_checked(size_of::<T>().checked_mul(count)?)?;
        self.left = left;
        // SAFETY: it is aligned, as large as that, and was split off for this alone; `MaybeUninit` may hold anything.
        Some(unsafe { slice::from_raw_parts_mut(part.as_mut_ptr().cast(), count) })
    }
}
