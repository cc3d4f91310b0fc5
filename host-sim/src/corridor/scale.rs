//! How fast a corridor is simulated: a number of vehicles enters; how much faster than real time so many are leaves.
//!
//! So many vehicles under way at once take corridors side by side, as many as at the description's own rate of arrivals have
//! that many (rate times mean travel time), with a seed each; rounded up, and the rate is that much less. Each thread has its
//! share of the corridors. When the roads have filled, all threads wait for one another, and what follows is timed. All that a
//! run has is there: radio, buses, units, bodies, those who watch. Vehicles that have left and drive on out of sight are
//! simulated too, but not counted.

use std::io;
use std::sync::Barrier;
use std::thread;
use std::time::Instant;

use serde::Serialize;

use super::beliefs::Beliefs;
use super::conditions::Conditions;
use super::description::{Corridor, RoadPlan};
use super::experiment::Experiment;
use super::referee::Referee;
use super::tally::Tally;
use super::traffic::Traffic;
use super::trips::{Trip, trips};
use super::watch::Watch;
use crate::error::Error;

/// Vehicles under way at once, if nothing else is asked for.
pub const VEHICLES: [usize; 4] = [10, 30, 100, 300];

/// The time that is simulated under the clock.
pub const SPAN_S: f64 = 30.0;

/// Before, the roads fill for so many mean travel times.
const FILL: f64 = 2.0;

/// What it takes to simulate so many vehicles.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Load {
    /// How many were to be under way at once.
    pub vehicles: usize,
    /// In so many corridors.
    pub corridors: usize,
    /// On so many threads.
    pub threads: usize,
    /// How many were under way on average.
    pub under_way: f64,
    /// How many others each of them heard: messages heard over messages that one vehicle sends.
    pub peers_heard: f64,
    /// How long [`SPAN_S`] took.
    pub wall_s: f64,
    /// How many times faster than real time that is.
    pub times_real_time: f64,
    /// Simulated vehicle seconds per second, of all threads together.
    pub vehicle_seconds_per_s: f64,
    /// How many cores the threads had on average, because others want them too; `None` where the system does not say.
    pub cores: Option<f64>,
    /// Microseconds of a core per vehicle second and peer heard; of a thread where the system does not say.
    pub us_per_vehicle_second_and_peer: f64,
}

/// What a share of the corridors came to.
struct Share {
    tally: Tally,
    wall_s: f64,
    core_s: Option<f64>,
}

/// For how long this thread has had a core; `None` where the system does not say.
fn core_s() -> Option<f64> {
    let said = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    Some(said.split_whitespace().next()?.parse::<f64>().ok()? * 1e-9)
}

/// Measures it; nothing else is to run meanwhile. `travel_s` is the mean travel time.
///
/// # Errors
/// A scenario that the units refuse.
#[allow(clippy::cast_precision_loss, clippy::cast_possible_truncation, clippy::cast_sign_loss)] // numbers of vehicles
pub fn measure(experiment: &Experiment, seed: u64, vehicles: usize, travel_s: f64) -> Result<Load, Error> {
    let rate_hz = experiment.corridor.roads.iter().map(|road| road.vehicles_per_min).sum::<f64>() / 60.0;
    let usual = rate_hz * travel_s;
    let corridors = (vehicles as f64 / usual).ceil().max(1.0) as usize;
    let fill_s = FILL * travel_s;
    let corridor = thinned(&experiment.corridor, vehicles as f64 / (usual * corridors as f64), fill_s + SPAN_S);
    let seeds: Vec<u64> = (0..corridors as u64).map(|number| seed.wrapping_add(number)).collect();
    let threads = rayon::current_num_threads().min(corridors);
    let full = Barrier::new(threads);
    let share = |first: usize| {
        let mine: Vec<u64> = seeds.iter().skip(first).step_by(threads).copied().collect();
        drive(experiment, &corridor, &mine, fill_s, &full)
    };
    let shares: Vec<io::Result<Share>> = thread::scope(|scope| {
        let running: Vec<_> = (0..threads).map(|first| scope.spawn(move || share(first))).collect();
        let ended =
            running.into_iter().map(|share| share.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)));
        ended.collect()
    });
    let shares: Vec<Share> = shares.into_iter().collect::<io::Result<_>>().map_err(super::experiment::refused)?;
    let all = shares.iter().fold(Tally::default(), |sum, share| sum.with(share.tally));
    let wall_s = shares.iter().map(|share| share.wall_s).fold(0.0, f64::max);
    let core_s: Option<f64> = shares.iter().map(|share| share.core_s).sum();
    let vehicle_seconds = all.on_way as f64 * corridor.period_s;
    let peers_heard = all.heard as f64 / (vehicle_seconds * corridor.message_rate_hz).max(f64::MIN_POSITIVE);
    Ok(Load {
        vehicles,
        corridors,
        threads,
        under_way: vehicle_seconds / SPAN_S,
        peers_heard,
        wall_s,
        times_real_time: SPAN_S / wall_s,
        vehicle_seconds_per_s: vehicle_seconds / wall_s,
        cores: core_s.map(|core_s| core_s / wall_s),
        us_per_vehicle_second_and_peer: 1e6 * core_s.unwrap_or(wall_s * threads as f64)
            / (vehicle_seconds * peers_heard),
    })
}

/// The corridor with that share of the arrivals, for so long.
fn thinned(corridor: &Corridor, share: f64, duration_s: f64) -> Corridor {
    let thin = |road: &RoadPlan| RoadPlan { vehicles_per_min: road.vehicles_per_min * share, ..road.clone() };
    Corridor { duration_s, roads: corridor.roads.iter().map(thin).collect(), ..corridor.clone() }
}

/// One thread's share: the corridors of those seeds one after the other, first until they are full, then under the clock.
fn drive(
    experiment: &Experiment,
    corridor: &Corridor,
    seeds: &[u64],
    fill_s: f64,
    full: &Barrier,
) -> io::Result<Share> {
    let network = &experiment.network;
    let all: Vec<Vec<Trip>> = seeds.iter().map(|seed| trips(corridor, network, *seed)).collect();
    let mut worlds: Vec<(Traffic, Referee, Beliefs)> = seeds
        .iter()
        .zip(&all)
        .map(|(seed, trips)| {
            let conditions = Conditions::of(corridor);
            let traffic = Traffic::new(corridor, network, &experiment.itineraries, trips, conditions, *seed);
            (traffic, Referee::new(network, trips), Beliefs::new(network, None))
        })
        .collect();
    let mut advance = |to_s: f64| {
        worlds.iter_mut().try_fold(Tally::default(), |sum, (traffic, referee, beliefs)| {
            let watches: &mut [&mut dyn Watch] = &mut [referee, beliefs];
            traffic.advance(to_s, watches)?;
            Ok::<_, io::Error>(sum.with(traffic.tally()))
        })
    };
    let before = advance(fill_s);
    full.wait(); // whatever became of it: the others wait too
    let (start, core_before_s) = (Instant::now(), core_s());
    let after = advance(fill_s + SPAN_S)?;
    let core_s = core_s().zip(core_before_s).map(|(after, before)| after - before);
    Ok(Share { tally: after.less(before?), wall_s: start.elapsed().as_secs_f64(), core_s })
}
