//! The design numbers of the core, each with its source or derivation, and the relations between them, proved at
//! compile time.

use crate::time::{Duration, Stamp};
use crate::units::{Acceleration, Distance, Fraction, Gain, Seconds, Speed};

/// Largest acceleration of Algorithm 2 (eq. 8), `a_max` = 0.73 m/s².
pub const FREE_ROAD_ACCELERATION: Acceleration = Acceleration::from_mm_per_s2(730);

/// Below this target speed Algorithm 2 divides by nearly nothing: the leader brakes to a stop instead.
pub const STOP_SPEED: Speed = Speed::from_mm_per_s(100);

/// `(v/v_∞)` of Algorithm 2 is cut here. With `a_max` at its smallest allowed value of 0.1 m/s² the demand is then
/// 0.1 · (1 - 2.8⁴) = -6 m/s², so that the comfortable limit, which is less, always cuts first.
pub const FREE_ROAD_RATIO_MILLI: i64 = 2800;

/// Smallest `a_max` that a configuration may ask for (see [`FREE_ROAD_RATIO_MILLI`]).
pub const FREE_ROAD_ACCELERATION_MIN: Acceleration = Acceleration::from_mm_per_s2(100);

/// Hardest braking in normal driving that a configuration or a message may name (see [`FREE_ROAD_RATIO_MILLI`]).
pub const BRAKING_MAX: Acceleration = Acceleration::from_mm_per_s2(6000);

/// Time constant with which the last acceleration of a vehicle without driving parameters fades out: the best of
/// {0.5, 1, 1.5, 2, 3} s on recorded car drives.
pub const FADE: Duration = Duration::from_millis(2000);

/// News that is older than so many periods of own messages is old: to start a horizon from it takes long. Messages of a link that is on are
/// rarely so late.
pub const OLD_NEWS: i64 = 3;

/// Length taken for a vehicle that does not say its own (a car), by the gate too: driving parameters comes later than the first motion,
/// and to expect a lorry of 18.75 m until then is to brake hard at every association.
pub const DEFAULT_LENGTH: Distance = Distance::from_mm(4800);

/// No vehicle on a road is shorter.
pub const SHORTEST: Distance = Distance::from_mm(1_500);

/// Farther away than this a peer has nothing to do with the unit: V2X does not reach it, and a horizon's positions,
/// which are modulo 4096 m, stay unambiguous.
pub const FARTHEST_PEER: Distance = Distance::from_mm(1_500_000);

/// Oldest stamp that any configuration may use.
pub const STALE_MAX: Duration = Duration::from_millis(10_000);

/// An accuracy says that 95 % of the errors are below it, as in the messages of V2X. What is certain rests on errors of up to so many
/// times as much: 5.9 standard deviations of normal errors, which one in 2.4e8 exceeds. Errors of one sign in a row (a bias) within it
/// are inside as well, because no number of samples makes the bound narrower than one of them allows.
pub const ACCURACY_FACTOR: u8 = 3;

/// Position accuracy taken where none is published: what satellite positioning without correction keeps to.
pub const UNPUBLISHED_POSITION_ACCURACY: Distance = Distance::from_mm(5_000);
/// Speed accuracy taken where none is published.
pub const UNPUBLISHED_SPEED_ACCURACY: Speed = Speed::from_mm_per_s(1_500);

/// Accuracy of an acceleration, of which none is ever published: a slope of 10 % alone is as much.
pub const UNPUBLISHED_ACCELERATION_ACCURACY: Acceleration = Acceleration::from_mm_per_s2(1_000);

/// Half a step of a position on the wire, rounded up.
pub const POSITION_ROUNDING: Distance = Distance::from_mm(1);
/// Half a step of a speed on the wire, which is a whole mm/s, and what turning decimals into words loses of a speed and of
/// its accuracy.
pub const SPEED_ROUNDING: Speed = Speed::from_mm_per_s(1).plus(Speed::from_bits(2));
/// Half a step of a length on the wire.
pub const LENGTH_ROUNDING: Distance = Distance::from_mm(5);
/// Half a step of an acceleration on the wire.
pub const ACCELERATION_ROUNDING: Acceleration = Acceleration::from_mm_per_s2(10);

/// Without time synchronisation a message may have been under way for this long.
pub const UNKNOWN_DELAY: Duration = Duration::from_millis(2_000);

/// So many implausible samples in a row that are plausible among themselves are believed: then it was the bound that was
/// wrong (a restart of the sender, a corrected position).
pub const RECOVERY_SAMPLES: u8 = 5;
/// So many believed samples in a row, 10 s at 10 Hz, make up for one recovery.
pub const FORGIVEN_AFTER: u8 = 100;

/// Default gains: overdamped (poles of `s² + k(t_g+γ)s + k` at -1 and -0.5 for `t_g` = 1 s) and string stable at
/// `t_g` = 1 s, since `k (1 + 2γ/t_g) t_g² = 2.5 >= 2`.
pub const GAIN: Gain = Gain::from_milli(500);
/// Default damping, see [`GAIN`].
pub const DAMPING: Seconds = Seconds::from_millis(2000);

/// Time gap where nobody asks for another.
///
/// A follower that begins to slow down `L` after the one ahead, and as gently, loses `L Δv` of the gap, while the gap that it
/// wants shrinks by `t_g Δv`. With more than that lost it has to drive slower than the one ahead to open the gap again, and
/// passes on more than it got. `L` is the delay, the messages lost in a row, and what jerk limit and lag take. This is the
/// smallest whole tenth of a second at which ten cars pass on at most 1.01 times what they got of a step of their leader,
/// whatever is late by up to 0.2 s and lost up to 40 %, in 40 draws each; `holdover-sim string` measures it.
pub const TIME_GAP: Seconds = Seconds::from_millis(1_600);

/// The time gap of a car with a range sensor, which sees the braking ahead before it is heard: the smallest tenth of a second that keeps
/// to that limit with feed-forward, by `holdover-sim string --range-sensors on`. The sensor there looks 50 times a second, without
/// faults, and errs by up to 0.25 m and 0.1 m/s. While it sees nothing, 1.01 does not hold. A van needs more, and a bus more still.
pub const TIME_GAP_WITH_SENSOR: Seconds = Seconds::from_millis(800);

/// The time gap of the cruise control, and to which the time gap of the law opens while nothing new is known of the vehicle ahead. There
/// the string is stable without any message: behind what a sensor sees, by `holdover-sim gains`' criterion, `k (t_g² + 2γ t_g) >= 2` with
/// the gains of the cruise control, and with those of the tables.
pub const SILENT_TIME_GAP: Seconds = Seconds::from_millis(1_800);

/// The time gap opens after so long without news. A silence of 4 s, for which estimates are made, changes nothing: a vehicle that is silent
/// itself could not tell the vehicles behind that its gap opens. From here to the end of [`crate::config::Link::holdover`] there is time to
/// open the smallest gap that is shipped.
pub const OPENS_AFTER: Duration = Duration::from_millis(5_000);

/// The time gap opens and closes by one second in so many: the follower is then slower than the vehicle ahead by a tenth of its speed.
pub const OPENS_BY: i64 = 10;

/// The share of the predecessor's acceleration that a vehicle with a range sensor passes on, `φ`. A message carries whether it does.
pub const FEED_FORWARD: Fraction = Fraction::from_milli(500);

const _: () = {
    // A stamp that is used must unwrap to its time, with 1 s to spare for the clocks.
    assert!(STALE_MAX.as_micros() + Stamp::FUTURE.as_micros() + 1_000_000 < Stamp::PERIOD.as_micros());
    // Two vehicles within reach stay within the ring's 2048 m for the longest horizon (4 s at 100 m/s).
    assert!(FARTHEST_PEER.to_mm() + 4 * 100_000 < 2_048_000);
    // a_max (1 - ratio⁴) at the smallest a_max brakes harder than any comfortable limit.
    let fourth = FREE_ROAD_RATIO_MILLI * FREE_ROAD_RATIO_MILLI / 1000 * FREE_ROAD_RATIO_MILLI / 1000
        * FREE_ROAD_RATIO_MILLI
        / 1000;
    assert!(
        FREE_ROAD_ACCELERATION_MIN.to_mm_per_s2() as i64 * (fourth - 1000) / 1000 >= BRAKING_MAX.to_mm_per_s2() as i64
    );
    // String stability without lag: t_g >= sqrt(γ² + 2/k) - γ at t_g = 1 s, which is k (1 + 2γ) >= 2.
    assert!(GAIN.to_milli() * (1000 + 2 * DAMPING.to_millis()) >= 2_000_000);
    // The tables of gains are proved from 1 s and, with feed-forward, from 0.7 s on, each up to 2 s.
    assert!(TIME_GAP.to_millis() >= 1000 && TIME_GAP.to_millis() <= 2000);
    assert!(TIME_GAP_WITH_SENSOR.to_millis() >= 700 && TIME_GAP_WITH_SENSOR.to_millis() <= 2000);
};
