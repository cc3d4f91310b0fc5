//! Misbehaving peers. A sample, and what is certain of its sender, enter; what is certain after the sample, or the cause for which it is
//! refused, leaves.
//!
//! What is certain is the [`Bound`], carried on from all believed samples. A sample that contradicts it cannot come from a vehicle that
//! keeps to its limits, whichever of the two is wrong. Either its position is out of reach ([`Cause::Jump`], or [`Cause::Stuck`] if it
//! repeats the last sample), or its speed is ([`Cause::Implausible`]). A speed that does not fit the positions over many samples is
//! implausible too, as soon as the two have drifted apart by more than the published accuracies (`Course`). This lasts for half a second
//! at most, because the course begins anew after that. An acceleration beyond the limits of every road vehicle, and beyond the published
//! limits of this one, is implausible by itself.
//!
//! Recovery: when [`RECOVERY_SAMPLES`] samples in a row contradict the bound but not one another, they are believed, and the track starts
//! anew from them. A sample only counts if its stamp is at least half a period after the last one that counted. A copy of a refused
//! sample is a duplicate. So a burst of copies is no evidence, and the next honest sample is believed at once. A station whose false
//! samples take longer than that to show would be believed again and again. So each recovery doubles the number of samples that the next
//! one takes, up to 2⁵ times; [`FORGIVEN_AFTER`] samples in a row that agree halve it again.
//!
//! Forged samples in the name of a station are believed after five samples over four half periods without an honest one between them.
//! This keeps the station's honest samples out for ten samples, 1 s at 10 Hz. If it is repeated before it is forgiven, it keeps them out
//! for 160 samples at most, 16 s.

use super::Sample;
use super::drift::Course;
use super::limits::Limits;
use super::sender_clock::Off;
use crate::config::Link;
use crate::health::Cause;
use crate::model::bound::{AccelerationRange, Bound, Uncertainty};
use crate::parameters::{
    FORGIVEN_AFTER, POSITION_ROUNDING, RECOVERY_SAMPLES, SPEED_ROUNDING, UNKNOWN_DELAY,
    UNPUBLISHED_ACCELERATION_ACCURACY,
};
use crate::time::{Duration, Instant, Stamp};
use crate::units::Distance;

/// What is certain of a peer, and the evidence against that.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Certainty {
    bound: Option<Bound>,
    suspects: Option<Suspects>,
    /// The interval in which the peer is, by all its positions and speeds.
    course: Option<Course>,
    /// Recoveries that are not yet forgiven.
    strikes: u8,
    /// Samples in a row that agreed.
    agreed: u8,
}

/// Samples in a row that contradict the bound but not one another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
struct Suspects {
    /// What they agree on.
    bound: Bound,
    /// How many of them have counted.
    count: u8,
    /// The instant of the last of them that counted.
    counted: Instant,
    /// The stamp of the last of them.
    stamp: Stamp,
}

/// After this many recoveries further ones do not raise the number any more: then it is 160 samples.
const MOST_STRIKES: u8 = 5;

/// In which way a sample is believed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Belief {
    /// The sample is older than one that is held. It fills the history, and says nothing of what is certain now.
    Late,
    /// The sample agrees with what was certain.
    Agrees,
    /// The sample is the last of enough samples that agree with one another. What was certain is given up.
    Recovered,
}

/// What a sample is judged by.
#[derive(Clone, Copy, Debug)]
pub struct Grounds {
    /// What is certain of its sender by this sample alone.
    pub around: Bound,
    /// What is uncertain about it.
    pub uncertainty: Uncertainty,
    /// How hard its sender can change its speed.
    pub reach: AccelerationRange,
    /// The hardest limits of its sender since the sample before.
    pub from_last: AccelerationRange,
    /// The period of its messages.
    pub period: Duration,
}

/// The judgement of a sample, before the sample changes anything.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Judgement {
    /// What is certain after the sample, with the evidence. If the sample is refused, only the evidence differs.
    pub certainty: Certainty,
    /// Whether it is believed.
    pub verdict: Result<Belief, Cause>,
}

impl Certainty {
    /// Nothing is certain.
    pub const NONE: Self = Self { bound: None, suspects: None, course: None, strikes: 0, agreed: 0 };

    /// The bound, if there is one.
    #[must_use]
    pub const fn bound(&self) -> Option<&Bound> {
        self.bound.as_ref()
    }

    /// Moves all of it ahead by this way, because the vehicle's axis moved.
    pub fn shift(&mut self, way: Distance) {
        self.bound = self.bound.map(|bound| bound.shifted(way));
        self.suspects = self.suspects.map(|held| Suspects { bound: held.bound.shifted(way), ..held });
        self.course = self.course.map(|course| course.shifted(way));
    }

    /// Carries all of it on to the instant from which on the present limits hold.
    pub fn settle(&mut self, limits: &Limits) {
        self.bound = self.bound.map(|bound| limits.settled(&bound));
        self.suspects = self.suspects.map(|held| Suspects { bound: limits.settled(&held.bound), ..held });
    }

    /// Starts anew: only this bound is certain.
    pub fn restart(&mut self, bound: Bound) {
        (self.bound, self.suspects, self.course) = (Some(bound), None, None);
    }

    /// Narrows the bound by another bound that is certain. Returns whether the two agree; if not, nothing is changed.
    pub fn narrow(&mut self, other: &Bound, reach: &AccelerationRange) -> bool {
        let Some(bound) = self.bound.as_ref() else { return true };
        match bound.and(other, reach) {
            Some(both) => {
                self.bound = Some(both);
                true
            }
            None => false,
        }
    }

    /// Judges a sample that is newer than all before; `last` is the sample before it. It is believed, or refused as `Implausible`, `Jump`
    /// or `Stuck`, or as `Duplicate` of a refused sample.
    #[must_use]
    pub fn judge(&self, sample: &Sample, last: Option<&Sample>, grounds: &Grounds) -> Judgement {
        let mut judgement = Judgement { certainty: *self, verdict: Ok(Belief::Late) };
        judgement.verdict = judgement.certainty.weigh(sample, last, grounds);
        judgement
    }

    fn weigh(&mut self, sample: &Sample, last: Option<&Sample>, grounds: &Grounds) -> Result<Belief, Cause> {
        let Grounds { around, uncertainty, reach, from_last, period } = grounds;
        if self.suspects.is_some_and(|suspects| suspects.stamp == sample.stamp) {
            return Err(Cause::Duplicate);
        }
        let hardest = AccelerationRange::WORST.braking.max(reach.braking).max(reach.acceleration);
        if sample.acceleration.magnitude() > hardest.plus(UNPUBLISHED_ACCELERATION_ACCURACY) {
            return Err(Cause::Implausible);
        }
        let Some(bound) = &self.bound else {
            self.bound = Some(*around);
            self.course = Course::after(None, None, sample, uncertainty, reach).unwrap_or_default();
            return Ok(Belief::Agrees);
        };
        if let Some(both) = bound.and(around, reach) {
            // The bound agrees, so that a sample that does not fit the course is no evidence for another place.
            self.course = Course::after(self.course.as_ref(), last, sample, uncertainty, from_last)?;
            self.agree(both);
            return Ok(Belief::Agrees);
        }
        self.agreed = 0;
        let refusal = name(bound, around, sample, last, reach);
        let first = Suspects { bound: *around, count: 1, counted: sample.at, stamp: sample.stamp };
        let suspects = self.suspects.and_then(|held| held.joined_by(&first, reach, *period)).unwrap_or(first);
        if suspects.count >= RECOVERY_SAMPLES.wrapping_shl(self.strikes.into()) {
            let strikes = self.strikes.saturating_add(1).min(MOST_STRIKES);
            *self = Self { bound: Some(suspects.bound), strikes, ..Self::NONE };
            return Ok(Belief::Recovered);
        }
        self.suspects = Some(suspects);
        Err(refusal)
    }

    fn agree(&mut self, both: Bound) {
        (self.bound, self.suspects) = (Some(both), None);
        self.agreed = self.agreed.saturating_add(1);
        if self.agreed >= FORGIVEN_AFTER {
            (self.strikes, self.agreed) = (self.strikes.saturating_sub(1), 0);
        }
    }
}

impl Suspects {
    /// With one more sample, if it agrees with these. It counts if it is not part of the same burst.
    fn joined_by(self, one: &Self, reach: &AccelerationRange, period: Duration) -> Option<Self> {
        let bound = self.bound.and(&one.bound, reach)?;
        if one.counted.since(self.counted).times(2) < period {
            return Some(Self { bound, stamp: one.stamp, ..self });
        }
        Some(Self { bound, count: self.count.saturating_add(1), ..*one })
    }
}

// The largest number of samples, 160, fits the count.
const _: () = assert!((RECOVERY_SAMPLES as u32) << MOST_STRIKES <= u8::MAX as u32);

/// The cause for which a contradicting sample is refused.
fn name(bound: &Bound, around: &Bound, sample: &Sample, last: Option<&Sample>, reach: &AccelerationRange) -> Cause {
    let carried = bound.after(around.at(), reach);
    let out_of_reach =
        around.highest_position() < carried.lowest_position() || around.lowest_position() > carried.highest_position();
    let same_again = last.is_some_and(|last| last.position == sample.position && last.speed == sample.speed);
    match (out_of_reach, same_again) {
        (true, true) => Cause::Stuck,
        (true, false) => Cause::Jump,
        (false, _) => Cause::Implausible,
    }
}

/// What is uncertain about a sample of a sender whose clock is off by this.
#[must_use]
pub fn uncertainty(sample: &Sample, is_synchronised: bool, link: &Link, off: Off) -> Uncertainty {
    let (earlier, later) = if is_synchronised {
        // However the clocks are off, the sample is from before its reception.
        let (earlier, later) = off.uncertainty();
        (link.clock_error.plus(earlier), link.clock_error.plus(later).min(sample.received.since(sample.at)))
    } else {
        // Its age was taken to be the assumed delay, and may be anything up to the largest delay.
        (UNKNOWN_DELAY.minus(link.assumed_delay).max(Duration::ZERO), link.assumed_delay)
    };
    Uncertainty {
        position: sample.position_error().plus(POSITION_ROUNDING),
        speed: sample.speed_error().plus(SPEED_ROUNDING),
        earlier,
        later,
    }
}
