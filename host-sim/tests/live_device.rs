//! `live --bus`: a device on a bus in memory drives the ego, and the page shows the world with it in it.

use std::net::{IpAddr, Ipv4Addr};
use std::path::{Path, PathBuf};
use std::sync::mpsc;

use holdover::time::Duration;
use holdover_sim::commands::ecu::arguments::UnitArguments;
use holdover_sim::commands::hil::judge::LATENCY_P99_MS;
use holdover_sim::commands::hil::session::{self, Setup};
use holdover_sim::commands::hil::virtual_bus::{Behaviour, bench};
use holdover_sim::commands::interruption::Interruption;
use holdover_sim::commands::live::arguments::LiveArguments;
use holdover_sim::commands::live::device::Device;
use holdover_sim::commands::live::engine::Ask;
use holdover_sim::commands::live::options::LiveOptions;
use holdover_sim::commands::live::order::Order;
use holdover_sim::input::scenario::{Overrides, Part, Scenario};
use holdover_sim::sim::world::{self, MOST_TICKS};
use serde_json::Value;
use tokio::sync::{oneshot, watch};

fn setup(duration_s: f64) -> Setup {
    let text = format!("duration_s = {duration_s:?}\n[channel]\noutages = []\n");
    let scenario = Scenario::parse(Path::new("live.toml"), &text, &Overrides::default()).unwrap();
    let config = world::config(&scenario, scenario.ego);
    let (wait, latency_p99_ms) = (Duration::from_millis(3000), LATENCY_P99_MS);
    Setup { scenario, config, wait, latency_p99_ms, faults: Vec::new(), most_ticks: MOST_TICKS }
}

/// A run before which these orders were given: what became of each, the last scene, and the journal.
fn run(setup: &Setup, orders: &[Order], change: impl FnOnce(&mut Behaviour)) -> (Vec<Result<(), String>>, Value, bool) {
    let ((asks, asked), (show, scenes)) = (mpsc::channel(), watch::channel("{}".into()));
    let answers: Vec<_> = orders
        .iter()
        .map(|order| {
            let (to, from) = oneshot::channel();
            asks.send(Ask::Do(*order, to)).unwrap();
            from
        })
        .collect();
    let end = Interruption::default();
    let mut desk = Device::new(&setup.scenario, asked, show, &end, None);
    let mut behaviour = Behaviour::good(setup.config, false);
    change(&mut behaviour);
    let (port, mut rig) = bench(behaviour);
    let outcome = session::run_before(setup, port, &mut rig, &mut desk, |_| {}).unwrap();
    let answered = answers.into_iter().filter_map(|answer| answer.blocking_recv().ok());
    let answered = answered.map(|answer| answer.map_err(|error| error.to_string())).collect();
    (answered, serde_json::from_str(&scenes.borrow()).unwrap(), outcome.cut.is_none())
}

#[test]
fn the_device_is_seen_to_drive_and_to_believe_and_whoever_is_driven_is_seen_by_it() {
    let setup = setup(12.0);
    let ego = setup.scenario.ego;
    let (_, quiet, is_whole) = run(&setup, &[], |_| {});
    assert!(is_whole && quiet["ticks"].as_u64().unwrap() >= 1198, "{quiet}");
    let of = |scene: &Value, key: &str| scene["vehicles"][ego][key].as_f64().unwrap();
    assert!(of(&quiet, "speed_mps") > 9.0 && of(&quiet, "load") > 0.05);
    let target = &quiet["vehicles"][ego]["target"];
    assert!(target["error_m"].as_f64().unwrap().abs() < 0.3 && target["bound_m"].is_array(), "{target}");
    // Those who look change nothing.
    assert_eq!(run(&setup, &[], |_| {}).1, quiet);
    let (answers, scene, _) = run(&setup, &[Order::Drive { vehicle: 0, mps2: -1.5 }], |_| {});
    assert_eq!((answers, &scene["vehicles"][0]["is_driven"]), (vec![Ok(())], &true.into()));
    assert!(of(&scene, "speed_mps") < of(&quiet, "speed_mps") - 4.0, "{}", of(&scene, "speed_mps"));
}

#[test]
fn what_a_device_does_not_let_itself_do_is_refused_and_the_run_goes_on() {
    let setup = setup(3.0);
    let orders = [
        Order::Back { seconds: 10.0 },
        Order::Switch { vehicle: Some(2), part: Part::Envelope, on: false },
        Order::Switch { vehicle: Some(2), part: Part::Holdover, on: false },
        Order::Switch { vehicle: Some(4), part: Part::Holdover, on: false },
        Order::Drive { vehicle: 9, mps2: 1.0 },
        Order::Outage { vehicle: Some(2), seconds: 1.0 },
    ];
    let (answers, scene, is_whole) = run(&setup, &orders, |_| {});
    let wanted = [
        Err("time is the device's: it neither stops nor goes back, because nobody can rewind a device; "),
        Err("vehicle 2 drives by the device's own estimate and envelope; "),
        Err("vehicle 2 drives by the device's own estimate and envelope; "),
        Ok(()),
        Err("there is no vehicle 9; "),
        Ok(()),
    ];
    for (answer, wanted) in answers.iter().zip(wanted) {
        match (answer, wanted) {
            (Ok(()), Ok(())) => {}
            (Err(said), Err(wanted)) => assert!(said.starts_with(wanted), "{said}"),
            other => panic!("{other:?}"),
        }
    }
    assert!(answers.len() == orders.len() && is_whole);
    assert_eq!(scene["events"], serde_json::json!([2, 2]));
}

#[test]
fn what_is_switched_of_all_is_switched_of_all_but_the_device_at_once() {
    let setup = setup(3.0);
    let off = |part: Part| Order::Switch { vehicle: None, part, on: false };
    let (answers, scene, _) = run(&setup, &[off(Part::Envelope), off(Part::Holdover)], |_| {});
    assert_eq!(answers, [Ok(()), Ok(())]);
    for (vehicle, seen) in scene["vehicles"].as_array().unwrap().iter().enumerate() {
        let is_device = vehicle == setup.scenario.ego;
        assert_eq!(seen["has_envelope"], is_device, "vehicle {vehicle}");
        // The leader follows nobody, and drives by no estimate.
        assert_eq!(seen["is_plain"], !is_device && vehicle > 0, "vehicle {vehicle}");
    }
}

/// The options of `live --bus can0` with these.
fn on_bus(scenario: Option<&str>, vehicle: Option<usize>) -> Result<LiveOptions, String> {
    let arguments = LiveArguments {
        scenario: scenario.map(PathBuf::from),
        port: 0,
        no_browser: true,
        listen: IpAddr::V4(Ipv4Addr::LOCALHOST),
        mcap: None,
        bus: Some("can0".into()),
        unit: UnitArguments { vehicle, ..UnitArguments::default() },
        device: None,
        seed: None,
        set: Vec::new(),
    };
    LiveOptions::read(arguments).map_err(|error| error.to_string())
}

#[test]
fn a_device_drives_whichever_vehicle_is_named() {
    for vehicle in [1, 3, 4] {
        let options = on_bus(None, Some(vehicle)).unwrap();
        assert!(options.archive.cast().contains(&format!("\"device\":{vehicle}")));
        let mut setup = options.device.unwrap().setup;
        setup.scenario.duration_s = 6.0;
        let switch = Order::Switch { vehicle: None, part: Part::Envelope, on: false };
        let (_, scene, is_whole) = run(&setup, &[switch], |_| {});
        assert!(is_whole);
        let seen = &scene["vehicles"][vehicle];
        assert!(seen["target"]["error_m"].as_f64().unwrap().abs() < 0.3 && seen["mode"] != "standby", "{seen}");
        // Its envelope is its own.
        assert_eq!(seen["has_envelope"], true);
        assert_eq!(scene["vehicles"][2]["has_envelope"], false);
    }
}

#[test]
fn a_place_that_no_device_can_have_is_refused_with_the_remedy() {
    for (vehicle, cause) in
        [(0, "is 0, the leader, and a device follows somebody"), (9, "is 9, and there is no such vehicle")]
    {
        let said = on_bus(None, Some(vehicle)).unwrap_err();
        assert_eq!(said, format!("--vehicle: {cause}; give an index from 1 to 4"));
    }
    let said = on_bus(Some("corridor"), Some(1)).unwrap_err();
    assert!(
        said.starts_with("--bus: a device drives in a string of vehicles, and this is a corridor; give "),
        "{said}"
    );
}

#[test]
fn a_device_that_dies_ends_the_run_and_is_named() {
    let (_, scene, is_whole) =
        run(&setup(20.0), &[], |behaviour| behaviour.dies_after = Some(Duration::from_millis(8000)));
    assert!(!is_whole && scene["at_s"].as_f64().unwrap() < 10.0, "{}", scene["at_s"]);
}
