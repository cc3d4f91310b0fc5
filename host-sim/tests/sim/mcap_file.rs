//! `--mcap`: its figures are those of the CSV, and in a corridor those that were seen.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;

use holdover_sim::commands::live::road::RoadPlay;
use holdover_sim::commands::mcap_road::RoadMcap;
use holdover_sim::input::scenario::Overrides;
use holdover_sim::roads::read::corridor;
use holdover_sim::roads::watch::{Sighting, Watch};

#[test]
fn the_file_has_every_tick_of_every_vehicle_with_the_figures_of_the_csv() {
    let folder = tempfile::tempdir().unwrap();
    let [mcap, csv] = ["run.mcap", "run.csv"].map(|name| folder.path().join(name));
    let run = Command::new(env!("CARGO_BIN_EXE_holdover-sim"))
        .args(["run", "--no-report", "--set", "duration_s=3", "--trace"])
        .args([csv.as_os_str(), "--mcap".as_ref(), mcap.as_os_str()])
        .output()
        .unwrap();
    assert!(run.status.code().is_some_and(|code| code < 2), "{}", String::from_utf8_lossy(&run.stderr));
    let bytes = std::fs::read(&mcap).unwrap();
    let mut counts: BTreeMap<String, u32> = BTreeMap::new();
    let mut rows = csv::Reader::from_path(&csv).unwrap();
    let names = rows.headers().unwrap().clone();
    let mut rows = rows.records();
    for message in mcap::MessageStream::new(&bytes).unwrap() {
        let message = message.unwrap();
        *counts.entry(message.channel.topic.clone()).or_default() += 1;
        if message.channel.topic != "/measured" {
            continue;
        }
        let values: serde_json::Value = serde_json::from_slice(&message.data).unwrap();
        let schema: serde_json::Value = serde_json::from_slice(&message.channel.schema.as_ref().unwrap().data).unwrap();
        let row = rows.next().unwrap().unwrap();
        for (name, field) in names.iter().zip(&row) {
            let value = &values[name];
            assert!(schema["properties"][name].is_object(), "{name}");
            match field.parse::<f64>() {
                Ok(number) if name == "limited" => assert_eq!(value.as_bool(), Some(number == 1.0)),
                Ok(number) => {
                    assert!((value.as_f64().unwrap() - number).abs() <= 5.1e-7, "{name}: {value} and {number}")
                }
                Err(_) if field.is_empty() => assert!(value.is_null(), "{name}: {value}"),
                Err(_) => assert_eq!(value.as_str(), Some(field)),
            }
        }
    }
    assert!(rows.next().is_none());
    assert_eq!(counts.len(), 11);
    assert!(counts.values().all(|count| *count == 300), "{counts:?}");
}

/// Every sighting of a run.
#[derive(Default)]
struct All(Vec<(f64, Sighting)>);

impl Watch for All {
    fn tick(&mut self, at_s: f64, sightings: &[Sighting]) {
        self.0.extend(sightings.iter().map(|own| (at_s, *own)));
    }
    fn left(&mut self, _: f64, _: usize) {}
}

#[test]
fn of_a_corridor_it_has_every_vehicle_at_every_tick_with_its_place_on_the_map() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("roads.mcap");
    // In this seed vehicles soon follow one another at this time gap.
    let text = std::fs::read_to_string("scenarios/corridor.toml").unwrap();
    let text = text.replacen("seed = 1 ", "seed = 5 ", 1).replacen("\ntime_gap_s = 1.0 ", "\ntime_gap_s = 3.0 ", 1);
    let play = RoadPlay::new(corridor(Path::new("corridor.toml"), &text, &Overrides::default()).unwrap());
    let (mut mcap, mut all) = (RoadMcap::of(&file, &play.experiment.network).unwrap(), All::default());
    play.again(&[], 3000, None, &mut [&mut mcap, &mut all]).unwrap();
    mcap.finish().unwrap();
    let bytes = std::fs::read(&file).unwrap();
    let (mut states, mut fixes) = (Vec::new(), Vec::new());
    for message in mcap::MessageStream::new(&bytes).unwrap() {
        let message = message.unwrap();
        let values: serde_json::Value = serde_json::from_slice(&message.data).unwrap();
        let topic = message.channel.topic.clone();
        if topic.ends_with("/fix") { &mut fixes } else { &mut states }.push((topic, values));
    }
    assert!(all.0.len() > 10_000 && (states.len(), fixes.len()) == (all.0.len(), all.0.len()));
    for (((topic, state), (_, fix)), (at_s, own)) in states.iter().zip(&fixes).zip(&all.0) {
        assert_eq!(*topic, format!("/station/{}", own.station.0));
        let point = play.experiment.network.lanes[own.road].road.at(own.way_m).0;
        for (values, name, wanted) in [
            (state, "t_s", Some(*at_s)),
            (state, "trip", Some(own.trip as f64)),
            (state, "position_m", Some(own.way_m)),
            (state, "speed_mps", Some(own.speed_mps)),
            (state, "target_position_m", own.belief.map(|belief| belief.position_m - own.odometer_m)),
            (fix, "latitude", Some(point.latitude)),
            (fix, "longitude", Some(point.longitude)),
        ] {
            // The last digit may be lost where the text is read.
            let is_same = match (values[name].as_f64(), wanted) {
                (Some(said), Some(wanted)) => (said - wanted).abs() < 1e-9,
                (said, wanted) => said == wanted,
            };
            assert!(is_same, "{topic} {at_s}: {name} is {} and not {wanted:?}", values[name]);
        }
    }
    let errors: Vec<f64> = states.iter().filter_map(|(_, state)| state["target_error_m"].as_f64()).collect();
    assert!(errors.len() > 1000 && errors.iter().all(|error_m| error_m.abs() < 20.0));
}
