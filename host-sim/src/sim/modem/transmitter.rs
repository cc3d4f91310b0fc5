//! What a modem broadcasts: the unit's `Own*` messages enter one by one, and one message for the channel leaves.

use holdover::wire::Said;
use holdover::wire::driving_parameters::DrivingParameters;
use holdover::wire::fd::State;
use holdover::wire::horizon::Knots;
use holdover::wire::motion::Motion;
use holdover::wire::pass::Pass;
use holdover::wire::route::Route;

use super::REPEATED;

/// One broadcast of a vehicle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct V2xMessage {
    /// Its motion.
    pub motion: Motion,
    /// Its driving parameters; `None` if it does not publish them now.
    pub parameters: Option<DrivingParameters>,
    /// Its horizon from that motion on, if it computed one.
    pub horizon: Option<Knots>,
    /// Its place on its route, if it has one.
    pub route: Option<Route>,
    /// Its passes, if it said any.
    pub pass: Option<Pass>,
    /// Passes of others that it heard.
    pub repeated: [Option<Pass>; REPEATED],
}

/// The messages that the unit sent since the last broadcast.
#[derive(Clone, Debug, Default)]
pub struct Transmitter {
    motion: Option<Motion>,
    parameters: Option<DrivingParameters>,
    horizon: Option<Knots>,
    route: Option<Route>,
    pass: Option<Pass>,
}

impl Transmitter {
    /// Takes in one of the unit's own messages.
    pub fn take(&mut self, said: &Said) {
        match said {
            Said::Motion(motion) => self.motion = Some(*motion),
            Said::DrivingParameters(parameters) => self.parameters = Some(*parameters),
            Said::Horizon(knots) => self.horizon = Some(*knots),
            Said::Route(route) => self.route = Some(*route),
            Said::State(State { motion, parameters, horizon }) => {
                self.motion = Some(*motion);
                self.parameters = parameters.or(self.parameters);
                self.horizon = *horizon;
            }
            Said::Geo(_) => {}
        }
    }

    /// Takes in what the unit says of its passes.
    pub fn take_pass(&mut self, pass: &Pass) {
        self.pass = Some(*pass);
    }

    /// The message to broadcast now; `None` if the unit has not sent its motion. Driving parameters hold until the next
    /// ones. `repeated` are the passes of others to go with it.
    pub fn broadcast(&mut self, repeated: impl FnOnce() -> [Option<Pass>; REPEATED]) -> Option<V2xMessage> {
        let motion = self.motion.take()?;
        let horizon = self.horizon.take().filter(|knots| knots.tag == motion.tag);
        let route = self.route.take().filter(|route| route.stamp == motion.stamp);
        let (parameters, pass, repeated) = (self.parameters, self.pass.take(), repeated());
        Some(V2xMessage { motion, parameters, horizon, route, pass, repeated })
    }
}
