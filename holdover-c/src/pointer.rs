//! Pointers from C: an address enters; a reference, or why there is none, leaves.

use core::mem::MaybeUninit;

use crate::status::Status;

/// What the pointer points to, to be read.
///
/// # Errors
/// [`Status::Null`], [`Status::Misaligned`].
///
/// # Safety
/// A pointer that is neither null nor misaligned has to point to a `T` that nobody changes as long as the reference lives.
pub unsafe fn read<'a, T>(pointer: *const T) -> Result<&'a T, Status> {
    check(pointer)?;
    // SAFETY: not null, aligned, and the caller vouches for the rest.
    Ok(unsafe { &*pointer })
}

/// So many values from where the pointer points on, to be read; none wherever it points, if there are none.
///
/// # Errors
/// [`Status::Null`], [`Status::Misaligned`].
///
/// # Safety
/// As [`read`], of as many as that, which have to fit into memory.
pub unsafe fn read_all<'a, T>(pointer: *const T, count: usize) -> Result<&'a [T], Status> {
    if count == 0 {
        return Ok(&[]);
    }
    check(pointer)?;
    // SAFETY: not null, aligned, and the caller vouches for the rest.
    Ok(unsafe { core::slice::from_raw_parts(pointer, count) })
}

/// The place that the pointer points to, to be written; what is there so far may be anything.
///
/// # Errors
/// [`Status::Null`], [`Status::Misaligned`].
///
/// # Safety
/// A pointer that is neither null nor misaligned has to point to memory for a `T` that nobody else uses as long as the
/// reference lives.
pub unsafe fn write<'a, T>(pointer: *mut T) -> Result<&'a mut MaybeUninit<T>, Status> {
    check(pointer)?;
    // SAFETY: not null, aligned, the caller vouches for the rest, and `MaybeUninit` may hold anything.
    Ok(unsafe { &mut *pointer.cast::<MaybeUninit<T>>() })
}

/// Whether something of this type may lie there at all.
///
/// # Errors
/// [`Status::Null`], [`Status::Misaligned`].
pub fn check<T>(pointer: *const T) -> Result<(), Status> {
    if pointer.is_null() {
        return Err(Status::Null);
    }
    if pointer.is_aligned() { Ok(()) } else { Err(Status::Misaligned) }
}
