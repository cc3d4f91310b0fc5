//! Whether a vehicle that ran into the one ahead could have come to rest before. The drives of both enter; yes or no leaves.
//!
//! A follower can know of a braking once the vehicle ahead is slower by as much as its range sensor may err, and is given 0.1 s more to
//! begin braking; or it is taken to know of it at once. Then it brakes as hard as its law may: what the law demands is limited in strength
//! and in its change.

use crate::sim::world::Tick;

/// What the law may demand, and how it comes about.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Hardest braking, as a magnitude.
    pub braking_mps2: f64,
    /// Fastest change of a demand.
    pub jerk_mps3: f64,
    /// Time constant of the actuators.
    pub lag_s: f64,
}

/// A view errs by so much by default (`range_speed_accuracy_mps`). A vehicle that has lost more has braked.
const SLOWER_MPS: f64 = 0.1;

/// The time that the follower is given to begin braking.
const ANSWER_S: f64 = 0.1;

/// Speed changes by no more than this without braking.
const WAVERS_MPS2: f64 = 0.1;

/// When the follower knows of the braking ahead, and begins to brake.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Known {
    /// In the moment in which it begins, as nobody can.
    AtOnce,
    /// 0.1 s after one could see it.
    Seen,
}

impl Known {
    /// The tick in which the follower begins to brake; `None` if the vehicle ahead does not brake from the tick `from` on.
    fn answers_at(self, ahead: &[Tick], from: usize, period_s: f64) -> Option<usize> {
        let before = ahead.get(from)?;
        let brakes = |tick: &usize| ahead[*tick].acceleration_mps2 < -WAVERS_MPS2;
        let is_slower = |tick: &usize| ahead[*tick].speed_mps < before.speed_mps - SLOWER_MPS;
        let mut braking = (from..ahead.len()).filter(brakes);
        match self {
            Self::AtOnce => braking.next(),
            Self::Seen => Some(braking.find(is_slower)? + (ANSWER_S / period_s).round() as usize),
        }
    }
}

/// Whether the vehicle behind could have kept off the rear ahead, `length_m` behind the front, had it braked as hard as it may from its
/// answer on. Until then it drives as it really did. `from` is the tick at which the leader of the string begins to brake. Also true if the
/// vehicle ahead never brakes.
#[must_use]
pub fn is_avoidable(
    ahead: &[Tick],
    behind: &[Tick],
    length_m: f64,
    from: usize,
    known: Known,
    limits: &Limits,
    period_s: f64,
) -> bool {
    let Some(answers) = known.answers_at(ahead, from, period_s) else { return true };
    let Some(start) = behind.get(answers) else { return true };
    let kept = (-period_s / limits.lag_s).exp();
    let (mut position_m, mut speed_mps) = (start.position_m, start.speed_mps);
    let (mut acceleration_mps2, mut demand_mps2) = (start.acceleration_mps2, start.command_mps2);
    ahead.iter().skip(answers + 1).all(|ahead| {
        demand_mps2 = (demand_mps2 - limits.jerk_mps3 * period_s).max(-limits.braking_mps2);
        acceleration_mps2 = demand_mps2 + (acceleration_mps2 - demand_mps2) * kept;
        let before_mps = speed_mps;
        speed_mps = (speed_mps + acceleration_mps2 * period_s).max(0.0);
        position_m += 0.5 * (before_mps + speed_mps) * period_s;
        ahead.position_m - length_m > position_m
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use holdover::wire::command::ModeCode;

    const PERIOD_S: f64 = 0.001;
    const LIMITS: Limits = Limits { braking_mps2: 4.0, jerk_mps3: 5.0, lag_s: 1e-6 };

    /// At 15 m/s from this place; brakes with this from 1 s on.
    fn drive(from_m: f64, braking_mps2: f64) -> Vec<Tick> {
        let tick = |n: u32| {
            let braked_s = (f64::from(n) * PERIOD_S - 1.0).clamp(0.0, 15.0 / braking_mps2.max(1e-9));
            let driven_m = 15.0 * (f64::from(n) * PERIOD_S).min(1.0 + braked_s);
            Tick {
                position_m: from_m + driven_m - 0.5 * braking_mps2 * braked_s * braked_s,
                speed_mps: 15.0 - braking_mps2 * braked_s,
                acceleration_mps2: if braked_s > 0.0 && braked_s * braking_mps2 < 15.0 { -braking_mps2 } else { 0.0 },
                command_mps2: if braked_s > 0.0 && braked_s * braking_mps2 < 15.0 { -braking_mps2 } else { 0.0 },
                limited: false,
                mode: ModeCode::Cooperative,
                target: None,
            }
        };
        (0..15_000).map(tick).collect()
    }

    /// The gap that is needed behind a vehicle of 5 m that stops with 6 m/s².
    fn needed_m() -> f64 {
        // 0.1 m/s are lost after 1/60 s, and 0.1 s later the demand grows over 0.8 s to 4 m/s²: 15 · 0.8 - 5 · 0.8³/6 m, down to
        // 13.4 m/s; then 13.4²/8 m.
        let own_m = 15.0 * (1.0 / 60.0 + 0.1) + 15.0 * 0.8 - 5.0 * 0.512 / 6.0 + 13.4 * 13.4 / 8.0;
        own_m - 15.0 * 15.0 / 12.0
    }

    #[test]
    fn it_can_come_to_rest_where_its_way_to_rest_is_no_longer_than_gap_and_way_ahead() {
        let behind = drive(0.0, 0.0);
        for (more_m, avoidable) in [(0.1, true), (-0.1, false)] {
            let ahead = drive(5.0 + needed_m() + more_m, 6.0);
            assert_eq!(is_avoidable(&ahead, &behind, 5.0, 0, Known::Seen, &LIMITS, PERIOD_S), avoidable, "{more_m}");
        }
    }

    #[test]
    fn whoever_knows_at_once_needs_less_by_the_way_until_its_answer() {
        let behind = drive(0.0, 0.0);
        let needed_m = needed_m() - 15.0 * (1.0 / 60.0 + 0.1);
        for (more_m, avoidable) in [(0.1, true), (-0.1, false)] {
            let ahead = drive(5.0 + needed_m + more_m, 6.0);
            assert_eq!(is_avoidable(&ahead, &behind, 5.0, 0, Known::AtOnce, &LIMITS, PERIOD_S), avoidable, "{more_m}");
        }
    }

    #[test]
    fn until_its_answer_it_drives_as_it_did_and_wavering_is_no_braking() {
        let ahead = drive(5.0 + needed_m() - 1.0, 6.0);
        assert!(!is_avoidable(&ahead, &drive(0.0, 0.0), 5.0, 0, Known::Seen, &LIMITS, PERIOD_S));
        assert!(
            is_avoidable(&ahead, &drive(0.0, 4.0), 5.0, 0, Known::Seen, &LIMITS, PERIOD_S),
            "it brakes as soon as the one ahead"
        );
        // By the speed alone it would have answered at 0.9 s, and been metres better.
        let mut wavered = drive(5.0 + needed_m() - 1.0, 6.0);
        wavered[..900].iter_mut().for_each(|tick| tick.speed_mps = 15.2);
        assert!(!is_avoidable(&wavered, &drive(0.0, 0.0), 5.0, 0, Known::Seen, &LIMITS, PERIOD_S));
    }

    #[test]
    fn a_lag_takes_the_way_that_is_driven_in_it() {
        let behind = drive(0.0, 0.0);
        let limits = Limits { lag_s: 0.3, ..LIMITS };
        for (more_m, avoidable) in [(15.0 * 0.3 + 0.2, true), (15.0 * 0.3 - 0.6, false)] {
            let ahead = drive(5.0 + needed_m() + more_m, 6.0);
            assert_eq!(is_avoidable(&ahead, &behind, 5.0, 0, Known::Seen, &limits, PERIOD_S), avoidable, "{more_m}");
        }
    }

    #[test]
    fn whoever_runs_into_a_vehicle_that_does_not_brake_could_have_braked() {
        assert!(is_avoidable(&drive(20.0, 0.0), &drive(0.0, 0.0), 5.0, 0, Known::Seen, &LIMITS, PERIOD_S));
    }
}
