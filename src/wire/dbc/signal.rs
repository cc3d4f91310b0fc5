//! Signals of a message: a line of the catalogue enters, its fields leave with their names and places, as the DBC spells them.

use core::fmt::{Display, Formatter, Result};

use crate::wire::catalogue::{Content, Line};
use crate::wire::field::{Field, Place, TAG};
use crate::wire::meaning;

/// A signal of the file: a field, in one part where every part of a message has the same fields, so that tools see each part by a
/// name of its own.
pub(super) struct Signal {
    /// Where it stands in this frame.
    pub(super) field: Field,
    /// The part, in its name.
    part: Option<u8>,
    /// Of what it speaks.
    content: Content,
}

/// How many parts of a line have the same fields, and so names of their own; 0 where the parts differ or there is one.
fn like_parts(line: &Line) -> u8 {
    let parts = line.selector().filter(|_| line.fields.iter().all(|field| !matches!(field.place, Place::Part(_))));
    parts.map_or(0, |selector| u8::try_from(selector.max).unwrap_or(0).saturating_add(1))
}

/// All signals of a line.
pub(super) fn classic(line: &'static Line) -> impl Iterator<Item = Signal> {
    let parts = like_parts(line);
    line.fields.iter().flat_map(move |field| {
        let is_in_each = parts > 0 && field.place == Place::Always && field.name != TAG.name;
        let (first, last) = if is_in_each { (0, parts) } else { (0, 1) };
        (first..last).map(move |part| {
            let part = is_in_each.then_some(part);
            let place = part.map_or(field.place, Place::Part);
            Signal { field: Field { place, ..*field }, part, content: line.content }
        })
    })
}

/// All signals of the frame of CAN FD that begins with the line at this place.
#[cfg(feature = "fd")]
pub(super) fn over_fd(place: usize) -> impl Iterator<Item = Signal> {
    use crate::wire::catalogue::{CATALOGUE, OnFd};
    use crate::wire::fd::layout;

    const VALID: &[(i64, &str)] = &[(0, "absent"), (1, "present")];
    let sections = layout::of(place).map_or(&[][..], layout::Layout::sections);
    sections.iter().filter_map(|section| Some((section, CATALOGUE.get(usize::from(section.line))?))).flat_map(
        |(section, line)| {
            let flag = match line.on_fd {
                OnFd::MayFollow(name) if section.part == 0 => {
                    let field = Field::unsigned(name, section.valid.into(), 1).named(VALID);
                    Some(Signal { field, part: None, content: line.content })
                }
                _ => None,
            };
            let is_whole = line.frames == 1;
            let part = (!is_whole && like_parts(line) > 0).then_some(section.part);
            let stands = move |field: &&Field| match field.place {
                Place::Always => line.within_ms == 0 || field.start != TAG.start,
                Place::Selector => is_whole,
                Place::Part(of) => is_whole || of == section.part,
            };
            flag.into_iter().chain(line.fields.iter().filter(stands).map(move |field| {
                let start = u32::from(section.at).saturating_add(field.start).saturating_sub(section.first.into());
                let place = if is_whole { field.place } else { Place::Always };
                Signal { field: Field { start, place, ..*field }, part, content: line.content }
            }))
        },
    )
}

impl Signal {
    pub(super) fn name(&self) -> SignalName {
        SignalName(self.field.name, self.part)
    }

    /// What it means.
    pub(super) fn meaning(&self, is_over_fd: bool) -> &'static str {
        meaning::signal(self.content, self.field.name, is_over_fd)
    }

    /// The raw value before anything is known: the code for none, or the one that the field names, or the value nearest to zero.
    pub(super) fn start(&self) -> i64 {
        self.field.none.or(self.field.initial).unwrap_or(0i64.max(self.field.min).min(self.field.max))
    }
}

/// The name of a signal, with its part where every part has one.
pub(super) struct SignalName(&'static str, Option<u8>);

impl Display for SignalName {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        f.write_str(self.0)?;
        self.1.map_or(Ok(()), |part| write!(f, "{part}"))
    }
}

impl Display for Signal {
    /// Up to its unit.
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let Field { start, length, per_unit, unit, min, max, .. } = self.field;
        write!(f, "{}", self.name())?;
        match self.field.place {
            Place::Always => {}
            Place::Selector => f.write_str(" M")?,
            Place::Part(part) => write!(f, " m{part}")?,
        }
        // The code for none is among the limits, or tools would warn of it as a start value.
        let max = max.max(self.field.none.unwrap_or(max));
        let sign = if self.field.signed { '-' } else { '+' };
        let (factor, min, max) = (Decimal(1, per_unit), Decimal(min, per_unit), Decimal(max, per_unit));
        write!(f, " : {start}|{length}@1{sign} ({factor},0) [{min}|{max}] \"{unit}\"")
    }
}

/// `.0 / .1` as an exact decimal; the divisor divides a power of ten.
struct Decimal(i64, i64);

impl Display for Decimal {
    #[allow(clippy::arithmetic_side_effects)] // the divisor is at least 1
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let (numerator, divisor) = (self.0.unsigned_abs(), self.1.unsigned_abs().max(1));
        let (whole, mut rest) = (numerator / divisor, numerator % divisor);
        if self.0 < 0 {
            f.write_str("-")?;
        }
        write!(f, "{whole}")?;
        if rest > 0 {
            f.write_str(".")?;
        }
        while rest > 0 {
            let tenfold = rest.saturating_mul(10);
            write!(f, "{}", tenfold / divisor)?;
            rest = tenfold % divisor;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decimals_are_exact() {
        let shown = |numerator, divisor| Decimal(numerator, divisor).to_string();
        assert_eq!(shown(1, 80), "0.0125");
        assert_eq!(shown(-900_000_000, 10_000_000), "-90");
        assert_eq!(shown(-1, 10_000_000), "-0.0000001");
        assert_eq!(shown(28_799, 80), "359.9875");
    }
}
