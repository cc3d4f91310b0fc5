//! The unit in the memory of the caller: an address enters, and the unit there or why there is none leaves.
//!
//! A mark before the unit and one behind it tell whether there is a unit at all, and whether something wrote past the end of
//! what lies next to it. A flag tells whether somebody is in it: a C program may well receive in an interrupt and tick in a
//! task, and two at once in the same unit would be undefined behaviour.

use core::ffi::c_void;
use core::mem::MaybeUninit;
use core::ops::Range;
use core::sync::atomic::{AtomicU32, Ordering};

use holdover::{Config, OnboardUnit};

use crate::map::{self, Itinerary};
use crate::pointer;
use crate::room::Room;
use crate::status::Status;

#[cfg(all(feature = "capacity-16-8-1072", feature = "capacity-4-4-200"))]
compile_error!("a library has one capacity");

/// Vehicles that a unit of this library keeps track of.
#[cfg(not(any(feature = "capacity-16-8-1072", feature = "capacity-4-4-200")))]
pub const HOLDOVER_PEERS: usize = 8;
/// Vehicles that a unit of this library keeps track of.
#[cfg(feature = "capacity-16-8-1072")]
pub const HOLDOVER_PEERS: usize = 16;
/// Vehicles that a unit of this library keeps track of.
#[cfg(feature = "capacity-4-4-200")]
pub const HOLDOVER_PEERS: usize = 4;

/// Samples of the past that it keeps of each.
#[cfg(not(any(feature = "capacity-16-8-1072", feature = "capacity-4-4-200")))]
pub const HOLDOVER_HISTORY: usize = 8;
/// Samples of the past that it keeps of each.
#[cfg(feature = "capacity-16-8-1072")]
pub const HOLDOVER_HISTORY: usize = 8;
/// Samples of the past that it keeps of each.
#[cfg(feature = "capacity-4-4-200")]
pub const HOLDOVER_HISTORY: usize = 4;

/// Steps of a horizon.
#[cfg(not(any(feature = "capacity-16-8-1072", feature = "capacity-4-4-200")))]
pub const HOLDOVER_STEPS: usize = 400;
/// Steps of a horizon.
#[cfg(feature = "capacity-16-8-1072")]
pub const HOLDOVER_STEPS: usize = 1072;
/// Steps of a horizon.
#[cfg(feature = "capacity-4-4-200")]
pub const HOLDOVER_STEPS: usize = 200;

/// The unit that the library is built for.
pub type Unit = OnboardUnit<HOLDOVER_PEERS, HOLDOVER_HISTORY, HOLDOVER_STEPS>;

/// Bytes of memory that a unit needs, on every target.
#[cfg(not(any(feature = "capacity-16-8-1072", feature = "capacity-4-4-200")))]
pub const HOLDOVER_UNIT_SIZE: usize = 48_000;
/// Bytes of memory that a unit needs, on every target.
#[cfg(feature = "capacity-16-8-1072")]
pub const HOLDOVER_UNIT_SIZE: usize = 180_000;
/// Bytes of memory that a unit needs, on every target.
#[cfg(feature = "capacity-4-4-200")]
pub const HOLDOVER_UNIT_SIZE: usize = 20_000;
/// What the address of that memory has to be a multiple of.
pub const HOLDOVER_UNIT_ALIGN: usize = 8;

const _: () = assert!(size_of::<Held>() <= HOLDOVER_UNIT_SIZE, "the header promises more than the unit fits into");
const _: () = assert!(align_of::<Held>() <= HOLDOVER_UNIT_ALIGN && HOLDOVER_UNIT_ALIGN.is_power_of_two());
const _: () = assert!(HOLDOVER_UNIT_SIZE.is_multiple_of(HOLDOVER_UNIT_ALIGN), "an array of words has that size");

/// "holdover" in ASCII. Other memory holds these 64 bits by chance once in 1.8e19 times.
const HEAD: u64 = u64::from_be_bytes(*b"holdover");
const TAIL: u64 = !HEAD;

/// What lies in the memory.
#[repr(C)]
struct Held {
    head: u64,
    busy: AtomicU32,
    /// Where the map lies that the unit uses; an empty range if it has none.
    map: Range<usize>,
    unit: MaybeUninit<Unit>,
    tail: u64,
}

/// Puts a new unit there.
///
/// # Errors
/// [`Status::Null`], [`Status::Misaligned`], [`Status::TooSmall`], [`Status::AlreadyInitialised`], or what is wrong with the
/// configuration. The memory is as it was then.
///
/// # Safety
/// Memory that is neither null, misaligned nor too small has to be there, for as long as the unit is used, and nobody else
/// may use it meanwhile.
pub unsafe fn occupy(memory: *mut c_void, size: usize, config: &Config) -> Result<(), Status> {
    let held = memory.cast::<Held>();
    pointer::check(memory.cast::<u64>())?;
    pointer::check(held)?;
    if size < HOLDOVER_UNIT_SIZE {
        return Err(Status::TooSmall);
    }
    // SAFETY: not null, aligned, large enough, and the caller vouches for the rest.
    if unsafe { inspect(held) }.is_ok() {
        return Err(Status::AlreadyInitialised);
    }
    config.check(HOLDOVER_STEPS)?; // before anything is written
    // SAFETY: as above, and nothing that is in use lies there; `MaybeUninit` may hold anything.
    let place = unsafe { &mut (*held).unit };
    // An idle unit is all zero, so it is made where it lies and not on the stack.
    place.write(const { Unit::idle() }).start(config)?;
    // SAFETY: as above. The head comes last, so that an interrupt in between finds no unit rather than half of one.
    unsafe {
        (&raw mut (*held).busy).write(AtomicU32::new(0));
        (&raw mut (*held).map).write(0..0);
        (&raw mut (*held).tail).write_volatile(TAIL);
        (&raw mut (*held).head).write_volatile(HEAD);
    }
    Ok(())
}

/// Does something with the unit there.
///
/// # Errors
/// [`Status::Null`], [`Status::Misaligned`], [`Status::NotInitialised`], [`Status::Overrun`], [`Status::Busy`]; nothing was
/// done then.
///
/// # Safety
/// An address that is neither null nor misaligned has to be that of memory as [`occupy`] asks for.
pub unsafe fn enter<R>(memory: *mut c_void, task: impl FnOnce(&mut Unit) -> R) -> Result<R, Status> {
    // SAFETY: as the caller vouches.
    unsafe { with(memory, |held| task((*held).unit.assume_init_mut())) }
}

/// Sends the unit there on a way, of which it keeps a copy in other memory.
///
/// # Errors
/// As [`enter`]; as [`map::take`]; [`Status::MapInUse`], or what is wrong with the way. The unit goes on as before then.
///
/// # Safety
/// As [`enter`], as [`Room::new`] for the memory of the map, and as [`map::take`] for the way.
pub unsafe fn set_out(memory: *mut c_void, way: &Itinerary, map: *mut c_void, size: usize) -> Result<(), Status> {
    let task = |held: *mut Held| {
        // SAFETY: as the caller vouches; nobody else is in the unit.
        let (held, mut room) = unsafe { (&mut *held, Room::new(map, size)?) };
        let addresses = room.addresses();
        if held.map.start < addresses.end && addresses.start < held.map.end {
            return Err(Status::MapInUse);
        }
        // SAFETY: as the caller vouches; and there is a unit.
        unsafe { held.unit.assume_init_mut().set_out(map::take(way, &mut room)?)? };
        held.map = addresses;
        Ok(())
    };
    // SAFETY: as the caller vouches.
    unsafe { with(memory, task) }?
}

/// Takes the unit out of the memory, which may then be used for anything.
///
/// # Errors
/// As [`enter`].
///
/// # Safety
/// As [`enter`].
pub unsafe fn vacate(memory: *mut c_void) -> Result<(), Status> {
    // SAFETY: as the caller vouches. The unit itself owns nothing that would have to be dropped.
    unsafe { with(memory, |held| (&raw mut (*held).head).write_volatile(0)) }
}

/// Takes out of the memory whatever a program that ran before has left in it: a unit, one with somebody in it too, or none.
///
/// # Errors
/// [`Status::Null`], [`Status::Misaligned`].
///
/// # Safety
/// As [`occupy`]; and no call into a unit there may be under way.
pub unsafe fn clear(memory: *mut c_void) -> Result<(), Status> {
    let held = memory.cast::<Held>();
    pointer::check(memory.cast::<u64>())?;
    pointer::check(held)?;
    // SAFETY: not null, aligned, and the caller vouches for the rest.
    unsafe { (&raw mut (*held).head).write_volatile(0) };
    Ok(())
}

/// Does something with what lies there, of which there is a whole one that nobody else is in.
///
/// # Safety
/// As [`enter`].
unsafe fn with<R>(memory: *mut c_void, task: impl FnOnce(*mut Held) -> R) -> Result<R, Status> {
    let held = memory.cast::<Held>();
    pointer::check(memory.cast::<u64>())?;
    pointer::check(held)?;
    // SAFETY: not null, aligned, and the caller vouches for the rest.
    unsafe { inspect(held) }?;
    // SAFETY: as above; the flag is atomic and only ever reached by such a shared reference.
    let busy = unsafe { &(*held).busy };
    if was_busy(busy) {
        return Err(Status::Busy);
    }
    let result = task(held);
    busy.store(0, Ordering::Release);
    Ok(result)
}

/// Whether there is a whole unit.
///
/// # Safety
/// The pointer has to be that of memory for it, which may hold anything.
unsafe fn inspect(held: *const Held) -> Result<(), Status> {
    // SAFETY: as the caller vouches. The memory comes from outside, so the compiler has to take its bytes as they are, and
    // every pattern of them is a number.
    let (head, tail) =
        unsafe { ((&raw const (*held).head).read_volatile(), (&raw const (*held).tail).read_volatile()) };
    match (head == HEAD, tail == TAIL) {
        (false, _) => Err(Status::NotInitialised),
        (true, false) => Err(Status::Overrun),
        (true, true) => Ok(()),
    }
}

/// Sets the flag; whether it was set already.
#[cfg(target_has_atomic = "32")]
fn was_busy(busy: &AtomicU32) -> bool {
    busy.swap(1, Ordering::Acquire) != 0
}

/// Sets the flag; whether it was set already. A core that cannot swap is a single one, and what interrupts it between the
/// two steps has left the unit before the second one.
#[cfg(not(target_has_atomic = "32"))]
fn was_busy(busy: &AtomicU32) -> bool {
    let was = busy.load(Ordering::Acquire) != 0;
    if !was {
        busy.store(1, Ordering::Relaxed);
    }
    was
}
