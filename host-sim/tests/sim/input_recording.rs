//! What a recording must be, and what is said of one that is not.

use holdover_sim::error::Error;
use holdover_sim::input::recording::{ChannelTrace, Motion};
use std::path::Path;

fn motion(bytes: &[u8]) -> Result<Motion, Error> {
    Motion::parse(Path::new("m.csv"), bytes)
}

fn channel(bytes: &[u8]) -> Result<ChannelTrace, Error> {
    ChannelTrace::parse(Path::new("c.csv"), bytes)
}

#[test]
fn columns_are_found_by_name_in_any_order_and_others_are_ignored() {
    let drive = motion(b"note,speed_mps,\"t_s\",yaw,position_m\nx,10,0,,5\n,11,1,9,15.5\n").unwrap();
    let row = drive.rows()[1];
    assert_eq!((row.t_s, row.position_m, row.speed_mps, row.acceleration_mps2), (1.0, 15.5, 11.0, None));
}

#[test]
fn byte_order_mark_crlf_blanks_and_blank_lines_are_tolerated() {
    let drive = motion(b"\xef\xbb\xbft_s, position_m ,speed_mps\r\n\r\n0,0,10\r\n1, 10 ,10\r\n\r\n").unwrap();
    assert_eq!(drive.rows().len(), 2);
    assert_eq!(drive.rows()[1].position_m, 10.0);
}

#[test]
fn an_empty_delay_is_a_lost_message() {
    let trace = channel(b"t_s,delay_s\n0,0.02\n0.1,\n").unwrap();
    assert_eq!(trace.rows()[1].delay_s, None);
}

#[test]
fn a_bad_motion_recording_is_refused_with_file_line_cause_and_remedy() {
    let h = "t_s,position_m,speed_mps\n";
    let columns = "t_s,position_m,speed_mps[,acceleration_mps2]";
    let cases: &[(String, String)] = &[
        (String::new(), format!("m.csv: is empty; give a CSV file with the columns {columns}")),
        (" \r\n\n".into(), format!("m.csv: is empty; give a CSV file with the columns {columns}")),
        ("PNG\0\r".into(), format!("m.csv: is not a text file; give a CSV file with the columns {columns}")),
        (
            "t_s,speed_mps\n0,1\n".into(),
            format!("m.csv:1: no column `position_m` in the header \"t_s,speed_mps\"; name the columns {columns}"),
        ),
        (
            "0,0,10\n1,10,10\n".into(),
            format!("m.csv:1: no column `t_s` in the header \"0,0,10\"; name the columns {columns}"),
        ),
        (h.into(), "m.csv:1: has a header but no rows; give a recording of at least 2 rows".into()),
        (format!("{h}0,0,10\n"), "m.csv:2: has only one row; give a recording of at least 2 rows".into()),
        (format!("{h}0,0,10\n1,ten,10\n"), "m.csv:3: `position_m` is \"ten\", not a number; give a number of m".into()),
        (format!("{h}0,0,NaN\n"), "m.csv:2: `speed_mps` is \"NaN\"; give m/s from -0.5 to 65.534 (km/h / 3.6)".into()),
        (
            format!("{h}0,0,1\n1,-inf,1\n"),
            "m.csv:3: `position_m` is \"-inf\"; give m from -1000000000 to 1000000000".into(),
        ),
        (format!("{h}0,0,88\n"), "m.csv:2: `speed_mps` is \"88\"; give m/s from -0.5 to 65.534 (km/h / 3.6)".into()),
        (
            format!("{h}0,0,-0.51\n"),
            "m.csv:2: `speed_mps` is \"-0.51\"; give m/s from -0.5 to 65.534 (km/h / 3.6)".into(),
        ),
        (
            format!("{h}0,0,1\n1,1,1\n0.5,2,1\n"),
            "m.csv:4: time runs backwards, from 1 s to 0.5 s; sort the lines by t_s, or split the recording here"
                .into(),
        ),
        (
            format!("{h}0,0,1\n1,1,1\n1,2,1\n"),
            "m.csv:4: time 1 s stands there twice; delete one of the two lines".into(),
        ),
        (format!("{h}0,0,1\n1,,1\n"), "m.csv:3: `position_m` is empty; give a number of m, or delete the line".into()),
        (
            format!("{h}0,0,1\n1,1\n"),
            "m.csv:3: has 2 fields, so `speed_mps` is missing; complete or delete the line (a comma stands before an \
             empty last field)"
                .into(),
        ),
        (
            format!("{h}# a comment\n0,0,1\n"),
            "m.csv:2: `t_s` is \"# a comment\", not a number; give a number of s".into(),
        ),
    ];
    for (text, message) in cases {
        assert_eq!(motion(text.as_bytes()).unwrap_err().to_string(), *message, "{text:?}");
    }
}

#[test]
fn lines_are_counted_as_an_editor_counts_them() {
    for text in ["t_s,delay_s\n\n\n0,0.1\n\n1,x\n", "t_s,delay_s\r\n\r\n\r\n0,0.1\r\n\r\n1,x\r\n"] {
        assert_eq!(channel(text.as_bytes()).unwrap_err().line(), Some(6), "{text:?}");
    }
    assert_eq!(channel(b"\n\nt_s,delay\n").unwrap_err().line(), Some(3));
    assert_eq!(channel(b"t_s,delay_s,note\n0,0.1,\"two\nlines\"\nx,0.1,\n").unwrap_err().line(), Some(4));
    assert_eq!(channel(b"t_s,delay_s\n0,0.1\n  \n,\n").unwrap_err().line(), Some(4));
}

#[test]
fn a_bad_channel_recording_is_refused_with_file_line_cause_and_remedy() {
    let cases = [
        ("t_s,delay_s\n0,-0.1\n", "c.csv:2: `delay_s` is \"-0.1\"; give s from 0 to 1000000"),
        ("t_s,delay_s\n0,lost\n", "c.csv:2: `delay_s` is \"lost\", not a number; give a number of s"),
        ("t_s,delay_s\n", "c.csv:1: has a header but no rows; give a recording of at least 1 row"),
        ("t_s,delay_s\n,0.1\n", "c.csv:2: `t_s` is empty; give a number of s, or delete the line"),
        (
            "t_s,delay_s\n0\n",
            "c.csv:2: has 1 field, so `delay_s` is missing; complete or delete the line (a comma stands before an \
             empty last field)",
        ),
    ];
    for (text, message) in cases {
        assert_eq!(channel(text.as_bytes()).unwrap_err().to_string(), message, "{text:?}");
    }
}

#[test]
fn binary_files_are_refused_whatever_is_in_them() {
    let all_bytes: Vec<u8> = (0..=255).collect();
    for bytes in [&all_bytes[..], b"\x1f\x8b\x08", b"\x7fELF\x02\x01\x01\0\0", &[0; 64]] {
        let message = motion(bytes).unwrap_err().to_string();
        assert!(message.starts_with("m.csv: is not a text file;"), "{message}");
    }
}

#[test]
fn a_folder_is_not_a_recording() {
    let folder = tempfile::tempdir().unwrap();
    let message = Motion::read(folder.path()).unwrap_err().to_string();
    assert!(message.ends_with(": cannot be read (Is a directory); name a readable file"), "{message}");
}

proptest::proptest! {
    #[test]
    fn no_text_at_all_makes_a_reader_panic(text in "[-0-9.,;\"\n\r eNaN#t_sdely\u{0}é]{0,80}") {
        let _ = motion(format!("t_s,position_m,speed_mps\n{text}").as_bytes());
        let _ = channel(format!("t_s,delay_s\n{text}").as_bytes());
    }
}
