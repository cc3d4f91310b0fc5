//! What a unit sent, in a log of its bus and in a replay of that log.

use std::collections::BTreeMap;

/// Identifiers of what a unit sends, of the catalogue at 0x480.
const OWN: [&str; 11] = ["482", "48A", "48B", "490", "491", "492", "493", "494", "495", "498", "499"];

/// The unit's frames in a log, by identifier: on the bus, frames of several identifiers change places.
fn sent(log: &str) -> BTreeMap<&str, Vec<&str>> {
    let mut sent = BTreeMap::new();
    for frame in log.lines().map(|line| line.split(' ').nth(2).unwrap()) {
        if OWN.contains(&&frame[..3]) {
            sent.entry(&frame[..3]).or_insert_with(Vec::new).push(frame);
        }
    }
    sent
}

/// The number of frames that the unit sent in a log.
#[allow(dead_code)] // not by every test
pub fn count(log: &str) -> usize {
    sent(log).values().map(Vec::len).sum()
}

/// Whether the unit of the replay sent what that of the log sent, bit for bit. The replay has the tick after the log's last frame
/// in addition: at most one message of each kind more.
pub fn repeats(replayed: &str, log: &str) -> bool {
    let (again, first) = (sent(replayed), sent(log));
    assert!(!first.is_empty(), "the log is of no unit");
    again.keys().eq(first.keys())
        && first.iter().all(|(id, frames)| {
            let again = again.get(id).map_or(&[][..], Vec::as_slice);
            again.starts_with(frames) && again.len() <= frames.len() + 5
        })
}
