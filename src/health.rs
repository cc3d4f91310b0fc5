//! What the unit refuses, and what the platform around it lost, counted by cause: a refusal or an incident enters, a
//! saturating count per cause leaves.

/// A cause a line: its number, its name as reports and the DBC spell it, and its text, which is the documentation here and stands in
/// the DBC.
macro_rules! causes {
    ($($(#[$more:meta])* $variant:ident = $number:literal, $name:literal, $text:literal;)*) => {
        /// Why a frame or a message was refused. A refusal changes nothing but its count, the end-to-end state of that
        /// identifier, and the evidence of misbehaviour.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[cfg_attr(feature = "defmt", derive(defmt::Format))]
        #[repr(u8)]
        pub enum Cause {
            $(#[doc = $text] $(#[$more])* $variant = $number,)*
        }

        impl Cause {
            /// Every cause, in the order of its number.
            pub const ALL: [Self; [$($number),*].len()] = [$(Self::$variant),*];

            /// The name of the cause, as reports and the DBC spell it.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $name,)*
                }
            }

            /// What the cause means, as the DBC says it.
            #[must_use]
            pub const fn meaning(self) -> &'static str {
                match self {
                    $(Self::$variant => $text,)*
                }
            }
        }
    };
}

causes! {
    Length = 0, "length", "A frame with another number of bytes than its message has, or a remote frame.";
    Checksum = 1, "checksum", "The E2E checksum does not fit.";
    Repeated = 2, "repeated", "The E2E counter repeats the last one: the same frame twice.";
    CounterGap = 3, "counter_gap", "More E2E counters are missing than the message tolerates.";
    CounterRange = 4, "counter_range", "The E2E counter is outside its range.";
    NotYetTrusted = 5, "not_yet_trusted", "The E2E state machine has not seen enough good frames of this identifier yet.";
    Range = 6, "range", "A signal holds a value outside its range, or a reserved one.";
    Torn = 7, "torn", "The parts of a message do not belong together, or one is missing; or RangeSensor came before the first EgoMotion.";
    Stale = 8, "stale", "The stamp is older than the unit uses.";
    Future = 9, "future", "The stamp lies in the future by more than the clock's error.";
    Duplicate = 10, "duplicate", "A sample with this stamp is held already.";
    OutOfOrder = 11, "out_of_order", "A newer sample is held already, and this one does not fit the history.";
    UnknownSlot = 12, "unknown_slot", "A slot beyond the unit's capacity.";
    StationConflict = 13, "station_conflict", "Another station claims a slot whose station is still alive.";
    TooFar = 14, "too_far", "A peer too far away to have anything to do with the unit.";
    SyncSequence = 15, "sync_sequence", "A follow-up without its sync message, or out of sequence.";
    Jump = 16, "jump", "A position that cannot be reached from the sample before it.";
    Implausible = 17, "implausible", "A speed that does not fit the positions.";
    Stuck = 18, "stuck", "A value that does not change though it has to.";
    ClockBackwards = 19, "clock_backwards", "No refusal: the unit was given a time before one that it was given already.";
    ///
    /// ([`Incident::ReceiveOverflow`])
    ReceiveOverflow = 20, "receive_overflow", "No refusal: frames that the receive queue had no room for.";
    ///
    /// ([`Incident::Overrun`])
    Overrun = 21, "overrun", "No refusal: frames that the bus controller lost before they were taken.";
    ///
    /// They waited too long on the platform, or it had no room for them ([`Incident::TransmitOverflow`]); or the unit's own answer had
    /// none.
    TransmitOverflow = 22, "transmit_overflow", "No refusal: frames of the unit that are lost before the bus.";
    ///
    /// ([`Incident::BusOff`])
    BusOff = 23, "bus_off", "No refusal: the bus controller left the bus after too many errors, or could not be put onto it.";
    ///
    /// ([`Incident::Restart`])
    Restart = 24, "restart", "No refusal: the unit was restarted by its watchdog.";
    OffRoute = 25, "off_route", "A place on the globe that is not on the ego's path.";
    Overlooked = 26, "overlooked", "No refusal: a station that arrived later did not heed the ego, which then gave way to it.";
    ///
    /// See [`Clock`](crate::clock::Clock).
    SyncLate = 27, "sync_late", "A synchronisation that came later than the unit's own clock allows.";
    ///
    /// See [`Clock`](crate::clock::Clock).
    SyncEarly = 28, "sync_early", "A synchronisation that came earlier than the unit's own clock allows.";
    PeerClock = 29, "peer_clock", "No refusal: a peer's clock that is ahead of GNSS time, or perhaps behind it; once for every 5 s.";
    ///
    /// The unit drives by what it sees then.
    RangeDisagrees = 30, "range_disagrees", "No refusal: a contradiction of the range sensor and what is certain of the target begins.";
    Unreachable = 31, "unreachable", "A horizon that its sender cannot drive, by all that is certain of it: it is not used.";
    RequestLost = 32, "request_lost", "No refusal: DriverRequest stopped coming while the unit drove, which hands back; once for each time.";
    EgoStation = 33, "ego_station", "No refusal: an EgoMotion of another station than the unit is configured for.";
    DriverOverride = 34, "driver_override", "No refusal: the driver took over by a pedal while the unit was asked to drive; once for each time.";
    CommandUnheeded = 35, "command_unheeded", "No refusal: for 200 ms ActuatorState has acknowledged no command of the last 50 ms while the unit drove; once for each time.";
    PassesFull = 36, "passes_full", "No refusal: a station comes to the next intersection, and the unit knows so many that there is no room for it. No pass is firm then.";
    ///
    /// ([`Incident::MissedPeriod`])
    MissedPeriod = 37, "missed_period", "No refusal: periods in which the platform did not tick the unit; all of a gap are counted.";
    ///
    /// ([`Incident::ClockFailed`])
    ClockFailed = 38, "clock_failed", "No refusal: the platform's crystal did not start, and a less accurate clock is in its place.";
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
    /// A frame was lost before the bus: the transmit queue was full, or it waited until it was too old or a newer one was there.
    TransmitOverflow,
    /// The bus controller left the bus, or could not be put onto it.
    BusOff,
    /// The watchdog restarted the unit.
    Restart,
    /// A period has passed without a tick; one for each, so that the count has the length of a gap.
    MissedPeriod,
    /// The crystal did not start, and a less accurate clock is in its place.
    ClockFailed,
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
            Self::MissedPeriod => Cause::MissedPeriod,
            Self::ClockFailed => Cause::ClockFailed,
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
            assert!(cause.meaning().ends_with('.') && !cause.meaning().contains('"'), "{}", cause.name());
        }
    }
}
