//! Lock step: frames enter, and the unit receives them and ticks by the bus's time synchronisation alone; the answers of
//! its ticks leave. For hardware in the loop: two units that are given the same frames in the same order then say the
//! same, bit for bit, however fast they are and whenever the frames come.
//!
//! The rule, with `T` for the time that the last pair of `Sync` and `FollowUp` gave (`Sync.Seconds` + `FollowUp.Micros`):
//!
//! 1. An intact `Sync` is kept, in place of one that was kept before.
//! 2. An intact `FollowUp` with the kept `Sync`'s sequence sets `T`. The unit receives the two at `T` and ticks at `T`.
//! 3. Any other frame is received at `T` and one period: when the next pair is expected. Before the first pair it is
//!    dropped.
//!
//! Intact is a data frame of its length with the right checksum; what is not intact falls under 3. GNSS time and the unit's
//! own clock are thereby the same.

use embedded_can::Frame;

use crate::config::Config;
use crate::time::Instant;
use crate::unit::{Answer, OnboardUnit};
use crate::wire::bits::Payload;
use crate::wire::catalogue::{self, Content};
#[cfg(feature = "fd")]
use crate::wire::fd;
use crate::wire::sync::{FollowUp, Sync};
use crate::wire::{Data, Frame as WireFrame, Transport, e2e};

/// The shell of a unit in lock step.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct LockStep {
    kept: Option<(WireFrame, Sync)>,
    time: Option<Instant>,
}

/// A step of the time synchronisation.
enum Step {
    Mark(WireFrame, Sync),
    FollowUp(FollowUp),
}

impl LockStep {
    /// Nothing has arrived yet.
    #[must_use]
    pub const fn new() -> Self {
        Self { kept: None, time: None }
    }

    /// Takes the next frame of the bus; the answer of the tick, if it makes the unit tick.
    pub fn receive<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
        &mut self,
        unit: &mut OnboardUnit<PEERS, SAMPLES, STEPS>,
        frame: &impl Frame,
    ) -> Option<Answer> {
        match (step(unit.config(), frame), self.kept) {
            (Some(Step::Mark(frame, sync)), _) => {
                self.kept = Some((frame, sync));
                None
            }
            (Some(Step::FollowUp(follow_up)), Some((mark, sync))) if follow_up.sequence == sync.sequence => {
                self.kept = None;
                let now = Instant::from_micros(follow_up.time_of(&sync).as_micros());
                self.time = Some(now);
                // Refusals are the unit's to count.
                let _ = unit.receive(now, &mark);
                let _ = unit.receive(now, frame);
                Some(unit.tick(now))
            }
            _ => {
                let next = self.time?.plus(unit.config().period);
                let _ = unit.receive(next, frame);
                None
            }
        }
    }
}

/// What step of the time synchronisation an intact frame is.
fn step(config: &Config, frame: &impl Frame) -> Option<Step> {
    let id = frame.id().into();
    let offset = config.identifiers.offset_of(id)?;
    let (_place, line, _) = catalogue::find(offset)?;
    let data = if frame.is_remote_frame() { None } else { Data::new(frame.data()) }?;
    let payload = [match config.transport {
        Transport::Classic => intact(catalogue::data_id(offset), &data)?,
        #[cfg(feature = "fd")]
        Transport::Fd => fd::layout::of(_place)?.intact(catalogue::data_id(offset), &data)?,
        #[cfg(not(feature = "fd"))]
        Transport::Fd => return None,
    }];
    match line.content {
        Content::Sync => Some(Step::Mark(WireFrame { id, data }, Sync::decode(&payload))),
        Content::FollowUp => Some(Step::FollowUp(FollowUp::decode(&payload))),
        _ => None,
    }
}

/// The payload of a classic frame with the right checksum.
fn intact(data_id: u16, data: &[u8]) -> Option<Payload> {
    let data: [u8; 8] = data.try_into().ok()?;
    let [_, counted, ..] = data;
    (e2e::protect(data, data_id, counted) == data).then(|| Payload::from_bytes(data))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::health::Cause;
    use crate::wire::{Identifiers, Message, Sender, StationHash};

    type Unit = OnboardUnit<1, 4, 400>;

    /// A unit in lock step and the sender of what it hears.
    struct Bench {
        unit: Unit,
        shell: LockStep,
        sender: Sender<0>,
    }

    impl Bench {
        fn new() -> Self {
            let unit = Unit::new(&Config::car(StationHash(1))).unwrap();
            Self { unit, shell: LockStep::new(), sender: Sender::new(Identifiers::DEFAULT) }
        }

        fn frame(&mut self, message: &Message) -> WireFrame {
            let mut frame = None;
            self.sender.send(message, &mut |sent| frame = Some(sent)).unwrap();
            frame.unwrap()
        }

        fn pair(&mut self, sequence: u8, micros: u32) -> [WireFrame; 2] {
            let sync = self.frame(&Message::Sync(Sync { sequence, seconds: 1000 }));
            [sync, self.frame(&Message::FollowUp(FollowUp { sequence, micros }))]
        }

        fn give(&mut self, frame: &WireFrame) -> bool {
            self.shell.receive(&mut self.unit, frame).is_some()
        }
    }

    #[test]
    fn the_unit_ticks_once_for_each_pair_at_the_time_of_the_pair() {
        let mut bench = Bench::new();
        for tick in 1..=3 {
            let [sync, follow_up] = bench.pair(tick, u32::from(tick) * 10_000);
            assert!(!bench.give(&sync));
            let answer = bench.shell.receive(&mut bench.unit, &follow_up).unwrap();
            assert_eq!(answer.command.tick, tick);
        }
        let now = Instant::from_micros(1_000_030_000);
        assert!(bench.unit.is_synchronised(now));
        assert_eq!(bench.unit.health().of(Cause::ClockBackwards), 0);
    }

    #[test]
    fn a_follow_up_without_its_own_sync_is_no_tick() {
        let mut bench = Bench::new();
        let ([sync, _], [_, follow_up]) = (bench.pair(1, 0), bench.pair(2, 0));
        assert!(!bench.give(&follow_up));
        assert!(!bench.give(&sync));
        assert!(!bench.give(&follow_up));
    }

    #[test]
    fn a_damaged_step_is_no_step_and_is_counted_by_the_unit() {
        let mut bench = Bench::new();
        for frame in bench.pair(1, 0) {
            bench.give(&frame);
        }
        let [sync, mut follow_up] = bench.pair(2, 10_000);
        follow_up.data[4] ^= 1;
        assert!(!bench.give(&sync) && !bench.give(&follow_up));
        assert_eq!(bench.unit.health().of(Cause::Checksum), 1);
    }

    #[test]
    fn other_frames_are_received_when_the_next_pair_is_expected_and_dropped_before_the_first() {
        use crate::time::GnssTime;
        use crate::units::{Acceleration, Position, Speed};
        use crate::wire::Said;
        use crate::wire::motion::{Motion, WirePosition};
        let mut bench = Bench::new();
        let motion = |tag, micros| {
            Message::Ego(Said::Motion(Motion {
                tag,
                position: WirePosition::from_position(Position::default()),
                speed: Speed::ZERO,
                acceleration: Acceleration::ZERO,
                demand: Acceleration::ZERO,
                stamp: GnssTime::from_micros(micros).stamp(),
                position_accuracy: None,
                speed_accuracy: None,
                station: StationHash(1),
            }))
        };
        let mut frames = Vec::new();
        bench.sender.send(&motion(0, 0), &mut |frame| frames.push(frame)).unwrap();
        frames.drain(..).for_each(|frame| assert!(!bench.give(&frame)));
        assert_eq!(bench.unit.health().total(), 0);
        // With the time of the pair before, the third motion's stamp would lie 10 ms in the future and be refused.
        for step in 1..=3u8 {
            let at = 1_000_000_000 + u64::from(step) * 10_000;
            bench.sender.send(&motion(step, at), &mut |frame| frames.push(frame)).unwrap();
            frames.drain(..).for_each(|frame| assert!(!bench.give(&frame)));
            for frame in bench.pair(step, u32::from(step) * 10_000) {
                bench.give(&frame);
            }
        }
        assert_eq!(bench.unit.health().of(Cause::Future), 0);
        assert_eq!(bench.unit.health().total(), bench.unit.health().of(Cause::NotYetTrusted));
    }
}
