//! What a vehicle claims itself. When it will be in the conflict area, and what is known of the others, enter; what it says, and whether
//! a stay is covered, leave.
//!
//! A vehicle claims the time for which it foresees to be in the area, with some slack before and after. As long as that covers what it
//! foresees, the claim stays as it is, because only time that is claimed anew has to become firm anew (F6). What it will not need it
//! gives back. Time that is missing at the end becomes a window of its own, which joins the first. If anything else is missing, another
//! window is claimed: the earliest that is free.

use super::{Claim, Known, PIECES, Rules, Window, is_covered};
use crate::held::Held;
use crate::parameters::DEFAULT_LENGTH;
use crate::time::{Duration, GnssTime};
use crate::units::Distance;
use crate::wire::pass::STEP;

/// Time beyond what is wanted that a vehicle does not give back, so that a claim does not follow every change of what is foreseen.
const KEPT: Duration = Duration::from_millis(400);

/// [`STEP`].
const STEP_MICROS: i32 = 10_000;
const _: () = assert!(STEP.as_micros() == STEP_MICROS as i64);

/// A vehicle that has said nothing for so long is not on air any more. It speaks every 200 ms.
const SILENT: Duration = Duration::from_millis(500);

/// When a vehicle foresees to be in the conflict area.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Outlook {
    /// From the entry of its front to the exit of its rear.
    pub stay: Window,
    /// Time to claim beyond the stay.
    pub slack: Slack,
    /// With less than this beyond the stay, more is claimed.
    pub least: Slack,
    /// It cannot stop before the area any more, or is in it.
    pub is_committed: bool,
}

/// Time before and after a stay.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Slack {
    /// The vehicle may be there earlier by so much.
    pub before: Duration,
    /// It may be there later by so much.
    pub after: Duration,
}

impl Slack {
    /// What the unit of a vehicle of this length claims beyond the stay that it foresees, in whole [steps](STEP): 0.6 s before it,
    /// and after it 0.8 s for a car of 4.8 m, and 75 ms more for each metre by which it is longer.
    ///
    /// They are three standard deviations of how far entries are off where vehicles make emergency stops. A vehicle is more often later than
    /// earlier, and the time that it has lost before the area grows with the way until its rear has left.
    #[must_use]
    pub fn of(length: Distance) -> Self {
        let micros =
            length.minus(DEFAULT_LENGTH).max(Distance::ZERO).to_mm().saturating_mul(75).saturating_add(800_000);
        Self { before: Duration::from_millis(600), after: STEP.times(i64::from(micros / STEP_MICROS)) }
    }

    const KEPT: Self = Self { before: KEPT, after: KEPT };

    /// A window with this before and after it.
    fn around(self, window: &Window) -> Window {
        Window { entry: window.entry.plus(Duration::ZERO.minus(self.before)), exit: window.exit.plus(self.after) }
    }

    /// How far it falls short of another.
    fn minus(self, other: Self) -> Self {
        Self { before: self.before.minus(other.before), after: self.after.minus(other.after) }
    }
}

/// The place of another vehicle in the order at the intersection, against the own one. It decides who gets time that two want. It does
/// not decide what is firm.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// It goes first: the ego gives way to what it claims, and when.
    Ahead,
    /// It goes after the ego, and gives way.
    Behind,
    /// Not known: the earlier claim goes first (F3).
    Unknown,
}

/// The own claims at the next intersection.
#[derive(Clone, Debug)]
pub struct Own {
    /// The stamp of the first message in the zone.
    on_air: Held<GnssTime>,
    /// The stamp of the last message.
    said: Held<GnssTime>,
    pieces: [Held<Claim>; PIECES],
    /// It says that it is not in the zone yet.
    is_before_zone: bool,
}

impl Own {
    /// Nothing is claimed: all zero.
    pub const NOTHING: Self =
        Self { on_air: Held::Nothing, said: Held::Nothing, pieces: [Held::Nothing; PIECES], is_before_zone: false };

    /// Another intersection comes next, or the time is not known any more (F8).
    pub fn begin(&mut self) {
        *self = Self::NOTHING;
    }

    /// Gives everything back, and stays out of the zone until the next plan. What is claimed then is that of a newcomer (F2).
    pub fn stay_out(&mut self) {
        *self = Self { is_before_zone: true, ..Self::NOTHING };
    }

    /// A person drives: nothing more is claimed. What was claimed stays until it is over, because the vehicle may be on its way in, unless the
    /// last message was long ago.
    #[cold] // whoever drives itself does not pay for it
    pub fn run_out(&mut self, now: GnssTime) {
        for piece in &mut self.pieces {
            *piece = piece.get().filter(|claim| claim.window.exit > now).into();
        }
        if self.claims().next().is_none() || self.was_silent(now) {
            self.stay_out();
        }
    }

    /// Whether it says that it is not in the zone.
    #[must_use]
    pub const fn is_before_zone(&self) -> bool {
        self.is_before_zone
    }

    /// The claims.
    pub fn claims(&self) -> impl Iterator<Item = Claim> + Clone {
        self.pieces.iter().filter_map(|piece| piece.get())
    }

    /// Claims what is foreseen, and gives back the rest. Without an outlook everything is given back. `known` are the vehicles on ways
    /// that cross the own one, with their places in the order.
    pub fn plan<'a>(
        &mut self,
        rules: &Rules,
        now: GnssTime,
        station: u32,
        outlook: Option<&Outlook>,
        known: impl Iterator<Item = (Known<'a>, Order)> + Clone,
    ) {
        self.is_before_zone = false;
        let Some(outlook) = outlook else {
            self.pieces = [Held::Nothing; PIECES];
            return;
        };
        // Others may have come on air since, and have not heard what was claimed.
        if !outlook.is_committed && self.was_silent(now) {
            self.begin();
        }
        if !outlook.is_committed {
            self.give_way(rules, known.clone());
        }
        let want = outlook.slack.around(&outlook.stay);
        self.shrink(now, outlook, &want);
        if self.is_claimed(&outlook.least.around(&outlook.stay)) {
            return;
        }
        let on_air = self.on_air.get().unwrap_or(now);
        let at = rules.claims_from(now, on_air, self.said.get());
        let is_firm = |claim: &Claim| rules.is_firm(now, claim, known.clone().map(|(other, _)| other));
        // A window that covers the stay, and is not firm yet, is firm sooner than what it would become a part of.
        let is_pending = |claim: &Claim| claim.at < at && !is_firm(claim);
        if !outlook.is_committed
            && self.claims().count() == PIECES
            && self.is_claimed(&outlook.stay)
            && self.claims().any(|claim| is_pending(&claim))
        {
            return;
        }
        // Who goes after the ego gives way.
        let before = known.clone().filter(|(_, order)| *order != Order::Behind);
        let taken = before.flat_map(|(other, _)| other.claims.iter()).map(|claim| claim.window);
        let free = |window: &Window| {
            let cut =
                |window: Window, other| if outlook.is_committed { window } else { rules.trimmed(&window, &other) };
            taken.clone().fold(*window, cut)
        };
        if let Some(growth) =
            self.missing(outlook, &want).map(|window| free(&window)).filter(|window| !window.is_empty())
        {
            self.add(Claim { at, window: growth, station }, is_firm);
            if self.is_claimed(&outlook.stay) {
                return;
            }
        }
        let window = if outlook.is_committed {
            want
        } else {
            // What is left of the slack is enough, if it is free.
            let least = outlook.least.around(&outlook.stay);
            let cut = free(&want);
            let is_enough = cut.entry <= least.entry && cut.exit >= least.exit;
            if is_enough { cut } else { rules.earliest_free(&want, taken) }
        };
        // While it waits for a later window, that one is as good as one that moves on with what is foreseen.
        if self.is_claimed(&outlook.least.minus(outlook.slack).around(&window)) {
            return;
        }
        self.replace(Claim { at, window, station }, &outlook.stay, is_firm);
    }

    /// The claims as they are said in a message with this stamp. One that is not in the zone is not on air by what it says. Those that were
    /// made before the first message of all count from when that has been heard. What is claimed is given up if the last message was long ago,
    /// unless it is in use: others may have come on air since.
    pub fn say(&mut self, rules: &Rules, stamp: GnssTime, is_committed: bool) -> [Option<Claim>; PIECES] {
        if self.is_before_zone {
            return [None; PIECES];
        }
        if !is_committed && self.was_silent(stamp) {
            self.begin();
        }
        if self.on_air.as_ref().is_none() {
            self.on_air.set(stamp);
            let at = rules.heard_by_all(stamp);
            for piece in &mut self.pieces {
                *piece = piece.get().map(|claim| Claim { at: claim.at.max(at), ..claim }).into();
            }
        }
        self.said.set(stamp);
        self.pieces.map(|piece| piece.get())
    }

    /// Whether a stay is covered by firm claims (F4, F5).
    pub fn covers<'a>(
        &self,
        rules: &Rules,
        now: GnssTime,
        stay: &Window,
        known: impl Iterator<Item = Known<'a>> + Clone,
    ) -> bool {
        // Most of the time nothing covers it, firm or not.
        if !self.is_claimed(stay) {
            return false;
        }
        let firm = self.claims().filter(|claim| rules.is_firm(now, claim, known.clone()));
        is_covered(stay, firm.map(|claim| claim.window))
    }

    /// Whether a stay is claimed, firm or not.
    #[must_use]
    pub fn is_claimed(&self, stay: &Window) -> bool {
        is_covered(stay, self.claims().map(|claim| claim.window))
    }

    /// Whether it has said nothing for so long that it is not on air any more.
    fn was_silent(&self, now: GnssTime) -> bool {
        self.said.get().is_some_and(|said| now > said.plus(SILENT))
    }

    /// What is missing of the wanted window before or after what is claimed already.
    fn missing(&self, outlook: &Outlook, want: &Window) -> Option<Window> {
        let stay = &outlook.stay;
        if let Some(end) = self.reaches(stay.entry) {
            return Some(Window { entry: end, exit: want.exit });
        }
        let is_later = |claim: &Claim| (stay.entry..stay.exit).contains(&claim.window.entry);
        let first = self.claims().filter(is_later).map(|claim| claim.window.entry).min()?;
        Some(Window { entry: want.entry, exit: first })
    }

    /// The end of the claimed time that begins at `entry` or before.
    #[must_use]
    pub fn reaches(&self, entry: GnssTime) -> Option<GnssTime> {
        reached(entry, self.claims())
    }

    /// The end of the firmly claimed time that begins at `entry` or before.
    pub fn firmly_reaches<'a>(
        &self,
        rules: &Rules,
        now: GnssTime,
        entry: GnssTime,
        known: impl Iterator<Item = Known<'a>> + Clone,
    ) -> Option<GnssTime> {
        reached(entry, self.claims().filter(|claim| rules.is_firm(now, claim, known.clone())))
    }

    /// Gives up what has to give way, or cuts it (F3). What a vehicle that goes after the ego has claimed is waited for: until that one
    /// has given way, the own claim is not firm.
    fn give_way<'a>(&mut self, rules: &Rules, known: impl Iterator<Item = (Known<'a>, Order)>) {
        for (other, order) in known.flat_map(|(other, order)| other.claims.iter().map(move |claim| (claim, order))) {
            for piece in &mut self.pieces {
                let gives_way = |own: &Claim| match order {
                    Order::Ahead => true,
                    Order::Behind => false,
                    Order::Unknown => other.precedes(own),
                };
                let Some(own) = piece.get().filter(gives_way) else { continue };
                let window = rules.trimmed(&own.window, &other.window);
                *piece = Some(Claim { window, ..own }).filter(|own| !own.window.is_empty()).into();
            }
        }
    }

    /// Gives back what is over, and what will not be needed.
    fn shrink(&mut self, now: GnssTime, outlook: &Outlook, want: &Window) {
        let kept = Slack::KEPT.around(want);
        for piece in &mut self.pieces {
            let Some(own) = piece.get() else { continue };
            let mut window = own.window;
            if !outlook.is_committed {
                window.entry = window.entry.max(kept.entry);
                // A window that is later than what is wanted is waited for.
                if window.entry <= outlook.stay.entry {
                    window.exit = window.exit.min(kept.exit);
                }
            }
            let is_needed = !window.is_empty() && window.exit > now;
            *piece = Some(Claim { window, ..own }).filter(|_| is_needed).into();
        }
    }

    /// Adds a window. Where there is no place for it, the two that are there become one, if that is firm: it counts from when the later of
    /// them did, and all messages since have said as much. Otherwise the later one becomes part of the new one, unless it is firm: then it
    /// may be in use, and keeps its time.
    fn add(&mut self, claim: Claim, is_firm: impl Fn(&Claim) -> bool) {
        let [Held::Value(one), Held::Value(other)] = self.pieces else {
            if let Some(free) = self.pieces.iter_mut().find(|piece| piece.as_ref().is_none()) {
                free.set(claim);
            }
            return;
        };
        let (first, second) = if one.at <= other.at { (one, other) } else { (other, one) };
        let joined = joined(&first.window, &second.window).map(|window| Claim { window, ..second });
        self.pieces = if let Some(joined) = joined.filter(&is_firm) {
            [Held::Value(joined), Held::Value(claim)]
        } else if is_firm(&second) {
            self.pieces
        } else {
            let window = joined_or(&second.window, &claim.window);
            [Held::Value(first), Held::Value(Claim { window, ..claim })]
        };
    }

    /// Claims another window. What overlaps the stay is kept: it is firm already, and the ego may still be there in that time.
    fn replace(&mut self, claim: Claim, stay: &Window, is_firm: impl Fn(&Claim) -> bool) {
        for piece in &mut self.pieces {
            let overlaps = |own: &Claim| own.window.entry < stay.exit && stay.entry < own.window.exit;
            *piece = piece.get().filter(overlaps).into();
        }
        self.add(claim, is_firm);
    }
}

/// The end of the windows that follow one another from `entry` on.
fn reached(entry: GnssTime, claims: impl Iterator<Item = Claim> + Clone) -> Option<GnssTime> {
    let mut end = entry;
    for _ in 0..PIECES {
        let further = |claim: &Claim| claim.window.entry <= end && claim.window.exit > end;
        end = claims.clone().filter(further).map(|claim| claim.window.exit).max().unwrap_or(end);
    }
    (end > entry).then_some(end)
}

/// Two windows as one, if there is no time between them.
fn joined(one: &Window, other: &Window) -> Option<Window> {
    let do_join = one.entry <= other.exit && other.entry <= one.exit;
    do_join.then(|| Window { entry: one.entry.min(other.entry), exit: one.exit.max(other.exit) })
}

/// Two windows as one; the second alone if there is time between them.
fn joined_or(one: &Window, other: &Window) -> Window {
    joined(one, other).unwrap_or(*other)
}

#[cfg(test)]
mod tests;
