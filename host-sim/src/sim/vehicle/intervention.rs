//! What is done to a vehicle from outside while it drives: a person drives it, its range sensor is covered, its unit changes places with
//! one whose envelope is engaged or not, or the vehicle drives by the newest message as it stands.

use holdover::ConfigError;
use holdover::config::Envelope;
use holdover::coordination::{Crossing, Itinerary, MapError, PeerApproach, standstill_on_way};
use holdover::time::Instant;
use holdover::units::Position;
use holdover::wire::Predecessor;
use holdover::wire::command::ModeCode;
use holdover::wire::motion::WirePosition;

use super::{Unit, Vehicle};
use crate::bus::Frame;
use crate::sim::modem::V2xMessage;
use crate::sim::plain::{Sample, desired, limited};
use crate::sim::quantities::metres;
use crate::sim::time::{EPOCH_US, gnss};

/// What is done to a vehicle.
#[derive(Clone, Debug, Default)]
pub(super) struct Intervention {
    hands: Hands,
    /// Whether what the person asks for was said from outside, and holds until it is let go.
    is_told: bool,
    /// Whether the driver's request is to be sent before its time.
    asks: bool,
    is_blind: bool,
    /// The unit with the other envelope. It hears what the unit hears, and nobody hears it.
    twin: Option<Unit>,
    /// Whether the vehicle drives without the estimate.
    is_plain: bool,
    /// The newest motion of the vehicle ahead that came over the air.
    ahead: Option<Sample>,
    demand_mps2: f64,
}

/// Whose hands the vehicle is in.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum Hands {
    /// The unit's.
    #[default]
    Units,
    /// A person's, who asks for this acceleration.
    Persons(f64),
    /// The person has let go. Until the unit drives, what was asked for last stays in force.
    Given(f64),
}

impl Intervention {
    /// The acceleration that is not the unit's, if there is one.
    pub fn hands(&self) -> Option<f64> {
        match self.hands {
            Hands::Units => None,
            Hands::Persons(wanted_mps2) | Hands::Given(wanted_mps2) => Some(wanted_mps2),
        }
    }

    /// Whether the range sensor is not covered.
    pub fn sees(&self) -> bool {
        !self.is_blind
    }

    /// Whether the driver's request has changed since this was asked for the last time.
    pub fn asks_anew(&mut self) -> bool {
        std::mem::take(&mut self.asks)
    }

    /// The twin gets the map.
    pub fn set_out(&mut self, itinerary: &'static Itinerary) -> Result<(), MapError> {
        self.twin.as_mut().map_or(Ok(()), |twin| twin.set_out(itinerary))
    }

    /// Whose hands it is in when the unit drives.
    fn hand_back(&mut self, mode: ModeCode) {
        if matches!(self.hands, Hands::Given(_)) && mode != ModeCode::Standby {
            self.hands = Hands::Units;
        }
    }

    /// The twin hears a frame.
    pub fn receive(&mut self, at: Instant, frame: &Frame) {
        if let Some(twin) = &mut self.twin {
            let _ = twin.receive(at, frame); // as the unit, it counts refusals
        }
    }

    /// The twin ticks.
    pub fn tick(&mut self, now: Instant) {
        if let Some(twin) = &mut self.twin {
            let _ = twin.tick(now);
        }
    }
}

impl Vehicle {
    /// A person drives from now on, and asks for this acceleration. The driver's request says so at once, and a unit that does not drive
    /// tells nobody how it will.
    pub fn take_over(&mut self, wanted_mps2: f64) {
        self.intervention.is_told = true;
        self.intervention.asks |= self.engaged;
        self.intervention.hands = Hands::Persons(wanted_mps2);
        self.engage(false);
    }

    /// A person who always drives asks for this acceleration, unless another one was said from outside.
    pub fn drive_by_hand(&mut self, wanted_mps2: f64) {
        if !self.intervention.is_told {
            self.intervention.hands = Hands::Persons(wanted_mps2);
        }
    }

    /// The person lets go, and the unit takes over; or the person who always drives, drives on as before.
    pub fn let_go(&mut self) {
        self.intervention.is_told = false;
        if !self.request.engaged {
            return;
        }
        if let Hands::Persons(wanted_mps2) = self.intervention.hands {
            self.intervention.hands = Hands::Given(wanted_mps2);
            self.intervention.asks = true;
            self.engage(true);
        }
    }

    /// Whether a person drives.
    #[must_use]
    pub fn is_driven(&self) -> bool {
        matches!(self.intervention.hands, Hands::Persons(_))
    }

    /// Covers the range sensor, or uncovers it.
    pub fn cover_sensor(&mut self, is_blind: bool) {
        self.intervention.is_blind = is_blind;
    }

    /// Whether its range sensor is at work, if it has one.
    #[must_use]
    pub fn sees(&self) -> bool {
        self.intervention.sees()
    }

    /// Fits a second unit with this envelope, which is ready to change places with the first one.
    ///
    /// # Errors
    /// An error of the configuration.
    pub fn fit_twin(&mut self, envelope: Option<Envelope>) -> Result<(), ConfigError> {
        let config = holdover::Config { envelope, ..*self.unit.config() };
        self.intervention.twin = Some(Unit::new(&config)?);
        Ok(())
    }

    /// Lets the unit drive whose envelope is engaged, or is not.
    pub fn switch_envelope(&mut self, engaged: bool) {
        if let Some(twin) = self.intervention.twin.as_mut().filter(|_| self.unit.config().envelope.is_some() != engaged)
        {
            std::mem::swap(&mut self.unit, twin);
        }
    }

    /// Lets the vehicle drive by the newest message as it stands, or by its unit.
    pub fn drive_plainly(&mut self, is_plain: bool) {
        self.intervention.is_plain = is_plain;
        self.intervention.demand_mps2 = self.command_mps2;
    }

    /// Whether the vehicle drives without the estimate.
    #[must_use]
    pub fn is_plain(&self) -> bool {
        self.intervention.is_plain
    }

    /// After the unit's tick: the hands that have let go are gone when the unit drives, and without the estimate the newest message is
    /// what there is of the vehicle ahead, which is so long.
    pub fn intervene(&mut self, ahead_length_m: f64, period_s: f64) {
        self.intervention.hand_back(self.mode);
        if !self.intervention.is_plain || !self.engaged {
            return;
        }
        let plant = (self.plant.position_m, self.plant.speed_mps);
        let last_mps2 = self.intervention.demand_mps2;
        let config = self.unit.config();
        let desired_mps2 = desired(config, ahead_length_m, plant, self.intervention.ahead);
        let wanted_mps2 = limited(config, desired_mps2, last_mps2, period_s);
        self.intervention.demand_mps2 = wanted_mps2;
        self.override_with(wanted_mps2);
    }

    /// The same on a way through intersections. The vehicle ahead is the one that the unit follows, where its newest message puts it on the
    /// own way. The law keeps the distances that the unit keeps. Without a vehicle ahead the unit drives.
    pub fn intervene_on_way(&mut self, period_s: f64) {
        self.intervention.hand_back(self.mode);
        let last_mps2 = std::mem::replace(&mut self.intervention.demand_mps2, self.command_mps2);
        let Some((newest, length_m)) = self.newest_ahead().filter(|_| self.intervention.is_plain && self.engaged)
        else {
            return;
        };
        let mut config = *self.unit.config();
        let coordination = self.unit.coordination();
        let target = coordination.choice().target.and_then(|slot| coordination.approach(slot.into()));
        let conflict = |crossing: &Crossing, target: &PeerApproach| {
            target.crossing == coordination.next() && crossing.intersection.conflict(crossing.movement, target.movement)
        };
        let crossing = coordination.crossing().zip(target).filter(|(crossing, target)| conflict(crossing, target));
        let crossing = crossing.map(|(crossing, _)| crossing);
        config.law.standstill = standstill_on_way(config.law.standstill, crossing, config.range_sensor);
        let desired_mps2 = desired(&config, length_m, (self.plant.position_m, self.plant.speed_mps), Some(newest));
        let wanted_mps2 = limited(&config, desired_mps2, last_mps2, period_s);
        self.intervention.demand_mps2 = wanted_mps2;
        self.override_with(wanted_mps2);
    }

    /// The newest message of the vehicle that the unit follows, as the unit places it on the own axis, and the length of that vehicle.
    #[must_use]
    pub fn newest_ahead(&self) -> Option<(Sample, f64)> {
        let track = self.unit.peers().get(self.unit.coordination().choice().target?.into())?;
        let newest = track.newest()?;
        let sample = Sample {
            at_s: self.time_of(newest.at),
            position_m: self.near(newest.position),
            speed_mps: newest.speed.get().to_num(),
            demand_mps2: newest.demand.get().to_num(),
        };
        Some((sample, track.length().get().to_num()))
    }

    /// A position of the unit's axis, near the vehicle.
    #[must_use]
    pub fn near(&self, position: Position) -> f64 {
        WirePosition::from_position(position).nearest_to(metres(self.plant.position_m)).get().to_num()
    }

    /// Notes the motion in a message, if the vehicle follows its sender.
    pub(super) fn note_ahead(&mut self, at_s: f64, message: &V2xMessage) {
        let motion = &message.motion;
        if self.request.predecessor != Predecessor::Station(motion.station) {
            return;
        }
        let stamp = motion.stamp.unwrap_near(gnss(at_s)).as_micros();
        let sample = Sample {
            at_s: (stamp as i64 - EPOCH_US as i64) as f64 * 1e-6,
            position_m: motion.position.nearest_to(metres(self.plant.position_m)).get().to_num(),
            speed_mps: motion.speed.get().to_num(),
            demand_mps2: motion.demand.get().to_num(),
        };
        if self.intervention.ahead.is_none_or(|last| last.at_s < sample.at_s) {
            self.intervention.ahead = Some(sample);
        }
    }
}
