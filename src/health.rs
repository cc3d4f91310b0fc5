//! What the unit refuses, and what the platform around it lost, counted by cause: a refusal or an incident enters, a
//! saturating count per cause leaves.

/// Why a frame or a message was refused. A refusal changes nothing but its count, the end-to-end state of that
/// identifier, and the evidence of misbehaviour.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum Cause {
    /// A frame of ours that is not exactly 8 data bytes long, or a remote frame.
    Length = 0,
    /// The E2E checksum does not fit.
    Checksum = 1,
    /// The E2E counter repeats the last one: the same frame twice.
    Repeated = 2,
    /// More E2E counters are missing than the message tolerates.
    CounterGap = 3,
    /// The E2E counter is outside 0 to 14.
    CounterRange = 4,
    /// The E2E state machine has not seen enough good frames of this identifier yet.
    NotYetTrusted = 5,
    /// A field holds a value outside its range, or a reserved one.
    Range = 6,
    /// The parts of a message do not belong together, or one of them is missing.
    Torn = 7,
    /// The stamp is older than the unit uses.
    Stale = 8,
    /// The stamp lies in the future by more than the clock's error.
    Future = 9,
    /// A sample with this stamp is held already.
    Duplicate = 10,
    /// A sample that is newer than this one is held already, and this one no longer fits the history.
    OutOfOrder = 11,
    /// A slot beyond the unit's capacity.
    UnknownSlot = 12,
    /// Another station claims a slot whose station is still alive.
    StationConflict = 13,
    /// A peer too far away to have anything to do with the unit.
    TooFar = 14,
    /// A follow-up without its sync message, or out of sequence.
    SyncSequence = 15,
    /// A position that cannot be reached from the sample before it.
    Jump = 16,
    /// A speed that does not fit the positions.
    Implausible = 17,
    /// A value that does not change though it has to.
    Stuck = 18,
    /// A time before one that the unit was given already.
    ClockBackwards = 19,
    /// Frames that the platform's receive queue had no room for ([`Incident::ReceiveOverflow`]).
    ReceiveOverflow = 20,
    /// Frames that the bus controller lost before the platform took them ([`Incident::Overrun`]).
    Overrun = 21,
    /// Frames of the unit that are lost before the bus, because the platform's transmit queue had no room for them
    /// ([`Incident::TransmitOverflow`]) or the unit's own answer had none.
    TransmitOverflow = 22,
    /// The bus controller left the bus after too many errors, or could not be put onto it ([`Incident::BusOff`]).
    BusOff = 23,
    /// The unit was restarted by its watchdog ([`Incident::Restart`]).
    Restart = 24,
    /// A place on the globe that is not on the ego's path.
    OffRoute = 25,
    /// A station that arrived later went on not heeding the ego, which then gave way to it.
    Overlooked = 26,
    /// A synchronisation that came later than the unit's own clock allows ([`Clock`](crate::clock::Clock)).
    SyncLate = 27,
    /// A synchronisation that came earlier than the unit's own clock allows ([`Clock`](crate::clock::Clock)).
    SyncEarly = 28,
    /// Not a refusal of a message: a peer's clock that is ahead of GNSS time, or perhaps behind it; once for every 5 s.
    PeerClock = 29,
    /// Views of the range sensor that what is certain of the target excludes: once for every contradiction that begins. The unit
    /// drives by what it sees then.
    RangeDisagrees = 30,
    /// A horizon that its sender cannot drive, by all that is certain of it: it is not used.
    Unreachable = 31,
    /// Not a refusal: the driver's request stopped coming while the unit drove, once for each time. The unit hands back.
    RequestLost = 32,
    /// Not a refusal: an `EgoMotion` of another station than the unit is configured for.
    EgoStation = 33,
    /// Not a refusal: the driver took over by a pedal while the unit was asked to drive, once for each time.
    DriverOverride = 34,
}

/// What the platform around the unit has met with. It tells the unit ([`OnboardUnit::note`](crate::OnboardUnit::note)), so
/// that `Health` counts it beside the unit's own refusals.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Incident {
    /// The receive queue was full.
    ReceiveOverflow,
    /// The bus controller lost a frame.
    Overrun,
    /// The transmit queue was full.
    TransmitOverflow,
    /// The bus controller left the bus, or could not be put onto it.
    BusOff,
    /// The watchdog restarted the unit.
    Restart,
}

impl Incident {
    /// The cause that it is counted under.
    #[must_use]
    pub const fn cause(self) -> Cause {
        match self {
            Self::ReceiveOverflow => Cause::ReceiveOverflow,
            Self::Overrun => Cause::Overrun,
            Self::TransmitOverflow => Cause::TransmitOverflow,
            Self::BusOff => Cause::BusOff,
            Self::Restart => Cause::Restart,
        }
    }
}

impl Cause {
    /// Every cause, in the order of its number.
    pub const ALL: [Self; 35] = [
        Self::Length,
        Self::Checksum,
        Self::Repeated,
        Self::CounterGap,
        Self::CounterRange,
        Self::NotYetTrusted,
        Self::Range,
        Self::Torn,
        Self::Stale,
        Self::Future,
        Self::Duplicate,
        Self::OutOfOrder,
        Self::UnknownSlot,
        Self::StationConflict,
        Self::TooFar,
        Self::SyncSequence,
        Self::Jump,
        Self::Implausible,
        Self::Stuck,
        Self::ClockBackwards,
        Self::ReceiveOverflow,
        Self::Overrun,
        Self::TransmitOverflow,
        Self::BusOff,
        Self::Restart,
        Self::OffRoute,
        Self::Overlooked,
        Self::SyncLate,
        Self::SyncEarly,
        Self::PeerClock,
        Self::RangeDisagrees,
        Self::Unreachable,
        Self::RequestLost,
        Self::EgoStation,
        Self::DriverOverride,
    ];

    /// The name of the cause, as reports and the DBC spell it.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Length => "length",
            Self::Checksum => "checksum",
            Self::Repeated => "repeated",
            Self::CounterGap => "counter_gap",
            Self::CounterRange => "counter_range",
            Self::NotYetTrusted => "not_yet_trusted",
            Self::Range => "range",
            Self::Torn => "torn",
            Self::Stale => "stale",
            Self::Future => "future",
            Self::Duplicate => "duplicate",
            Self::OutOfOrder => "out_of_order",
            Self::UnknownSlot => "unknown_slot",
            Self::StationConflict => "station_conflict",
            Self::TooFar => "too_far",
            Self::SyncSequence => "sync_sequence",
            Self::Jump => "jump",
            Self::Implausible => "implausible",
            Self::Stuck => "stuck",
            Self::ClockBackwards => "clock_backwards",
            Self::ReceiveOverflow => "receive_overflow",
            Self::Overrun => "overrun",
            Self::TransmitOverflow => "transmit_overflow",
            Self::BusOff => "bus_off",
            Self::Restart => "restart",
            Self::OffRoute => "off_route",
            Self::Overlooked => "overlooked",
            Self::SyncLate => "sync_late",
            Self::SyncEarly => "sync_early",
            Self::PeerClock => "peer_clock",
            Self::RangeDisagrees => "range_disagrees",
            Self::Unreachable => "unreachable",
            Self::RequestLost => "request_lost",
            Self::EgoStation => "ego_station",
            Self::DriverOverride => "driver_override",
        }
    }
}

/// How often each cause has been met since start; each count stops at its maximum.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Health {
    counts: [u32; Cause::ALL.len()],
}

impl Default for Health {
    fn default() -> Self {
        Self::new()
    }
}

impl Health {
    /// Nothing refused yet.
    #[must_use]
    pub const fn new() -> Self {
        Self { counts: [0; Cause::ALL.len()] }
    }

    /// Counts one refusal.
    pub fn count(&mut self, cause: Cause) {
        self.add(cause, 1);
    }

    /// Counts so many at once.
    pub fn add(&mut self, cause: Cause, times: u32) {
        if let Some(count) = self.counts.get_mut(cause as usize) {
            *count = count.saturating_add(times);
        }
    }

    /// How often this cause was met.
    #[must_use]
    pub fn of(&self, cause: Cause) -> u32 {
        self.counts.get(cause as usize).copied().unwrap_or(0)
    }

    /// Refusals of all causes together, saturating.
    #[must_use]
    pub fn total(&self) -> u32 {
        self.counts.iter().fold(0, |sum, count| sum.saturating_add(*count))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_cause_has_the_number_of_its_place_and_a_name_of_its_own() {
        for (place, cause) in Cause::ALL.iter().enumerate() {
            assert_eq!(*cause as usize, place);
            assert_eq!(Cause::ALL.iter().filter(|other| other.name() == cause.name()).count(), 1);
        }
    }
}
