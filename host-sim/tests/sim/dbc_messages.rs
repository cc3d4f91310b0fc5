//! The messages of the DBC files against the catalogue: their attributes, and the files of messages on extended identifiers.

use can_dbc::{AttributeDefinition, AttributeValue, AttributeValueType, Comment, Dbc, MessageId};
use holdover::wire;
use holdover::wire::catalogue::{CATALOGUE, Content, Speaker, data_id};
use holdover::wire::status::INTERFACE;
use holdover::wire::{Identifiers, Slot};

fn read(name: &str) -> Dbc {
    let text = std::fs::read_to_string(format!("{}/../{name}", env!("CARGO_MANIFEST_DIR"))).unwrap();
    Dbc::try_from(text.as_str()).unwrap()
}

#[test]
fn a_file_with_extended_identifiers_has_every_message_of_the_other_and_its_attributes() {
    let id = |number| wire::Identifier::extended(number).unwrap();
    let placed =
        CATALOGUE.iter().zip((0x18FF_0021..).step_by(0x1000)).fold(Identifiers::DEFAULT, |placed, (line, number)| {
            match line.content {
                Content::Said(Speaker::Peer, about) => placed.place_peers(about, id(number), 0x100),
                content => placed.place(content, id(number)).unwrap(),
            }
        });
    for (fd, of_block) in [(false, read("holdover.dbc")), (true, read("holdover-fd.dbc"))] {
        let made = wire::dbc::Dbc::new(placed, 8);
        let text = if fd { made.over_fd() } else { made }.to_string();
        let made = Dbc::try_from(text.as_str()).unwrap();
        assert_eq!(made.messages.len(), of_block.messages.len());
        for (message, other) in made.messages.iter().zip(&of_block.messages) {
            let MessageId::Extended(number) = message.id else { panic!("{} is not extended", message.name) };
            let MessageId::Standard(other_number) = other.id else { panic!("{} is extended", other.name) };
            let offset = Identifiers::DEFAULT.offset_of(wire::Identifier::standard(other_number).unwrap()).unwrap();
            assert_eq!((&message.name, number), (&other.name, placed.at(offset).number()));
            assert_eq!((message.size, &message.signals), (other.size, &other.signals));
            let of = |file: &Dbc, id| {
                let of = |a: &&can_dbc::AttributeValueForMessage| a.message_id == id && a.name != "VFrameFormat";
                let values = file.attribute_values_message.iter().filter(of);
                values.map(|a| (a.name.clone(), a.value.clone())).collect::<Vec<_>>()
            };
            assert_eq!(of(&made, message.id), of(&of_block, other.id), "{}", message.name);
            let has_format = format!("BA_ \"VFrameFormat\" BO_ {} 15;", number | 1 << 31);
            assert_eq!(text.contains(&has_format), fd, "{}", message.name);
        }
    }
}

#[test]
fn the_file_tells_cycles_and_protection_of_every_message() {
    let file = read("holdover.dbc");
    let attribute = |id: u16, name: &str| {
        let of = |a: &&can_dbc::AttributeValueForMessage| a.message_id == MessageId::Standard(id) && a.name == name;
        match file.attribute_values_message.iter().find(of).map(|a| &a.value) {
            Some(AttributeValue::Uint(value)) => *value as i64,
            Some(AttributeValue::Int(value)) => *value,
            other => panic!("{id} {name} {other:?}"),
        }
    };
    let mut messages = 0;
    for line in &CATALOGUE {
        for slot in 0..if line.is_per_slot() { 8 } else { 1 } {
            let offset = line.offset_for(Slot(slot));
            let id = Identifiers::DEFAULT.at(offset).number() as u16;
            assert_eq!(attribute(id, "GenMsgCycleTime"), i64::from(line.cycle_ms));
            assert_eq!(attribute(id, "GenMsgTimeout"), i64::from(line.timeout_ms));
            assert_eq!(attribute(id, "E2EDataId"), i64::from(data_id(offset)));
            assert_eq!(attribute(id, "E2EMaxDeltaCounterInit"), i64::from(line.limits().max_delta_counter_init));
            assert_eq!(attribute(id, "E2EMaxNoNewOrRepeatedData"), i64::from(line.limits().max_no_new_or_repeated));
            assert_eq!(attribute(id, "E2ESyncCounterInit"), i64::from(line.limits().sync_counter_init));
            messages += 1;
        }
    }
    assert_eq!(file.messages.len(), messages);
}

/// The number of an attribute's value.
fn number(value: Option<&AttributeValue>) -> Option<i64> {
    match value? {
        AttributeValue::Uint(value) => i64::try_from(*value).ok(),
        AttributeValue::Int(value) => Some(*value),
        _ => None,
    }
}

/// The names of the messages with this send type, of the peers those of slot 0.
fn sent(file: &Dbc, send_type: &str) -> Vec<String> {
    let names = file.attribute_definitions.iter().find_map(|definition| match definition {
        AttributeDefinition::Message(name, AttributeValueType::Enum(names)) if name == "GenMsgSendType" => Some(names),
        _ => None,
    });
    let place = names.unwrap().iter().position(|name| name == send_type).map(|place| place as i64);
    let of = |id| number(file.message_attribute(id, "GenMsgSendType"));
    let is_of_first = |name: &str| !name.starts_with("Peer") || name.starts_with("Peer0") || name == "PeersUnserved";
    let messages = file.messages.iter().filter(|message| place.is_some() && of(message.id) == place);
    messages.map(|message| message.name.clone()).filter(|name| is_of_first(name)).collect()
}

#[test]
fn every_attribute_is_written_for_every_message_and_signal() {
    for (file, bus) in [(read("holdover.dbc"), "CAN"), (read("holdover-fd.dbc"), "CAN FD")] {
        let of_bus = |name: &str| file.attribute_values_database.iter().find(|a| a.name == name).map(|a| &a.value);
        assert_eq!(of_bus("BusType"), Some(&AttributeValue::String(bus.into())));
        assert_eq!(number(of_bus("InterfaceVersion")), Some(INTERFACE.into()));
        assert_eq!(number(file.attribute_default("InterfaceVersion")), Some(INTERFACE.into()));
        for message in &file.messages {
            for definition in &file.attribute_definitions {
                let AttributeDefinition::Message(name, _) = definition else { continue };
                assert!(file.message_attribute(message.id, name).is_some(), "{} has no {name}", message.name);
            }
            for signal in &message.signals {
                let start = file.signal_attribute(message.id, &signal.name, "GenSigStartValue");
                assert!(start.is_some(), "{} {}", message.name, signal.name);
            }
            let is_over_fd = bus == "CAN FD";
            let profile = if is_over_fd { "PROFILE_05" } else { "PROFILE_01A" };
            let written = file.message_attribute(message.id, "E2EProfile");
            assert_eq!(written, Some(&AttributeValue::String(profile.into())), "{}", message.name);
            let of_fd = ["VFrameFormat", "CANFD_BRS"].map(|name| number(file.message_attribute(message.id, name)));
            assert_eq!(of_fd, if is_over_fd { [Some(14), Some(1)] } else { [None; 2] }, "{}", message.name);
        }
    }
}

#[test]
fn the_file_tells_what_is_not_always_sent_and_when_it_is() {
    let (classic, fd) = (read("holdover.dbc"), read("holdover-fd.dbc"));
    for file in [&classic, &fd] {
        assert_eq!(sent(file, "NoMsgSendType"), ["OwnPosition"]);
    }
    let always = ["TimeSync", "TimeFollowUp", "MotionCommand", "ActuatorState", "EgoMotionA", "EgoMotionB"];
    assert_eq!(sent(&classic, "Cyclic"), [&always[..], &["DriverRequest", "Health"]].concat());
    let always = ["TimeSync", "TimeFollowUp", "MotionCommand", "ActuatorState", "EgoMotion", "DriverRequest", "Health"];
    assert_eq!(sent(&fd, "Cyclic"), always);
    let conditional =
        ["EgoPosition", "RangeSensor", "PeersUnserved", "TargetEstimate", "OwnState", "OwnRoute", "OwnPass"];
    let of_peers = ["Peer0State", "Peer0Position", "Peer0Route"];
    assert_eq!(sent(&fd, "CyclicIfActive"), [&conditional[..], &of_peers].concat());
    for file in [&classic, &fd] {
        let comment = |id: MessageId| {
            let of = |comment: &Comment| match comment {
                Comment::Message { id: of, comment } if *of == id => Some(comment.clone()),
                _ => None,
            };
            file.comments.iter().find_map(of).unwrap_or_default()
        };
        for message in &file.messages {
            let (comment, name) = (comment(message.id), &message.name);
            let number = |name| number(file.message_attribute(message.id, name));
            assert!(!comment.is_empty(), "{name}");
            let is_conditional = number("GenMsgSendType") == Some(1);
            assert_eq!(comment.starts_with("Sent only "), is_conditional, "{name}: {comment}");
            if name == "OwnPosition" {
                assert_eq!(comment, "Reserved: no unit of this version sends it.");
                assert_eq!((number("GenMsgCycleTime"), number("GenMsgTimeout")), (Some(0), Some(0)));
            }
        }
    }
}
