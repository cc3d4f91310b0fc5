//! The unit's CAN messages: frames enter and typed messages leave ([`Receiver`]), and the other way round ([`Sender`]). The bus
//! is classic CAN, or with the feature `fd` CAN FD ([`Transport`]).
//!
//! Contract of every decoder here: any bytes in, a value or a named [`Cause`](crate::health::Cause) out; no panic, no allocation.
//! Every message has a named field table, and `decode` and `encode` are inverse on every representable value.

pub mod actuators;
mod assembly;
mod base_id;
pub mod bits;
pub mod catalogue;
pub mod command;
pub mod curve;
pub mod dbc;
pub mod driver_request;
pub mod driving_parameters;
pub mod e2e;
pub mod estimate;
#[cfg(feature = "fd")]
pub mod fd;
pub mod field;
pub mod frame;
pub mod geo;
pub mod horizon;
mod identifier;
mod identifiers;
mod index;
pub mod load;
mod meaning;
mod message_name;
pub mod motion;
pub mod movement;
pub mod pass;
mod predecessor;
pub mod quantity;
pub mod range_sensor;
pub mod receiver;
pub mod route;
pub mod sender;
pub mod status;
pub mod sync;
mod tie;
pub mod unserved;

pub use base_id::BaseId;
pub use frame::{Data, Frame};
pub use identifier::Identifier;
pub use identifiers::{IdentifierError, Identifiers};
pub use message_name::MessageName;
pub use movement::Movement;
pub use receiver::{Received, Receiver, Role};
pub use sender::{Sender, Unsent};

/// An 8-bit hash of a station's identity: enough to notice that a slot has changed hands, not to identify anybody.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct StationHash(pub u8);

/// Whom a vehicle says it follows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Predecessor {
    /// It did not say.
    #[default]
    Unknown,
    /// Nobody: it leads its string (index 0 of the paper).
    None,
    /// That station.
    Station(StationHash),
}

/// A vehicle's slot on the bus; the modem assigns it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Slot(pub u8);

/// What a vehicle says of itself over V2X; it stands on the bus as `Peer*` (heard by the modem, per slot), as `Own*`
/// (for the modem to broadcast), and its motion and position also as `Ego*` (from the vehicle's own sensors).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[allow(clippy::large_enum_variant)] // a message lives for one call; boxing needs an allocator
#[repr(u32)] // what follows the tag is on words, and is copied by words
pub enum Said {
    /// Where it is and how it moves.
    Motion(motion::Motion),
    /// How it will drive: the parameters of its law.
    DrivingParameters(driving_parameters::DrivingParameters),
    /// Its own horizon in a few knots.
    Horizon(horizon::Knots),
    /// Where it is on the globe.
    Geo(geo::GeoPosition),
    /// Where it is on its route.
    Route(route::Route),
    /// The first three in one, as CAN FD has them. Over classic CAN each is sent by itself, in this order: motion, driving parameters,
    /// horizon.
    #[cfg(feature = "fd")]
    State(fd::State),
}

/// Which frames the bus carries.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Transport {
    /// Classic CAN: 8 bytes, E2E Profile 1.
    #[default]
    Classic,
    /// CAN FD: up to 64 bytes, E2E Profile 5. Needs the feature `fd`.
    Fd,
}

/// A whole message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[allow(clippy::large_enum_variant)] // as above
#[repr(u32)] // as above
pub enum Message {
    /// First step of the time synchronisation.
    Sync(sync::Sync),
    /// Second step: when the first was really sent.
    FollowUp(sync::FollowUp),
    /// From the vehicle itself (only motion and position occur).
    Ego(Said),
    /// What the driver or the planner wants.
    DriverRequest(driver_request::DriverRequest),
    /// What the actuators make of the commands, and what the driver does with the pedals.
    Actuators(actuators::ActuatorState),
    /// An on-board sensor's view of the vehicle ahead.
    Range(range_sensor::RangeSample),
    /// Whom the modem hears and has no slot for.
    Unserved(unserved::Unserved),
    /// Heard by the modem.
    Peer(Slot, Said),
    /// The passes of another vehicle, heard by the modem. It need not have a slot.
    PeerPass(pass::Pass),
    /// For the modem to broadcast.
    Own(Said),
    /// The own passes, for the modem to broadcast.
    OwnPass(pass::Pass),
    /// The unit's command to the actuators.
    Command(command::Command),
    /// The unit's estimate of its target.
    Estimate(estimate::TargetEstimate),
    /// The unit's state and its refusals.
    Status(status::Status),
}
