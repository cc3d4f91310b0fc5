//! The functions of the library: what a C program has enters, a status leaves.
//!
//! No pointer is used before it is checked, and no output is left unwritten: what a caller reads after a refused call is
//! harmless.

use core::ffi::{c_char, c_void};

use holdover::time::Instant;
use holdover::wire::StationHash;
use holdover::{Reception, config};

use crate::answer::Answer;
use crate::config::Config;
use crate::frame::{Frame, Heard};
use crate::incident;
use crate::map::Itinerary;
use crate::memory;
use crate::pointer;
use crate::status::{self, Status};

/// Whole steps of the longest horizon.
#[allow(clippy::cast_possible_truncation)] // a few hundred
const LAST_STEP: u32 = (memory::HOLDOVER_STEPS - 2) as u32;

/// The version of the header: major in bits 16 and up, minor in bits 8 to 15, patch in bits 0 to 7.
pub const HOLDOVER_VERSION: u32 = 0x000200;

/// The version of the library; to be compared with `HOLDOVER_VERSION` once at start, since structs of another version may
/// be laid out differently.
#[unsafe(no_mangle)]
pub extern "C" fn holdover_version() -> u32 {
    HOLDOVER_VERSION
}

/// The name of a code, as a string in ASCII that is there for good; `"unknown"` if there is no such code.
#[unsafe(no_mangle)]
pub extern "C" fn holdover_status_name(status: i32) -> *const c_char {
    status::name(status).as_ptr()
}

/// Bytes of memory that a unit of the library needs at least; to be compared with `HOLDOVER_UNIT_SIZE` once at start, since a library
/// may be built for another capacity than the program.
#[unsafe(no_mangle)]
pub extern "C" fn holdover_unit_size() -> usize {
    memory::HOLDOVER_UNIT_SIZE
}

/// Fills in the configuration of a car: 1,500 kg, 4.8 m, 100 Hz, time gap 1.6 s, station 0, no range sensor, passes kept, the envelope
/// engaged, and a horizon of 10.71 s or as long as the library has steps for.
///
/// # Safety
/// `config` has to point to memory for a configuration that nobody else uses during the call.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holdover_default_config(config: *mut Config) -> Status {
    // SAFETY: checked there, and the caller vouches for the rest.
    match unsafe { pointer::write(config) } {
        Ok(place) => {
            let config = place.write(Config::from(&config::Config::car(StationHash(0))));
            // All of a horizon's steps but the two at its ends.
            let most = config.prediction.step_us.saturating_mul(LAST_STEP);
            config.prediction.horizon_us = config.prediction.horizon_us.min(most);
            Status::Ok
        }
        Err(cause) => cause,
    }
}

/// Makes a unit in `memory`, of which there are `size` bytes: at least `HOLDOVER_UNIT_SIZE`, at an address that is a multiple
/// of `HOLDOVER_UNIT_ALIGN`. The configuration is copied. What is refused leaves the memory as it was.
///
/// The memory should be zero; if it may still hold the unit of a program that ran before (a section that a reset does not
/// clear), call `holdover_after_reset` before.
///
/// # Safety
/// `memory` has to be the caller's for as long as the unit is used, and nobody else may write to it. `config` has to
/// point to a configuration.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holdover_init(memory: *mut c_void, size: usize, config: *const Config) -> Status {
    // SAFETY: checked there, and the caller vouches for the rest.
    let made = unsafe { pointer::read(config) }
        .and_then(config::Config::try_from)
        // SAFETY: checked there, and the caller vouches for the rest.
        .and_then(|config| unsafe { memory::occupy(memory, size, &config) });
    made.map_or_else(|cause| cause, |()| Status::Ok)
}

/// Ends the use of a unit; its memory may be used for anything then, also for another unit.
///
/// # Safety
/// As [`holdover_tick`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holdover_release(unit: *mut c_void) -> Status {
    // SAFETY: checked there, and the caller vouches for the rest.
    unsafe { memory::vacate(unit) }.map_or_else(|cause| cause, |()| Status::Ok)
}

/// Takes out of memory that a reset does not clear what the program before the reset has left there, also a unit that it was in the
/// middle of a call into, which every other function would refuse as busy for ever. To be called once after a reset, before
/// `holdover_init` and before anything calls into the unit. There need not be a unit.
///
/// # Safety
/// `memory` has to be memory as in [`holdover_init`], and no call into a unit there may be under way.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holdover_after_reset(memory: *mut c_void) -> Status {
    // SAFETY: checked there, and the caller vouches for the rest.
    unsafe { memory::clear(memory) }.map_or_else(|cause| cause, |()| Status::Ok)
}

/// Takes in one frame, received at `at_us` microseconds of a clock that never goes back. Frames may come in any order and at
/// any time. Positive or zero: what became of it; else the cause for which it was refused.
///
/// # Safety
/// `frame` has to point to a frame; `unit` as in [`holdover_tick`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holdover_receive(unit: *mut c_void, at_us: u64, frame: *const Frame) -> Status {
    // SAFETY: checked there, and the caller vouches for the rest.
    let received = unsafe { pointer::read(frame) }.and_then(Heard::try_from).and_then(|frame| {
        // SAFETY: checked there, and the caller vouches for the rest.
        unsafe { memory::enter(unit, |unit| unit.receive(Instant::from_micros(at_us), &frame)) }
    });
    match received {
        Ok(Ok(Reception::Taken)) => Status::Ok,
        Ok(Ok(Reception::Pending)) => Status::Pending,
        Ok(Ok(Reception::Foreign)) => Status::Foreign,
        Ok(Err(cause)) => Status::from(cause),
        Err(cause) => cause,
    }
}

/// The task of one period, at `now_us` microseconds of the same clock; the frames of the answer are then to be sent. If the
/// call is refused, the answer is mode standby (the command is not to be used) without frames.
///
/// # Safety
/// `unit` has to be memory in which [`holdover_init`] was called, or that is at least as large; `answer` has to point to
/// memory for an answer, outside of the unit, that nobody else uses during the call.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holdover_tick(unit: *mut c_void, now_us: u64, answer: *mut Answer) -> Status {
    // SAFETY: checked there, and the caller vouches for the rest.
    let place = match unsafe { pointer::write(answer) } {
        Ok(place) => place,
        Err(cause) => return cause,
    };
    let place = place.write(Answer::NONE);
    // SAFETY: checked there, and the caller vouches for the rest.
    let ticked = unsafe { memory::enter(unit, |unit| place.fill(&unit.tick(Instant::from_micros(now_us)))) };
    ticked.map_or_else(|cause| cause, |()| Status::Ok)
}

/// Takes note of what the platform around the unit met with, so many times since it last said so: one of
/// `HOLDOVER_INCIDENT_...`. `Health` counts it beside the unit's own refusals.
///
/// # Safety
/// As [`holdover_tick`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holdover_note(unit: *mut c_void, incident: i32, times: u32) -> Status {
    let noted = incident::incident(incident)
        // SAFETY: checked there, and the caller vouches for the rest.
        .and_then(|incident| unsafe { memory::enter(unit, |unit| unit.note(incident, times)) });
    noted.map_or_else(|cause| cause, |()| Status::Ok)
}

/// Sets out on a way through intersections: from now on, and until the unit is made anew, positions of peers are taken on the virtual
/// lane, and where `DriverRequest` names no predecessor the order at the intersections decides whom to follow.
///
/// The way and all that it points to is copied into `map`, of which there are `size` bytes: `HOLDOVER_MAP_SIZE` at least. What is
/// refused leaves the unit as it was, and on the way that it had; `map` may hold anything then.
///
/// # Safety
/// `map` has to be the caller's until the unit is on another way, is made anew, or is not used any more, and nobody else may write to
/// it. `way`, and what is in it, has to point to as many structs as it says; `unit` as in [`holdover_tick`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holdover_set_out(
    unit: *mut c_void,
    way: *const Itinerary,
    map: *mut c_void,
    size: usize,
) -> Status {
    // SAFETY: checked there, and the caller vouches for the rest.
    let set_out = unsafe { pointer::read(way).and_then(|way| memory::set_out(unit, way, map, size)) };
    set_out.map_or_else(|cause| cause, |()| Status::Ok)
}

/// How often frames were refused for a cause since the unit was made; `cause` is one of `HOLDOVER_REFUSED_...`. 0 if
/// the call is refused.
///
/// # Safety
/// `count` has to point to memory for a number that nobody else uses during the call; `unit` as in [`holdover_tick`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holdover_count(unit: *mut c_void, cause: i32, count: *mut u32) -> Status {
    // SAFETY: checked there, and the caller vouches for the rest.
    let place = match unsafe { pointer::write(count) } {
        Ok(place) => place,
        Err(cause) => return cause,
    };
    place.write(0);
    let counted = status::cause_of(cause)
        // SAFETY: checked there, and the caller vouches for the rest.
        .and_then(|cause| unsafe { memory::enter(unit, |unit| unit.health().of(cause)) });
    match counted {
        Ok(count) => {
            place.write(count);
            Status::Ok
        }
        Err(cause) => cause,
    }
}
