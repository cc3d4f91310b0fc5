//! The harness on a bus in memory: good devices pass, and each kind of bad one has its own clear verdict.

use embedded_can::{Frame as _, Id};
use holdover::Config;
use holdover::time::Duration;
use holdover::wire::catalogue::{About, Content, Speaker};
use holdover::wire::{BaseId, Identifier, Identifiers, StationHash, Transport, e2e};
use holdover_sim::bus::{Frame, Port};
use holdover_sim::commands::hil::judge::{LATENCY_P99_MS, Results, judge};
use holdover_sim::commands::hil::lock_step;
use holdover_sim::commands::hil::rig::Rig;
use holdover_sim::commands::hil::session::{self, Setup};
use holdover_sim::commands::hil::virtual_bus::{Behaviour, VirtualRig, bench};
use holdover_sim::input::scenario::{Overrides, Scenario};
use holdover_sim::sim::world::{self, MOST_TICKS};
use holdover_sim::verdict::Verdict;
use std::collections::VecDeque;
use std::io;
use std::path::Path;

/// A scenario by messages alone.
fn setup(scenario: &str, faults: &[&str]) -> Setup {
    setup_with(scenario, faults, &Overrides::MESSAGES_ALONE)
}

fn setup_with(scenario: &str, faults: &[&str], overrides: &Overrides) -> Setup {
    let scenario = Scenario::parse(Path::new("test"), scenario, overrides).unwrap();
    let config = world::config(&scenario, scenario.ego);
    let faults = faults.iter().map(|fault| fault.parse().unwrap()).collect();
    let (wait, latency_p99_ms) = (Duration::from_millis(3000), LATENCY_P99_MS);
    Setup { scenario, config, wait, latency_p99_ms, faults, most_ticks: MOST_TICKS }
}

/// Four seconds on a clean channel.
const SHORT: &str = "duration_s = 4\n[channel]\noutages = []\nloss = 0.0";

fn step(setup: &Setup, change: impl FnOnce(&mut Behaviour)) -> Results {
    let mut behaviour = Behaviour::good(setup.config, true);
    change(&mut behaviour);
    let (port, mut rig) = bench(behaviour);
    let outcome = lock_step::run(setup, port, &mut rig, |_| {}).unwrap();
    judge(setup, &outcome)
}

fn run(setup: &Setup, change: impl FnOnce(&mut Behaviour)) -> Results {
    let mut behaviour = Behaviour::good(setup.config, false);
    change(&mut behaviour);
    let (port, mut rig) = bench(behaviour);
    let outcome = session::run(setup, port, &mut rig, |_| {}).unwrap();
    judge(setup, &outcome)
}

#[test]
fn a_good_device_passes_the_papers_scenario_and_its_twin_is_never_far_from_it() {
    let results = run(&setup("", &[]), |_| {});
    assert_eq!((results.verdict, &results.reasons[..]), ("passed", &[][..]));
    let (device, deviation, timing) = (&results.device, &results.deviation, &results.timing);
    assert!(device.commands >= 2000 && deviation.ticks >= 2000);
    // 20 s with 4 s of silence: holdover is what it is for.
    assert!(device.modes["holdover"] > 300 && device.modes["cooperative"] > 1500, "{:?}", device.modes);
    assert!(!device.modes.contains_key("fault"));
    assert_eq!((device.e2e_errors, device.restarts, timing.missed_periods, timing.harness.lost), (0, 0, 0, 0));
    // Device and twin tick 0.3 ms apart: at 11 m/s that is 3.3 mm, and the wire rounds.
    assert!(deviation.position_m < 0.02, "{}", deviation.position_m);
    assert!(timing.latency.max_ms.unwrap() < 10.5 && timing.harness.lateness.max_ms.unwrap() < 0.5);
}

#[test]
fn in_lock_step_device_and_twin_say_the_same_bit_for_bit() {
    let results = step(&setup("", &[]), |_| {});
    assert_eq!((results.verdict, &results.reasons[..]), ("passed", &[][..]));
    assert_eq!((results.deviation.ticks, results.deviation.different_frames), (2100, 0));
    assert!(results.deviation.frames > 3 * 2100, "{}", results.deviation.frames);
}

#[test]
fn with_range_sensors_and_the_envelope_too_device_and_twin_say_the_same_bit_for_bit() {
    let setup = setup_with("", &[], &Overrides::default());
    assert!(setup.config.envelope.is_some() && setup.config.range_sensor);
    let results = step(&setup, |_| {});
    assert_eq!((results.verdict, &results.reasons[..]), ("passed", &[][..]));
    assert_eq!((results.deviation.ticks, results.deviation.different_frames), (2100, 0));
}

/// The same over CAN FD.
const SHORT_FD: &str = "duration_s = 4\n[bus]\nkind = \"fd\"\n[channel]\noutages = []\nloss = 0.0";

#[test]
fn over_can_fd_a_good_device_passes_and_says_what_its_twin_says() {
    let setup = setup(SHORT_FD, &[]);
    let results = step(&setup, |_| {});
    assert_eq!((results.verdict, &results.reasons[..]), ("passed", &[][..]));
    assert_eq!((results.deviation.ticks, results.deviation.different_frames), (500, 0));
    let results = run(&setup, |_| {});
    assert_eq!((results.verdict, &results.reasons[..]), ("passed", &[][..]));
    assert!(results.device.commands >= 400 && results.deviation.position_m < 0.02);
    assert!(results.timing.latency.max_ms.unwrap() < 10.5);
}

#[test]
fn over_can_fd_faults_of_the_bus_are_played_and_a_device_of_the_other_bus_is_found_silent() {
    for (fault, is_refused) in [("corrupt@1:1", "checksum"), ("truncate@1:1", "length"), ("foreign@1:1", "")] {
        let setup = setup(&SHORT_FD.replace("= 4", "= 12"), &[fault]);
        let results = run(&setup, |_| {});
        assert!(results.faults.len() == 1, "{fault}");
        assert!(
            is_refused.is_empty() || results.device.refusals.contains_key(is_refused),
            "{:?}",
            results.device.refusals
        );
    }
    let results = run(&setup(SHORT_FD, &[]), |behaviour| behaviour.config.transport = Transport::Classic);
    assert_eq!(results.verdict, "failed");
}

#[test]
fn on_other_identifiers_of_11_and_29_bits_a_good_device_passes_and_says_what_its_twin_says() {
    let extended = |number| Identifier::extended(number).unwrap();
    let block = Identifiers::block(BaseId::new(0x300).unwrap());
    let motion = Content::Said(Speaker::Ego, About::MotionA);
    let placed = Identifiers::DEFAULT
        .place(Content::Command, extended(0x0CFF_0210))
        .and_then(|placed| placed.place(Content::DriverRequest, Identifier::standard(0x123)?))
        .and_then(|placed| placed.place(motion, extended(0x0CFF_0321)))
        .map(|placed| placed.place_peers(About::MotionA, extended(0x18FF_4021), 0x100))
        .unwrap();
    for identifiers in [block, placed] {
        let mut setup = setup(SHORT, &[]);
        setup.scenario.identifiers = identifiers;
        setup.config = world::config(&setup.scenario, setup.scenario.ego);
        for results in [step(&setup, |_| {}), run(&setup, |_| {})] {
            assert_eq!((results.verdict, &results.reasons[..]), ("passed", &[][..]));
            assert!(results.device.modes["cooperative"] > 300, "{:?}", results.device.modes);
        }
        // A device that listens to the block of the default does not drive.
        let results = run(&setup, |behaviour| behaviour.config.identifiers = Identifiers::DEFAULT);
        assert_eq!(results.verdict, "failed");
    }
}

#[test]
fn in_lock_step_one_wrong_bit_of_a_device_is_found_and_named() {
    let results = step(&setup(SHORT, &[]), |behaviour| behaviour.garble = one_step_too_much);
    assert_eq!(results.verdict, "failed");
    assert!(results.deviation.different_frames > 0);
    assert!(results.reasons[0].contains("frames are not the twin's; the first at"), "{:?}", results.reasons);
}

#[test]
fn a_device_that_its_own_station_calls_otherwise_is_called_so_on_its_bus() {
    // The firmware has station 1, which in this world is the leader's.
    let mut setup = setup(SHORT, &[]);
    setup.config = Config::car(StationHash(1));
    let results = step(&setup, |_| {});
    assert_eq!((results.verdict, &results.reasons[..]), ("passed", &[][..]));
    assert!(results.device.modes["cooperative"] > 300);
}

#[test]
fn a_silent_device_is_a_verdict() {
    for lock_step in [false, true] {
        let setup = setup(SHORT, &[]);
        let (port, mut rig) = bench(Behaviour::good(setup.config, !lock_step)); // waits for what never comes
        rig.power(false).unwrap();
        let mut rig = NoPower { rig, ended: None };
        let outcome = match lock_step {
            true => lock_step::run(&setup, port, &mut rig, |_| {}),
            false => session::run(&setup, port, &mut rig, |_| {}),
        };
        let results = judge(&setup, &outcome.unwrap());
        assert_eq!((results.verdict, results.code()), ("failed", Verdict::Failed));
        assert_eq!(results.reasons, ["the device is silent: not one frame of it in 3 s"]);
    }
}

#[test]
fn a_device_that_goes_half_way_is_a_verdict_before_the_end_of_the_run() {
    let results = run(&setup("", &[]), |behaviour| behaviour.dies_after = Some(Duration::from_millis(9_000)));
    assert_eq!(results.verdict, "failed");
    assert!(results.reasons[0].starts_with("the device is gone: its last frame was at "), "{:?}", results.reasons);
    assert!(results.device.commands < 900);
    let results = step(&setup("", &[]), |behaviour| behaviour.dies_after = Some(Duration::from_millis(1_000)));
    assert!(results.reasons[0].starts_with("the device is gone"), "{:?}", results.reasons);
}

#[test]
fn a_late_device_is_a_verdict() {
    let results = run(&setup(SHORT, &[]), |behaviour| behaviour.latency = Duration::from_millis(24));
    assert_eq!(results.verdict, "failed");
    assert!(results.reasons[0].starts_with("late: commands 3"), "{:?}", results.reasons);
}

#[test]
fn how_late_is_too_late_can_be_said() {
    let mut setup = setup(SHORT, &[]);
    setup.latency_p99_ms = 5.0;
    let results = run(&setup, |behaviour| behaviour.latency = Duration::from_millis(7));
    assert!(
        results.reasons[0].ends_with("ms after the motion in one of 100, of at most 5 ms"),
        "{:?}",
        results.reasons
    );
}

#[test]
fn a_late_harness_is_inconclusive_whatever_the_device_does() {
    let stall = (Duration::from_millis(4_000), Duration::from_millis(60));
    let results = run(&setup(SHORT, &[]), |behaviour| behaviour.stalls = [stall].into());
    assert_eq!((results.verdict, results.code()), ("inconclusive", Verdict::Inconclusive));
    assert!(results.reasons[0].starts_with("the harness was 5"), "{:?}", results.reasons);
    assert!(results.timing.harness.lateness.max_ms.unwrap() > 50.0);
}

/// So many times in a run, from the first millisecond on and so many apart, the harness stands still for so long.
fn stalls(count: i64, first: i64, apart: i64, length: i64) -> VecDeque<(Duration, Duration)> {
    let stall = |index: i64| (Duration::from_millis(first + apart * index), Duration::from_millis(length));
    (0..count).map(stall).collect()
}

#[test]
fn what_a_device_does_while_the_harness_is_late_is_not_put_down_to_it() {
    // The device and its line stand still 13 times in the run, as a process does that gets no processor.
    let results = |stalls| {
        run(&setup(SHORT, &[]), |behaviour| {
            behaviour.pause = Some((Duration::from_millis(310), Duration::from_millis(15)));
            behaviour.stalls = stalls;
        })
    };
    let missed = |results: &Results| (results.verdict, results.timing.missed_periods);
    assert_eq!(missed(&results(stalls(0, 0, 0, 0))), ("failed", 13));
    let together = results(stalls(18, 1240, 310, 19));
    assert_eq!(missed(&together), ("passed", 0), "{:?}", together.reasons);
    assert_eq!(together.timing.disturbed_commands, 52, "{:?}", together.timing);
    // At other times, it is no excuse.
    let apart = results(stalls(20, 150, 310, 19));
    assert_eq!(missed(&apart), ("failed", 13), "{:?}", apart.timing);
    assert_eq!(apart.reasons, ["late: 13 periods without a command"]);
}

#[test]
fn a_short_lateness_of_the_harness_excuses_no_long_silence_of_the_device() {
    for stalls in [VecDeque::new(), stalls(2, 3_390, 2_900, 14)] {
        let results = run(&setup(SHORT, &[]), |behaviour| {
            behaviour.pause = Some((Duration::from_millis(2_900), Duration::from_millis(500)));
            behaviour.stalls = stalls.clone();
        });
        assert_eq!(results.verdict, "failed", "{:?}", results.timing);
        assert!(results.timing.missed_periods > 80, "{stalls:?} {:?}", results.timing);
        assert!(results.timing.latency.max_ms.unwrap() > 400.0, "{stalls:?} {:?}", results.timing);
    }
}

#[test]
fn a_harness_that_is_late_around_most_of_the_commands_judges_none() {
    for (apart, verdict) in [(120, "passed"), (90, "inconclusive")] {
        let results = run(&setup(SHORT, &[]), |behaviour| behaviour.stalls = stalls(70, 0, apart, 15));
        assert_eq!(results.verdict, verdict, "{apart}: {:?} {:?}", results.reasons, results.timing);
        if verdict == "inconclusive" {
            assert!(results.reasons[0].starts_with("the harness was late around "), "{:?}", results.reasons);
        }
    }
}

#[test]
fn a_device_whose_process_ended_has_failed_however_late_the_harness_was() {
    let setup = setup(SHORT, &[]);
    let mut behaviour = Behaviour::good(setup.config, false);
    behaviour.stalls = [(Duration::from_millis(1_500), Duration::from_millis(60))].into();
    behaviour.dies_after = Some(Duration::from_millis(2_000));
    for (ended, verdict) in [(Some("exit status: 7"), Verdict::Failed), (None, Verdict::Inconclusive)] {
        let (port, rig) = bench(behaviour.clone());
        let mut rig = NoPower { rig, ended };
        let results = judge(&setup, &session::run(&setup, port, &mut rig, |_| {}).unwrap());
        assert_eq!(results.code(), verdict, "{:?}", results.reasons);
        let says_late = results.reasons.iter().any(|reason| reason.starts_with("the harness was "));
        assert_eq!(says_late, ended.is_none(), "{:?}", results.reasons);
        assert!(results.reasons.last().unwrap().starts_with("the device is gone"), "{:?}", results.reasons);
    }
}

#[test]
fn a_device_whose_protection_is_wrong_is_a_verdict() {
    let results = run(&setup(SHORT, &[]), |behaviour| behaviour.garble = |frame| frame.with_flipped_bit(17));
    assert_eq!(results.verdict, "failed");
}

#[test]
fn a_device_that_answers_something_else_than_its_twin_is_a_verdict() {
    let results = run(&setup(SHORT, &[]), |behaviour| behaviour.garble = one_step_too_much);
    assert_eq!(results.verdict, "failed");
    assert!(results.deviation.unexplained > 100, "{:?}", results.deviation);
}

/// A seventieth of the time it stands still, as an emulator does that gets no processor.
fn pauses(behaviour: &mut Behaviour) {
    behaviour.pause = Some((Duration::from_millis(1_770), Duration::from_millis(25)));
}

#[test]
fn a_device_that_stands_still_now_and_then_differs_by_what_its_time_stamps_explain() {
    let results = run(&setup("", &[]), pauses);
    assert_eq!(results.deviation.unexplained, 0, "{:?}", results.reasons);
    assert!(results.deviation.command_mps2 > 0.02 || results.deviation.position_m > 0.1, "{:?}", results.deviation);
}

#[test]
fn what_is_wrong_with_a_device_is_not_explained_by_its_standing_still() {
    let wrong: [fn(&mut Behaviour); 2] = [
        |behaviour| behaviour.garble = one_step_too_much,
        |behaviour| behaviour.config.prediction.model.standstill = false, // keeps 2 m less than its twin
    ];
    for wrong in wrong {
        let results = run(&setup(SHORT, &[]), |behaviour| {
            pauses(behaviour);
            wrong(behaviour);
        });
        assert_eq!(results.verdict, "failed");
        assert!(results.deviation.unexplained > 100, "{:?}", results.deviation);
    }
}

/// Adds 0.256 m/s² to every command, well protected.
fn one_step_too_much(frame: Frame) -> Frame {
    let Id::Standard(id) = frame.id() else { return frame };
    let Ok(mut data) = <[u8; 8]>::try_from(frame.data()) else { return frame };
    if id.as_raw() != 0x482 {
        return frame;
    }
    // Acceleration is bits 12 to 25, by 2 mm/s².
    let raw = u64::from_le_bytes(data);
    let field = (raw >> 12).wrapping_add(128) & 0x3FFF;
    data = ((raw & !(0x3FFF << 12)) | field << 12).to_le_bytes();
    Frame::standard(0x482, &e2e::protect(data, 0x4802, data[1] & 15)).unwrap()
}

/// Nobody can give the device power.
struct NoPower {
    rig: VirtualRig,
    /// How its process ended.
    ended: Option<&'static str>,
}

impl Rig for NoPower {
    fn power(&mut self, _: bool) -> io::Result<()> {
        Ok(())
    }

    fn interface(&mut self, up: bool) -> io::Result<()> {
        self.rig.interface(up)
    }

    fn injector(&mut self) -> io::Result<&mut dyn Port> {
        self.rig.injector()
    }

    fn has_ended(&mut self) -> Option<String> {
        self.ended.map(str::to_owned)
    }
}
