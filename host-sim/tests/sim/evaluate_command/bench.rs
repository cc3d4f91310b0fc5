//! A folder of made-up recordings and the program run on them.

use serde_json::Value;
use std::path::PathBuf;
use std::process::{Command, Output};
use tempfile::TempDir;

/// Names of the baselines.
pub const BASELINES: [&str; 6] = ["freeze", "constant_speed", "constant_acceleration", "singer", "kalman", "paper"];

/// The folder.
pub struct Bench {
    folder: TempDir,
}

impl Bench {
    pub fn new() -> Self {
        Self { folder: tempfile::tempdir().unwrap() }
    }

    pub fn file(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub fn write(&self, name: &str, content: impl AsRef<[u8]>) -> &Self {
        std::fs::write(self.file(name), content).unwrap();
        self
    }

    /// Writes a motion recording of `(time, position, speed)`.
    pub fn drive(&self, name: &str, samples: impl IntoIterator<Item = (f64, f64, f64)>) -> &Self {
        let rows = samples.into_iter().map(|(t, r, v)| format!("{t},{r},{v}\n"));
        self.write(name, format!("t_s,position_m,speed_mps\n{}", rows.collect::<String>()))
    }

    /// Writes a channel recording of `(time, delay)`.
    pub fn link(&self, name: &str, messages: impl IntoIterator<Item = (f64, Option<f64>)>) -> &Self {
        let row = |(t, delay): (f64, Option<f64>)| format!("{t},{}\n", delay.map_or(String::new(), |d| d.to_string()));
        let rows: String = messages.into_iter().map(row).collect();
        self.write(name, format!("t_s,delay_s\n{rows}"))
    }

    /// Runs `evaluate` in the folder.
    pub fn run(&self, arguments: &str) -> Output {
        let mut command = Command::new(env!("CARGO_BIN_EXE_holdover-sim"));
        command.current_dir(self.folder.path()).arg("evaluate").args(arguments.split_whitespace());
        command.output().unwrap()
    }

    /// The results of an evaluation, without a report.
    pub fn results(&self, arguments: &str) -> Value {
        self.results_of(0, arguments)
    }

    /// The results of an evaluation that ends with this exit code.
    pub fn results_of(&self, code: i32, arguments: &str) -> Value {
        let output = self.run(&format!("{arguments} --json --no-report"));
        assert_eq!(output.status.code(), Some(code), "{}", String::from_utf8_lossy(&output.stderr));
        serde_json::from_slice(&output.stdout).unwrap()
    }

    /// The one line on stderr that bad input ends with.
    pub fn refusal(&self, arguments: &str) -> String {
        let output = self.run(&format!("{arguments} --no-report"));
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments}: {stderr}");
        assert!(output.stdout.is_empty());
        assert_eq!(stderr.lines().count(), 1, "{arguments}: {stderr}");
        stderr.trim_end().to_owned()
    }
}

/// The figures of a method.
pub fn of<'a>(results: &'a Value, method: &str) -> &'a Value {
    if method == "ours" { &results["ours"] } else { &results["baselines"][method] }
}

/// The number at a key, which has to be one.
pub fn number(value: &Value, key: &str) -> f64 {
    value[key].as_f64().unwrap_or_else(|| panic!("{key} in {value}"))
}

/// A class's counts or figures, class by class.
pub fn column(figures: &Value, classes: &str, key: &str) -> Vec<Value> {
    figures[classes].as_array().unwrap().iter().map(|class| class[key].clone()).collect()
}

/// Root of the mean square.
pub fn rms(errors: &[f64]) -> f64 {
    (errors.iter().map(|error| error * error).sum::<f64>() / errors.len() as f64).sqrt()
}

/// The 99th percentile of the magnitudes by nearest rank.
pub fn p99(errors: &[f64]) -> f64 {
    let mut magnitudes: Vec<f64> = errors.iter().map(|error| error.abs()).collect();
    magnitudes.sort_by(f64::total_cmp);
    magnitudes[(0.99 * errors.len() as f64 - 1e-9).ceil() as usize - 1]
}

pub fn close(actual: f64, expected: f64, tolerance: f64, what: &str) {
    assert!((actual - expected).abs() <= tolerance, "{what}: {actual} instead of {expected}");
}
