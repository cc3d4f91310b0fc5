//! What candump writes is read back, and what it cannot have written is refused with its line.

use embedded_can::{Frame as _, Id, StandardId};
use holdover::time::Instant;
use holdover_sim::bus::Frame;
use holdover_sim::bus::candump::{Content, Entry, LogReader, LogWriter};
use holdover_sim::error::Error;
use proptest::prelude::*;
use std::path::Path;

fn read(log: &[u8]) -> Result<Vec<Entry>, Error> {
    LogReader::new(Path::new("bus.log"), log).collect()
}

fn only(line: &str) -> Entry {
    let mut entries = read(line.as_bytes()).unwrap_or_else(|error| panic!("{line}: {error}"));
    assert_eq!(entries.len(), 1, "{line}");
    entries.remove(0)
}

fn data_frame(id: u16, data: &[u8]) -> Content {
    Content::Frame(Frame::standard(id, data).unwrap())
}

fn remote(id: u16, dlc: usize) -> Content {
    Content::Frame(Frame::new_remote(StandardId::new(id).unwrap(), dlc).unwrap())
}

#[test]
fn a_log_line_is_time_interface_and_frame() {
    let entry = only("(1436509052.249713) vcan0 044#2A366C2BBA\n");
    assert_eq!(entry.at, Some(Instant::from_micros(1_436_509_052_249_713)));
    assert_eq!(entry.interface, "vcan0");
    assert_eq!(entry.content, data_frame(0x44, &[0x2A, 0x36, 0x6C, 0x2B, 0xBA]));
}

#[test]
fn a_screen_line_is_the_same_frame_with_or_without_a_time() {
    let content = data_frame(0x44, &[0x2A, 0x36, 0x6C, 0x2B, 0xBA]);
    let plain = only("  vcan0  044   [5]  2A 36 6C 2B BA\r\n");
    assert_eq!((plain.at, plain.content), (None, content));
    let stamped = only(" (1436509052.249713)  vcan0  044   [5]  2A 36 6C 2B BA   '*6l+.'");
    assert_eq!((stamped.at, stamped.content), (Some(Instant::from_micros(1_436_509_052_249_713)), content));
    let directed = only(" (000.500000)  can1  RX - -  044   [5]  2A 36 6C 2B BA");
    assert_eq!((directed.at, directed.content), (Some(Instant::from_micros(500_000)), content));
    assert_eq!(only("  can1  TX B E  044   [5]  2A 36 6C 2B BA").content, content);
}

const TWELVE: [u8; 12] = [0x11, 0x22, 0x33, 0x44, 0x55, 0x66, 0x77, 0x88, 0x99, 0xAA, 0xBB, 0xCC];

fn fd(flags: u8, data: &[u8]) -> Content {
    Content::Frame(Frame::fd(StandardId::new(0x123).unwrap(), flags, data).unwrap())
}

#[test]
fn every_kind_of_frame_is_recognised_in_both_forms() {
    let extended = Content::Frame(Frame::extended(0x12345678, &[0x11]).unwrap());
    let cases = [
        ("(1.0) can0 123#", data_frame(0x123, &[])),
        ("(1.0) can0 123#1122334455667788", data_frame(0x123, &[0x11, 0x22, 0x33, 0x44, 0x55, 0x66, 0x77, 0x88])),
        ("(1.0) can0 123#1122334455667788_F", data_frame(0x123, &[0x11, 0x22, 0x33, 0x44, 0x55, 0x66, 0x77, 0x88])),
        ("(1.0) can0 7ff#ab T", data_frame(0x7FF, &[0xAB])),
        ("(1.0) can0 12345678#11", extended),
        ("(1.0) can0 00000123#11", Content::Frame(Frame::extended(0x123, &[0x11]).unwrap())),
        ("(1.0) can0 123#R", remote(0x123, 0)),
        ("(1.0) can0 123#R8", remote(0x123, 8)),
        ("(1.0) can0 123##0112233445566778899AABBCC", fd(0, &TWELVE)),
        ("(1.0) can0 00123#81:00:12345678#11223344", Content::Xl),
        ("(1.0) can0 20000004#0004000000000000", Content::ErrorFrame),
        ("  can0  123   [0] ", data_frame(0x123, &[])),
        ("  can0  12345678   [1]  11", extended),
        ("  can0  123   [4]  remote request", remote(0x123, 4)),
        ("  can0  123  [12]  11 22 33 44 55 66 77 88 99 AA BB CC", fd(5, &TWELVE)),
        ("  can0  123  [08]  11 22 33 44 55 66 77 88", fd(5, &TWELVE[..8])),
        ("  can0  20000004   [8]  00 04 00 00 00 00 00 00   ERRORFRAME", Content::ErrorFrame),
    ];
    for (line, content) in cases {
        assert_eq!(only(line).content, content, "{line}");
    }
}

#[test]
fn times_are_cut_off_after_microseconds() {
    for (time, micros) in [("1.5", 1_500_000), ("0000000001.500000", 1_500_000), ("1.123456789", 1_123_456)] {
        assert_eq!(only(&format!("({time}) can0 123#")).at, Some(Instant::from_micros(micros)), "{time}");
    }
}

#[test]
fn blank_lines_are_skipped_and_both_forms_may_be_mixed() {
    let log = b"\n(1.0) can0 123#11\r\n  \n  can0  123   [1]  11\n\n";
    assert_eq!(read(log).unwrap().len(), 2);
    assert_eq!(read(b"").unwrap(), []);
}

#[test]
fn what_candump_cannot_have_written_is_refused_with_its_line() {
    let cases: &[(&[u8], &str)] = &[
        (b"(1.0) can0", "the line is not complete; delete it"),
        (b"(1.0)", "the line is not complete; delete it"),
        (b"(1.0) can0 123#1", "the data \"1\" has half a byte; complete or delete the line"),
        (b"(1.0) can0 123#1G", "the data \"1G\" is not hexadecimal; complete or delete the line"),
        (b"(1.0) can0 123#+1", "the data \"+1\" is not hexadecimal; complete or delete the line"),
        (b"(1.0) can0 123#112233445566778899", "9 bytes of data; a classic frame has at most 8; correct the line"),
        (b"(1.0) can0 123#R9", "the remote frame's length is \"9\"; give 0 to 8"),
        (b"(1.0) can0 800#", "the identifier is \"800\"; give 3 hexadecimal digits up to 7FF, or 8 up to 1FFFFFFF"),
        (b"(1.0) can0 1234#", "the identifier is \"1234\"; give 3 hexadecimal digits up to 7FF, or 8 up to 1FFFFFFF"),
        (b"(1.0) can0 +12#", "the identifier is \"+12\"; give 3 hexadecimal digits up to 7FF, or 8 up to 1FFFFFFF"),
        (b"(1.0) can0 hello", "the identifier is \"hello\"; give 3 hexadecimal digits up to 7FF, or 8 up to 1FFFFFFF"),
        (b"(1,0) can0 123#", "the time is \"1,0\"; give seconds since an epoch, such as (1436509052.249713)"),
        (b"(-1.0) can0 123#", "the time is \"-1.0\"; give seconds since an epoch, such as (1436509052.249713)"),
        (
            b"(99999999999999999.0) can0 123#",
            "the time is \"99999999999999999.0\"; give seconds since an epoch, such as (1436509052.249713)",
        ),
        (
            b"(2015-07-10 08:17:32.249713)  can0  123   [0]",
            "the time begins with \"(2015-07-10\"; record with `candump -l`, or on the screen with -t a, z or d",
        ),
        (
            b"(1.0) a_network_interface 123#",
            "\"a_network_interface\" is no network interface; give a log as `candump -l` writes it",
        ),
        (b"  can0  123   [2]  11", "the line is not complete; delete it"),
        (b"  can0  123   [1]  1", "the data \"1\" is not hexadecimal; complete or delete the line"),
        (b"  can0  123   [9]  1", "the data \"1\" is not hexadecimal; complete or delete the line"),
        (b"  can0  123   8  11", "\"8\" stands where the length should; give a log as `candump -l` writes it"),
        (b"\x80\xff", "is not text; give a log as `candump -l` writes it"),
    ];
    for (line, message) in cases {
        let mut log = b"(0.5) can0 123#11\n\n".to_vec();
        log.extend(*line);
        log.extend(b"\n(2.0) can0 123#11\n");
        let found = read(&log).expect_err(message).to_string();
        assert_eq!(found, format!("bus.log:3: {message}"));
    }
}

#[test]
fn a_file_without_line_ends_is_refused_before_it_fills_the_memory() {
    let endless = std::io::BufReader::new(std::io::repeat(b'x'));
    let message = LogReader::new(Path::new("bus.log"), endless).next().unwrap().unwrap_err().to_string();
    assert!(message.starts_with("bus.log:1: "), "{message}");
}

#[test]
fn only_the_name_of_an_interface_can_stand_in_a_log() {
    for name in ["", "can 0", "a_network_interface", "can\n0"] {
        assert!(LogWriter::new(Vec::new(), name).is_none(), "{name:?}");
    }
}

fn any_frame() -> impl Strategy<Value = Frame> {
    let id = prop_oneof![
        (0u16..=0x7FF).prop_map(|id| Id::Standard(StandardId::new(id).unwrap())),
        (0u32..=0x1FFF_FFFF).prop_map(|id| Id::Extended(embedded_can::ExtendedId::new(id).unwrap())),
    ];
    (id, any::<bool>(), prop::collection::vec(any::<u8>(), 0..=8)).prop_map(|(id, remote, data)| {
        if remote { Frame::new_remote(id, data.len()).unwrap() } else { Frame::new(id, &data).unwrap() }
    })
}

proptest! {
    #[test]
    fn what_is_written_is_read_back(frame in any_frame(), micros in 0u64..4_000_000_000_000_000) {
        let at = Instant::from_micros(micros);
        let mut log = LogWriter::new(Vec::new(), "can0").unwrap();
        log.write(at, &frame).unwrap();
        let entries = read(&log.finish().unwrap()).unwrap();
        prop_assert_eq!(entries.len(), 1);
        prop_assert_eq!((entries[0].at, &entries[0].content), (Some(at), &Content::Frame(frame)));
    }

    #[test]
    fn no_text_makes_the_reader_panic(line in "[ ()#.:_R0-9a-gA-G\\[\\]\u{e9}]{0,40}") {
        let _ = read(line.as_bytes());
        let _ = read(format!("(1.0) can0 {line}").as_bytes());
        let _ = read(format!("  can0  {line}").as_bytes());
    }
}
