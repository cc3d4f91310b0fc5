//! Proof of the gate's arithmetic: that the fixed-point gate keeps what the theory at the top of [`crate::envelope`] says. The names are
//! those of the theory. `H` is the reaction time: a tick `h` and what is left of the delay `d`.
//!
//! # What is proved
//!
//! Let `X = Z + ½ j (τ + H)²`, with `Z` the closing speed (of `y`, or of `y` on `q`), `b` the braking (less `c`, if the vehicle ahead
//! goes on braking), and `S` the way. **Safe** is `S >= 0` and `X <= 0` or `X² <= 2 b S`.
//!
//! 1. **A command that comes into force late.** If it is safe with the whole reaction time `h + d` when it is computed, it is safe with
//!    `h + d - δ` when it comes into force `δ <= d` later. The condition is that what was in force until then had been commanded no
//!    faster than at jerk `j`.
//! 2. **A tick.** Let it be safe with the command `u = jτ - b` and a reaction time `h + ρ`. After a tick of length `h` it is safe with
//!    the floor that then holds, `max(u - jh, -b)`, and the same reaction time; and `S >= 0` at every moment in between. A tick that is
//!    longer by `m <= ρ` uses up `m` of `ρ`. A shorter tick uses up nothing. While `-b` is in force, no tick uses up any, however long it
//!    is. Without an allowance nothing is kept through a tick that is too long.
//! 3. **The vehicle ahead does what it can.** `S` only grows and `Z` only falls if the vehicle is further ahead or faster than its near
//!    end. If a near end is reckoned with a harder braking than it has, its point of rest only moves on.
//! 4. **Rounding.** What the code calls safe is safe, and so is every command up to the code's cap, for every lag within the tolerance.
//!
//! So the gate keeps *safe*. Either the command is up to the cap, and 4 and 1 make it safe anew when it comes into force; or it is the
//! floor, and 2 has said that it is safe. A safe ego never meets the near end: `S >= 0` until rest. The reaction time that is reckoned
//! with has to last from a command up to the cap to the end of the emergency braking's ramp. So missed ticks, and changes in how late
//! commands are, must come to no more than `d` together in that time, `(u + b)/j`.
//!
//! # How
//!
//! 1 to 3 hold for **all** real values: each is an identity of polynomials whose remainder has no negative coefficient
//! ([`crate::polynomial`]). The demand and the obstacle do not enter: the demand is arbitrary, and the near end is any that is not behind
//! and not slower than the near end of 3.
//!
//! 4, and 2 through the real plant (the lag solved exactly over a tick, standstill included), are tested at **points**, in intervals that
//! are rounded outward:
//!
//! - `lattice`: speeds 0 to 65.5 m/s, braking 0.5 m/s² to the hardest that a command can say, jerks 1 to 63.9 m/s³, lags 0 to 1.998 s
//!   with their tolerance, periods 1 to 100 ms, delays 0 to 0.5 s, braking of the vehicle ahead 0.1 to 20.46 m/s². At each point the gap
//!   is bisected to the nearest one that the code calls safe, because that is where the code can fail. The gap is then widened, from one
//!   bit of the word to 29 m. For a known lag, what the code called safe before a tick it calls safe after the tick, to within 31 µm of
//!   the gap.
//! - `extremes`: words at the ends of every format, and words that no decimal makes.
//! - `drives`: whole drives in float64, with late commands, missed ticks and lags within the tolerances.
//!
//! # What is not proved
//!
//! A braking below 2 mm/s² counts as none, because no command can say it. Jerks below 1 m/s³ are in `extremes` alone. Three things are
//! proved or assumed elsewhere: that the state is known (`Reckoning`), that the near end is behind the real vehicle
//! (`crate::model::bound`), and what is ahead at all.

mod drives;
mod extremes;
mod interval;
mod lattice;

use crate::polynomial::Polynomial;

fn number(n: i64) -> Polynomial {
    Polynomial::from(n)
}

fn square(x: &Polynomial) -> Polynomial {
    x.clone() * x.clone()
}

/// A command `u = jτ - b` in force for a time. For a part of that time an earlier and higher command was in force. It made the ego faster
/// by at most half of `faster`, and brought it farther by at most half of `farther`.
struct Tick {
    jerk: Polynomial,
    braking: Polynomial,
    lasts: Polynomial,
    /// `τ` of the command, and `τ` of the floor after it.
    ramps: [Polynomial; 2],
    /// The reaction time that is reckoned with, before and after the tick.
    reactions: [Polynomial; 2],
    faster: Polynomial,
    farther: Polynomial,
}

impl Tick {
    /// `2 (X - Z)`, before or after the tick.
    fn ramp(&self, when: usize) -> Polynomial {
        self.jerk.clone() * square(&(self.ramps[when].clone() + self.reactions[when].clone()))
    }

    fn command(&self) -> Polynomial {
        self.jerk.clone() * self.ramps[0].clone() - self.braking.clone()
    }

    /// `2 b h`: the least by which `2X` has to fall.
    fn due(&self) -> Polynomial {
        number(2) * self.braking.clone() * self.lasts.clone()
    }

    /// By how much more than that `2X` falls.
    fn falls_more(&self) -> Polynomial {
        let gained = number(2) * self.command() * self.lasts.clone() + self.faster.clone();
        self.ramp(0) - self.ramp(1) - gained - self.due()
    }

    /// `8 b` times the way, from `2X`.
    fn way(&self, twice_x: &Polynomial) -> Polynomial {
        let z = twice_x.clone() - self.ramp(0);
        let twice = z * self.lasts.clone() + self.command() * square(&self.lasts) + self.farther.clone();
        number(4) * self.braking.clone() * twice
    }

    /// Whether the tick keeps what is safe. Before it `2 b S = X² + spare`, if `X >= 0`. No variable is negative.
    fn keeps(&self, spare: &Polynomial, x: &Polynomial) -> bool {
        // 8 b S' - 4 X'² for X' >= 0, with x = 2X'.
        let before = x.clone() + self.due() + self.falls_more();
        let both = number(4) * spare.clone() + square(&before) - self.way(&before) - square(x);
        // 8 b S' for X >= 0, with x = 2X, whatever X' is: a square, and a part that is not negative.
        let alone = number(4) * spare.clone() + square(x) - self.way(x) - square(&(x.clone() - self.due()));
        // 8 b (S' - S) for X < 0, with x = -2X: the way is not positive.
        let backwards = number(0) - self.way(&(number(0) - x.clone()));
        [self.falls_more(), both, alone, backwards].iter().all(Polynomial::is_plainly_not_negative)
    }
}

#[test]
fn a_command_up_to_the_cap_is_still_safe_when_it_comes_into_force() {
    let [jerk, braking, period, tau, late, rest, spare, x] = Polynomial::variables();
    // What was in force until then was higher by up to j (h + what is left of the delay).
    let higher = jerk.clone() * late.clone() * (late.clone() + number(2) * period.clone());
    let left = period + rest;
    let wait = Tick {
        jerk,
        braking,
        ramps: [tau.clone(), tau],
        reactions: [left.clone() + late.clone(), left],
        farther: higher.clone() * late.clone(),
        faster: higher,
        lasts: late,
    };
    assert!(wait.keeps(&spare, &x));
}

/// The two cases of a floor after a command that was in force for a period and the time `longer`. `allowances` is by how much the
/// reaction time is longer than the period, before and after.
fn ticks(longer: Polynomial, allowances: [Polynomial; 2], [jerk, braking, time, more]: [Polynomial; 4]) -> [Tick; 2] {
    let ramp_goes_on = (time.clone(), [time.clone() + more.clone(), more.clone()]);
    let ramp_ends = (time.clone() + more, [time, number(0)]);
    [ramp_goes_on, ramp_ends].map(|(period, ramps)| Tick {
        jerk: jerk.clone(),
        braking: braking.clone(),
        lasts: period.clone() + longer.clone(),
        ramps,
        reactions: allowances.clone().map(|allowance| period.clone() + allowance),
        faster: number(0),
        farther: number(0),
    })
}

#[test]
fn a_tick_keeps_what_is_safe_and_a_longer_one_uses_up_that_much_of_the_allowance() {
    let [jerk, braking, time, more, missed, rest, spare, x] = Polynomial::variables();
    let of = [jerk, braking, time, more];
    let kept = [rest.clone(), rest.clone()];
    assert!(ticks(number(0), kept.clone(), of.clone()).iter().all(|tick| tick.keeps(&spare, &x)));
    let used = [rest.clone() + missed.clone(), rest];
    assert!(ticks(missed.clone(), used, of.clone()).iter().all(|tick| tick.keeps(&spare, &x)));
    assert!(!ticks(missed, kept, of).iter().all(|tick| tick.keeps(&spare, &x)));
}

#[test]
fn a_shorter_tick_keeps_what_is_safe() {
    let [jerk, braking, lasts, lacks, more, rest, spare, x] = Polynomial::variables();
    let period = lasts.clone() + lacks.clone();
    let reaction = period.clone() + rest;
    // The ramp goes on; or it ends within the time that the tick lasts, or that a period would last.
    for ramps in
        [[period.clone() + more.clone(), more.clone()], [lasts.clone(), number(0)], [period.clone(), number(0)]]
    {
        let tick = Tick {
            jerk: jerk.clone(),
            braking: braking.clone(),
            lasts: lasts.clone(),
            ramps,
            reactions: [reaction.clone(), reaction.clone()],
            faster: number(0),
            farther: number(0),
        };
        assert!(tick.keeps(&spare, &x));
    }
}

#[test]
fn the_hardest_braking_stays_safe_however_long_a_tick_is() {
    let [jerk, braking, lasts, reaction, spare, x] = Polynomial::variables();
    let [faster, farther] = [number(0), number(0)];
    let ramps = [number(0), number(0)];
    let tick = Tick { jerk, braking, lasts, ramps, reactions: [reaction.clone(), reaction], faster, farther };
    assert!(tick.keeps(&spare, &x));
}

/// A near end brakes with `c` while its point of rest is reckoned with the ego's harder `b`. The claim: `2 b` times how far that point
/// moves on in a time `t` at whose end the near end still has the speed `left`; and `2 b c` times it if the near end comes to rest.
#[test]
fn the_point_of_rest_of_who_brakes_less_hard_only_moves_on() {
    let [c, harder, time, left] = Polynomial::variables();
    let b = c.clone() + harder.clone();
    let speed = left.clone() + c.clone() * time.clone();
    let way = number(2) * speed.clone() * time.clone() - c.clone() * square(&time);
    let moves = b.clone() * way + square(&left) - square(&speed);
    assert!(moves.is_plainly_not_negative());
    let rests = b * square(&speed) - c * square(&speed);
    assert!(rests.is_plainly_not_negative());
}
