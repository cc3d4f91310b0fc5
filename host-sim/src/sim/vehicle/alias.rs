//! Exchanged names of two stations. A device has the station that it was built with, and the simulation has another
//! station for that vehicle. So on the device's own bus two stations exchange their names. A station enters by one name
//! and leaves by the other.

use holdover::wire::{Predecessor, StationHash};

use crate::sim::modem::V2xMessage;

/// The two stations that exchange their names; by default none do.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Alias(Option<(StationHash, StationHash)>);

impl Alias {
    /// Station `a` is called `b`, and station `b` is called `a`.
    #[must_use]
    pub fn between(a: StationHash, b: StationHash) -> Self {
        Self((a != b).then_some((a, b)))
    }

    /// The other name of a station; its own name if it has no other. Applied twice, this gives the first name again.
    #[must_use]
    pub fn of(self, station: StationHash) -> StationHash {
        match self.0 {
            Some((a, b)) if station == a => b,
            Some((a, b)) if station == b => a,
            _ => station,
        }
    }

    /// The same predecessor by its other name.
    #[must_use]
    pub fn of_predecessor(self, predecessor: Predecessor) -> Predecessor {
        match predecessor {
            Predecessor::Station(station) => Predecessor::Station(self.of(station)),
            other => other,
        }
    }

    /// The same message by other names.
    #[must_use]
    pub fn of_message(self, message: &V2xMessage) -> V2xMessage {
        let mut renamed = *message;
        renamed.motion.station = self.of(message.motion.station);
        if let Some(parameters) = &mut renamed.parameters {
            parameters.predecessor = self.of_predecessor(parameters.predecessor);
        }
        for pass in renamed.pass.iter_mut().chain(renamed.repeated.iter_mut().flatten()) {
            let station = self.of(StationHash(pass.station_id as u8));
            pass.station_id = pass.station_id & !0xFF | u32::from(station.0);
        }
        renamed
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_stations_trade_names_and_the_others_keep_theirs() {
        let alias = Alias::between(StationHash(3), StationHash(1));
        let names: Vec<u8> = (1..=4).map(|station| alias.of(StationHash(station)).0).collect();
        assert_eq!(names, [3, 2, 1, 4]);
        assert_eq!(Alias::default().of(StationHash(3)), StationHash(3));
        assert_eq!(alias.of_predecessor(Predecessor::None), Predecessor::None);
        assert_eq!(alias.of_predecessor(Predecessor::Station(StationHash(3))), Predecessor::Station(StationHash(1)));
    }
}
