//! `docs/TUTORIAL.md`: every command in it that is one of the simulator's, or makes a file, works as it stands there.

use std::path::Path;
use std::process::Command;

/// The blocks of a language, in their order.
fn blocks<'a>(text: &'a str, language: &str) -> Vec<&'a str> {
    let opening = format!("```{language}\n");
    text.split(&*opening).skip(1).map(|rest| rest.split("```").next().unwrap()).collect()
}

#[test]
fn the_commands_of_the_tutorial_work() {
    let tutorial = std::fs::read_to_string("../docs/TUTORIAL.md").unwrap();
    let folder = tempfile::tempdir().unwrap();
    let [city] = blocks(&tutorial, "toml")[..] else { panic!("one scenario") };
    std::fs::write(folder.path().join("city.toml"), city).unwrap();
    let program = Path::new(env!("CARGO_BIN_EXE_holdover-sim")).parent().unwrap();
    let path = format!("{}:{}", program.display(), std::env::var("PATH").unwrap());
    let mut ran = 0;
    // `cargo` would build anew, and a CAN interface is not to be had everywhere.
    let commands = |block: &&str| !block.contains("cargo") && !block.contains("vcan.sh");
    for block in blocks(&tutorial, "sh").into_iter().filter(commands) {
        let output = Command::new("sh").args(["-ec", block]).current_dir(&folder).env("PATH", &path).output().unwrap();
        assert!(output.status.success(), "{block}\n{}", String::from_utf8_lossy(&output.stderr));
        ran += 1;
    }
    assert_eq!(ran, 7);
}
