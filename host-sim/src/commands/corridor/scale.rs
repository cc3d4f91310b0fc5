//! The speed of the simulation: a number of vehicles enters; how much faster than real time they are simulated leaves.
//!
//! Corridors side by side, each with its own seed, give that number of vehicles under way at once, on average over the
//! measured time, if no vehicle is delayed. There are as many corridors as this takes. Of all their arrivals, evenly
//! chosen ones are left out, so that the number is met to within one vehicle.
//!
//! The corridors are dealt to the threads: the largest first, each to the thread with the least load. When the roads
//! have filled, all threads wait for one another, and the simulation that follows is timed. Everything of a run is
//! included: radio, buses, units, vehicles, observers. Vehicles that have left and drive on out of sight are simulated
//! but not counted.

use std::io;
use std::sync::Barrier;
use std::thread;
use std::time::Instant;

use serde::Serialize;

use crate::error::Error;
use crate::roads::beliefs::Beliefs;
use crate::roads::conditions::Conditions;
use crate::roads::description::Corridor;
use crate::roads::experiment::Experiment;
use crate::roads::network::Network;
use crate::roads::referee::Referee;
use crate::roads::tally::Tally;
use crate::roads::traffic::Traffic;
use crate::roads::trips::{Trip, trips};
use crate::roads::watch::Watch;

/// Default numbers of vehicles under way at once.
pub const VEHICLES: [usize; 4] = [10, 30, 100, 300];

/// Simulated time that is measured.
pub const SPAN_S: f64 = 30.0;

/// Time for which the roads fill before that, in mean travel times.
const FILL: f64 = 2.0;

/// At most this many corridors per vehicle are simulated, however few vehicles the roads have.
const MOST_PER_VEHICLE: usize = 20;

/// The measurement with one number of vehicles.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Load {
    /// Intended number of vehicles under way at once.
    pub vehicles: usize,
    /// Number of corridors.
    pub corridors: usize,
    /// Number of threads.
    pub threads: usize,
    /// Mean number of vehicles that were under way.
    pub under_way: f64,
    /// Mean number of peers that each vehicle heard: messages heard over messages that one vehicle sends.
    pub peers_heard: f64,
    /// Wall time of [`SPAN_S`].
    pub wall_s: f64,
    /// Simulated time over wall time.
    pub times_real_time: f64,
    /// Simulated vehicle seconds per second, of all threads together.
    pub vehicle_seconds_per_s: f64,
    /// Mean number of cores that the threads had, because other processes use them too; `None` where the system does
    /// not say.
    pub cores: Option<f64>,
    /// Microseconds of a core per vehicle second and peer heard; of a thread where the system does not report the time
    /// on a core.
    pub us_per_vehicle_second_and_peer: f64,
}

/// The result of one thread's corridors.
struct Share {
    tally: Tally,
    wall_s: f64,
    core_s: Option<f64>,
}

/// Time for which this thread has had a core; `None` where the system does not say.
fn core_s() -> Option<f64> {
    let said = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    Some(said.split_whitespace().next()?.parse::<f64>().ok()? * 1e-9)
}

/// Measures one number of vehicles. No other work should run meanwhile. `travel_s` is the mean travel time.
///
/// # Errors
/// A scenario that the units refuse.
pub fn measure(experiment: &Experiment, seed: u64, vehicles: usize, travel_s: f64) -> Result<Load, Error> {
    let fill_s = FILL * travel_s;
    // The vehicles of other seeds, some of them left out, are others than those that something befalls.
    let corridor = Corridor { duration_s: fill_s + SPAN_S, events: Vec::new(), ..experiment.corridor.clone() };
    let lots = lots(experiment, &corridor, seed, vehicles);
    let corridors = lots.len();
    let threads = rayon::current_num_threads().min(corridors);
    let full = Barrier::new(threads);
    let share = |mine: &[Lot]| drive(experiment, &corridor, mine, fill_s, &full);
    let shares: Vec<io::Result<Share>> = thread::scope(|scope| {
        let running: Vec<_> = dealt(lots, threads).into_iter().map(|mine| scope.spawn(move || share(&mine))).collect();
        let ended =
            running.into_iter().map(|share| share.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)));
        ended.collect()
    });
    let shares: Vec<Share> =
        shares.into_iter().collect::<io::Result<_>>().map_err(crate::roads::experiment::refused)?;
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

/// One corridor: the trips of a seed, and the mean number of vehicles under way in the measured time if no vehicle is
/// delayed. The true number is slightly larger.
struct Lot {
    seed: u64,
    trips: Vec<Trip>,
    under_way: f64,
}

impl Lot {
    fn new(seed: u64, trips: Vec<Trip>, corridor: &Corridor, network: &Network) -> Self {
        let to_s = corridor.duration_s;
        let leaves_s = |trip: &Trip| {
            let lane = &network.lanes[trip.road];
            trip.at_s + (lane.exit_m - lane.entry_m) / corridor.traffic.target_speed_mps
        };
        let on_way_s = |trip: &Trip| (leaves_s(trip).min(to_s) - trip.at_s.max(to_s - SPAN_S)).max(0.0);
        let under_way = trips.iter().map(on_way_s).sum::<f64>() / SPAN_S;
        Self { seed, trips, under_way }
    }
}

/// As many corridors as it takes for this number of vehicles under way. Surplus arrivals are left out at even
/// distances.
fn lots(experiment: &Experiment, corridor: &Corridor, seed: u64, vehicles: usize) -> Vec<Lot> {
    let network = &experiment.network;
    let mut lots: Vec<Lot> = Vec::new();
    let mut under_way = 0.0;
    while under_way < vehicles as f64 && lots.len() < MOST_PER_VEHICLE * vehicles {
        let seed = seed.wrapping_add(lots.len() as u64);
        lots.push(Lot::new(seed, trips(corridor, network, seed), corridor, network));
        under_way = lots.iter().map(|lot| lot.under_way).sum();
    }
    let share = vehicles as f64 / under_way;
    let mut owed = 0.0;
    let mut stays = |_: &Trip| {
        owed += share;
        let stays = owed >= 1.0;
        owed -= f64::from(u8::from(stays));
        stays
    };
    let thin = |lot: Lot| Lot::new(lot.seed, lot.trips.into_iter().filter(&mut stays).collect(), corridor, network);
    lots.into_iter().map(thin).collect()
}

/// Deals the corridors to the threads: the largest first, each to the thread with the least load.
fn dealt(mut lots: Vec<Lot>, threads: usize) -> Vec<Vec<Lot>> {
    let mut hands: Vec<(f64, Vec<Lot>)> = (0..threads).map(|_| (0.0, Vec::new())).collect();
    lots.sort_by(|a, b| b.under_way.total_cmp(&a.under_way));
    for lot in lots {
        if let Some((load, hand)) = hands.iter_mut().min_by(|(a, _), (b, _)| a.total_cmp(b)) {
            *load += lot.under_way;
            hand.push(lot);
        }
    }
    hands.into_iter().map(|(_, hand)| hand).collect()
}

/// Runs one thread's corridors one after the other, first until the roads are full, then timed.
fn drive(experiment: &Experiment, corridor: &Corridor, lots: &[Lot], fill_s: f64, full: &Barrier) -> io::Result<Share> {
    let network = &experiment.network;
    let mut worlds: Vec<(Traffic, Referee, Beliefs)> = lots
        .iter()
        .map(|Lot { seed, trips, .. }| {
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
    full.wait(); // even after an error, because the other threads wait too
    let (start, core_before_s) = (Instant::now(), core_s());
    let after = advance(fill_s + SPAN_S)?;
    let core_s = core_s().zip(core_before_s).map(|(after, before)| after - before);
    Ok(Share { tally: after.less(before?), wall_s: start.elapsed().as_secs_f64(), core_s })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::roads::example;

    fn of_the_corridor(edit: impl Fn(&str) -> String) -> (Experiment, Corridor) {
        let experiment = Experiment::new(example::of(&edit(example::TEXT)));
        let corridor = Corridor { duration_s: 90.0, ..experiment.corridor.clone() };
        (experiment, corridor)
    }

    fn sum(lots: &[Lot]) -> f64 {
        lots.iter().map(|lot| lot.under_way).sum()
    }

    #[test]
    fn as_many_are_under_way_as_are_asked_for_whoever_happens_to_come() {
        let (experiment, corridor) = of_the_corridor(str::to_owned);
        for seed in [1, 77, u64::MAX] {
            for vehicles in [10, 30, 100, 300] {
                let lots = lots(&experiment, &corridor, seed, vehicles);
                // Leaving out one arrival more or less changes the number by at most one vehicle.
                assert!((sum(&lots) - vehicles as f64).abs() < 1.0, "{seed} {vehicles} {}", sum(&lots));
            }
        }
    }

    #[test]
    fn the_threads_are_dealt_all_corridors_as_evenly_as_whole_ones_can_be() {
        let (experiment, corridor) = of_the_corridor(str::to_owned);
        let lots = lots(&experiment, &corridor, 1, 100);
        let (count, largest) = (lots.len(), lots.iter().map(|lot| lot.under_way).fold(0.0, f64::max));
        for threads in [1, 2, 3, 8] {
            let hands = dealt(super::lots(&experiment, &corridor, 1, 100), threads);
            assert_eq!((hands.len(), hands.iter().map(Vec::len).sum::<usize>()), (threads, count));
            let loads = || hands.iter().map(|hand| sum(hand));
            assert!(loads().fold(0.0, f64::max) - loads().fold(f64::MAX, f64::min) <= largest, "{threads}");
        }
    }

    #[test]
    fn roads_by_which_nobody_comes_end_the_search() {
        let (experiment, corridor) =
            of_the_corridor(|text| text.replace("vehicles_per_min = ", "vehicles_per_min = 0 # "));
        assert!(sum(&lots(&experiment, &corridor, 1, 3)) == 0.0);
    }
}
