//! The line protocol of serial CAN adapters, against what adapters and disturbed lines do.

/// The board's own sources, with the places that they have there.
#[path = "../src/board"]
#[allow(dead_code)]
mod board {
    pub mod frame;
    pub mod stm32f405 {
        pub mod line;
    }
}

use board::frame::CanFrame;
use board::stm32f405::line::{Line, OPENING, encode};
use embedded_can::{ExtendedId, Frame, Id, StandardId};

/// The frames of these bytes, as lines.
fn heard(bytes: &[u8]) -> Vec<String> {
    let mut line = Line::new();
    bytes.iter().filter_map(|&byte| line.take(byte)).map(|frame| written(&frame)).collect()
}

fn written(frame: &CanFrame) -> String {
    String::from_utf8(encode(frame).to_vec()).unwrap()
}

#[test]
fn a_frame_is_the_same_after_its_line() {
    let data = [0, 1, 2, 3, 0xfc, 0xfd, 0xfe, 0xff];
    let ids: [Id; 4] =
        [StandardId::ZERO.into(), StandardId::MAX.into(), ExtendedId::ZERO.into(), ExtendedId::MAX.into()];
    for id in ids {
        for length in 0..=8 {
            for frame in [CanFrame::new(id, &data[..length]), CanFrame::new_remote(id, length)] {
                let line = written(&frame.unwrap());
                assert_eq!(heard(line.as_bytes()), std::slice::from_ref(&line));
            }
        }
    }
}

#[test]
fn the_lines_are_those_of_the_protocol() {
    let standard = StandardId::new(0x123).unwrap();
    let extended = ExtendedId::new(0x1234_5678).unwrap();
    assert_eq!(written(&CanFrame::new(standard, &[0x11, 0xab]).unwrap()), "t123211AB\r");
    assert_eq!(written(&CanFrame::new(extended, &[0x11]).unwrap()), "T12345678111\r");
    assert_eq!(written(&CanFrame::new_remote(standard, 8).unwrap()), "r1238\r");
    assert_eq!(written(&CanFrame::new_remote(extended, 0).unwrap()), "R123456780\r");
}

#[test]
fn an_adapter_is_opened_whatever_was_said_to_it_before() {
    assert_eq!(OPENING, b"\r\rC\rS6\rO\r");
    // What it answers is no frame.
    assert!(heard(b"\x07\x07\x07\r\r").is_empty());
}

#[test]
fn a_bell_costs_no_frame() {
    assert_eq!(heard(b"\x07t123211AB\r"), ["t123211AB\r"]);
    assert_eq!(heard(b"t1230\r\x07\x07t1231FF\r\x07\r"), ["t1230\r", "t1231FF\r"]);
    assert!(heard(b"t1232\x0711AB\r").is_empty(), "a line that a bell broke is no frame");
}

#[test]
fn half_a_line_costs_no_more_than_itself() {
    // The adapter was plugged in, or bytes were lost: the beginning, the end, or both are missing.
    assert_eq!(heard(b"11AB\rt1231FF\r"), ["t1231FF\r"]);
    assert_eq!(heard(b"t12321t1231FF\r"), ["t1231FF\r"]);
    assert_eq!(heard(b"t123211ABT123456781FF\r"), ["T123456781FF\r"]);
    assert_eq!(heard(b"0123456789012345678901234567890123456789t1231FF\r"), ["t1231FF\r"]);
}

#[test]
fn what_is_no_frame_is_dropped_with_its_line_alone() {
    for wrong in
        ["t", "t12", "t123", "t1239", "t1232FF", "t1231FFF", "t8000", "tXYZ0", "T200000000", "z", "Z", "V1013", ""]
    {
        assert_eq!(heard(format!("{wrong}\rt1231FF\r").as_bytes()), ["t1231FF\r"], "{wrong}");
    }
}

#[test]
fn a_lost_byte_spoils_its_line_alone() {
    let mut line = Line::new();
    let take = |bytes: &[u8], line: &mut Line| bytes.iter().filter(|&&byte| line.take(byte).is_some()).count();
    assert_eq!(take(b"t1231F", &mut line), 0);
    line.spoil();
    assert_eq!(take(b"F\r", &mut line), 0);
    assert_eq!(take(b"t1231FF\r", &mut line), 1);
}
