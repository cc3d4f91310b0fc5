//! Through the C interface and without it, a unit says the same.

mod drive;

use std::ffi::c_void;
use std::mem::MaybeUninit;

use drive::{END_US, TICK_US};
use holdover::time::Instant;
use holdover::wire::command::ModeCode;
use holdover_c::{Answer, HOLDOVER_UNIT_SIZE, Mode, Status};

#[test]
fn the_committed_drive_is_the_one_that_the_script_makes() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/drive.inc");
    let rows = drive::drive();
    let made = drive::text(&rows);
    if std::env::var_os("HOLDOVER_WRITE_DRIVE").is_some() {
        std::fs::write(path, &made).unwrap();
    }
    let committed = std::fs::read_to_string(path).unwrap_or_default();
    assert!(
        committed == made,
        "drive.inc is not up to date: HOLDOVER_WRITE_DRIVE=1 cargo test -p holdover-c --test agreement writes it"
    );
    assert_eq!(drive::parse(&made), rows);
}

#[test]
fn a_drive_through_all_modes_is_answered_as_by_the_core() {
    let mut memory = vec![0u64; HOLDOVER_UNIT_SIZE / 8];
    let unit = memory.as_mut_ptr().cast::<c_void>();
    let config = drive::config();
    // SAFETY: the memory is as large as said, and nobody else's.
    assert_eq!(unsafe { holdover_c::holdover_init(unit, HOLDOVER_UNIT_SIZE, &config) }, Status::Ok);
    let mut core = holdover::OnboardUnit::<8, 8, 400>::new(&(&config).try_into().unwrap()).unwrap();
    let rows = drive::drive();
    let mut rows = rows.iter().peekable();
    let (mut modes, mut received, mut estimates) = (Vec::new(), Vec::new(), 0);
    for now in (0..=END_US).step_by(TICK_US as usize) {
        while let Some(row) = rows.next_if(|row| row.at_us < now) {
            // SAFETY: as above.
            let status = unsafe { holdover_c::holdover_receive(unit, row.at_us, &row.frame) };
            if !received.contains(&status) {
                received.push(status);
            }
            let by_core = match core.receive(Instant::from_micros(row.at_us), &drive::Heard(row.frame)) {
                Ok(holdover::Reception::Taken) => Status::Ok,
                Ok(holdover::Reception::Pending) => Status::Pending,
                Ok(holdover::Reception::Foreign) => Status::Foreign,
                Err(cause) => Status::from(cause),
            };
            assert_eq!(status, by_core, "{row:?}");
        }
        let mut answer = MaybeUninit::<Answer>::uninit();
        // SAFETY: as above, and the call fills the answer in.
        let answer = unsafe {
            assert_eq!(holdover_c::holdover_tick(unit, now, answer.as_mut_ptr()), Status::Ok);
            answer.assume_init()
        };
        let by_core = core.tick(Instant::from_micros(now));
        let frames = &answer.frames[..answer.frame_count as usize];
        let core_frames: Vec<_> = by_core.frames.iter().map(holdover_c::Frame::from).collect();
        assert_eq!(frames, core_frames, "at {now}");
        assert_eq!(answer.command.acceleration_mm_s2, by_core.command.acceleration.to_mm_per_s2());
        assert_eq!(answer.command.mode as u8, by_core.command.mode as u8);
        assert_eq!(answer.estimate.valid == 1, by_core.estimate.is_some());
        if let Some(estimate) = &by_core.estimate {
            estimates += 1;
            assert_eq!(answer.estimate.position_mm, estimate.reading.position.to_mm());
            assert_eq!(answer.estimate.age_us, estimate.age.as_micros());
            assert_eq!(answer.estimate.bounded, 1);
            assert!(answer.estimate.lowest_position_mm <= answer.estimate.position_mm);
            assert!(answer.estimate.highest_position_mm >= answer.estimate.position_mm);
        }
        if modes.last() != Some(&(answer.command.mode, answer.command.cause)) {
            modes.push((answer.command.mode, answer.command.cause));
        }
    }
    assert!(estimates > 500, "{estimates}");
    use holdover_c::Cause;
    let expected = [
        (Mode::Standby, Cause::None),
        (Mode::Fault, Cause::EgoMissing),
        (Mode::Cooperative, Cause::None),
        (Mode::Holdover, Cause::None),
        (Mode::Fallback, Cause::Silent),
        (Mode::Cooperative, Cause::None),
        (Mode::Fault, Cause::EgoStale),
        (Mode::Cooperative, Cause::None),
        (Mode::Standby, Cause::None),
    ];
    assert_eq!(modes, expected);
    for status in [
        Status::Ok,
        Status::Pending,
        Status::Foreign,
        Status::RefusedChecksum,
        Status::RefusedRepeated,
        Status::RefusedLength,
        Status::RefusedUnknownSlot,
        Status::RefusedNotYetTrusted,
    ] {
        assert!(received.contains(&status), "{status:?} in {received:?}");
    }
}

#[test]
fn modes_have_the_numbers_that_they_have_on_the_bus() {
    for (mode, code) in [
        (Mode::Standby, ModeCode::Standby),
        (Mode::Cooperative, ModeCode::Cooperative),
        (Mode::Holdover, ModeCode::Holdover),
        (Mode::Fallback, ModeCode::Fallback),
        (Mode::Fault, ModeCode::Fault),
    ] {
        assert_eq!(mode as u8, code as u8);
    }
}
