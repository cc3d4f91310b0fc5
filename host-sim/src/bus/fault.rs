//! Seeded faults in front of a node of any bus: frames that it receives are dropped, corrupted, duplicated or delayed.
//!
//! A corrupt bit stands for an error that CAN's own CRC does not see: in a gateway, in a memory, in a driver. Frames
//! that the node sends are not changed; wrap the nodes that receive them.

use super::memory::{insert, take};
use super::{Bus, Frame};
use crate::streams::{Purpose, stream, unit};
use holdover::time::{Duration, Instant};
use rand_chacha::ChaCha8Rng;
use std::collections::VecDeque;
use std::io;

/// The rate of each fault: fractions of all frames, 0 to 1, independent of one another.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FaultModel {
    /// Fraction of frames that never arrive.
    pub drop: f64,
    /// Fraction of frames with one bit of the data flipped.
    pub corrupt: f64,
    /// Fraction of frames that arrive twice.
    pub duplicate: f64,
    /// Fraction of frames that arrive late, and so perhaps after later frames.
    pub delay: f64,
    /// The longest delay; delays are uniform up to it.
    pub longest_delay: Duration,
}

/// Counts of the faults so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FaultCounts {
    /// Frames that came from the bus.
    pub frames: u64,
    /// Of these, dropped.
    pub dropped: u64,
    /// Of the others, corrupted.
    pub corrupted: u64,
    /// Of the others, duplicated.
    pub duplicated: u64,
    /// Of the others, delayed.
    pub delayed: u64,
}

/// A node of a bus, with seeded faults on its receiving side.
#[derive(Debug)]
pub struct Faults<B> {
    bus: B,
    model: FaultModel,
    generator: ChaCha8Rng,
    arrived: VecDeque<(Instant, Frame)>,
    counts: FaultCounts,
}

impl<B: Bus> Faults<B> {
    /// Wraps the node of the vehicle with this index.
    pub fn new(bus: B, model: FaultModel, seed: u64, vehicle: u32) -> Self {
        let generator = stream(seed, Purpose::BusFaults(vehicle));
        Self { bus, model, generator, arrived: VecDeque::new(), counts: FaultCounts::default() }
    }

    /// Counts of the faults so far.
    pub fn counts(&self) -> FaultCounts {
        self.counts
    }

    fn arrive(&mut self, at: Instant, frame: Frame) {
        // All numbers are drawn in any case, so that one kind of fault does not shift the others.
        let mut draw = || unit(&mut self.generator);
        let (drop, corrupt, bit, duplicate, delay, share) = (draw(), draw(), draw(), draw(), draw(), draw());
        self.counts.frames += 1;
        if drop < self.model.drop {
            self.counts.dropped += 1;
            return;
        }
        let (mut at, mut frame) = (at, frame);
        if corrupt < self.model.corrupt {
            self.counts.corrupted += 1;
            frame = frame.with_flipped_bit((bit * 64.0) as usize);
        }
        if delay < self.model.delay {
            self.counts.delayed += 1;
            at = at.plus(Duration::from_micros((self.model.longest_delay.as_micros() as f64 * share) as i64));
        }
        insert(&mut self.arrived, at, frame);
        if duplicate < self.model.duplicate {
            self.counts.duplicated += 1;
            insert(&mut self.arrived, at, frame);
        }
    }
}

impl<B: Bus> Bus for Faults<B> {
    fn send(&mut self, at: Instant, frame: Frame) -> io::Result<()> {
        self.bus.send(at, frame)
    }

    fn receive(&mut self, upto: Instant) -> io::Result<Option<(Instant, Frame)>> {
        while let Some((at, frame)) = self.bus.receive(upto)? {
            self.arrive(at, frame);
        }
        Ok(take(&mut self.arrived, upto))
    }
}

#[cfg(test)]
mod tests {
    use super::super::memory::MemoryBus;
    use super::*;
    use embedded_can::Frame as _;

    const FRAMES: u64 = 4000;

    /// The arrivals of 4000 frames, 1 ms apart, whose data is their number.
    fn arrivals(model: FaultModel, seed: u64) -> (Vec<(Instant, Frame)>, FaultCounts) {
        let bus = MemoryBus::new();
        let (mut sender, node) = (bus.node(), bus.node());
        let mut receiver = Faults::new(node, model, seed, 2);
        let mut received = Vec::new();
        for number in 0..FRAMES {
            let now = Instant::from_micros(1000 * number);
            sender.send(now, Frame::standard(0x100, &number.to_be_bytes()).unwrap()).unwrap();
            received.extend(std::iter::from_fn(|| receiver.receive(now).unwrap()));
        }
        received.extend(std::iter::from_fn(|| receiver.receive(Instant::from_micros(u64::MAX)).unwrap()));
        (received, receiver.counts())
    }

    fn number((_, frame): &(Instant, Frame)) -> u64 {
        u64::from_be_bytes(frame.data().try_into().unwrap())
    }

    #[test]
    fn without_faults_everything_arrives_as_sent() {
        let (received, _) = arrivals(FaultModel::default(), 1);
        assert!(received.iter().map(number).eq(0..FRAMES));
    }

    #[test]
    fn a_tenth_dropped_is_a_tenth_missing() {
        let (received, counts) = arrivals(FaultModel { drop: 0.1, ..FaultModel::default() }, 1);
        assert_eq!(received.len() as u64, FRAMES - counts.dropped);
        assert!((320..480).contains(&counts.dropped), "{}", counts.dropped);
    }

    #[test]
    fn a_corrupt_frame_differs_in_exactly_one_bit() {
        let (received, counts) = arrivals(FaultModel { corrupt: 0.1, ..FaultModel::default() }, 1);
        let flipped: Vec<u32> =
            (0..).zip(&received).map(|(sent, got): (u64, _)| (sent ^ number(got)).count_ones()).collect();
        assert!(flipped.iter().all(|&bits| bits <= 1));
        assert_eq!(flipped.iter().map(|&bits| u64::from(bits)).sum::<u64>(), counts.corrupted);
        assert!((320..480).contains(&counts.corrupted), "{}", counts.corrupted);
    }

    #[test]
    fn a_duplicate_follows_its_original() {
        let (received, counts) = arrivals(FaultModel { duplicate: 0.1, ..FaultModel::default() }, 1);
        assert_eq!(received.windows(2).filter(|pair| pair[0] == pair[1]).count() as u64, counts.duplicated);
        assert_eq!(received.len() as u64, FRAMES + counts.duplicated);
    }

    #[test]
    fn a_delayed_frame_is_late_by_no_more_than_the_longest_delay_and_can_be_overtaken() {
        let longest_delay = Duration::from_millis(5);
        let (received, counts) = arrivals(FaultModel { delay: 0.1, longest_delay, ..FaultModel::default() }, 1);
        assert_eq!(received.len() as u64, FRAMES);
        assert!(received.is_sorted_by_key(|(at, _)| *at));
        let late = |timed: &(Instant, Frame)| timed.0.as_micros() - 1000 * number(timed);
        assert!(received.iter().all(|timed| late(timed) <= 5000));
        assert!(received.iter().filter(|timed| late(timed) > 0).count() as u64 <= counts.delayed);
        assert!(!received.is_sorted_by_key(number));
    }

    #[test]
    fn the_same_seed_gives_the_same_faults() {
        let model =
            FaultModel { drop: 0.1, corrupt: 0.1, duplicate: 0.1, delay: 0.1, longest_delay: Duration::from_millis(9) };
        assert_eq!(arrivals(model, 1), arrivals(model, 1));
        assert_ne!(arrivals(model, 1), arrivals(model, 2));
    }
}
