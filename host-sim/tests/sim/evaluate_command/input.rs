//! Bad input: one line that names the place and the remedy, exit code 2.

use super::bench::Bench;

fn bench() -> Bench {
    let bench = Bench::new();
    bench.drive("m.csv", (0..=20).map(|n| (n as f64 / 10.0, n as f64, 10.0)));
    bench.link("c.csv", (0..=20).map(|n| (n as f64 / 10.0, Some(0.02))));
    bench
}

#[test]
fn a_recording_that_cannot_be_used_is_named_with_its_line() {
    let bench = bench();
    let header = "t_s,position_m,speed_mps\n0,0,10\n";
    let motions: [(&str, &[u8], &str); 9] = [
        ("no column", b"t_s,speed_mps\n0,1\n1,1\n", "bad.csv:1: no column `position_m`"),
        ("text", b"t_s,position_m,speed_mps\n0,0,10\n1,ten,10\n", "bad.csv:3: `position_m` is \"ten\""),
        ("nan", b"t_s,position_m,speed_mps\n0,0,10\n1,10,NaN\n", "bad.csv:3: `speed_mps` is \"NaN\""),
        ("infinite", b"t_s,position_m,speed_mps\n0,0,10\ninf,10,10\n", "bad.csv:3: `t_s` is \"inf\""),
        ("backwards", b"t_s,position_m,speed_mps\n1,0,10\n0,10,10\n", "bad.csv:3: time runs backwards"),
        ("twice", b"t_s,position_m,speed_mps\n1,0,10\n1,10,10\n", "bad.csv:3: time 1 s stands there twice"),
        ("empty", b"", "bad.csv: is empty"),
        ("binary", b"\x7fELF\x00\x01\xff\xfe", "bad.csv: is not a text file"),
        ("one row", header.as_bytes(), "bad.csv:2: has only one row"),
    ];
    for (what, bytes, expected) in motions {
        bench.write("bad.csv", bytes);
        for arguments in ["--motion bad.csv --channel c.csv", "--motion m.csv bad.csv --outage 1"] {
            let line = bench.refusal(arguments);
            assert!(line.starts_with(&format!("error: {expected}")), "{what}: {line}");
            assert!(line.contains("; "), "{what} has no remedy: {line}");
        }
    }
    let channels: [(&str, &[u8], &str); 8] = [
        ("no column", b"t_s,delay\n0,1\n1,1\n", "bad.csv:1: no column `delay_s`"),
        ("text", b"t_s,delay_s\n0,0\n1,late\n", "bad.csv:3: `delay_s` is \"late\""),
        ("negative", b"t_s,delay_s\n0,0\n1,-0.1\n", "bad.csv:3: `delay_s` is \"-0.1\""),
        ("backwards", b"t_s,delay_s\n1,0\n0,0\n", "bad.csv:3: time runs backwards"),
        ("more fields", b"t_s,delay_s\n0,0\n1,0,1\n", "bad.csv:3: has 3 fields under 2 columns"),
        ("a column twice", b"t_s,delay_s,t_s\n0,0,0\n1,0,1\n", "bad.csv:1: the column \"t_s\" stands there twice"),
        ("empty", b"t_s,delay_s\n", "bad.csv:1: has a header but no rows"),
        ("one row", b"t_s,delay_s\n0,0.1\n", "bad.csv:2: has only one row"),
    ];
    for (what, bytes, expected) in channels {
        bench.write("bad.csv", bytes);
        let line = bench.refusal("--motion m.csv --channel bad.csv");
        assert!(line.starts_with(&format!("error: {expected}")), "{what}: {line}");
    }
    for arguments in
        ["--motion none.csv --channel c.csv", "--motion m.csv --channel none.csv", "--motion none.csv --outage 1"]
    {
        assert!(bench.refusal(arguments).starts_with("error: none.csv: cannot be read"), "{arguments}");
    }
}

#[test]
fn recordings_have_to_share_some_time() {
    let bench = bench();
    bench.link("late.csv", [(2.1, Some(0.0)), (3.0, Some(0.0))]).link("touching.csv", [(2.0, Some(0.0)), (3.0, None)]);
    let line = bench.refusal("--motion m.csv --channel late.csv");
    assert!(line.starts_with("error: m.csv: is of 0 to 2 s, which shares no time with"), "{line}");
    let results = bench.results("--motion m.csv --channel touching.csv");
    assert_eq!(results["ticks"], 1);
}

#[test]
fn what_keeps_messages_away_is_one_of_two() {
    let bench = bench();
    assert!(bench.refusal("--motion m.csv").contains("give --channel FILE.csv, or --outage"));
    let line = bench.refusal("--motion m.csv --channel c.csv --outage 1");
    assert!(line.starts_with("error: --outage: cannot be used together with --channel"), "{line}");
}

#[test]
fn lengths_of_silence_are_positive_numbers_that_fit_the_recording() {
    let bench = bench();
    let cases = [
        ("1,two", "has \"two\", which is not a number"),
        ("1,,2", "has an empty place"),
        ("0", "has a length of \"0\" s"),
        ("-1", "has a length of \"-1\" s"),
        ("nan", "has a length of \"nan\" s"),
        ("inf", "has a length of \"inf\" s"),
        ("1,2,1.0", "names 1.0 s twice"),
    ];
    for (list, expected) in cases {
        let line = bench.refusal(&format!("--motion m.csv --outage {list}"));
        assert!(line.starts_with(&format!("error: --outage: {expected}")), "{list}: {line}");
    }
    assert_eq!(bench.results("--motion m.csv --outage 2")["ticks"], 1);
    // A recording shorter than a silence has none of that length.
    let longer = bench.results("--motion m.csv --outage 1,2.01");
    let empty = &longer["ours"]["by_outage"][1];
    assert_eq!((&empty["count"], empty["rms_position_m"].is_null()), (&serde_json::json!(0), true), "{empty}");
}

#[test]
fn steps_are_those_of_the_core() {
    let bench = bench();
    for step in ["0", "-0.1", "nan", "0.0009", "1.1"] {
        let line = bench.refusal(&format!("--motion m.csv --outage 1 --step {step}"));
        assert!(line.starts_with("error: --step: is "), "{step}: {line}");
    }
    for step in ["0.001", "0.0333", "1"] {
        bench.results(&format!("--motion m.csv --outage 1 --step {step}"));
    }
}

#[test]
fn predecessors_and_drives_go_in_pairs() {
    let bench = bench();
    let line = bench.refusal("--motion m.csv m.csv --predecessor m.csv --outage 1");
    assert!(line.starts_with("error: --predecessor: names 1 of the vehicles ahead of 2"), "{line}");
}

#[test]
fn an_input_is_never_overwritten() {
    let bench = bench();
    for file in ["m.csv", "c.csv"] {
        let line = bench.refusal(&format!("--motion m.csv --channel c.csv --trace {file}"));
        assert!(line.starts_with("error: --trace:"), "{line}");
    }
    let line = bench.refusal("--motion m.csv --channel c.csv --trace none/t.csv");
    assert!(line.contains("create the folder first"), "{line}");
}
