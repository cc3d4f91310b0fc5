//! `dbc` prints the catalogue for any bus, and an independent parser reads it.

use std::process::Command;

use can_dbc::{Dbc, MessageId};

fn dbc(arguments: &[&str]) -> (i32, String, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_holdover-sim")).arg("dbc").args(arguments).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (output.status.code().unwrap(), text(output.stdout), text(output.stderr))
}

#[test]
fn without_arguments_it_is_the_committed_file() {
    let committed = include_str!("../../../holdover.dbc");
    assert_eq!(dbc(&[]), (0, committed.into(), String::new()));
    let committed = include_str!("../../../holdover-fd.dbc");
    assert_eq!(dbc(&["--fd"]), (0, committed.into(), String::new()));
}

#[test]
fn base_and_slots_are_as_asked_for() {
    for (arguments, base, slots) in [
        (&["--base-id", "0x300", "--slots", "16"][..], 0x300, 16),
        (&["--slots", "1"], 0x480, 1),
        (&["--base-id", "1856"], 0x740, 8),
    ] {
        let (code, text, _) = dbc(arguments);
        assert_eq!(code, 0);
        let file = Dbc::try_from(text.as_str()).unwrap();
        let ids = file.messages.iter().map(|message| match message.id {
            MessageId::Standard(id) => id,
            MessageId::Extended(id) => panic!("{id} is extended"),
        });
        let ids: Vec<u16> = ids.collect();
        assert_eq!(ids.iter().min(), Some(&base));
        assert!(ids.iter().all(|id| (base..base + 0xC0).contains(id)));
        let peers = file
            .messages
            .iter()
            .filter(|message| message.name.starts_with("Peer") && message.name.ends_with("MotionA"));
        assert_eq!(peers.count(), slots);
    }
}

#[test]
fn what_cannot_be_is_refused_in_one_line() {
    for (arguments, refusal) in [
        (
            ["--base-id", "0x741"],
            "--base-id: the first identifier is 0x741; give one up to 0x740, so that the messages fit into 11 bits",
        ),
        (["--slots", "0"], "--slots: 0 slots; give 1 to 16"),
        (["--slots", "17"], "--slots: 17 slots; give 1 to 16"),
        (["--slots", "256"], "--slots: 256 slots; give 1 to 16"),
        (["--slots", "-1"], "--slots: -1 slots; give 1 to 16"),
        (["--slots", "many"], "--slots: `many` is no number; give 1 to 16"),
        (["--base-id", "foo"], "--base-id: `foo` is no number; give one such as 0x480"),
        (["--base-id", "-1"], "--base-id: `-1` is no number; give one such as 0x480"),
        (["--place", "EgoMotion=0x123"], "--place: there is no message `EgoMotion` on classic CAN; give one of "),
    ] {
        let (code, out, error) = dbc(&arguments);
        assert_eq!((code, out.as_str()), (2, ""));
        assert!(error.contains(refusal) && error.lines().count() == 1, "{error}");
    }
}

#[test]
fn a_message_of_can_fd_lies_where_the_block_has_no_frame_of_can_fd() {
    let (code, text, _) = dbc(&["--fd", "--place", "MotionCommand=0x485", "--place", "PeerState=0x123/1"]);
    assert_eq!(code, 0);
    let file = Dbc::try_from(text.as_str()).unwrap();
    for (name, id) in [("MotionCommand", 0x485), ("Peer0State", 0x123), ("Peer7State", 0x12A)] {
        let message = file.messages.iter().find(|message| message.name == name).unwrap();
        assert_eq!(message.id, MessageId::Standard(id), "{name}");
    }
    let (code, _, error) = dbc(&["--fd", "--place", "EgoMotionB=0x123"]);
    assert_eq!((code, error.lines().count()), (2, 1));
    assert!(error.contains("--place: there is no message `EgoMotionB` on CAN FD; give one of "), "{error}");
}
