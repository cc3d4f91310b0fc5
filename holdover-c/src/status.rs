//! What every function returns: the core's causes enter, one code each leaves.
//!
//! Not negative: done. From -1 on: a mistake of the caller. From -32 on: the configuration. From -64 on: a refused frame,
//! `-64 - n` being the cause that has the number `n` on the bus (`Health.Cause`). Numbers in use never change.

use core::ffi::CStr;

use holdover::ConfigError;
use holdover::coordination::MapError;
use holdover::health::Cause;
use holdover::wire::IdentifierError;

/// What became of a call. Negative: it was refused, for the cause that the code names. A refused call changes nothing; a
/// refused frame changes its cause's count and the end-to-end state of its identifier.
#[repr(i32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// Done; of a frame: a message was taken in.
    Ok = 0,
    /// A good frame of a message whose other frames are still to come.
    Pending = 1,
    /// A frame that is not one of the catalogue's, or not for this unit.
    Foreign = 2,
    /// A pointer is null.
    Null = -1,
    /// An address is not a multiple of what its type needs.
    Misaligned = -2,
    /// The memory is smaller than `HOLDOVER_UNIT_SIZE`.
    TooSmall = -3,
    /// There is no unit in the memory.
    NotInitialised = -4,
    /// There is a unit in the memory already; `holdover_release` makes it free.
    AlreadyInitialised = -5,
    /// Something wrote past the end of the unit. It is not used any more; `holdover_init` makes a new one.
    Overrun = -6,
    /// Another call is in this unit: receive and tick have to take turns.
    Busy = -7,
    /// A frame has more than 8 bytes.
    FrameLength = -8,
    /// An identifier has more than 11 bits, or more than 29 if it is an extended one.
    FrameId = -9,
    /// The code is not that of a refusal (`HOLDOVER_REFUSED_...`).
    NoCause = -10,
    /// The number is not that of an incident (`HOLDOVER_INCIDENT_...`).
    NoIncident = -11,
    /// The memory for a map is smaller than `HOLDOVER_MAP_SIZE` says.
    MapTooSmall = -12,
    /// The unit's present map lies in this memory; a new way needs other memory.
    MapInUse = -13,
    /// A way has no crossing, or more than 65,535.
    MapCrossings = -16,
    /// An intersection is met twice, or the crossings are not in the order in which they are met.
    MapOrder = -17,
    /// A leg or an exit is numbered 8 or more.
    MapLeg = -18,
    /// Half a conflict area is negative, or longer than 5.115 m.
    MapArea = -19,
    /// A path has no segment.
    MapPath = -20,
    /// Between two conflict areas there is no room for the ego, which waits before each of them.
    MapClose = -21,
    /// Of two movements only one conflicts with the other, two of one leg conflict, or two to one exit do not.
    MapConflicts = -22,
    /// `base_id` is above 0x740.
    ConfigBaseId = -32,
    /// A switch is neither 0 nor 1.
    ConfigSwitch = -33,
    /// `period` is outside 1 to 100 ms.
    ConfigPeriod = -34,
    /// `step` is outside 1 ms to 1 s.
    ConfigStep = -35,
    /// `horizon` is shorter than two steps, longer than 25.5 s, or needs more steps than the capacity.
    ConfigHorizon = -36,
    /// `length` is outside 0 to 40.95 m.
    ConfigLength = -37,
    /// `lag` is outside 0 to 1.998 s.
    ConfigLag = -38,
    /// A limit is zero, negative or beyond the wire's range, or normal braking is harder than 6 m/s^2 or than emergency
    /// braking.
    ConfigLimits = -39,
    /// `time_gap` or `silent_time_gap` is outside 0.1 to 3.995 s.
    ConfigTimeGap = -40,
    /// `standstill` is outside 0 to 10.23 m.
    ConfigStandstill = -41,
    /// A gain is out of range.
    ConfigGain = -42,
    /// The semi-implicit step is unstable: `k dt^2 >= 4 + 2 k dt (t_g + gamma)`.
    ConfigUnstable = -43,
    /// A speed is outside 0 to 65.534 m/s.
    ConfigSpeed = -44,
    /// `a_max` of the free road is below 0.1 m/s^2 or above the limit on acceleration.
    ConfigFreeRoad = -45,
    /// A time of the link is zero where it must not be, or beyond 10 s for stamps; or the clock may be off by more than what
    /// is refused as future.
    ConfigLink = -46,
    /// The vehicle of eqs 1-3 has no mass or no brakes.
    ConfigBody = -47,
    /// A limit of the envelope is zero, or it brakes harder than emergency braking.
    ConfigEnvelope = -48,
    /// `catch_up` is outside 0 to 0.75, or no multiple of 0.05.
    ConfigCatchUp = -49,
    /// `transport` is CAN FD, which this library is built without.
    ConfigTransport = -50,
    /// An identifier that was placed has more than its 11 or 29 bits, with all its 16 slots, or no kind.
    ConfigIdentifierRange = -51,
    /// Two messages have the same identifier, all 16 slots counted. `holdover-sim dbc --place` names them.
    ConfigIdentifierShared = -52,
    /// `feed_forward_milli` is neither 0 nor 500, or is 500 with a step or a period below 7.813 ms.
    ConfigFeedForward = -53,
    /// A frame of ours that is not exactly 8 data bytes long, or a remote frame.
    RefusedLength = -64,
    /// The E2E checksum does not fit.
    RefusedChecksum = -65,
    /// The E2E counter repeats the last one: the same frame twice.
    RefusedRepeated = -66,
    /// More E2E counters are missing than the message tolerates.
    RefusedCounterGap = -67,
    /// The E2E counter is outside 0 to 14.
    RefusedCounterRange = -68,
    /// The E2E state machine has not seen enough good frames of this identifier yet.
    RefusedNotYetTrusted = -69,
    /// A field holds a value outside its range, or a reserved one.
    RefusedRange = -70,
    /// The parts of a message do not belong together, or one of them is missing.
    RefusedTorn = -71,
    /// The stamp is older than the unit uses.
    RefusedStale = -72,
    /// The stamp lies in the future by more than the clock's error.
    RefusedFuture = -73,
    /// A sample with this stamp is held already.
    RefusedDuplicate = -74,
    /// A sample that is newer than this one is held already, and this one no longer fits the history.
    RefusedOutOfOrder = -75,
    /// A slot beyond the unit's capacity.
    RefusedUnknownSlot = -76,
    /// Another station claims a slot whose station is still alive.
    RefusedStationConflict = -77,
    /// A peer too far away to have anything to do with the unit.
    RefusedTooFar = -78,
    /// A follow-up without its sync message, or out of sequence.
    RefusedSyncSequence = -79,
    /// A position that cannot be reached from the sample before it.
    RefusedJump = -80,
    /// A speed that does not fit the positions.
    RefusedImplausible = -81,
    /// A value that does not change though it has to.
    RefusedStuck = -82,
    /// A time before one that the unit was given already.
    RefusedClockBackwards = -83,
    /// Not a refusal, but counted like one: the platform's receive queue was full.
    RefusedReceiveOverflow = -84,
    /// Likewise: the bus controller lost a frame.
    RefusedOverrun = -85,
    /// Likewise: frames to be sent were lost before the bus.
    RefusedTransmitOverflow = -86,
    /// Likewise: the bus controller left the bus.
    RefusedBusOff = -87,
    /// Likewise: the watchdog restarted the unit.
    RefusedRestart = -88,
    /// A place on the globe that is not on the ego's path.
    RefusedOffRoute = -89,
    /// Not a refusal of a frame: a station went on not heeding the ego.
    RefusedOverlooked = -90,
    /// A synchronisation that came later than the unit's own clock allows.
    RefusedSyncLate = -91,
    /// A synchronisation that came earlier than the unit's own clock allows.
    RefusedSyncEarly = -92,
    /// Not a refusal of a frame: a peer's clock is off.
    RefusedPeerClock = -93,
    /// Not a refusal of a frame: what the range sensor sees began to contradict what is heard of the target.
    RefusedRangeDisagrees = -94,
    /// A horizon that its sender cannot drive.
    RefusedUnreachable = -95,
    /// Not a refusal of a frame: the driver's request stopped coming while the unit drove.
    RefusedRequestLost = -96,
    /// Not a refusal of a frame: an `EgoMotion` of another station than the unit's own.
    RefusedEgoStation = -97,
    /// Not a refusal of a frame: the driver took over by a pedal.
    RefusedDriverOverride = -98,
    /// Not a refusal of a frame: the actuators acknowledge no command in force.
    RefusedCommandUnheeded = -99,
    /// Not a refusal of a frame: no room for the passes of one more station.
    RefusedPassesFull = -100,
    /// Not a refusal of a frame: the platform did not tick the unit for a period.
    RefusedMissedPeriod = -101,
    /// Not a refusal of a frame: the platform's crystal did not start.
    RefusedClockFailed = -102,
}

impl From<ConfigError> for Status {
    fn from(error: ConfigError) -> Self {
        match error {
            ConfigError::Identifiers(IdentifierError::Range(_)) => Self::ConfigIdentifierRange,
            ConfigError::Identifiers(IdentifierError::Shared(..)) => Self::ConfigIdentifierShared,
            ConfigError::Period => Self::ConfigPeriod,
            ConfigError::Step => Self::ConfigStep,
            ConfigError::Horizon => Self::ConfigHorizon,
            ConfigError::Length => Self::ConfigLength,
            ConfigError::Lag => Self::ConfigLag,
            ConfigError::Limits => Self::ConfigLimits,
            ConfigError::TimeGap => Self::ConfigTimeGap,
            ConfigError::Standstill => Self::ConfigStandstill,
            ConfigError::Gain => Self::ConfigGain,
            ConfigError::FeedForward => Self::ConfigFeedForward,
            ConfigError::Unstable => Self::ConfigUnstable,
            ConfigError::Speed => Self::ConfigSpeed,
            ConfigError::CatchUp => Self::ConfigCatchUp,
            ConfigError::FreeRoad => Self::ConfigFreeRoad,
            ConfigError::Link => Self::ConfigLink,
            ConfigError::Body => Self::ConfigBody,
            ConfigError::Envelope => Self::ConfigEnvelope,
            ConfigError::Transport => Self::ConfigTransport,
        }
    }
}

impl From<MapError> for Status {
    fn from(error: MapError) -> Self {
        match error {
            MapError::Crossings => Self::MapCrossings,
            MapError::Order => Self::MapOrder,
            MapError::Leg => Self::MapLeg,
            MapError::Area => Self::MapArea,
            MapError::Path => Self::MapPath,
            MapError::Close => Self::MapClose,
            MapError::Conflicts => Self::MapConflicts,
        }
    }
}

impl From<Cause> for Status {
    fn from(cause: Cause) -> Self {
        match cause {
            Cause::Length => Self::RefusedLength,
            Cause::Checksum => Self::RefusedChecksum,
            Cause::Repeated => Self::RefusedRepeated,
            Cause::CounterGap => Self::RefusedCounterGap,
            Cause::CounterRange => Self::RefusedCounterRange,
            Cause::NotYetTrusted => Self::RefusedNotYetTrusted,
            Cause::Range => Self::RefusedRange,
            Cause::Torn => Self::RefusedTorn,
            Cause::Stale => Self::RefusedStale,
            Cause::Future => Self::RefusedFuture,
            Cause::Duplicate => Self::RefusedDuplicate,
            Cause::OutOfOrder => Self::RefusedOutOfOrder,
            Cause::UnknownSlot => Self::RefusedUnknownSlot,
            Cause::StationConflict => Self::RefusedStationConflict,
            Cause::TooFar => Self::RefusedTooFar,
            Cause::SyncSequence => Self::RefusedSyncSequence,
            Cause::Jump => Self::RefusedJump,
            Cause::Implausible => Self::RefusedImplausible,
            Cause::Stuck => Self::RefusedStuck,
            Cause::ClockBackwards => Self::RefusedClockBackwards,
            Cause::ReceiveOverflow => Self::RefusedReceiveOverflow,
            Cause::Overrun => Self::RefusedOverrun,
            Cause::TransmitOverflow => Self::RefusedTransmitOverflow,
            Cause::BusOff => Self::RefusedBusOff,
            Cause::Restart => Self::RefusedRestart,
            Cause::OffRoute => Self::RefusedOffRoute,
            Cause::Overlooked => Self::RefusedOverlooked,
            Cause::SyncLate => Self::RefusedSyncLate,
            Cause::SyncEarly => Self::RefusedSyncEarly,
            Cause::PeerClock => Self::RefusedPeerClock,
            Cause::RangeDisagrees => Self::RefusedRangeDisagrees,
            Cause::Unreachable => Self::RefusedUnreachable,
            Cause::RequestLost => Self::RefusedRequestLost,
            Cause::EgoStation => Self::RefusedEgoStation,
            Cause::DriverOverride => Self::RefusedDriverOverride,
            Cause::CommandUnheeded => Self::RefusedCommandUnheeded,
            Cause::PassesFull => Self::RefusedPassesFull,
            Cause::MissedPeriod => Self::RefusedMissedPeriod,
            Cause::ClockFailed => Self::RefusedClockFailed,
        }
    }
}

/// Every code with its name.
const NAMES: &[(Status, &CStr)] = &[
    (Status::Ok, c"ok"),
    (Status::Pending, c"pending"),
    (Status::Foreign, c"foreign"),
    (Status::Null, c"a pointer is null"),
    (Status::Misaligned, c"an address is not a multiple of what its type needs"),
    (Status::TooSmall, c"the memory is smaller than HOLDOVER_UNIT_SIZE"),
    (Status::NotInitialised, c"there is no unit in the memory"),
    (Status::AlreadyInitialised, c"there is a unit in the memory already"),
    (Status::Overrun, c"something wrote past the end of the unit"),
    (Status::Busy, c"another call is in the unit"),
    (Status::FrameLength, c"a frame has more than 8 bytes"),
    (Status::FrameId, c"an identifier has more bits than its kind"),
    (Status::NoCause, c"the code is not that of a refusal"),
    (Status::NoIncident, c"the number is not that of an incident"),
    (Status::MapTooSmall, c"the memory for the map is smaller than HOLDOVER_MAP_SIZE"),
    (Status::MapInUse, c"the unit's present map lies in this memory"),
    (Status::MapCrossings, c"map: no crossing, or more than 65,535"),
    (Status::MapOrder, c"map: an intersection is met twice, or out of order"),
    (Status::MapLeg, c"map: a leg or an exit is numbered 8 or more"),
    (Status::MapArea, c"map: half a conflict area is negative, or longer than 5.115 m"),
    (Status::MapPath, c"map: a path has no segment"),
    (Status::MapClose, c"map: no room for the ego between two conflict areas"),
    (Status::MapConflicts, c"map: only one of two movements conflicts with the other, or they share a leg, or they join and do not conflict"),
    (Status::ConfigBaseId, c"configuration: base_id is above 0x740"),
    (Status::ConfigSwitch, c"configuration: a switch is neither 0 nor 1"),
    (Status::ConfigPeriod, c"configuration: period"),
    (Status::ConfigStep, c"configuration: step"),
    (Status::ConfigHorizon, c"configuration: horizon"),
    (Status::ConfigLength, c"configuration: length"),
    (Status::ConfigLag, c"configuration: lag"),
    (Status::ConfigLimits, c"configuration: limits"),
    (Status::ConfigTimeGap, c"configuration: time_gap"),
    (Status::ConfigStandstill, c"configuration: standstill"),
    (Status::ConfigGain, c"configuration: gain"),
    (Status::ConfigUnstable, c"configuration: unstable"),
    (Status::ConfigSpeed, c"configuration: speed"),
    (Status::ConfigFreeRoad, c"configuration: free_road"),
    (Status::ConfigLink, c"configuration: link"),
    (Status::ConfigBody, c"configuration: body"),
    (Status::ConfigEnvelope, c"configuration: envelope"),
    (Status::ConfigCatchUp, c"configuration: catch_up"),
    (Status::ConfigTransport, c"configuration: transport"),
    (Status::ConfigIdentifierRange, c"configuration: an identifier has more bits than its kind, or no kind"),
    (Status::ConfigIdentifierShared, c"configuration: two messages have the same identifier"),
    (Status::ConfigFeedForward, c"configuration: feed_forward"),
    (Status::RefusedLength, c"refused: length"),
    (Status::RefusedChecksum, c"refused: checksum"),
    (Status::RefusedRepeated, c"refused: repeated"),
    (Status::RefusedCounterGap, c"refused: counter_gap"),
    (Status::RefusedCounterRange, c"refused: counter_range"),
    (Status::RefusedNotYetTrusted, c"refused: not_yet_trusted"),
    (Status::RefusedRange, c"refused: range"),
    (Status::RefusedTorn, c"refused: torn"),
    (Status::RefusedStale, c"refused: stale"),
    (Status::RefusedFuture, c"refused: future"),
    (Status::RefusedDuplicate, c"refused: duplicate"),
    (Status::RefusedOutOfOrder, c"refused: out_of_order"),
    (Status::RefusedUnknownSlot, c"refused: unknown_slot"),
    (Status::RefusedStationConflict, c"refused: station_conflict"),
    (Status::RefusedTooFar, c"refused: too_far"),
    (Status::RefusedSyncSequence, c"refused: sync_sequence"),
    (Status::RefusedJump, c"refused: jump"),
    (Status::RefusedImplausible, c"refused: implausible"),
    (Status::RefusedStuck, c"refused: stuck"),
    (Status::RefusedClockBackwards, c"refused: clock_backwards"),
    (Status::RefusedReceiveOverflow, c"refused: receive_overflow"),
    (Status::RefusedOverrun, c"refused: overrun"),
    (Status::RefusedTransmitOverflow, c"refused: transmit_overflow"),
    (Status::RefusedBusOff, c"refused: bus_off"),
    (Status::RefusedRestart, c"refused: restart"),
    (Status::RefusedOffRoute, c"refused: off_route"),
    (Status::RefusedOverlooked, c"counted: overlooked"),
    (Status::RefusedSyncLate, c"refused: sync_late"),
    (Status::RefusedSyncEarly, c"refused: sync_early"),
    (Status::RefusedPeerClock, c"counted: peer_clock"),
    (Status::RefusedRangeDisagrees, c"counted: range_disagrees"),
    (Status::RefusedUnreachable, c"counted: unreachable"),
    (Status::RefusedRequestLost, c"counted: request_lost"),
    (Status::RefusedEgoStation, c"counted: ego_station"),
    (Status::RefusedDriverOverride, c"counted: driver_override"),
    (Status::RefusedCommandUnheeded, c"counted: command_unheeded"),
    (Status::RefusedPassesFull, c"counted: passes_full"),
    (Status::RefusedMissedPeriod, c"counted: missed_period"),
    (Status::RefusedClockFailed, c"counted: clock_failed"),
];

/// The name of a code in ASCII; `"unknown"` if there is no such code.
pub fn name(code: i32) -> &'static CStr {
    NAMES.iter().find(|(status, _)| *status as i32 == code).map_or(c"unknown", |(_, name)| name)
}

/// The cause that a code stands for.
///
/// # Errors
/// [`Status::NoCause`] if it is not the code of a refused frame.
pub fn cause_of(code: i32) -> Result<Cause, Status> {
    Cause::ALL.into_iter().find(|cause| Status::from(*cause) as i32 == code).ok_or(Status::NoCause)
}
