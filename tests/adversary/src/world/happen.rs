//! The events of a world: an event enters and changes the world; messages that no station sent are put on the bus.

use super::World;
use crate::judge::WISHED;
use crate::peer::{Limits, Motion};
use crate::scenario::What;
use crate::wire::{BOOK, Can};

impl World<'_> {
    pub(super) fn happen(&mut self, now: f64, what: What) {
        match what {
            What::Drive { peer, demand } => self.others[peer].demand = demand,
            What::Limits { peer, braking, pulling } => self.others[peer].limits = Limits::new(braking, pulling),
            What::Length { peer, published } => {
                self.others[peer].length = published.max(self.others[peer].set_up.length);
            }
            What::Mute { peer, seconds } => {
                let until = &mut self.others[peer].mute_until;
                *until = until.max(now + seconds);
            }
            What::Deaf { seconds } => self.deaf_until = self.deaf_until.max(now + seconds),
            What::NoTime { seconds } => self.timeless_until = self.timeless_until.max(now + seconds),
            What::Torn { peer, half, messages } => self.torn = Some((peer, half, messages)),
            What::Overtaken { peer, half } => self.overtaken = Some((peer, half, None)),
            What::Slot { peer, slot } => self.slot_requests.push((peer, slot)),
            What::Station { peer, station } => self.others[peer].rename(station),
            What::Follow { station } => self.follow = station,
            What::Wanted { speed } => {
                self.note_wanted_before(now);
                self.wanted = speed;
            }
            What::CutIn { peer } => self.cutting_in.push(peer),
            What::Leave { peer } => self.others[peer].on_lane = false,
            What::Blind { seconds } => self.blind_until = now + seconds,
            What::Copies { peer, count, off } => self.copies = Some((peer, count, off)),
            What::Garbage { count } => self.garbage(now, count),
            What::Forged { peer, count, off } => self.forged = Some((peer, count, off)),
            What::Intruder { peer, station, count } => self.intruder = Some((peer, station, count)),
            What::SyncOff { seconds } => self.sync_off = seconds,
            What::Missed { ticks } => self.missed = ticks,
            What::NoEgo { seconds } => self.egoless_until = now + seconds,
            What::Well => self.be_well(now),
        }
    }

    /// Frames that no sender of the catalogue sent: wrong lengths, wrong checksums, identifiers that no sender has.
    fn garbage(&mut self, now: f64, count: u32) {
        let command = BOOK.command.id;
        for number in 0..count {
            let bits = self.random.bits();
            let length = if number % 5 == 4 { (bits >> 60) as u8 % 8 } else { 8 };
            let id = command - 2 + (self.random.bits() % 192) as u16;
            let frame = Can { id, data: bits.to_le_bytes(), length };
            // One in 256 has a valid checksum. That frame would be a forgery, so it is not sent.
            if !BOOK.is_intact(&frame) {
                self.ego.put(now + 1e-5 * f64::from(number), &frame);
            }
        }
    }

    /// What was wanted, or driven, until now counts on for a while.
    pub(super) fn note_wanted_before(&mut self, now: f64) {
        let (before, until) = self.wanted_before;
        let still = if now < until + WISHED { before } else { 0.0 };
        self.wanted_before = (self.wanted.max(still).max(self.ego.body.speed), now);
    }

    fn be_well(&mut self, now: f64) {
        self.well = Some(now);
        (self.deaf_until, self.timeless_until, self.blind_until, self.egoless_until) = (0.0, 0.0, 0.0, 0.0);
        (self.torn, self.overtaken, self.missed) = (None, None, 0);
        (self.copies, self.forged, self.intruder) = (None, None, None);
        self.cutting_in.clear();
        self.ego.heal();
        for other in &mut self.others {
            other.mute_until = 0.0;
            other.on_lane &= other.station != 0;
        }
        self.note_wanted_before(now);
        self.wanted = self.wanted.max(10.0);
        self.follow = self.nearest().map_or(0, |nearest| nearest.station);
    }

    /// Whether a message is held back. The message that overtakes it, with the same tag, finds its other half on the
    /// bus.
    pub(super) fn is_overtaken(&mut self, at: f64, number: usize, slot: u8, motion: &Motion) -> bool {
        let Some((_, half, held)) = self.overtaken.filter(|(peer, ..)| *peer == number) else { return false };
        let Some(held) = held else {
            let is_young = at - motion.at < 0.3;
            if is_young {
                self.overtaken = Some((number, half, Some(*motion)));
            }
            return is_young;
        };
        let meets = held.tag == motion.tag && held.at < motion.at;
        if meets {
            let frames = held.frames(slot, &mut self.ego.modem);
            self.ego.put(at, &frames[1 - usize::from(half)]);
        }
        if meets || at - held.at > 1.0 {
            self.overtaken = None;
        }
        false
    }

    /// Sends copies, forgeries and motions of another station, just after a message of this peer.
    pub(super) fn misuse(&mut self, at: f64, number: usize, slot: u8, motion: &Motion, is_taken: bool) {
        // A false motion has to contradict the bound, so it waits for an honest motion that was accepted.
        let is_seen_false = |off: f64| off == 0.0 || is_taken;
        if let Some((_, count, off)) = self.copies.filter(|(peer, _, off)| *peer == number && is_seen_false(*off)) {
            self.copies = None;
            let copy = Motion {
                position: motion.position + off,
                stamp: motion.stamp + i64::from(off != 0.0) * 1000,
                ..*motion
            };
            for _ in 0..count {
                self.put_both(at, slot, &copy);
            }
        }
        if let Some((_, count, off)) = self.forged.filter(|(peer, ..)| *peer == number) {
            self.forged = None;
            for turn in 1..=count {
                let ahead = f64::from(turn) * 0.001;
                let forged = Motion {
                    position: motion.position + off + motion.speed * ahead,
                    stamp: motion.stamp + i64::from(turn) * 1000,
                    tag: (motion.tag + turn as u8) % 4,
                    ..*motion
                };
                self.put_both(at + ahead, slot, &forged);
            }
        }
        if let Some((_, station, count)) = self.intruder.filter(|(peer, ..)| *peer == number) {
            self.intruder = (count > 1).then_some((number, station, count - 1));
            let other = Motion { station, position: motion.position + 300.0, speed: 20.0, ..*motion };
            self.put_both(at, slot, &other);
        }
    }

    fn put_both(&mut self, at: f64, slot: u8, motion: &Motion) {
        for frame in motion.frames(slot, &mut self.ego.modem) {
            self.ego.put(at + 0.0005, &frame);
        }
    }
}
