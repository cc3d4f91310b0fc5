//! What the range sensor sees of the vehicle ahead, and what that vehicle says of itself, as one track. Views and messages enter; the
//! motion of the vehicle by all of them leaves.
//!
//! A message is late. When it comes, views that were taken after its stamp are fused already. So the fusion keeps two things: the motion
//! at the newest message ([`Filter`]), and the views since then. A message is taken in at its stamp, and the views after it are taken in
//! anew. So each message and each view counts once, at the instant of its measurement, whatever the link does.
//!
//! What arrives is only kept. All of it is taken in once in a period ([`Fusion::update`]), so that a frame costs little. Of several
//! messages in one period the newest counts.
//!
//! The fusion keeps [`VIEWS`] views. When there are as many, the oldest goes into the base. A message that is older than the base is not
//! taken in: views were fused since then that say more.

pub mod filter;

pub use filter::{Filter, Measured, Motion};

use heapless::Deque;

use crate::held::Held;
use crate::parameters::{ACCURACY_FACTOR, UNPUBLISHED_ACCELERATION_ACCURACY};
use crate::peers::Sample;
use crate::time::{Duration, Instant};
use crate::units::{Acceleration, Distance, Position, Speed};

/// There is room for so many views: one for the next, and those of 0.3 s at 50 views a second.
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
    /// So many of the last views are not in `newest` yet.
    waiting: usize,
    /// The newest message, until it is taken in.
    heard: Held<Heard>,
    /// Whether something came since the last update.
    has_news: bool,
    /// When the newest view was taken.
    seen: Instant,
}

/// What a message says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Heard {
    measured: Measured,
    acceleration: Acceleration,
}

impl Fusion {
    /// Nothing is tracked.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            base: Held::Nothing,
            views: Deque::new(),
            newest: Held::Nothing,
            waiting: 0,
            heard: Held::Nothing,
            has_news: false,
            seen: Instant::ZERO,
        }
    }

    /// Whether a vehicle is tracked at an instant.
    #[must_use]
    pub fn is_tracking(&self, now: Instant) -> bool {
        self.base.as_ref().is_some() && now.since(self.seen) <= LASTS
    }

    /// The motion by all that was taken in, if a vehicle is tracked at an instant.
    #[must_use]
    pub fn motion(&self, now: Instant) -> Option<&Motion> {
        self.newest.as_ref().filter(|_| self.is_tracking(now)).map(Filter::motion)
    }

    /// Ends the track.
    pub fn clear(&mut self) {
        self.base.clear();
        self.newest.clear();
        self.views.clear();
        self.heard.clear();
        (self.waiting, self.has_news) = (0, false);
    }

    /// Moves the track, because the axis of the vehicle moved.
    pub fn shift(&mut self, way: Distance) {
        for filter in [&mut self.base, &mut self.newest] {
            if let Held::Value(filter) = filter {
                filter.shift(way);
            }
        }
        if let Held::Value(heard) = &mut self.heard {
            heard.measured.position = heard.measured.position.ahead(way);
        }
        self.views.iter_mut().for_each(|view| view.position = view.position.ahead(way));
    }

    /// Keeps a view. A track begins with the newest message, if that is fresh, or else with the view. A view from before the newest
    /// message or the newest view changes nothing.
    pub fn see(&mut self, view: &Measured, message: &Sample) {
        let tracked = self.newest.as_ref().filter(|_| self.is_tracking(view.at));
        let Some(tracked) = tracked else { return self.begin(view, message) };
        let heard = self.heard.as_ref().map(|heard| heard.measured.at);
        let last = self.views.back().map(|last| last.at);
        if [Some(tracked.motion().at), heard, last].into_iter().flatten().all(|before| before <= view.at) {
            self.keep(view);
        }
    }

    fn begin(&mut self, view: &Measured, message: &Sample) {
        self.clear();
        let age = view.at.since(message.at);
        let is_fresh = (Duration::ZERO..=FRESH).contains(&age);
        let base = if is_fresh {
            Filter::begin(&measured(message), message.acceleration, acceleration_deviation())
        } else {
            Filter::begin(view, Acceleration::ZERO, UNKNOWN_ACCELERATION)
        };
        self.base.set(base);
        self.newest.set(base);
        if is_fresh {
            self.keep(view);
        }
        (self.seen, self.has_news) = (view.at, true);
    }

    /// Keeps the newest message, until the next update. The track ends if no vehicle is tracked at `now`.
    pub fn hear(&mut self, now: Instant, message: &Sample) {
        if self.is_tracking(now) {
            self.heard.set(Heard { measured: measured(message), acceleration: message.acceleration });
            self.has_news = true;
        } else {
            self.clear();
        }
    }

    /// Takes in what came since the last update. Returns the motion, or `None` if nothing came.
    pub fn update(&mut self) -> Option<Motion> {
        let Self { base: Held::Value(base), newest: Held::Value(newest), views, waiting, heard, has_news, .. } = self
        else {
            return None;
        };
        if !core::mem::take(has_news) {
            return None;
        }
        if let Held::Value(heard) = core::mem::take(heard)
            && heard.measured.at >= base.motion().at
        {
            while let Some(view) = views.front().filter(|view| view.at <= heard.measured.at) {
                step(base, view);
                views.pop_front();
            }
            step(base, &heard.measured);
            base.correct_acceleration(heard.acceleration, acceleration_deviation());
            (*newest, *waiting) = (*base, views.len());
        }
        let known = views.len().saturating_sub(core::mem::take(waiting));
        views.iter().skip(known).for_each(|view| step(newest, view));
        let motion = *newest.motion();
        if views.is_full() {
            self.make_room();
        }
        Some(motion)
    }

    /// Keeps a view. It finds room, unless more views come in a period than the sensor's cycle says.
    fn keep(&mut self, view: &Measured) {
        if self.views.is_full() {
            self.make_room();
        }
        let _ = self.views.push_back(*view); // there is room
        self.waiting = self.waiting.saturating_add(1).min(VIEWS);
        (self.seen, self.has_news) = (view.at, true);
    }

    /// The oldest view goes into the base.
    fn make_room(&mut self) {
        if let (Some(oldest), Held::Value(base)) = (self.views.pop_front(), &mut self.base) {
            step(base, &oldest);
        }
    }
}

fn step(filter: &mut Filter, measured: &Measured) {
    filter.predict(measured.at);
    filter.correct(measured);
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
