//! Bodies in motion, in float64: a command or an acceleration enters, the exact motion leaves.

/// A vehicle whose actuators lag: `ȧ = (u - a)/T`, solved exactly while the command holds; never backwards.
#[derive(Clone, Copy, Debug)]
pub struct Plant {
    pub position: f64,
    pub speed: f64,
    pub acceleration: f64,
    pub lag: f64,
}

impl Plant {
    /// Moves on under a command that holds; in pieces of a millisecond where it may come to a stand between two instants.
    pub fn drive(&mut self, u: f64, time: f64) {
        let pieces = if self.speed > 1.0 { 1.0 } else { (time / 1e-3).round().max(1.0) };
        for _ in 0..pieces as u64 {
            self.piece(u, time / pieces);
        }
    }

    fn piece(&mut self, u: f64, h: f64) {
        let behind = self.acceleration - u;
        let (kept, gained) = if self.lag > 0.0 {
            let kept = (-h / self.lag).exp();
            (kept, self.lag * (1.0 - kept))
        } else {
            (0.0, 0.0)
        };
        let speed = self.speed + u * h + behind * gained;
        if speed >= 0.0 {
            self.position += self.speed * h + 0.5 * u * h * h + behind * self.lag * (h - gained);
            self.speed = speed;
            self.acceleration = u + behind * kept;
        } else {
            let part = h * self.speed / (self.speed - speed);
            self.position += 0.5 * self.speed * part;
            self.speed = 0.0;
            self.acceleration = (u + behind * kept).max(0.0);
        }
    }
}

/// A vehicle that changes its acceleration at once, within 0 and a top speed.
#[derive(Clone, Copy, Debug)]
pub struct Body {
    pub position: f64,
    pub speed: f64,
}

/// The top speed that the wire can say.
pub const TOP: f64 = 65.534;

impl Body {
    /// Moves on under an acceleration that holds until it rests or is at its top speed.
    #[must_use]
    pub fn after(self, a: f64, time: f64) -> Self {
        let end = if a < 0.0 { 0.0 } else { TOP };
        let changing = if a == 0.0 { time } else { ((end - self.speed) / a).clamp(0.0, time) };
        let speed = if a == 0.0 { self.speed } else { (self.speed + a * changing).clamp(0.0, TOP) };
        let way = 0.5 * (self.speed + speed) * changing + speed * (time - changing);
        Self { position: self.position + way, speed }
    }
}
