//! What a scenario file means, and what is said of one that cannot be.

use holdover_sim::error::Error;
use holdover_sim::input::impairment::{AppliesTo, Impairment};
use holdover_sim::input::kind::{Difference, Kind};
use holdover_sim::input::scenario::{Overrides, Scenario, Span, Start};
use proptest::prelude::*;
use std::fs;
use std::path::Path;

fn parse(text: &str) -> Result<Scenario, Error> {
    Scenario::parse(Path::new("s.toml"), text, &Overrides::default())
}

fn refused(text: &str) -> String {
    parse(text).expect_err(text).to_string()
}

#[test]
fn the_papers_scenario_is_what_an_empty_file_means() {
    let paper = Scenario::read(Some(Path::new("scenarios/paper.toml")), &Overrides::default()).unwrap();
    assert_eq!(paper, parse("").unwrap());
    assert_eq!(paper, Scenario::read(None, &Overrides::default()).unwrap());
}

#[test]
fn the_papers_scenario_is_pinned() {
    let paper = parse("").unwrap();
    assert_eq!((paper.seed, paper.duration_s, paper.period_s, paper.step_s), (1, 20.0, 0.01, 0.03));
    assert_eq!((paper.message_rate_hz, paper.leader.target_speed_mps, paper.ego), (10.0, 11.0, 2));
    assert_eq!((paper.vehicles.len(), &paper.leader.motion), (5, &None));
    for (index, vehicle) in paper.vehicles.iter().enumerate() {
        assert_eq!(vehicle.start, Start::Gap(Span { low: 12.0, high: 16.0 }), "{index}");
        assert_eq!(vehicle.speed_mps, Span { low: 9.0, high: 11.0 });
        assert_eq!((vehicle.length_m, vehicle.lag_s, vehicle.plant_lag_s), (4.8, 0.3, 0.3));
        assert_eq!((vehicle.time_gap_s, vehicle.standstill_m), (1.0, 2.0));
    }
    assert_eq!(paper.channel.applies_to, AppliesTo::Vehicles(vec![2]));
    let Impairment::Random { delay_mean_s, delay_std_s, loss, duplicate, outages } = paper.channel.impairment else {
        panic!("a recorded channel");
    };
    assert_eq!((delay_mean_s, delay_std_s, loss, duplicate), (0.040, 0.0259, 0.1, 0.0));
    assert_eq!(outages.iter().map(|w| (w.from_s, w.to_s)).collect::<Vec<_>>(), [(4.0, 6.0), (6.0, 8.0)]);
}

#[test]
fn a_unit_drives_by_the_law_of_its_vehicle() {
    let scenario = parse(
        "[[vehicle]]\n[[vehicle]]\ntime_gap_s = 1.25\nsilent_time_gap_s = 2.5\nstandstill_m = 3.5\nfeed_forward = 0.5\n\
         catch_up = 0.1\nlag_s = 0.4\n",
    )
    .unwrap();
    let laws = [0, 1].map(|index| holdover_sim::sim::world::config(&scenario, index).law);
    let gaps = laws.map(|law| [law.time_gap, law.silent_time_gap].map(|gap| gap.to_millis()));
    assert_eq!(gaps, [[1_000, 1_800], [1_250, 2_500]]);
    assert_eq!(laws.map(|law| (law.standstill.to_mm(), law.feed_forward.to_milli())), [(2_000, 0), (3_500, 500)]);
    assert_eq!(laws.map(|law| law.catch_up.to_milli()), [200, 100]);
}

#[test]
fn values_are_taken_as_they_stand() {
    let scenario = parse(
        "seed = 0x10\nduration_s = 1_000\nego = 1\n[leader]\ntarget_speed_mps = 0\n[[vehicle]]\nposition_m = 50\n\
         lag_s = 0.2\n[[vehicle]]\ngap_m = [3, 4]\nplant_lag_s = 0.6\n[channel]\nloss = 1\noutages = []\n\
         applies_to = [0, 1]\n",
    )
    .unwrap();
    assert_eq!((scenario.seed, scenario.duration_s, scenario.ego), (16, 1000.0, 1));
    assert_eq!(scenario.vehicles[0].start, Start::Position(Span { low: 50.0, high: 50.0 }));
    assert_eq!((scenario.vehicles[0].lag_s, scenario.vehicles[0].plant_lag_s), (0.2, 0.2));
    assert_eq!((scenario.vehicles[1].lag_s, scenario.vehicles[1].plant_lag_s), (0.3, 0.6));
    assert_eq!(scenario.channel.applies_to, AppliesTo::Vehicles(vec![0, 1]));
}

#[test]
fn a_kind_brings_its_length_and_lag_and_a_plant_can_be_another() {
    let scenario = parse(
        "[[vehicle]]\nkind = \"bus\"\n[[vehicle]]\nkind = \"van\"\nlength_m = 7\n[vehicle.plant]\nmass_scale = 1.3\n\
         grade = -0.04\nheadwind_mps = 8\nthrottle = 0.5\n",
    )
    .unwrap();
    let [bus, van] = &scenario.vehicles[..] else { panic!("two vehicles") };
    assert_eq!((bus.kind, bus.length_m, bus.lag_s, bus.plant_lag_s), (Kind::Bus, 12.0, 0.5, 0.5));
    assert_eq!(bus.difference, Difference::NONE);
    assert_eq!((van.kind, van.length_m, van.lag_s), (Kind::Van, 7.0, 0.4));
    assert_eq!(van.difference, Difference { mass_scale: 1.3, grade: -0.04, headwind_mps: 8.0, throttle: 0.5 });
}

#[test]
fn the_ego_of_two_vehicles_is_the_second_unless_said_otherwise() {
    assert_eq!(parse("[[vehicle]]\n[[vehicle]]\n").unwrap().ego, 1);
}

#[test]
fn a_scenario_that_cannot_be_is_refused_with_file_line_cause_and_remedy() {
    let cases = [
        ("[[vehicle]]\n[[vehicle]]\nkind = \"tram\"", "s.toml:3: `kind` is \"tram\"; give \"car\", \"van\" or \"bus\""),
        ("[[vehicle]]\n[[vehicle]]\nplant.grade = 0.4", "s.toml:3: `grade` is 0.4; give a share from -0.15 to 0.15"),
        (
            "[[vehicle]]\n[[vehicle]]\nplant.mas_scale = 1",
            "s.toml:3: unknown key \"mas_scale\" in [plant]; write `mass_scale`",
        ),
        ("sead = 1", "s.toml:1: unknown key \"sead\"; write `seed`"),
        ("seed = 1\nego = 1\ndelay_mean = 1", "s.toml:3: unknown key \"delay_mean\"; remove it, or use one of "),
        ("[channel]\ndelay_mean = 1", "s.toml:2: unknown key \"delay_mean\" in [channel]; write `delay_mean_s`"),
        ("[chanel]\nloss = 1", "s.toml:1: unknown key \"chanel\"; write `channel`"),
        ("[[vehicle]]\n[[vehicle]]\nlagg_s = 1", "s.toml:3: unknown key \"lagg_s\" in [[vehicle]]; write `lag_s`"),
        ("seed = 1\nseed = 2", "s.toml:2: is not TOML (duplicate key); correct this line"),
        ("ego = = 2", "s.toml:1: is not TOML ("),
        ("seed = -1", "s.toml:1: `seed` is -1; give a whole number from 0 to 18446744073709551615"),
        (
            "seed = 99999999999999999999",
            "s.toml:1: `seed` is 99999999999999999999; give a whole number from 0 to 18446744073709551615",
        ),
        ("seed = 1.5", "s.toml:1: `seed` is 1.5; give a whole number from 0 to 18446744073709551615"),
        ("duration_s = \"20\"", "s.toml:1: `duration_s` is \"20\"; give seconds from 2 to 86400"),
        ("duration_s = true", "s.toml:1: `duration_s` is true; give seconds from 2 to 86400"),
        ("\nduration_s = inf", "s.toml:2: `duration_s` is inf; give seconds from 2 to 86400"),
        ("step_s = 0", "s.toml:1: `step_s` is 0; give seconds from 0.001 to 1"),
        ("step_s = nan", "s.toml:1: `step_s` is NaN; give seconds from 0.001 to 1"),
        ("period_s = 1979-05-27", "s.toml:1: `period_s` is a date or time; give seconds from 0.001 to 0.1"),
        ("message_rate_hz = 0", "s.toml:1: `message_rate_hz` is 0; give Hz from 0.1 to 1000"),
        (
            "period_s = 0.1\nmessage_rate_hz = 20",
            "s.toml:2: 20 messages a second do not fit ticks of 0.1 s; give `message_rate_hz` up to 10",
        ),
        ("ego = 0", "s.toml:1: `ego` is 0, which follows nobody; give an index from 1 to 4 (0 is the leader)"),
        ("ego = 5", "s.toml:1: `ego` is 5, which follows nobody; give an index from 1 to 4 (0 is the leader)"),
        ("ego = -1", "s.toml:1: `ego` is -1; give a whole number from 0 to 18446744073709551615"),
        ("leader = 3", "s.toml:1: `leader` is 3; give [leader]"),
        ("[leader]\ntarget_speed_mps = 66", "s.toml:2: `target_speed_mps` is 66; give m/s from 0 to 65.534"),
        ("[leader]\nmotion = 1", "s.toml:2: `motion` is 1; give the path of a file in quotes"),
        (
            "[leader]\nmotion = \"no.csv\"",
            "s.toml:2: `motion` names \"no.csv\", which cannot be read (No such file or directory); check the path (a \
             relative one starts from this file's folder)",
        ),
        ("[vehicle]\nlag_s = 1", "s.toml:1: `vehicle` is a table; give one [[vehicle]] per vehicle"),
        ("vehicle = []", "s.toml: 0 [[vehicle]] make no scenario; give from 2 to 11, or none for the paper's five"),
        ("\n[[vehicle]]", "s.toml:2: 1 [[vehicle]] make no scenario; give from 2 to 11, or none for the paper's five"),
        ("[[vehicle]]\nlag_s = -0.3\n[[vehicle]]", "s.toml:2: `lag_s` is -0.3; give seconds from 0 to 1.998"),
        (
            "[[vehicle]]\nspeed_mps = [11, 9]\n[[vehicle]]",
            "s.toml:2: `speed_mps` runs from 11 down to 9; give the smaller",
        ),
        (
            "[[vehicle]]\nspeed_mps = [9, 10, 11]\n[[vehicle]]",
            "s.toml:2: `speed_mps` is a list that has not two numbers; give two numbers such as [9, 11]",
        ),
        (
            "[[vehicle]]\nspeed_mps = [9, \"x\"]\n[[vehicle]]",
            "s.toml:2: `speed_mps` is \"x\"; give m/s from 0 to 65.534",
        ),
        (
            "[[vehicle]]\ngap_m = 3\n[[vehicle]]",
            "s.toml:2: the leader (vehicle 0) has a `gap_m`, and nobody is ahead of it; give it `position_m`, or neither",
        ),
        (
            "[[vehicle]]\nposition_m = 9\n[[vehicle]]\nposition_m = 1\ngap_m = 3",
            "s.toml:5: a vehicle with `position_m` has a `gap_m` too; remove one of the two",
        ),
        ("[[vehicle]]\n[[vehicle]]\ngap_m = 0", "s.toml:3: `gap_m` is 0; give metres from 0.1 to 2000"),
        (
            "[[vehicle]]\nposition_m = [20, 30]\n\n[[vehicle]]\nposition_m = [0, 15.2]",
            "s.toml:4: vehicle 1 can start at 15.2 m, inside vehicle 0, whose rear bumper can be at 15.2 m; list the \
             vehicles from first to last, each behind the one before",
        ),
        (
            "[[vehicle]]\n[[vehicle]]\nposition_m = 9",
            "s.toml:2: vehicle 1 has a position and the leader (vehicle 0) has none; give the leader `position_m` too, \
             or this vehicle `gap_m`",
        ),
        (
            "[[vehicle]]\nposition_m = 3000\n[[vehicle]]\nposition_m = 0",
            "s.toml:3: vehicle 1 can start 3000 m behind the leader; keep all vehicles within 2000 m",
        ),
        ("[channel]\nloss = 1.01", "s.toml:2: `loss` is 1.01; give a share from 0 to 1"),
        ("[channel]\nloss = 10", "s.toml:2: `loss` is 10; give a share from 0 to 1"),
        ("[channel]\ndelay_std_s = -1", "s.toml:2: `delay_std_s` is -1; give seconds from 0 to 10"),
        ("[channel]\noutages = [4, 6]", "s.toml:2: `outages` is 4; give a list of pairs such as [[4, 6]]"),
        (
            "[channel]\noutages = [[1, 2],\n[6, 6]]",
            "s.toml:3: an outage runs from 6 s to 6 s; let it end after it begins",
        ),
        ("[channel]\noutages = [[1]]", "s.toml:2: `outages` is a list that has not two numbers; give two numbers"),
        (
            "[channel]\napplies_to = \"none\"",
            "s.toml:2: `applies_to` is \"none\"; give \"ego\", \"all\", or a list of indices from 0 to 4",
        ),
        (
            "[channel]\napplies_to = [1,\n5]",
            "s.toml:3: `applies_to` is 5; give \"ego\", \"all\", or a list of indices from 0 to 4",
        ),
        (
            "[channel]\ntrace = \"c.csv\"\nloss = 0",
            "s.toml:3: a recorded channel (`trace` in line 2) has no random one beside it; remove `trace`, or every",
        ),
    ];
    for (text, message) in cases {
        let found = refused(text);
        assert!(found.starts_with(message), "{text:?}\n found: {found}\nwanted: {message}");
        assert!(!found.contains('\n'));
    }
}

#[test]
fn at_most_eleven_vehicles_fit_and_the_error_points_at_the_twelfth() {
    assert_eq!(parse(&"[[vehicle]]\n".repeat(11)).unwrap().vehicles.len(), 11);
    assert!(refused(&"[[vehicle]]\n".repeat(12)).starts_with("s.toml:12: 12 [[vehicle]] make no scenario; "));
}

#[test]
fn a_byte_order_mark_and_crlf_are_no_part_of_a_scenario() {
    assert_eq!(parse("\u{feff}seed = 4\r\nego = 3\r\n").unwrap().seed, 4);
    assert!(refused("\u{feff}seed = 4\r\nego = 9\r\n").starts_with("s.toml:2: "));
}

#[test]
fn a_file_that_is_no_text_or_not_there_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("s.toml");
    fs::write(&file, [0xff, 0xfe, 0]).unwrap();
    let read = |file: &Path| Scenario::read(Some(file), &Overrides::default()).unwrap_err().to_string();
    assert!(read(&file).contains("s.toml: is not a text file; give a scenario in TOML"), "{}", read(&file));
    let missing = read(Path::new("no.toml"));
    assert_eq!(missing, "no.toml: cannot be read (No such file or directory); check the path");
}

#[test]
fn starts_are_the_same_for_the_same_seed_inside_their_spans_and_end_at_or_beyond_zero() {
    let paper = parse("").unwrap();
    assert_eq!(paper.initial_states(7), paper.initial_states(7));
    assert_ne!(paper.initial_states(7), paper.initial_states(8));
    for seed in 0..200 {
        let states = paper.initial_states(seed);
        assert!(states.iter().all(|state| (9.0..11.0).contains(&state.speed_mps)));
        for pair in states.windows(2) {
            let gap = pair[0].position_m - pair[1].position_m - 4.8;
            assert!((12.0 - 1e-9..16.0).contains(&gap), "{gap}");
        }
        assert!(states[4].position_m >= 0.0);
    }
}

#[test]
fn fixing_one_number_leaves_all_others_as_they_were_drawn() {
    let vehicles = |first: &str| format!("[[vehicle]]\nposition_m = 90\n{first}\n[[vehicle]]\n[[vehicle]]\n");
    let drawn = parse(&vehicles("")).unwrap().initial_states(3);
    let fixed = parse(&vehicles("speed_mps = 5")).unwrap().initial_states(3);
    assert_eq!(drawn[0].position_m, 90.0);
    assert_eq!(fixed[0].speed_mps, 5.0);
    assert_eq!(drawn[1..], fixed[1..]);
}

#[test]
fn the_command_line_goes_before_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let channel = folder.path().join("c.csv");
    fs::write(&channel, "t_s,delay_s\n0,0.1\n1,0.1\n").unwrap();
    let overrides =
        Overrides { seed: Some(9), step_s: Some(0.5), channel_trace: Some(channel), ..Overrides::default() };
    let scenario = Scenario::parse(Path::new("s.toml"), "seed = 1\n[channel]\nloss = 0.5", &overrides).unwrap();
    assert_eq!((scenario.seed, scenario.step_s), (9, 0.5));
    assert!(matches!(scenario.channel.impairment, Impairment::Recorded(_)));
    let overrides = Overrides { step_s: Some(f64::NAN), ..Overrides::default() };
    let error = Scenario::parse(Path::new("s.toml"), "", &overrides).unwrap_err();
    assert_eq!(error.to_string(), "--step: `step_s` is NaN; give seconds from 0.001 to 1");
}

/// A folder with a scenario and, beside it, the recording of a drive of 30 s that begins at 3 m/s.
fn with_motion(scenario: &str, overrides: &Overrides) -> Result<Scenario, Error> {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("drive.csv"), "t_s,position_m,speed_mps\n100,5,3\n130,155,7\n").unwrap();
    let file = folder.path().join("s.toml");
    fs::write(&file, scenario).unwrap();
    let overrides = Overrides {
        leader_motion: overrides.leader_motion.as_ref().map(|name| folder.path().join(name)),
        ..overrides.clone()
    };
    Scenario::read(Some(&file), &overrides)
}

#[test]
fn a_recorded_leader_sets_the_duration_and_the_speeds_that_the_file_leaves_open() {
    let named = with_motion("[leader]\nmotion = \"drive.csv\"", &Overrides::default()).unwrap();
    let overrides = Overrides { leader_motion: Some("drive.csv".into()), ..Overrides::default() };
    assert_eq!(named, with_motion("", &overrides).unwrap());
    assert_eq!(named.duration_s, 30.0);
    assert_eq!(named.vehicles[0].speed_mps, Span { low: 3.0, high: 3.0 });
    assert_eq!(named.vehicles[1].speed_mps, Span { low: 2.0, high: 4.0 });
    let stated =
        with_motion("duration_s = 20\n[[vehicle]]\nspeed_mps = 9\n[[vehicle]]\nspeed_mps = 9", &overrides).unwrap();
    assert_eq!(stated.duration_s, 20.0);
    assert_eq!(stated.vehicles[0].speed_mps.low, 3.0, "the leader's speed is the recording's");
    assert_eq!(stated.vehicles[1].speed_mps.low, 9.0);
}

#[test]
fn a_run_cannot_be_longer_than_its_leaders_recording() {
    let overrides = Overrides { leader_motion: Some("drive.csv".into()), ..Overrides::default() };
    let message = with_motion("duration_s = 31", &overrides).unwrap_err().to_string();
    let wanted = "s.toml:1: `duration_s` is 31, and the leader's recorded motion ends after 30 s; shorten it, or leave \
                  it out to drive the whole recording";
    assert!(message.ends_with(wanted), "{message}");
}

proptest! {
    #[test]
    fn a_damaged_scenario_is_read_or_refused_in_one_line(
        from in 0usize..4000,
        length in 0usize..40,
        insert in "[-0-9a-z\\[\\]=\"\n.#]{0,6}",
    ) {
        let mut text = fs::read_to_string("scenarios/paper.toml").unwrap().replace('δ', "d").replace('∞', "0");
        let from = from.min(text.len());
        text.replace_range(from..(from + length).min(text.len()), &insert);
        if let Err(error) = parse(&text) {
            prop_assert!(!error.to_string().contains('\n'), "{error}");
            prop_assert!(error.to_string().starts_with("s.toml:"), "{error}");
        }
    }
}
