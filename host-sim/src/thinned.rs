//! Series of bounded length: a value for each sample enters; every sample is kept, or of a long series every second, every fourth and so
//! on, evenly from the first on.

/// Which samples of a series are kept. Several series of the same samples share one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Thinning {
    most: usize,
    stride: usize,
    noted: usize,
    kept: usize,
}

/// What to do with a sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// Whether every second one of those that were kept has to go first, by [`halve`].
    pub is_full: bool,
    /// Whether it is kept.
    pub is_kept: bool,
}

impl Default for Thinning {
    /// Every sample, however many there are.
    fn default() -> Self {
        Self::to(usize::MAX)
    }
}

impl Thinning {
    /// At most this many samples, at least 2.
    #[must_use]
    pub fn to(most: usize) -> Self {
        Self { most: most.max(2), stride: 1, noted: 0, kept: 0 }
    }

    /// The next sample.
    pub fn place(&mut self) -> Place {
        let is_due = self.noted.is_multiple_of(self.stride);
        let is_full = is_due && self.kept >= self.most;
        if is_full {
            self.stride *= 2;
            self.kept = self.kept.div_ceil(2);
        }
        let is_kept = self.noted.is_multiple_of(self.stride);
        self.kept += usize::from(is_kept);
        self.noted += 1;
        Place { is_full, is_kept }
    }

    /// How many samples there have been for each that is kept.
    #[must_use]
    pub fn stride(&self) -> usize {
        self.stride
    }

    /// How many samples there have been.
    #[must_use]
    pub fn noted(&self) -> usize {
        self.noted
    }
}

/// Keeps the first of every two values.
pub fn halve<T>(values: &mut Vec<T>) {
    let mut index = 0;
    values.retain(|_| {
        index += 1;
        index % 2 == 1
    });
}

/// A thinned series.
#[derive(Clone, Debug, PartialEq)]
pub struct Thinned<T> {
    values: Vec<T>,
    thinning: Thinning,
}

impl<T> Thinned<T> {
    /// At most this many values.
    #[must_use]
    pub fn to(most: usize) -> Self {
        Self { values: Vec::new(), thinning: Thinning::to(most) }
    }

    /// The next value.
    pub fn push(&mut self, value: T) {
        let place = self.thinning.place();
        if place.is_full {
            halve(&mut self.values);
        }
        if place.is_kept {
            self.values.push(value);
        }
    }

    /// Those that are kept.
    #[must_use]
    pub fn values(&self) -> &[T] {
        &self.values
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn thinned(most: usize, samples: usize) -> Vec<usize> {
        let mut thinned = Thinned::to(most);
        (0..samples).for_each(|sample| thinned.push(sample));
        thinned.values().to_vec()
    }

    #[test]
    fn a_short_series_is_kept_whole_and_a_long_one_evenly() {
        assert_eq!(thinned(4, 4), [0, 1, 2, 3]);
        assert_eq!(thinned(4, 5), [0, 2, 4]);
        assert_eq!(thinned(4, 8), [0, 2, 4, 6]);
        assert_eq!(thinned(4, 9), [0, 4, 8]);
        assert_eq!(thinned(5, 11), [0, 4, 8]);
        let long = thinned(1000, 1_000_000);
        assert!((500..=1000).contains(&long.len()));
        assert!(long.windows(2).all(|pair| pair[1] - pair[0] == long[1]), "{:?}", &long[..3]);
    }
}
