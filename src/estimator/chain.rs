//! The order in which horizons are computed. The vehicle that each peer follows enters; an order in which every peer comes after the peer
//! that it follows leaves.

/// An order of the slots.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Chain<const PEERS: usize> {
    order: [u8; PEERS],
}

impl<const PEERS: usize> Chain<PEERS> {
    /// The order of the slots themselves.
    #[must_use]
    #[allow(clippy::cast_possible_truncation)] // the catalogue has 16 slots at most
    pub fn new() -> Self {
        Self { order: core::array::from_fn(|index| index as u8) }
    }

    /// No order yet: all zero.
    pub const NONE: Self = Self { order: [0; PEERS] };

    /// The order of a chain. Stations that claim to follow one another in a circle come last, in the order of their slots. Each of these
    /// is computed from the horizon that is held of the other.
    #[must_use]
    #[allow(clippy::cast_possible_truncation)] // as above
    pub fn of(ahead: [Option<usize>; PEERS]) -> Self {
        let mut placed = [false; PEERS];
        let mut order = [0; PEERS];
        let mut places = order.iter_mut();
        for circle in [false, true] {
            for _ in 0..PEERS {
                if places.len() == 0 {
                    break; // nearly always after the first time around
                }
                for index in 0..PEERS {
                    let is_placed = placed.get(index).copied().unwrap_or(true);
                    let is_free = ahead
                        .get(index)
                        .copied()
                        .flatten()
                        .is_none_or(|other| circle || placed.get(other).copied().unwrap_or(true));
                    if is_placed || !is_free {
                        continue;
                    }
                    if let (Some(place), Some(mark)) = (places.next(), placed.get_mut(index)) {
                        *place = index as u8;
                        *mark = true;
                    }
                }
            }
        }
        Self { order }
    }

    /// The slot at this place of the order.
    #[must_use]
    pub fn at(&self, place: usize) -> Option<usize> {
        self.order.get(place).map(|index| usize::from(*index))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn everyone_comes_after_the_one_that_it_follows() {
        let chain = Chain::of([Some(3), None, Some(0), Some(1)]);
        assert_eq!(chain.order, [1, 3, 0, 2]);
    }

    #[test]
    fn a_circle_comes_last_and_everyone_in_it_once() {
        let chain = Chain::of([Some(1), Some(0), None, Some(2)]);
        assert_eq!(chain.order, [2, 3, 0, 1]);
    }
}
