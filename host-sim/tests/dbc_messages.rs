//! The messages of the DBC files against the catalogue: their attributes, and the files of messages on extended identifiers.

use can_dbc::{AttributeValue, Dbc, MessageId};
use holdover::wire;
use holdover::wire::catalogue::{CATALOGUE, Content, Speaker, data_id};
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
