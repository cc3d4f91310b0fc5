//! What a controller lets in: the identifiers that the unit takes in enter, and as few patterns as fit the controller's filters
//! leave. What no filter lets in costs the core nothing.
//!
//! Patterns are joined exactly as long as they can be: two that differ in one bit are one that does not ask for this bit. If there are
//! more than filters, the two whose common pattern lets in the fewest others become that one, and so on. So everything that is
//! wanted gets in, and with too few filters some that is not; the unit then refuses that by two comparisons.

use embedded_can::Id;
use heapless::Vec;
use holdover::wire::Identifier;

/// Identifiers of one kind that have these bits where the mask has ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pattern {
    pub is_extended: bool,
    pub bits: u32,
    pub mask: u32,
}

impl Pattern {
    /// One identifier.
    fn of(id: Identifier) -> Self {
        Self { is_extended: id.is_extended(), bits: id.number(), mask: Self::all(id.is_extended()) }
    }

    /// A mask that asks for every bit.
    pub const fn all(is_extended: bool) -> u32 {
        if is_extended { 0x1fff_ffff } else { 0x7ff }
    }

    /// Whether it lets this identifier in.
    #[allow(dead_code)] // a controller does that; tests ask
    pub fn takes(&self, id: Id) -> bool {
        self.includes(Self::of(id.into()))
    }

    /// How many identifiers it lets in.
    pub fn size(&self) -> u64 {
        1 << (Self::all(self.is_extended) & !self.mask).count_ones()
    }

    fn includes(self, other: Self) -> bool {
        let asks_for_no_more = self.mask & !other.mask == 0;
        self.is_extended == other.is_extended && asks_for_no_more && (self.bits ^ other.bits) & self.mask == 0
    }

    /// What lets in just what the two of them do.
    fn joined(self, other: Self) -> Option<Self> {
        if self.includes(other) {
            return Some(self);
        }
        if other.includes(self) {
            return Some(other);
        }
        let is_one_bit = self.mask == other.mask && (self.bits ^ other.bits).is_power_of_two();
        self.common(other).filter(|_| is_one_bit)
    }

    /// The least that lets in what both do.
    fn common(self, other: Self) -> Option<Self> {
        let mask = self.mask & other.mask & !(self.bits ^ other.bits);
        (self.is_extended == other.is_extended).then_some(Self { bits: self.bits & mask, mask, ..self })
    }
}

/// As many as are kept while they are being joined.
const MOST: usize = 36;

/// Patterns, none of which includes another one.
#[derive(Clone)]
pub struct Patterns(Vec<Pattern, MOST>);

impl Patterns {
    /// Those of these identifiers.
    pub fn of(wanted: impl Iterator<Item = Identifier>) -> Self {
        let mut patterns = Self(Vec::new());
        wanted.for_each(|id| patterns.add(Pattern::of(id)));
        patterns
    }

    /// Every frame.
    #[allow(dead_code)] // tests have it
    pub fn everything() -> Self {
        let mut patterns = Self(Vec::new());
        for is_extended in [false, true] {
            patterns.add(Pattern { is_extended, bits: 0, mask: 0 });
        }
        patterns
    }

    /// As few as there are filters for both kinds together.
    #[allow(dead_code)] // some controllers have filters for either kind, others for both
    pub fn at_most<const FILTERS: usize>(mut self) -> Vec<Pattern, FILTERS> {
        self.reduce(FILTERS, |_| true);
        self.those(|_| true)
    }

    /// As few standard and extended ones as there are filters for each.
    #[allow(dead_code)] // as above
    pub fn at_most_of_each<const STANDARD: usize, const EXTENDED: usize>(
        mut self,
    ) -> (Vec<Pattern, STANDARD>, Vec<Pattern, EXTENDED>) {
        self.reduce(STANDARD, |pattern| !pattern.is_extended);
        self.reduce(EXTENDED, |pattern| pattern.is_extended);
        (self.those(|pattern| !pattern.is_extended), self.those(|pattern| pattern.is_extended))
    }

    fn those<const FILTERS: usize>(&self, is_meant: impl Fn(&Pattern) -> bool) -> Vec<Pattern, FILTERS> {
        let mut some = Vec::new();
        for pattern in self.0.iter().filter(|pattern| is_meant(pattern)) {
            let _ = some.push(*pattern); // there are no more than that
        }
        some
    }

    fn add(&mut self, new: Pattern) {
        self.reduce(MOST - 1, |_| true);
        self.put(new);
    }

    /// Joins it to those that it can be joined to. There has to be room.
    fn put(&mut self, mut new: Pattern) {
        // Each turn takes a pattern away.
        while let Some(joined) = self.take_out_first(|old| old.joined(new)) {
            new = joined;
        }
        let _ = self.0.push(new);
    }

    /// Takes out the first pattern of which this makes something, and returns what it makes.
    fn take_out_first(&mut self, make: impl Fn(&Pattern) -> Option<Pattern>) -> Option<Pattern> {
        let mut made = None;
        self.0.retain(|old| {
            let is_first = made.is_none();
            if is_first {
                made = make(old);
            }
            !is_first || made.is_none()
        });
        made
    }

    /// Until there are no more of these, two of them become one. At least one of each kind remains.
    fn reduce(&mut self, filters: usize, is_meant: impl Fn(&Pattern) -> bool) {
        while self.0.iter().filter(|pattern| is_meant(pattern)).count() > filters {
            let mut best: Option<(u64, Pattern)> = None;
            for (place, one) in self.0.iter().enumerate().filter(|(_, one)| is_meant(one)) {
                for other in self.0.iter().skip(place + 1) {
                    let Some(common) = one.common(*other) else { continue };
                    let more = common.size().saturating_sub(one.size() + other.size());
                    if best.is_none_or(|(least, _)| more < least) {
                        best = Some((more, common));
                    }
                }
            }
            let Some((_, common)) = best else { return };
            self.0.retain(|pattern| !common.includes(*pattern));
            self.put(common);
        }
    }
}
