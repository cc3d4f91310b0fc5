//! A vehicle's body on the road: a demanded acceleration enters, its motion leaves. All values are float64.

/// A vehicle whose acceleration follows its demand with a lag: `ȧ = (u - a)/T`. It never drives backwards.
#[derive(Clone, Copy, Debug)]
pub struct Body {
    /// Front bumper, m.
    pub position: f64,
    /// m/s, not negative.
    pub speed: f64,
    /// m/s².
    pub acceleration: f64,
    /// T, s; 0 for no lag.
    pub lag: f64,
    /// Hardest braking that the vehicle, or its road, is capable of, m/s².
    pub braking: f64,
    /// Hardest acceleration, m/s².
    pub pulling: f64,
    /// Highest speed, m/s.
    pub top: f64,
}

impl Body {
    /// Moves on for a time under a constant demand.
    pub fn drive(&mut self, demand: f64, time: f64) {
        let demand = demand.clamp(-self.braking, self.pulling);
        let kept = if self.lag > 0.0 { (-time / self.lag).exp() } else { 0.0 };
        let behind = self.acceleration.clamp(-self.braking, self.pulling) - demand;
        let gained = self.lag * (1.0 - kept);
        let speed = self.speed + demand * time + behind * gained;
        if speed <= 0.0 {
            self.rest(demand, behind, time);
            self.acceleration = (demand + behind * kept).max(0.0);
        } else if speed > self.top && speed > self.speed {
            // At its top speed the engine has no reserve: the vehicle reaches that speed and keeps it.
            let rising = time * ((self.top - self.speed) / (speed - self.speed)).clamp(0.0, 1.0);
            self.position +=
                0.5 * (self.speed + self.top.max(self.speed)) * rising + self.top.max(self.speed) * (time - rising);
            (self.speed, self.acceleration) = (self.top.max(self.speed), 0.0);
        } else {
            self.position += self.speed * time + 0.5 * demand * time * time + behind * self.lag * (time - gained);
            (self.speed, self.acceleration) = (speed, demand + behind * kept);
        }
    }

    /// Stops within the time. The instant is found by bisection.
    fn rest(&mut self, demand: f64, behind: f64, time: f64) {
        let gained = |t: f64| if self.lag > 0.0 { self.lag * (1.0 - (-t / self.lag).exp()) } else { 0.0 };
        let (mut low, mut high) = (0.0, time);
        if self.speed > 0.0 {
            for _ in 0..40 {
                let t = 0.5 * (low + high);
                if self.speed + demand * t + behind * gained(t) > 0.0 { low = t } else { high = t }
            }
            self.position += self.speed * low + 0.5 * demand * low * low + behind * self.lag * (low - gained(low));
        }
        self.speed = 0.0;
    }

    /// The body after a further time.
    pub fn after(&self, demand: f64, time: f64) -> Self {
        let mut later = *self;
        later.drive(demand, time);
        later
    }
}

/// A gap behind a vehicle that brakes with `ahead_brakes` at its hardest. From this gap a vehicle with this lag, which
/// is able to brake with `braking`, stops in time, even if it learns of it only after `blind` seconds. It is not the
/// smallest such gap.
pub fn safe_gap(speed: f64, ahead: f64, ahead_brakes: f64, braking: f64, lag: f64, blind: f64) -> f64 {
    // If the vehicle ahead brakes less hard than the ego, the two are nearest before they stop. So its braking counts
    // as the ego's own.
    let reaction = lag + 0.02 + braking / (2.0 * 25.0) + 0.3 + blind;
    let stops = speed * reaction + speed * speed / (2.0 * braking);
    let surely = (ahead - ahead_brakes * blind).max(0.0);
    (stops - surely * surely / (2.0 * ahead_brakes.max(braking))).max(0.0) + 3.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn body(lag: f64) -> Body {
        Body { position: 0.0, speed: 20.0, acceleration: 0.0, lag, braking: 8.0, pulling: 3.0, top: 30.0 }
    }

    #[test]
    fn braking_at_once_takes_the_textbook_way() {
        let mut body = body(0.0);
        (0..400).for_each(|_| body.drive(-12.0, 0.01));
        assert!((body.position - 25.0).abs() < 1e-6 && body.speed == 0.0);
    }

    #[test]
    fn a_lag_costs_its_time_at_the_speed() {
        let mut body = body(0.3);
        (0..600).for_each(|_| body.drive(-8.0, 0.01));
        assert!((body.position - 25.0 - 6.0).abs() < 0.4, "{}", body.position);
    }

    #[test]
    fn steps_and_one_step_agree() {
        let (mut fine, mut coarse) = (body(0.3), body(0.3));
        (0..10).for_each(|_| fine.drive(-4.0, 0.001));
        coarse.drive(-4.0, 0.01);
        assert!((fine.position - coarse.position).abs() < 1e-9 && (fine.speed - coarse.speed).abs() < 1e-9);
    }
}
