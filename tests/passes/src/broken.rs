//! The rules with one of them taken out. The checker has to find a state with two vehicles in the area for each, or it would find none
//! for the rules either.

/// What is done otherwise than the rules say.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Broken {
    /// F2: a newcomer waits a step less than the longest silence.
    WaitsLess,
    /// F2: a newcomer does not wait for the difference of clocks.
    WaitsNoClocks,
    /// F1: a vehicle counts as on air before it is within range.
    OutOfRange,
    /// F2: a claim counts from the stamp of a message that was sent without it.
    SaidBefore,
    /// F2, F3: windows are kept apart without the difference of clocks.
    PadsNoClocks,
    /// F3, F4: a claim neither gives way nor is kept from being firm by another one with priority.
    KeepsAll,
    /// F4: a claim is firm before the known vehicles have been heard.
    HearsNobody,
    /// F4: a vehicle that has been silent for a step is forgotten with its windows, as where its slot is given to another station.
    ForgetsTheSilent,
    /// F4: a claim is firm whatever vehicles do that were heard before the zone.
    LeavesOutTheQueue,
    /// F5: a vehicle goes in when the beginning of its stay is covered.
    CoversLess,
    /// F6: a window is shifted and keeps the time at which it was claimed.
    KeepsItsTime,
}

impl Broken {
    /// Every one of them.
    pub const ALL: [Self; 11] = [
        Self::WaitsLess,
        Self::WaitsNoClocks,
        Self::OutOfRange,
        Self::SaidBefore,
        Self::PadsNoClocks,
        Self::KeepsAll,
        Self::HearsNobody,
        Self::ForgetsTheSilent,
        Self::LeavesOutTheQueue,
        Self::CoversLess,
        Self::KeepsItsTime,
    ];
}
