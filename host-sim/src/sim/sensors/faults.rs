//! The faults of a range sensor: the time of each view enters; what the sensor shows then leaves.
//!
//! A sensor that shows nothing keeps assumption A12: a view is of the nearest vehicle on the own path, or of nothing. A
//! ghost is of no vehicle, and breaks it.

use rand_chacha::ChaCha8Rng;

use crate::input::scenario::Faults;
use crate::streams::{Purpose, stream, unit};

/// A ghost is shown for this time, in seconds: five views, long enough for the unit to act on it.
pub const GHOST_S: f64 = 0.1;

/// What a sensor shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shows {
    /// The nearest vehicle, if there is one.
    What,
    /// No vehicle.
    Nothing,
    /// It does not see, and does not say anything.
    Blind,
    /// A vehicle that stands at this share of the free way ahead, where none is.
    Ghost(f64),
}

/// A sensor with faults.
#[derive(Clone, Debug)]
pub struct Faulty {
    faults: Faults,
    generator: ChaCha8Rng,
    /// Time of the last view.
    last_s: Option<f64>,
    /// The present dropout lasts until then.
    blind_until_s: f64,
    /// The present ghost lasts until then, and stands at this share of the free way.
    ghost: (f64, f64),
}

/// Whether the vehicle with this index has a range sensor, if this share of the vehicles has one. A vehicle that has
/// one at a share has one at every larger share.
#[must_use]
pub fn is_fitted(share: f64, seed: u64, index: u32) -> bool {
    unit(&mut stream(seed, Purpose::RangeFaults(index))) < share
}

impl Faulty {
    /// The sensor of the vehicle with this index.
    #[must_use]
    pub fn new(faults: Faults, seed: u64, index: u32) -> Self {
        let mut generator = stream(seed, Purpose::RangeFaults(index));
        let _ = unit(&mut generator); // the number by which it is fitted
        let never_s = f64::NEG_INFINITY;
        Self { faults, generator, last_s: None, blind_until_s: never_s, ghost: (never_s, 0.0) }
    }

    /// What the sensor shows in its view at a time. Times have to rise from call to call.
    pub fn at(&mut self, at_s: f64) -> Shows {
        // Drawn in every view, so that no draw depends on the result of another.
        let [miss, dropout, ghost, place] = [(); 4].map(|()| unit(&mut self.generator));
        let since_s = self.last_s.map_or(0.0, |last_s| at_s - last_s);
        self.last_s = Some(at_s);
        if at_s < self.blind_until_s - 1e-9 {
            return Shows::Blind;
        }
        let begins = |per_min: f64, share: f64| share < 1.0 - (-per_min / 60.0 * since_s).exp();
        if begins(self.faults.dropouts_per_min, dropout) {
            self.blind_until_s = at_s + self.faults.dropout_s;
            return Shows::Blind;
        }
        if at_s >= self.ghost.0 - 1e-9 && begins(self.faults.ghosts_per_min, ghost) {
            self.ghost = (at_s + GHOST_S, place);
        }
        if miss < self.faults.misses {
            Shows::Nothing
        } else if at_s < self.ghost.0 - 1e-9 {
            Shows::Ghost(self.ghost.1)
        } else {
            Shows::What
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An hour of views, 20 ms apart.
    fn an_hour(faults: Faults) -> Vec<Shows> {
        let mut faulty = Faulty::new(faults, 1, 7);
        (0..180_000).map(|view| faulty.at(f64::from(view) * 0.02)).collect()
    }

    fn share(views: &[Shows], of: impl Fn(&Shows) -> bool) -> f64 {
        views.iter().filter(|view| of(view)).count() as f64 / views.len() as f64
    }

    fn is_ghost(shows: &Shows) -> bool {
        matches!(shows, Shows::Ghost(_))
    }

    #[test]
    fn a_sensor_without_faults_shows_what_there_is() {
        assert_eq!(share(&an_hour(Faults::NONE), |view| *view == Shows::What), 1.0);
    }

    #[test]
    fn single_views_are_missing_at_the_stated_rate() {
        let missing = share(&an_hour(Faults { misses: 0.1, ..Faults::NONE }), |view| *view == Shows::Nothing);
        assert!((missing - 0.1).abs() < 0.003, "{missing}");
    }

    #[test]
    fn dropouts_come_at_the_stated_rate_and_last_for_the_stated_time() {
        let views = an_hour(Faults { dropouts_per_min: 6.0, dropout_s: 0.5, ..Faults::NONE });
        let begins = views.windows(2).filter(|pair| pair[0] == Shows::What && pair[1] == Shows::Blind).count();
        // Six in a minute in which the sensor works, which is 57 s of every minute: 343 in an hour, give or take 19.
        assert!((286..=400).contains(&begins), "{begins}");
        let runs: Vec<usize> =
            views.split(|view| *view == Shows::What).map(<[Shows]>::len).filter(|n| *n > 0).collect();
        assert!(runs.iter().all(|views| views % 25 == 0), "{runs:?}");
    }

    #[test]
    fn a_ghost_stands_still_for_a_tenth_of_a_second() {
        let views = an_hour(Faults { ghosts_per_min: 2.0, ..Faults::NONE });
        let runs: Vec<&[Shows]> = views.split(|view| !is_ghost(view)).filter(|run| !run.is_empty()).collect();
        assert!((80..=160).contains(&runs.len()), "{}", runs.len());
        assert!(runs.iter().all(|run| run.len() % 5 == 0 && run[..5].iter().all(|view| *view == run[0])));
    }

    #[test]
    fn who_has_a_sensor_at_a_share_has_one_at_a_larger_share() {
        let fitted = |share: f64| (0..1000).filter(|index| is_fitted(share, 1, *index)).collect::<Vec<_>>();
        assert_eq!((fitted(0.0).len(), fitted(1.0).len()), (0, 1000));
        let (few, many) = (fitted(0.3), fitted(0.6));
        assert!((250..350).contains(&few.len()) && few.iter().all(|index| many.contains(index)), "{}", few.len());
    }
}
