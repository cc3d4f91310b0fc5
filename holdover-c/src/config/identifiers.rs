//! Messages that do not lie in the block: C's identifiers enter and the core's leave, and back.

use holdover::wire;
use holdover::wire::BaseId;
use holdover::wire::catalogue::{About, Content, Speaker};

use crate::status::Status;

/// In front of an identifier of 11 bits: `HOLDOVER_STANDARD | 0x123`.
pub const HOLDOVER_STANDARD: u32 = 0x4000_0000;
/// In front of an identifier of 29 bits: `HOLDOVER_EXTENDED | 0x0CFF0210`.
pub const HOLDOVER_EXTENDED: u32 = 0x8000_0000;

/// Messages that lie outside the block, by their names in the DBC. 0, as everything is that an initialiser does not name: in the
/// block.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Identifiers {
    /// `TimeSync`.
    pub time_sync: u32,
    /// `TimeFollowUp`.
    pub time_follow_up: u32,
    /// `MotionCommand`.
    pub motion_command: u32,
    /// `ActuatorState`.
    pub actuator_state: u32,
    /// `EgoMotionA`.
    pub ego_motion_a: u32,
    /// `EgoMotionB`.
    pub ego_motion_b: u32,
    /// `DriverRequest`.
    pub driver_request: u32,
    /// `EgoPosition`.
    pub ego_position: u32,
    /// `RangeSensor`.
    pub range_sensor: u32,
    /// `PeersUnserved`.
    pub peers_unserved: u32,
    /// `TargetEstimateA`.
    pub target_estimate_a: u32,
    /// `TargetEstimateB`.
    pub target_estimate_b: u32,
    /// `OwnMotionA`.
    pub own_motion_a: u32,
    /// `OwnMotionB`.
    pub own_motion_b: u32,
    /// `OwnHorizon`.
    pub own_horizon: u32,
    /// `OwnDrivingParameters`.
    pub own_driving_parameters: u32,
    /// `OwnPosition`.
    pub own_position: u32,
    /// `OwnRoute`.
    pub own_route: u32,
    /// `OwnPass`.
    pub own_pass: u32,
    /// `PeerPass`.
    pub peer_pass: u32,
    /// `Health`.
    pub health: u32,
    /// `Peer{slot}MotionA`.
    pub peer_motion_a: PeerIdentifiers,
    /// `Peer{slot}MotionB`.
    pub peer_motion_b: PeerIdentifiers,
    /// `Peer{slot}Horizon`.
    pub peer_horizon: PeerIdentifiers,
    /// `Peer{slot}DrivingParameters`.
    pub peer_driving_parameters: PeerIdentifiers,
    /// `Peer{slot}Position`.
    pub peer_position: PeerIdentifiers,
    /// `Peer{slot}Route`.
    pub peer_route: PeerIdentifiers,
}

/// The identifiers of one message of all peers.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PeerIdentifiers {
    /// Of slot 0; 0: in the block.
    pub first: u32,
    /// How far one slot's is from the next; there are 16.
    pub stride: u32,
}

/// Calls `$single!(field, content)` for each message without slots, and `$peer!(field, about)` for each of the peers'.
macro_rules! each {
    ($single:ident, $peer:ident) => {
        $single!(time_sync, Content::Sync);
        $single!(time_follow_up, Content::FollowUp);
        $single!(motion_command, Content::Command);
        $single!(actuator_state, Content::Actuators);
        $single!(ego_motion_a, Content::Said(Speaker::Ego, About::MotionA));
        $single!(ego_motion_b, Content::Said(Speaker::Ego, About::MotionB));
        $single!(driver_request, Content::DriverRequest);
        $single!(ego_position, Content::Said(Speaker::Ego, About::Geo));
        $single!(range_sensor, Content::Range);
        $single!(peers_unserved, Content::Unserved);
        $single!(target_estimate_a, Content::EstimateA);
        $single!(target_estimate_b, Content::EstimateB);
        $single!(own_motion_a, Content::Said(Speaker::Own, About::MotionA));
        $single!(own_motion_b, Content::Said(Speaker::Own, About::MotionB));
        $single!(own_horizon, Content::Said(Speaker::Own, About::Horizon));
        $single!(own_driving_parameters, Content::Said(Speaker::Own, About::DrivingParameters));
        $single!(own_position, Content::Said(Speaker::Own, About::Geo));
        $single!(own_route, Content::Said(Speaker::Own, About::Route));
        $single!(own_pass, Content::Pass(Speaker::Own));
        $single!(peer_pass, Content::Pass(Speaker::Peer));
        $single!(health, Content::Status);
        $peer!(peer_motion_a, About::MotionA);
        $peer!(peer_motion_b, About::MotionB);
        $peer!(peer_horizon, About::Horizon);
        $peer!(peer_driving_parameters, About::DrivingParameters);
        $peer!(peer_position, About::Geo);
        $peer!(peer_route, About::Route);
    };
}

impl Identifiers {
    /// The core's, with the rest in a block from this base on.
    ///
    /// # Errors
    /// [`Status::ConfigIdentifierRange`] for what is no identifier.
    pub(super) fn on(&self, base: BaseId) -> Result<wire::Identifiers, Status> {
        let mut placed = wire::Identifiers::block(base);
        macro_rules! single {
            ($field:ident, $content:expr) => {
                place(&mut placed, $content, self.$field)?;
            };
        }
        macro_rules! peer {
            ($field:ident, $about:expr) => {
                place_peers(&mut placed, $about, self.$field)?;
            };
        }
        each!(single, peer);
        Ok(placed)
    }
}

impl From<&wire::Identifiers> for Identifiers {
    fn from(typed: &wire::Identifiers) -> Self {
        let mut plain = Self::default();
        macro_rules! single {
            ($field:ident, $content:expr) => {
                plain.$field = typed.placement($content).map_or(0, |(id, _)| word(id));
            };
        }
        macro_rules! peer {
            ($field:ident, $about:expr) => {
                let placement = typed.placement(Content::Said(Speaker::Peer, $about));
                plain.$field = placement
                    .map_or(PeerIdentifiers::default(), |(id, stride)| PeerIdentifiers { first: word(id), stride });
            };
        }
        each!(single, peer);
        plain
    }
}

#[inline(never)] // or the stack would have room for a copy of all identifiers for each of them
fn place(placed: &mut wire::Identifiers, content: Content, word: u32) -> Result<(), Status> {
    if let Some(id) = identifier(word)? {
        *placed = placed.place(content, id).ok_or(Status::ConfigIdentifierRange)?;
    }
    Ok(())
}

#[inline(never)] // as above
fn place_peers(placed: &mut wire::Identifiers, about: About, plain: PeerIdentifiers) -> Result<(), Status> {
    if let Some(first) = identifier(plain.first)? {
        *placed = placed.place_peers(about, first, plain.stride);
    }
    Ok(())
}

/// `None`: in the block.
fn identifier(word: u32) -> Result<Option<wire::Identifier>, Status> {
    let number = word & !(HOLDOVER_STANDARD | HOLDOVER_EXTENDED);
    let id = match word & (HOLDOVER_STANDARD | HOLDOVER_EXTENDED) {
        HOLDOVER_STANDARD => u16::try_from(number).ok().and_then(wire::Identifier::standard),
        HOLDOVER_EXTENDED => wire::Identifier::extended(number),
        0 if number == 0 => return Ok(None),
        _ => None,
    };
    id.map(Some).ok_or(Status::ConfigIdentifierRange)
}

fn word(id: wire::Identifier) -> u32 {
    id.number() | if id.is_extended() { HOLDOVER_EXTENDED } else { HOLDOVER_STANDARD }
}

#[cfg(test)]
mod tests {
    use super::*;
    use holdover::wire::Identifier;
    use holdover::wire::catalogue::CATALOGUE;

    #[test]
    fn every_line_is_placed_as_the_core_has_it() {
        for (number, line) in (0x18FF_0000..).step_by(0x1000).zip(&CATALOGUE) {
            let (block, id) = (wire::Identifiers::DEFAULT, Identifier::extended(number).unwrap());
            let typed = match line.content {
                Content::Said(Speaker::Peer, about) => block.place_peers(about, id, 0x100),
                content => block.place(content, id).unwrap(),
            };
            let plain = Identifiers::from(&typed);
            assert_ne!(plain, Identifiers::default(), "{}", line.name);
            assert_eq!(plain.on(BaseId::DEFAULT), Ok(typed), "{}", line.name);
        }
    }

    #[test]
    fn a_number_without_a_kind_or_beyond_its_bits_is_no_identifier() {
        for word in
            [0x482, HOLDOVER_STANDARD | 0x800, HOLDOVER_EXTENDED | HOLDOVER_STANDARD, HOLDOVER_EXTENDED | 0x2000_0000]
        {
            let plain = Identifiers { health: word, ..Identifiers::default() };
            assert_eq!(plain.on(BaseId::DEFAULT), Err(Status::ConfigIdentifierRange), "{word:#x}");
        }
    }
}
