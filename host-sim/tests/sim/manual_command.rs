//! Facts about the completions and the manual pages: each command and each option of `--help` is in them.

use std::collections::BTreeSet;
use std::process::{Command, Output};

fn holdover(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_holdover-sim")).args(arguments).output().unwrap()
}

fn text(output: Output) -> String {
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// The commands that `--help` lists.
fn commands() -> Vec<String> {
    let help = text(holdover(&["--help"]));
    let list = help.split("Commands:\n").nth(1).unwrap().split("\n\n").next().unwrap();
    let first =
        |line: &str| line.strip_prefix("  ")?.split(' ').next().filter(|word| !word.is_empty()).map(str::to_owned);
    let found: Vec<String> = list.lines().filter_map(first).filter(|name| name != "help").collect();
    assert!(found.len() > 12, "{found:?}");
    found
}

/// The long options in a help text.
fn options(help: &str) -> BTreeSet<String> {
    let lines = help.lines().map(str::trim_start).filter(|line| line.starts_with("--") || line.starts_with("-h,"));
    let word = |line: &str| {
        let from = line.find("--")?;
        Some(line[from..].split([' ', '[', '=', ',']).next()?.to_owned())
    };
    lines.filter_map(word).collect()
}

#[test]
fn completions_know_every_command_and_option() {
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let completions = text(holdover(&["completions", shell]));
        for command in commands() {
            assert!(completions.contains(&command), "{shell} {command}");
        }
    }
    let bash = text(holdover(&["completions", "bash"]));
    for option in options(&text(holdover(&["run", "--help"]))) {
        assert!(bash.contains(&option), "{option}");
    }
    let refused = holdover(&["completions", "csh"]);
    assert_eq!(refused.status.code(), Some(2));
    let said = String::from_utf8(refused.stderr).unwrap();
    assert!(said.lines().count() == 1 && said.contains("csh") && said.contains("bash"), "{said}");
}

#[test]
fn there_is_a_manual_page_for_each_command_with_every_option() {
    let folder = tempfile::tempdir().unwrap();
    let pages = folder.path().join("man1");
    text(holdover(&["man", pages.to_str().unwrap()]));
    let page = |name: &str| std::fs::read_to_string(pages.join(name)).unwrap().replace("\\-", "-");
    assert!(page("holdover-sim.1").starts_with(".ie") || page("holdover-sim.1").contains(".TH holdover-sim 1"));
    for command in commands() {
        let page = page(&format!("holdover-sim-{command}.1"));
        let help = text(holdover(&[&command, "--help"]));
        for option in options(&help) {
            assert!(page.contains(&option), "{command} {option}");
        }
    }
    let refused = holdover(&["man", "/dev/null/x"]);
    assert_eq!(refused.status.code(), Some(2));
}

#[test]
fn a_folder_for_the_pages_that_cannot_be_is_refused_by_its_name() {
    let refused = holdover(&["man", "/proc/nope"]);
    let said = String::from_utf8(refused.stderr).unwrap();
    assert_eq!(refused.status.code(), Some(2));
    assert!(said.starts_with("error: FOLDER: \"/proc/nope\" cannot be written ("), "{said}");
    assert!(said.ends_with("; name a folder that you may write\n") && said.lines().count() == 1, "{said}");
}
