//! What the range sensor sees of the vehicle ahead, and what that vehicle says of itself, as one track. Views and messages enter; the motion
//! of the vehicle by all of them leaves.
//!
//! A message is late. When it comes, views that were taken after its stamp are fused already. So the fusion keeps two things: the motion
//! at the newest message ([`Filter`]), and the views since then. A message is taken in at its stamp, and the views after it are taken in
//! anew. So each message and each view counts once, at the instant of its measurement, whatever the link does.
//!
//! The fusion keeps [`VIEWS`] views. When there are more, the oldest goes into the base. A message that is older than the base is not
//! taken in: views were fused since then that say more.

pub mod filter;

pub use filter::{Filter, Measured, Motion};

use heapless::Deque;

use crate::held::Held;
use crate::parameters::{ACCURACY_FACTOR, UNPUBLISHED_ACCELERATION_ACCURACY};
use crate::peers::Sample;
use crate::time::{Duration, Instant};
use crate::units::{Acceleration, Distance, Position, Speed};

/// So many views are kept: those of 0.32 s at 50 views a second.
pub const VIEWS: usize = 16;

/// A track without a view for this long ends.
pub const LASTS: Duration = Duration::from_millis(500);

/// A message that is older than this when a track begins says nothing of the acceleration.
const FRESH: Duration = Duration::from_millis(1_000);

/// Standard deviation of an acceleration of which nothing is known.
const UNKNOWN_ACCELERATION: Acceleration = Acceleration::from_mm_per_s2(2_000);

/// The largest error has so many standard deviations: an accuracy has two, because 95 % of the errors are below it.
const DEVIATIONS: i32 = 2 * ACCURACY_FACTOR as i32;

/// The track of the vehicle ahead.
#[derive(Clone, Debug, Default)]
pub struct Fusion {
    base: Held<Filter>,
    views: Deque<Measured, VIEWS>,
    newest: Held<Filter>,
    /// When the newest view was taken.
    seen: Instant,
}

impl Fusion {
    /// Nothing is tracked.
    #[must_use]
    pub const fn new() -> Self {
        Self { base: Held::Nothing, views: Deque::new(), newest: Held::Nothing, seen: Instant::ZERO }
    }

    /// Whether a vehicle is tracked at an instant.
    #[must_use]
    pub fn is_tracking(&self, now: Instant) -> bool {
        self.base.as_ref().is_some() && now.since(self.seen) <= LASTS
    }

    /// Ends the track.
    pub fn clear(&mut self) {
        self.base.clear();
        self.newest.clear();
        self.views.clear();
    }

    /// Moves the track, because the axis of the vehicle moved.
    pub fn shift(&mut self, way: Distance) {
        for filter in [&mut self.base, &mut self.newest] {
            if let Held::Value(filter) = filter {
                filter.shift(way);
            }
        }
        self.views.iter_mut().for_each(|view| view.position = view.position.ahead(way));
    }

    /// Takes in a view. A track begins with the newest message, if that is fresh, or else with the view. A view from before the
    /// newest message or the newest view changes nothing. Returns the motion.
    pub fn see(&mut self, view: &Measured, message: &Sample) -> Motion {
        let tracked = self.newest.get().filter(|_| self.is_tracking(view.at));
        let Some(mut filter) = tracked else {
            self.clear();
            let age = view.at.since(message.at);
            let is_fresh = (Duration::ZERO..=FRESH).contains(&age);
            let mut filter = if is_fresh {
                of_message(message)
            } else {
                Filter::begin(view, Acceleration::ZERO, UNKNOWN_ACCELERATION)
            };
            self.base.set(filter);
            if is_fresh {
                self.keep(view);
                step(&mut filter, view);
            }
            self.newest.set(filter);
            self.seen = view.at;
            return *filter.motion();
        };
        if view.at >= filter.motion().at {
            self.seen = view.at;
            self.keep(view);
            step(&mut filter, view);
            self.newest.set(filter);
        }
        *filter.motion()
    }

    /// Takes in the newest message. Returns the motion, or `None` if no vehicle is tracked at `now`.
    pub fn hear(&mut self, now: Instant, message: &Sample) -> Option<Motion> {
        let mut base = self.base.get()?;
        if !self.is_tracking(now) {
            self.clear();
            return None;
        }
        if message.at >= base.motion().at {
            while let Some(view) = self.views.front().filter(|view| view.at <= message.at) {
                step(&mut base, view);
                self.views.pop_front();
            }
            let heard = measured(message);
            step(&mut base, &heard);
            base.correct_acceleration(message.acceleration, acceleration_deviation());
            self.base.set(base);
            let mut newest = base;
            self.views.iter().for_each(|view| step(&mut newest, view));
            self.newest.set(newest);
        }
        self.newest.as_ref().map(|newest| *newest.motion())
    }

    /// Keeps a view. If there is no room, the oldest one goes into the base.
    fn keep(&mut self, view: &Measured) {
        if self.views.is_full()
            && let (Some(oldest), Held::Value(base)) = (self.views.pop_front(), &mut self.base)
        {
            step(base, &oldest);
        }
        let _ = self.views.push_back(*view); // there is room
    }
}

fn step(filter: &mut Filter, measured: &Measured) {
    filter.predict(measured.at);
    filter.correct(measured);
}

fn of_message(message: &Sample) -> Filter {
    Filter::begin(&measured(message), message.acceleration, acceleration_deviation())
}

/// What a message measures.
fn measured(message: &Sample) -> Measured {
    Measured::within(message.at, message.position, message.speed, message.position_error(), message.speed_error())
}

const fn acceleration_deviation() -> Acceleration {
    Acceleration::from_bits(UNPUBLISHED_ACCELERATION_ACCURACY.to_bits() / 2)
}

impl Measured {
    /// With the largest errors of position and speed.
    #[must_use]
    pub const fn within(
        at: Instant,
        position: Position,
        speed: Speed,
        position_error: Distance,
        speed_error: Speed,
    ) -> Self {
        Self {
            at,
            position,
            speed,
            position_error: Distance::from_bits(position_error.to_bits() / DEVIATIONS),
            speed_error: Speed::from_bits(speed_error.to_bits() / DEVIATIONS),
        }
    }
}
