//! Facts about what the unit sends: what cannot be sent is counted.

use super::*;
use crate::config::Config;
use crate::time::Stamp;
use crate::unit::OnboardUnit;
use crate::wire::StationHash;
use crate::wire::geo::GeoPosition;
use crate::wire::sync::Sync;

type Unit = OnboardUnit<1, 4, 400>;

fn unit() -> Unit {
    Unit::new(&Config::car(StationHash(1))).unwrap()
}

#[test]
fn frames_that_an_answer_has_no_room_for_are_counted() {
    for room in 0..=3 {
        let mut unit = unit();
        let mut frames = Vec::new();
        frames.resize(MAX_FRAMES - room, Frame { id: Identifiers::DEFAULT.at(0), data: [0; 8].into() }).unwrap();
        // A command and a page of health make two frames.
        unit.outbox.send_answer(&Command::NONE, None, &mut unit.health, &mut frames);
        unit.send_own(Instant::ZERO, None, &mut frames);
        let lost = 2usize.saturating_sub(room);
        assert_eq!(unit.health().of(Cause::TransmitOverflow) as usize, lost, "{room}");
        assert_eq!(unit.health().total() as usize, lost);
    }
}

#[test]
fn messages_that_are_none_of_the_units_are_counted_and_not_sent() {
    let place = GeoPosition { tag: 0, latitude: 0, longitude: 0, heading: 0, stamp: Stamp::from_raw(0) };
    for message in [Message::Sync(Sync { sequence: 1, seconds: 0 }), Message::Ego(Said::Geo(place))] {
        let (mut outbox, mut health, mut frames) = (Outbox::new(Identifiers::NONE), Health::new(), Vec::new());
        outbox.emit(&message, &mut health, &mut frames);
        assert_eq!((health.of(Cause::TransmitOverflow), frames.len()), (1, 0), "{message:?}");
    }
}
