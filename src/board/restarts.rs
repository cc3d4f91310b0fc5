//! How often the watchdog has restarted the unit: what memory kept over the reset enters, the count and what memory is to keep leave.
//!
//! A panic, an exception that must not happen and a loop without end all end in the same way: no tick is finished any more, so the
//! watchdog resets the chip. The unit starts anew, in standby, and `Health` tells. After too many restarts it stays down.

/// After so many the unit stays down: a reset loop would look alive.
const MOST: u32 = 3;

/// What outlives a reset: the count and its complement. Memory that power has just come to holds both by chance once in 4e9 times.
pub type Kept = [u32; 2];

/// What is to be kept, and the count since power came on or something else than the watchdog reset the chip; `None` if that was too
/// often.
pub fn count(by_watchdog: bool, [count, complement]: Kept) -> (Kept, Option<u32>) {
    let before = if by_watchdog && count == !complement { count } else { 0 };
    let count = before.saturating_add(u32::from(by_watchdog));
    ([count, !count], (count <= MOST).then_some(count))
}
