//! Reports show no more than there is: no line through missing data, no bold but the best, nothing cut off, and of a collision those who
//! had it.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

fn run(folder: &Path, arguments: &str) -> Output {
    let mut program = Command::new(env!("CARGO_BIN_EXE_holdover-sim"));
    program.current_dir(folder).args(arguments.split_whitespace()).output().unwrap()
}

fn page(folder: &Path, arguments: &str) -> String {
    let output = run(folder, &format!("{arguments} --out report"));
    assert!(matches!(output.status.code(), Some(0 | 1)), "{arguments}: {}", String::from_utf8_lossy(&output.stderr));
    fs::read_to_string(folder.join("report/index.html")).unwrap()
}

/// The leader stops while nobody is heard, and no unit has an envelope or a sensor.
const CRASH: &str = "duration_s = 14\n[envelope]\nengaged = false\n[leader]\nprogram = [[0, 15.0], [6, 0.0]]\n\
                     [channel]\nloss = 0.0\noutages = [[5, 14]]\napplies_to = \"all\"\n\
                     [[vehicle]]\nspeed_mps = 15.0\n[[vehicle]]\nspeed_mps = 15.0\nrange_sensor = false\n\
                     [[vehicle]]\nspeed_mps = 15.0\nrange_sensor = false\n[[vehicle]]\nspeed_mps = 15.0\nrange_sensor = false\n";

#[test]
fn a_failed_run_says_who_ran_into_whom_when_and_what_its_unit_believed() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("crash.toml"), CRASH).unwrap();
    let output = run(folder.path(), "run crash.toml --no-report");
    assert_eq!(output.status.code(), Some(1));
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(
        text.contains("first vehicle 1 ran into vehicle 0 at ") && text.contains("believed in a gap of "),
        "{text}"
    );
    let json = run(folder.path(), "run crash.toml --no-report --json");
    let results: serde_json::Value = serde_json::from_slice(&json.stdout).unwrap();
    let crash = &results["collided"][0];
    assert_eq!((crash["vehicle"].as_u64(), crash["into"].as_u64()), (Some(1), Some(0)));
    assert!(crash["at_s"].as_f64().unwrap() > 6.0 && crash["believed_gap_m"].as_f64().unwrap() > 1.0, "{crash}");
    let page = page(folder.path(), "run crash.toml");
    assert!(page.contains(">Collisions</h2>") && page.contains("vehicle 1 into leader</td>"));
    assert!(page.contains("The first collision: vehicle 1 runs into leader."));
}

#[test]
fn no_line_is_drawn_through_a_hole_of_a_recording() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, samples: &mut dyn Iterator<Item = u32>| {
        let rows: String = samples.map(|n| format!("{},{n},10\n", f64::from(n) / 10.0)).collect();
        fs::write(folder.path().join(name), format!("t_s,position_m,speed_mps\n{rows}")).unwrap();
    };
    write("whole.csv", &mut (0..=200));
    write("hole.csv", &mut (0..=200).filter(|n| !(80..140).contains(n)));
    // The lines of the true speed, by the number of their parts.
    let parts = |name: &str| {
        let page = page(folder.path(), &format!("evaluate --motion {name} --outage 1"));
        let path = page.split("class=\"line idle\" d=\"").nth(1).unwrap().split('"').next().unwrap().to_owned();
        path.matches('M').count()
    };
    assert_eq!((parts("whole.csv"), parts("hole.csv")), (1, 2));
}

#[test]
fn only_the_best_of_a_column_is_bold() {
    let folder = tempfile::tempdir().unwrap();
    let drive = |n: u32| {
        let t = f64::from(n) / 10.0;
        format!("{t},{:.3},{:.3}\n", 12.0 * t - 10.0 * ((t / 5.0).cos() - 1.0), 12.0 + 2.0 * (t / 5.0).sin())
    };
    let rows: String = (0..=300).map(drive).collect();
    fs::write(folder.path().join("drive.csv"), format!("t_s,position_m,speed_mps\n{rows}")).unwrap();
    let page = page(folder.path(), "evaluate --motion drive.csv --outage 1,2,4");
    assert!(!page.contains("ours and the least") && page.contains("bold: the least."));
    let table = page.split("<table").nth(1).unwrap().split("</table>").next().unwrap();
    let rows: Vec<Vec<&str>> =
        table.split("<tr>").skip(2).map(|row| row.split("<td class=\"number").skip(1).collect()).collect();
    assert!(rows.len() == 7 && rows.iter().all(|row| row.len() == 4), "{table}");
    let value = |cell: &str| cell.split(['>', '<']).nth(1).unwrap().parse::<f64>().unwrap();
    for column in 0..4 {
        let best = rows.iter().map(|row| value(row[column])).fold(f64::INFINITY, f64::min);
        let bold: Vec<f64> =
            rows.iter().filter(|row| row[column].starts_with(" strong")).map(|row| value(row[column])).collect();
        assert!(!bold.is_empty() && bold.iter().all(|bold| *bold == best), "{column}: {bold:?} of {best}");
    }
}

#[test]
fn a_run_emphasises_the_smaller_of_two_errors_and_says_that_the_width_is_a_median() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("short.toml"), "duration_s = 3").unwrap();
    let page = page(folder.path(), "run short.toml");
    let table = page.split("<table").nth(1).unwrap().split("</table>").next().unwrap();
    assert_eq!(table.matches("number strong").count(), 3, "{table}");
    assert!(table.contains("Median width of the bound"));
    let text = String::from_utf8(run(folder.path(), "run short.toml --no-report").stdout).unwrap();
    assert!(text.contains("median width of bound, m"), "{text}");
}

#[test]
fn methods_have_one_name_for_people() {
    let folder = tempfile::tempdir().unwrap();
    let text = String::from_utf8(run(folder.path(), "motions --silences 1 --no-report").stdout).unwrap();
    let help = String::from_utf8(run(folder.path(), "motions --help").stdout).unwrap();
    let page = page(folder.path(), "motions --silences 1");
    for name in ["constant speed", "Singer's model", "Kalman filter", "literal paper"] {
        assert!(text.contains(name) && help.contains(name), "{name}");
        assert!(page.contains(&name.replace('\'', "&#39;")), "{name}");
    }
    assert!(!text.contains("singer") && !text.contains("kalman") && !page.contains(">kalman<"));
}

#[test]
fn wide_tables_are_set_smaller_and_are_whole_on_paper() {
    let folder = tempfile::tempdir().unwrap();
    let page = page(folder.path(), "gains");
    assert!(page.contains("<table class=\"many stacked\">"), "a table of nine columns");
    let (screen, print) = page.split_once("@media print").unwrap();
    assert!(screen.contains("\nthead .number { white-space: normal; }"));
    assert!(print.split("</style>").next().unwrap().contains(".scroll { overflow: visible; }"));
}

#[test]
fn the_picture_of_the_documents_has_a_background() {
    let picture = fs::read_to_string("../docs/corridor.svg").unwrap();
    let (_, body) = picture.split_once("</style>").unwrap();
    assert!(
        body.trim_start().starts_with("<rect x=\"-10\" y=\"0\" width=\"100%\" height=\"100%\" fill=\"var(--paper)\"/>")
    );
}
