//! The vehicle's body: the commanded engine force or brake torque enters, the true motion leaves, in float64.
//!
//! Eq. 1 in full, `m a = F - R T_br - c_v (v + w)|v + w| - c_f v - d_m - m g sin(grade)`, with the head wind `w`.
//! Engine and brakes each follow their command within their limits and with the actuators' lag: `Ḟ = (F_cmd - F)/T`,
//! solved exactly while the command holds. The resistance and the limit of the engine's power are evaluated at the
//! middle of steps of a millisecond. That leaves an error of the third order: micrometres over a minute.
//!
//! A vehicle never rolls back. At standstill its brakes are released to the torque that holds it, as an automatic hold
//! does. So a start does not wait for a brake pressure to fall that was not needed.

mod machine;

pub use machine::Machine;

use holdover::wire::command::Effort;

/// The longest step. A vehicle comes to a stand between two instants, and this step finds that instant within half a
/// millisecond.
const PIECE_S: f64 = 1e-3;

/// The true motion of one vehicle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plant {
    /// Front bumper, along the lane.
    pub position_m: f64,
    /// Speed; never negative.
    pub speed_mps: f64,
    /// Acceleration that the actuators have reached.
    pub acceleration_mps2: f64,
    machine: Machine,
    engine_n: f64,
    brake_nm: f64,
}

impl Plant {
    /// A vehicle at constant speed: engine and brakes give the force that this takes, within their limits.
    #[must_use]
    pub fn cruising(machine: Machine, position_m: f64, speed_mps: f64) -> Self {
        let needed_n = if speed_mps > 0.0 { machine.resistance_n(speed_mps) } else { 0.0 };
        let engine_n = needed_n.clamp(0.0, machine.engine_limit_n(speed_mps));
        let brake_nm = (-needed_n / machine.ratio_per_m).clamp(0.0, machine.brake_limit_nm);
        Self { position_m, speed_mps, acceleration_mps2: 0.0, machine, engine_n, brake_nm }
    }

    /// Moves the vehicle on by `time_s` under a constant command.
    pub fn drive(&mut self, effort: Effort, time_s: f64) {
        let pieces = (time_s / PIECE_S).ceil().max(1.0);
        let slip = Slip::over(time_s / pieces, self.machine.lag_s);
        for _ in 0..pieces as u64 {
            self.drive_piece(effort, &slip);
        }
    }

    fn drive_piece(&mut self, effort: Effort, slip: &Slip) {
        let Machine { mass_kg, ratio_per_m, brake_limit_nm, .. } = self.machine;
        let h = slip.time_s;
        let middle_mps = (self.speed_mps + 0.5 * h * self.acceleration_mps2).max(0.0);
        let (engine_n, brake_nm) = match effort {
            Effort::Force(newtons) => (f64::from(newtons).min(self.machine.engine_limit_n(middle_mps)), 0.0),
            Effort::BrakeTorque(newton_metres) => (0.0, f64::from(newton_metres).min(brake_limit_nm)),
        };
        let wanted = (engine_n - ratio_per_m * brake_nm - self.machine.resistance_n(middle_mps)) / mass_kg;
        let behind = (self.engine_n - engine_n - ratio_per_m * (self.brake_nm - brake_nm)) / mass_kg;
        let speed_mps = self.speed_mps + wanted * h + behind * slip.gained_s;
        if speed_mps >= 0.0 {
            self.position_m += self.speed_mps * h + 0.5 * wanted * h * h + behind * slip.way_s2;
        } else {
            // The vehicle stops within this step. The distance that it still covers is its mean speed over that part.
            let part_s = h * self.speed_mps / (self.speed_mps - speed_mps);
            self.position_m += 0.5 * self.speed_mps * part_s;
        }
        self.speed_mps = speed_mps.max(0.0);
        self.engine_n = engine_n + (self.engine_n - engine_n) * slip.kept;
        self.brake_nm = brake_nm + (self.brake_nm - brake_nm) * slip.kept;
        self.accelerate();
    }

    /// Applies eq. 1 in the present state, and the hold at standstill.
    fn accelerate(&mut self) {
        let Machine { mass_kg, ratio_per_m, .. } = self.machine;
        let net_n = self.engine_n - ratio_per_m * self.brake_nm - self.machine.resistance_n(self.speed_mps);
        self.acceleration_mps2 = net_n / mass_kg;
        if self.speed_mps == 0.0 && net_n < 0.0 {
            self.brake_nm = (self.brake_nm + net_n / ratio_per_m).max(0.0);
            self.acceleration_mps2 = 0.0;
        }
    }
}

/// The response of a first-order lag to a command step that holds over a time.
struct Slip {
    time_s: f64,
    /// Fraction of the command step that is still to come at the end.
    kept: f64,
    /// Integral of that fraction over the time, and the integral of that integral.
    gained_s: f64,
    way_s2: f64,
}

impl Slip {
    fn over(time_s: f64, lag_s: f64) -> Self {
        if lag_s <= 0.0 {
            return Self { time_s, kept: 0.0, gained_s: 0.0, way_s2: 0.0 };
        }
        let kept = (-time_s / lag_s).exp();
        let gained_s = lag_s * (1.0 - kept);
        Self { time_s, kept, gained_s, way_s2: lag_s * (time_s - gained_s) }
    }
}

#[cfg(test)]
mod tests;
