//! `holdover.dbc` and `holdover-fd.dbc` say what the catalogue says. What they say is compared with the frames, signal by signal and
//! through a parser that is not ours, in the simulator's tests.

use holdover::wire::Identifiers;
use holdover::wire::dbc::Dbc;

fn is_current(name: &str, dbc: Dbc) {
    let path = format!("{}/{name}", env!("CARGO_MANIFEST_DIR"));
    let made = dbc.to_string();
    if std::env::var_os("HOLDOVER_WRITE_DBC").is_some() {
        std::fs::write(&path, &made).unwrap();
    }
    let committed = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(committed == made, "{name} is not up to date: {WRITE} writes it");
}

const WRITE: &str = "HOLDOVER_WRITE_DBC=1 cargo test --features fd --test dbc";

#[test]
fn the_committed_file_is_the_one_that_the_catalogue_makes() {
    is_current("holdover.dbc", Dbc::new(Identifiers::DEFAULT, 8));
}

#[cfg(feature = "fd")]
#[test]
fn the_committed_file_of_can_fd_is_the_one_that_the_catalogue_makes() {
    is_current("holdover-fd.dbc", Dbc::new(Identifiers::DEFAULT, 8).over_fd());
}
