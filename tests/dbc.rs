//! `holdover.dbc` says what the catalogue says. What it says is compared with the frames, signal by signal and through a
//! parser that is not ours, in the simulator's tests.

use holdover::wire::Identifiers;
use holdover::wire::dbc::Dbc;

#[test]
fn the_committed_file_is_the_one_that_the_catalogue_makes() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/holdover.dbc");
    let made = Dbc::new(Identifiers::DEFAULT, 8).to_string();
    if std::env::var_os("HOLDOVER_WRITE_DBC").is_some() {
        std::fs::write(path, &made).unwrap();
    }
    let committed = std::fs::read_to_string(path).unwrap_or_default();
    assert!(committed == made, "holdover.dbc is not up to date: HOLDOVER_WRITE_DBC=1 cargo test --test dbc writes it");
}
