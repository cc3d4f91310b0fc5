//! `--mcap`: its figures are those of the CSV.

use std::collections::BTreeMap;
use std::process::Command;

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
