//! What is not as it has to be is refused by the code that names it, and has no effect.

mod drive;

use std::ffi::{CStr, c_void};
use std::mem::MaybeUninit;
use std::ptr::{null, null_mut};

use holdover_c::*;

/// Memory for a unit, and some bytes around it to misalign it by.
struct Memory(Vec<u64>);

impl Memory {
    fn filled(byte: u8) -> Self {
        Self(vec![u64::from_ne_bytes([byte; 8]); HOLDOVER_UNIT_SIZE / 8 + 1])
    }

    fn at(&mut self, offset: usize) -> *mut c_void {
        self.0.as_mut_ptr().cast::<u8>().wrapping_add(offset).cast()
    }

    fn init(&mut self) -> Status {
        init(self.at(0), HOLDOVER_UNIT_SIZE, &drive::config())
    }
}

fn init(memory: *mut c_void, size: usize, config: *const Config) -> Status {
    // SAFETY: every memory and configuration of these tests is there and as large as said, or wrong in a way that is checked.
    unsafe { holdover_init(memory, size, config) }
}

fn receive(unit: *mut c_void, frame: *const Frame) -> Status {
    // SAFETY: as above.
    unsafe { holdover_receive(unit, 0, frame) }
}

/// The answer, of which every byte was 0xAA before, and the status.
fn tick(unit: *mut c_void) -> (Status, Answer) {
    let mut answer = MaybeUninit::<Answer>::uninit();
    // SAFETY: as above; a call with a usable answer writes it, whatever else it does.
    unsafe {
        answer.as_mut_ptr().cast::<u8>().write_bytes(0xAA, size_of::<Answer>());
        let status = holdover_tick(unit, 0, answer.as_mut_ptr());
        (status, answer.assume_init())
    }
}

fn release(unit: *mut c_void) -> Status {
    // SAFETY: as above.
    unsafe { holdover_release(unit) }
}

fn after_reset(memory: *mut c_void) -> Status {
    // SAFETY: as above; no call is under way.
    unsafe { holdover_after_reset(memory) }
}

fn count(unit: *mut c_void, cause: i32) -> (Status, u32) {
    let mut count = 0xAAAA;
    // SAFETY: as above.
    let status = unsafe { holdover_count(unit, cause, &mut count) };
    (status, count)
}

const FRAME: Frame = Frame { id: 0x484, extended: 0, remote: 0, length: 8, data: [0; 8] };

#[test]
fn a_null_pointer_is_refused_wherever_there_is_one() {
    let mut memory = Memory::filled(0);
    let config = drive::config();
    assert_eq!(init(null_mut(), HOLDOVER_UNIT_SIZE, &config), Status::Null);
    assert_eq!(init(memory.at(0), HOLDOVER_UNIT_SIZE, null()), Status::Null);
    assert_eq!(memory.init(), Status::Ok);
    assert_eq!(receive(null_mut(), &FRAME), Status::Null);
    assert_eq!(receive(memory.at(0), null()), Status::Null);
    assert_eq!(tick(null_mut()).0, Status::Null);
    assert_eq!(release(null_mut()), Status::Null);
    assert_eq!(count(null_mut(), Status::RefusedStale as i32).0, Status::Null);
    // SAFETY: null is checked for.
    unsafe {
        assert_eq!(holdover_tick(memory.at(0), 0, null_mut()), Status::Null);
        assert_eq!(holdover_count(memory.at(0), Status::RefusedStale as i32, null_mut()), Status::Null);
        assert_eq!(holdover_default_config(null_mut()), Status::Null);
    }
}

#[test]
fn a_misaligned_address_is_refused_wherever_there_is_one() {
    let (mut memory, mut other) = (Memory::filled(0), Memory::filled(0));
    for offset in 1..HOLDOVER_UNIT_ALIGN {
        assert_eq!(init(memory.at(offset), HOLDOVER_UNIT_SIZE, &drive::config()), Status::Misaligned, "{offset}");
        assert_eq!(tick(memory.at(offset)).0, Status::Misaligned, "{offset}");
        assert_eq!(receive(memory.at(offset), &FRAME), Status::Misaligned, "{offset}");
        assert_eq!(release(memory.at(offset)), Status::Misaligned, "{offset}");
    }
    assert_eq!(memory.init(), Status::Ok);
    assert_eq!(init(other.at(0), HOLDOVER_UNIT_SIZE, other.at(1).cast()), Status::Misaligned);
    assert_eq!(receive(memory.at(0), other.at(2).cast()), Status::Misaligned);
    // SAFETY: misalignment is checked for.
    unsafe {
        assert_eq!(holdover_tick(memory.at(0), 0, other.at(4).cast()), Status::Misaligned);
        assert_eq!(holdover_count(memory.at(0), Status::RefusedStale as i32, other.at(2).cast()), Status::Misaligned);
        assert_eq!(holdover_default_config(other.at(2).cast()), Status::Misaligned);
    }
    assert!(other.0.iter().all(|word| *word == 0), "nothing was written");
}

#[test]
fn memory_that_is_too_small_is_refused_and_left_alone() {
    let mut memory = Memory::filled(0x5A);
    for size in [0, 1, 8, HOLDOVER_UNIT_SIZE - 1] {
        assert_eq!(init(memory.at(0), size, &drive::config()), Status::TooSmall, "{size}");
    }
    assert!(memory.0.iter().all(|word| *word == 0x5A5A_5A5A_5A5A_5A5A));
    assert_eq!(init(memory.at(0), HOLDOVER_UNIT_SIZE, &drive::config()), Status::Ok);
    assert_eq!(memory.0.last(), Some(&0x5A5A_5A5A_5A5A_5A5A), "nothing behind the promised size is touched");
}

#[test]
fn there_is_no_unit_in_any_memory_before_it_is_made() {
    for byte in [0, 1, 0x5A, 0xFF] {
        let mut memory = Memory::filled(byte);
        assert_eq!(receive(memory.at(0), &FRAME), Status::NotInitialised, "{byte}");
        assert_eq!(tick(memory.at(0)), (Status::NotInitialised, Answer::NONE), "{byte}");
        assert_eq!(release(memory.at(0)), Status::NotInitialised, "{byte}");
        assert_eq!(count(memory.at(0), Status::RefusedStale as i32), (Status::NotInitialised, 0), "{byte}");
        assert_eq!(memory.init(), Status::Ok, "{byte}");
        assert_eq!(tick(memory.at(0)).0, Status::Ok, "{byte}");
    }
}

#[test]
fn a_unit_that_is_not_released_is_not_made_anew() {
    let mut memory = Memory::filled(0);
    assert_eq!(memory.init(), Status::Ok);
    assert_eq!(receive(memory.at(0), &FRAME), Status::RefusedChecksum);
    assert_eq!(memory.init(), Status::AlreadyInitialised);
    assert_eq!(count(memory.at(0), Status::RefusedChecksum as i32), (Status::Ok, 1));
    assert_eq!(release(memory.at(0)), Status::Ok);
    assert_eq!(tick(memory.at(0)).0, Status::NotInitialised);
    assert_eq!(memory.init(), Status::Ok);
    assert_eq!(count(memory.at(0), Status::RefusedChecksum as i32), (Status::Ok, 0));
}

#[test]
fn a_unit_whose_end_was_overwritten_is_not_used_any_more() {
    let mut memory = Memory::filled(0);
    assert_eq!(memory.init(), Status::Ok);
    let tail = memory.0.iter().rposition(|word| *word != 0).unwrap();
    memory.0[tail] ^= 1;
    assert_eq!(tick(memory.at(0)), (Status::Overrun, Answer::NONE));
    assert_eq!(receive(memory.at(0), &FRAME), Status::Overrun);
    assert_eq!(release(memory.at(0)), Status::Overrun);
    assert_eq!(memory.init(), Status::Ok);
    assert_eq!(tick(memory.at(0)).0, Status::Ok);
}

#[test]
fn a_second_call_into_the_same_unit_is_turned_away() {
    let mut memory = Memory::filled(0);
    assert_eq!(memory.init(), Status::Ok);
    memory.0[1] = u64::from_ne_bytes([1; 8]); // the flag, as a call that was interrupted leaves it
    assert_eq!(tick(memory.at(0)), (Status::Busy, Answer::NONE));
    assert_eq!(receive(memory.at(0), &FRAME), Status::Busy);
    assert_eq!(release(memory.at(0)), Status::Busy);
    memory.0[1] = 0;
    assert_eq!(tick(memory.at(0)).0, Status::Ok);
    assert_eq!(tick(memory.at(0)).0, Status::Ok, "a call that is over does not stand in the way");
}

#[test]
fn a_reset_in_the_middle_of_a_tick_with_memory_that_keeps_its_contents_leaves_a_unit_that_can_be_made_anew() {
    let mut memory = Memory::filled(0);
    assert_eq!(memory.init(), Status::Ok);
    assert_eq!(receive(memory.at(0), &FRAME), Status::RefusedChecksum);
    memory.0[1] = u64::from_ne_bytes([1; 8]); // the flag, as a call that a reset ended leaves it
    assert_eq!((memory.init(), release(memory.at(0))), (Status::AlreadyInitialised, Status::Busy));
    assert_eq!(after_reset(memory.at(0)), Status::Ok);
    assert_eq!(tick(memory.at(0)).0, Status::NotInitialised);
    assert_eq!(memory.init(), Status::Ok);
    assert_eq!(tick(memory.at(0)).0, Status::Ok);
    assert_eq!(count(memory.at(0), Status::RefusedChecksum as i32), (Status::Ok, 0));
}

#[test]
fn after_a_reset_any_memory_is_free_for_a_unit() {
    for byte in [0, 1, 0x5A, 0xFF] {
        let mut memory = Memory::filled(byte);
        assert_eq!(after_reset(memory.at(0)), Status::Ok, "{byte}");
        assert_eq!(memory.init(), Status::Ok, "{byte}");
    }
    assert_eq!(after_reset(null_mut()), Status::Null);
    assert_eq!(after_reset(Memory::filled(0).at(4)), Status::Misaligned);
}

#[test]
fn frames_that_no_bus_can_have_are_refused() {
    let mut memory = Memory::filled(0);
    assert_eq!(memory.init(), Status::Ok);
    for (frame, status) in [
        (Frame { length: 9, ..FRAME }, Status::FrameLength),
        (Frame { length: 255, ..FRAME }, Status::FrameLength),
        (Frame { id: 0x800, ..FRAME }, Status::FrameId),
        (Frame { id: u32::MAX, ..FRAME }, Status::FrameId),
        (Frame { id: 0x2000_0000, extended: 1, ..FRAME }, Status::FrameId),
        (Frame { id: 0x1FFF_FFFF, extended: 1, ..FRAME }, Status::Foreign),
        (Frame { id: 0x7FF, length: 0, ..FRAME }, Status::Foreign),
        (Frame { length: 7, ..FRAME }, Status::RefusedLength),
        (Frame { remote: 1, ..FRAME }, Status::RefusedLength),
    ] {
        assert_eq!(receive(memory.at(0), &frame), status, "{frame:?}");
    }
    assert_eq!(count(memory.at(0), Status::RefusedLength as i32), (Status::Ok, 2));
}

#[test]
fn only_refusals_are_counted() {
    let mut memory = Memory::filled(0);
    assert_eq!(memory.init(), Status::Ok);
    for cause in [0, -1, -63, -64 - holdover::health::Cause::ALL.len() as i32, i32::MIN, i32::MAX] {
        assert_eq!(count(memory.at(0), cause), (Status::NoCause, 0), "{cause}");
    }
}

#[test]
fn two_units_do_not_disturb_one_another() {
    let (mut one, mut other) = (Memory::filled(0), Memory::filled(0));
    assert_eq!((one.init(), other.init()), (Status::Ok, Status::Ok));
    assert_eq!(receive(one.at(0), &FRAME), Status::RefusedChecksum);
    assert_eq!(count(other.at(0), Status::RefusedChecksum as i32), (Status::Ok, 0));
}

#[test]
fn every_code_has_a_name_of_its_own_and_no_other_number_has_one() {
    let name = |code| {
        let name = holdover_status_name(code);
        // SAFETY: a string that is there for good.
        unsafe { CStr::from_ptr(name) }.to_str().unwrap()
    };
    let named: Vec<_> = (-300..300).filter(|code| name(*code) != "unknown").collect();
    let header = include_str!("../holdover.h");
    let codes =
        header.lines().filter_map(|line| line.split_once("((holdover_status_t)")?.1.trim_end_matches(')').parse().ok());
    let mut codes: Vec<i32> = codes.collect();
    codes.sort_unstable();
    assert_eq!(named, codes);
    let mut names: Vec<_> = codes.iter().map(|code| name(*code)).collect();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), codes.len());
    for cause in holdover::health::Cause::ALL {
        let code = Status::from(cause) as i32;
        assert_eq!(code, -64 - cause as i32);
        assert_eq!(name(code).split_once(": ").map(|(_, name)| name), Some(cause.name()));
    }
}
