//! What a watchdog's reset leads to, also one that ended a panic, as the firmware's documents have it.

#[path = "../src/board/restarts.rs"]
mod restarts;

use restarts::{Kept, count};

/// Memory as it is when power has come on.
const CHANCE: Kept = [0x5a5a_1234, 0xdead_beef];

#[test]
fn power_on_is_no_restart_whatever_memory_holds() {
    assert_eq!(count(false, CHANCE), ([0, !0], Some(0)));
    assert_eq!(count(false, [3, !3]), ([0, !0], Some(0)));
}

#[test]
fn three_restarts_are_counted_and_after_the_fourth_the_unit_stays_down_until_another_reset() {
    let (mut kept, _) = count(false, CHANCE);
    let mut counts = Vec::new();
    for _ in 0..6 {
        let (next, times) = count(true, kept);
        counts.push(times);
        kept = next;
    }
    assert_eq!(counts, [Some(1), Some(2), Some(3), None, None, None]);
    assert_eq!(count(false, kept).1, Some(0));
}

#[test]
fn a_restart_whose_memory_is_lost_counts_as_the_first() {
    assert_eq!(count(true, CHANCE).1, Some(1));
}
