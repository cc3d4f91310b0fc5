//! Nothing stale leaves: a unit, its outbox and each CAN controller, on a bus that is blocked for five seconds, and behind it an
//! actuator that checks end to end. The registers are those of a model.

/// The board's own sources, with the places that they have there.
#[path = "../src/board"]
#[allow(dead_code)]
mod board {
    pub mod acceptance;
    pub mod bit_time;
    pub mod frame;
    pub mod outbox;
    pub mod port;
    pub mod registers;
    pub mod stm32f405 {
        pub mod can;
        pub mod mailbox;
    }
    pub mod stm32g474 {
        pub mod element;
        pub mod fdcan;
    }
    pub mod zynqmp_r5 {
        pub mod can;
        pub mod layout;
    }
}

mod chips;

use board::frame::CanFrame;
use board::outbox::{MOST_AGE, Outbox, Pass};
use board::port::Port;
use chips::{Chip, same, standard};
use embedded_can::{Frame, Id, StandardId};
use holdover::health::{Cause, Incident};
use holdover::time::{Duration, Instant};
use holdover::wire::{Identifiers, Message, Received, Receiver, Role, StationHash};
use holdover::{Config, OnboardUnit};
use std::ops::Range;

/// A frame of a message in five parts, as an own horizon is, and of what comes last.
const PARTS: u16 = 0x492;
const HEALTH: u16 = 0x498;
const COMMAND: u16 = 0x482;

/// One that was on the bus: when, and the tick that it is from.
struct Sent {
    at: Instant,
    tick: Instant,
    frame: CanFrame,
}

impl Sent {
    fn is(&self, id: u16) -> bool {
        self.frame.id() == Id::from(StandardId::new(id).unwrap())
    }

    fn age(&self) -> Duration {
        self.at.since(self.tick)
    }
}

/// The whole way from the unit to the bus, by quarters of a millisecond: about a frame each.
struct Rig<P> {
    unit: OnboardUnit<1, 2, 400>,
    outbox: Outbox,
    port: P,
    /// All that was pushed, with its tick.
    pushed: Vec<(Instant, CanFrame)>,
    sent: Vec<Sent>,
    lost: u32,
    off: u32,
}

impl<P: Port> Rig<P> {
    fn new(port: P) -> Self {
        let unit = OnboardUnit::new(&Config::car(StationHash(1))).unwrap();
        Self { unit, outbox: Outbox::new(), port, pushed: vec![], sent: vec![], lost: 0, off: 0 }
    }

    fn push(&mut self, tick: Instant, frame: CanFrame) {
        self.outbox.push(tick, &frame);
        self.pushed.push((tick, frame));
    }

    /// Runs for these ticks. In each quarter of a millisecond the bus either takes a frame, or fails to.
    fn run(&mut self, ticks: Range<u64>, chip: &impl Chip, is_blocked: bool) {
        for number in ticks {
            let tick = Instant::from_micros(number * 10_000);
            let frames = self.unit.tick(tick).frames;
            for frame in &frames {
                self.push(tick, CanFrame::new(frame.id(), frame.data()).unwrap());
            }
            if number.is_multiple_of(10) {
                (0..5).for_each(|part| self.push(tick, standard(PARTS, &[part, number as u8, (number >> 8) as u8])));
            }
            for quarter in 0..40 {
                let at = tick.plus(Duration::from_micros(quarter * 250));
                while self.outbox.pass(at, &mut self.port) == Pass::Taken {}
                if is_blocked {
                    chip.fail();
                    continue;
                }
                for frame in chip.send(1) {
                    let (tick, _) = self.pushed.iter().rfind(|(_, pushed)| same(pushed, &frame)).unwrap();
                    self.sent.push(Sent { at, tick: *tick, frame });
                }
            }
            chip.wait();
            let [(transmit, lost), (bus_off, off)] = self.outbox.lost(&mut self.port);
            assert_eq!([transmit, bus_off], [Incident::TransmitOverflow, Incident::BusOff]);
            self.lost += lost;
            self.off += off;
        }
    }

    /// Of the commands that were sent, the ages of those that an actuator takes, by what it checks end to end.
    fn taken(&self) -> Vec<Duration> {
        let mut actuator = Receiver::<0>::new(Identifiers::DEFAULT, Role::Modem);
        let mut is_taken =
            |sent: &&Sent| matches!(actuator.receive(sent.at, &sent.frame), Ok(Received::Whole(Message::Command(_))));
        self.sent.iter().filter(|sent| sent.is(COMMAND)).filter(|sent| is_taken(sent)).map(Sent::age).collect()
    }

    /// What everything that was pushed has come to.
    fn is_accounted_for(&self, waiting: usize) -> bool {
        self.pushed.len() == self.sent.len() + self.lost as usize + waiting
    }
}

/// A bus that works, is blocked for five seconds, and works again; what is sent then.
fn blocked_for_five_seconds<P: Port>(port: P, chip: &impl Chip) -> Rig<P> {
    let mut rig = Rig::new(port);
    rig.run(0..100, chip, false);
    assert!(rig.is_accounted_for(0) && rig.lost == 0, "nothing is lost on a bus that works");
    rig.run(100..600, chip, true);
    assert!(rig.sent.iter().all(|sent| sent.at < Instant::from_micros(1_000_000)));
    rig.run(600..700, chip, false);
    assert!(rig.is_accounted_for(0), "{} {} {}", rig.pushed.len(), rig.sent.len(), rig.lost);
    rig
}

/// Every frame that leaves is fresh, and the actuator takes fresh commands alone, and soon again.
fn holds<P: Port>(rig: &Rig<P>, most: Duration) {
    let after: Vec<_> = rig.sent.iter().filter(|sent| sent.at >= Instant::from_micros(6_000_000)).collect();
    let oldest = rig.sent.iter().map(Sent::age).max().unwrap();
    assert!(oldest <= most, "{oldest:?}");
    assert!(after[0].is(COMMAND), "the command is the first to leave");
    let taken = rig.taken();
    assert!(taken.iter().all(|age| *age <= most));
    // After a gap in its counter the actuator refuses two commands.
    assert!((190..=200).contains(&taken.len()), "{}", taken.len());
    // 500 commands, 50 pages and 50 messages in five parts have been overtaken, but for the last of each.
    assert!((780..=800).contains(&rig.lost), "{}", rig.lost);
    // The parts of a message leave in their order, and as a whole.
    let parts: Vec<_> = rig.sent.iter().filter(|sent| sent.is(PARTS)).map(|sent| sent.frame.data().to_vec()).collect();
    assert_eq!(parts.len() % 5, 0);
    assert!(parts.chunks(5).all(|message| (0..5).all(|part| message[part][0] == part as u8)));
}

#[test]
fn after_five_seconds_without_an_acknowledge_bxcan_sends_the_newest_of_each_alone() {
    let (port, chip) = chips::stm32::controller();
    let rig = blocked_for_five_seconds(port, &chip);
    holds(&rig, Duration::from_millis(10));
}

#[test]
fn after_five_seconds_without_an_acknowledge_fdcan_sends_the_newest_of_each_alone() {
    let (port, chip) = chips::stm32g474::controller();
    let rig = blocked_for_five_seconds(port, &chip);
    holds(&rig, Duration::from_millis(10));
}

#[test]
fn after_five_seconds_without_an_acknowledge_the_zynqmp_sends_nothing_too_old() {
    let (port, chip) = chips::zynqmp::controller();
    let rig = blocked_for_five_seconds(port, &chip);
    holds(&rig, MOST_AGE);
    // One reset at the start, and one for each frame that grew too old in the controller.
    let resets = chip.resets.get();
    assert!((100..=170).contains(&resets), "{resets}");
}

/// Bus-off in the middle of a burst, and back.
fn off_and_back<P: Port>(port: P, chip: &impl Chip) -> Rig<P> {
    let mut rig = Rig::new(port);
    rig.run(0..100, chip, false);
    let tick = Instant::from_micros(1_000_000);
    (0..20).for_each(|id| rig.push(tick, standard(0x600 + id, &[7])));
    while rig.outbox.pass(tick, &mut rig.port) == Pass::Taken {}
    chip.go_off();
    rig.run(101..200, chip, false);
    assert!(rig.is_accounted_for(0), "{} {} {}", rig.pushed.len(), rig.sent.len(), rig.lost);
    assert_eq!(rig.off, 1);
    rig
}

#[test]
fn after_a_bus_off_nothing_leaves_that_waited_in_a_controller_before_it() {
    let (stm32, g474, zynqmp) =
        (chips::stm32::controller(), chips::stm32g474::controller(), chips::zynqmp::controller());
    let rigs = [
        off_and_back(stm32.0, &stm32.1).sent,
        off_and_back(g474.0, &g474.1).sent,
        off_and_back(zynqmp.0, &zynqmp.1).sent,
    ];
    for sent in &rigs {
        assert!(!sent.iter().any(|sent| sent.frame.data() == [7]));
        let back = sent.iter().find(|sent| sent.at > Instant::from_micros(1_000_000)).unwrap();
        assert!((20..=50).contains(&back.at.since(Instant::from_micros(1_000_000)).as_millis()));
        assert!(back.is(COMMAND) && back.age() < Duration::from_millis(10));
        let since = sent.iter().filter(|sent| sent.at >= back.at && sent.is(HEALTH)).count();
        assert!(since >= 9, "and the unit goes on: {since}");
    }
}

#[test]
fn what_was_lost_by_a_blocked_bus_stands_in_health() {
    let (port, chip) = chips::stm32::controller();
    let mut rig = Rig::new(port);
    rig.run(0..50, &chip, true);
    let lost = rig.lost;
    rig.unit.note(Incident::TransmitOverflow, lost);
    assert!(lost > 40 && rig.unit.health().of(Cause::TransmitOverflow) == lost);
}
