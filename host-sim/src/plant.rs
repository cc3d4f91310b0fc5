//! The vehicle's body: the commanded acceleration enters, the true motion leaves, in float64.
//!
//! So far an actuator lag, `ȧ = (u - a)/T`, solved exactly while the command holds, and a speed that never falls below 0.

/// The true motion of one vehicle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plant {
    /// Front bumper along the lane.
    pub position_m: f64,
    /// Never negative.
    pub speed_mps: f64,
    /// Acceleration reached.
    pub acceleration_mps2: f64,
    /// Time constant of the actuators; 0 for none.
    pub lag_s: f64,
}

impl Plant {
    /// Moves on by `time_s` under a command that holds.
    pub fn drive(&mut self, command_mps2: f64, time_s: f64) {
        // A vehicle comes to a stand between two instants: pieces of a millisecond put that within half a millisecond.
        let pieces = (time_s / 1e-3).ceil().max(1.0);
        for _ in 0..pieces as u64 {
            self.drive_piece(command_mps2, time_s / pieces);
        }
    }

    fn drive_piece(&mut self, u: f64, h: f64) {
        let behind = self.acceleration_mps2 - u;
        let (kept, gained, way) = if self.lag_s > 0.0 {
            let kept = (-h / self.lag_s).exp();
            let gained = self.lag_s * (1.0 - kept);
            (kept, gained, self.lag_s * (h - gained))
        } else {
            (0.0, 0.0, 0.0)
        };
        let speed = self.speed_mps + u * h + behind * gained;
        if speed >= 0.0 {
            self.position_m += self.speed_mps * h + 0.5 * u * h * h + behind * way;
            self.speed_mps = speed;
            self.acceleration_mps2 = u + behind * kept;
        } else {
            // Comes to a stand within this piece; what way it still makes is its mean speed over the part.
            let part = h * self.speed_mps / (self.speed_mps - speed);
            self.position_m += 0.5 * self.speed_mps * part;
            self.speed_mps = 0.0;
            self.acceleration_mps2 = (u + behind * kept).max(0.0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_make_the_same_motion_as_the_whole() {
        let mut plant = Plant { position_m: 3.0, speed_mps: 10.0, acceleration_mps2: 1.0, lag_s: 0.3 };
        plant.drive(-2.0, 0.7);
        // Closed form over the whole time.
        let (u, b, lag, h): (f64, f64, f64, f64) = (-2.0, 3.0, 0.3, 0.7);
        let kept = (-h / lag).exp();
        let speed = 10.0 + u * h + b * lag * (1.0 - kept);
        let position = 3.0 + 10.0 * h + 0.5 * u * h * h + b * lag * (h - lag * (1.0 - kept));
        assert!((plant.speed_mps - speed).abs() < 1e-12);
        assert!((plant.position_m - position).abs() < 1e-12);
        assert!((plant.acceleration_mps2 - (u + b * kept)).abs() < 1e-12);
    }

    #[test]
    fn a_braking_vehicle_stops_after_v_squared_over_2_a_and_stays() {
        let mut plant = Plant { position_m: 0.0, speed_mps: 10.0, acceleration_mps2: -5.0, lag_s: 0.0 };
        for _ in 0..400 {
            plant.drive(-5.0, 0.01);
        }
        assert!((plant.position_m - 10.0).abs() < 1e-3, "{}", plant.position_m);
        assert_eq!(plant.speed_mps, 0.0);
    }
}
