//! The catalogue as a DBC file for everyone else's tools: its identifiers and a number of slots enter, text leaves
//! ([`core::fmt::Display`]). `holdover.dbc` at the root of the package is this for base 0x480 and 8 slots.

use core::fmt::{Display, Formatter, Result};

use super::Slot;
use super::catalogue::{CATALOGUE, Line, Node, SLOTS, data_id};
use super::field::{Field, Place, TAG};
use super::identifiers::Identifiers;
use super::meaning;
use super::message_name::MessageName;

/// The DBC of a bus.
#[derive(Clone, Copy, Debug)]
pub struct Dbc {
    identifiers: Identifiers,
    slots: u8,
}

impl Dbc {
    /// With these identifiers and so many slots (at most those that there are identifiers for).
    #[must_use]
    pub fn new(identifiers: Identifiers, slots: u8) -> Self {
        Self { identifiers, slots: slots.min(u8::try_from(SLOTS).unwrap_or(u8::MAX)) }
    }

    /// Every message: its line, slot and identifier.
    fn messages(&self) -> impl Iterator<Item = (&'static Line, Slot, u32)> {
        let Self { identifiers, slots } = *self;
        let single = CATALOGUE.iter().filter(|line| !line.is_per_slot()).map(|line| (line, Slot(0)));
        let peers = (0..slots)
            .flat_map(|slot| CATALOGUE.iter().filter(|line| line.is_per_slot()).map(move |line| (line, Slot(slot))));
        single.chain(peers).map(move |(line, slot)| (line, slot, identifiers.at(line.offset_for(slot)).in_dbc()))
    }
}

impl Display for Dbc {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        f.write_str(HEAD)?;
        for (line, slot, id) in self.messages() {
            writeln!(f, "BO_ {id} {}: 8 {}", MessageName::of(line, slot), node(line.sender))?;
            let receivers = if matches!(line.sender, Node::Unit) { "Modem,Vehicle" } else { "Unit" };
            writeln!(f, " SG_ Crc : 0|8@1+ (1,0) [0|255] \"\" {receivers}")?;
            writeln!(f, " SG_ Counter : 8|4@1+ (1,0) [0|14] \"\" {receivers}")?;
            for signal in signals(line) {
                writeln!(f, " SG_ {signal} {receivers}")?;
            }
            writeln!(f)?;
        }
        f.write_str(NOTES)?;
        for (line, _, id) in self.messages() {
            writeln!(f, "CM_ BO_ {id} \"{}\";", line.comment)?;
            writeln!(f, "CM_ SG_ {id} Crc \"{}\";", meaning::CRC)?;
            writeln!(f, "CM_ SG_ {id} Counter \"{}\";", meaning::COUNTER)?;
            for signal in signals(line) {
                let meaning = meaning::signal(line.content, signal.field.name);
                writeln!(f, "CM_ SG_ {id} {} \"{meaning}\";", signal.name())?;
            }
        }
        f.write_str(ATTRIBUTES)?;
        for (line, slot, id) in self.messages() {
            let limits = line.limits();
            for (name, value) in [
                ("GenMsgCycleTime", line.cycle_ms),
                ("GenMsgTimeout", line.timeout_ms),
                ("FramesPerCycle", u16::from(line.frames)),
                ("E2EDataId", data_id(line.offset_for(slot))),
                ("E2EMaxDeltaCounterInit", u16::from(limits.max_delta_counter_init)),
                ("E2EMaxNoNewOrRepeatedData", u16::from(limits.max_no_new_or_repeated)),
                ("E2ESyncCounterInit", u16::from(limits.sync_counter_init)),
            ] {
                writeln!(f, "BA_ \"{name}\" BO_ {id} {value};")?;
            }
            for signal in signals(line) {
                let (name, start) = (signal.name(), signal.start());
                if start != 0 {
                    writeln!(f, "BA_ \"GenSigStartValue\" SG_ {id} {name} {start};")?;
                }
            }
        }
        for (line, _, id) in self.messages() {
            for signal in signals(line).filter(|signal| !signal.field.values.is_empty()) {
                write!(f, "VAL_ {id} {}", signal.name())?;
                for (raw, name) in signal.field.values {
                    write!(f, " {raw} \"{name}\"")?;
                }
                writeln!(f, " ;")?;
            }
        }
        Ok(())
    }
}

const HEAD: &str = concat!(
    "VERSION \"",
    env!("CARGO_PKG_VERSION"),
    "\"

NS_ :

BS_:

BU_: Unit Modem Vehicle

"
);

const NOTES: &str = "CM_ \"Every message: AUTOSAR E2E Profile 1, variant 1A: Crc is CRC-8 with polynomial 0x1D, initial \
value and final xor 0, over E2EDataId (low byte, high byte) and bytes 1 to 7; Counter counts 0 to 14 on each identifier. \
A raw value outside a signal's limits is reserved, and so is one between the last value and a named one: a frame with one is refused whole. Where a message \
needs several frames, they carry the same Tag, which differs from that of the message before; a message is used only when \
whole.\";
CM_ BU_ Unit \"The holdover unit.\";
CM_ BU_ Modem \"The V2X modem; it assigns the slots and keeps the bus's GNSS time.\";
CM_ BU_ Vehicle \"The vehicle's own sensors, driver's desk and planner.\";
";

const ATTRIBUTES: &str = "BA_DEF_ \"BusType\" STRING ;
BA_DEF_ \"Baudrate\" INT 0 1000000;
BA_DEF_ \"InterfaceVersion\" INT 0 7;
BA_DEF_ BO_ \"GenMsgSendType\" ENUM \"Cyclic\",\"NoMsgSendType\";
BA_DEF_ BO_ \"E2EProfile\" STRING ;
BA_DEF_ SG_ \"GenSigStartValue\" INT -2147483648 2147483647;
BA_DEF_ BO_ \"GenMsgCycleTime\" INT 0 65535;
BA_DEF_ BO_ \"GenMsgTimeout\" INT 0 65535;
BA_DEF_ BO_ \"FramesPerCycle\" INT 1 255;
BA_DEF_ BO_ \"E2EDataId\" INT 0 65535;
BA_DEF_ BO_ \"E2EMaxDeltaCounterInit\" INT 0 14;
BA_DEF_ BO_ \"E2EMaxNoNewOrRepeatedData\" INT 0 14;
BA_DEF_ BO_ \"E2ESyncCounterInit\" INT 0 14;
BA_DEF_DEF_ \"BusType\" \"CAN\";
BA_DEF_DEF_ \"Baudrate\" 500000;
BA_DEF_DEF_ \"InterfaceVersion\" 2;
BA_DEF_DEF_ \"GenMsgSendType\" \"Cyclic\";
BA_DEF_DEF_ \"E2EProfile\" \"PROFILE_01A\";
BA_DEF_DEF_ \"GenSigStartValue\" 0;
BA_DEF_DEF_ \"GenMsgCycleTime\" 0;
BA_DEF_DEF_ \"GenMsgTimeout\" 0;
BA_DEF_DEF_ \"FramesPerCycle\" 1;
BA_DEF_DEF_ \"E2EDataId\" 0;
BA_DEF_DEF_ \"E2EMaxDeltaCounterInit\" 0;
BA_DEF_DEF_ \"E2EMaxNoNewOrRepeatedData\" 0;
BA_DEF_DEF_ \"E2ESyncCounterInit\" 0;
";

const fn node(node: Node) -> &'static str {
    match node {
        Node::Unit => "Unit",
        Node::Modem => "Modem",
        Node::Vehicle => "Vehicle",
    }
}

/// A signal of the file: a field, in one part where every part of a message has the same fields, so that tools see each part by a
/// name of its own.
struct Signal {
    field: &'static Field,
    part: Option<u8>,
}

/// All signals of a line.
fn signals(line: &'static Line) -> impl Iterator<Item = Signal> {
    let parts = line.selector().filter(|_| line.fields.iter().all(|field| !matches!(field.place, Place::Part(_))));
    let parts = parts.map_or(0, |selector| u8::try_from(selector.max).unwrap_or(0).saturating_add(1));
    line.fields.iter().flat_map(move |field| {
        let is_in_each = parts > 0 && field.place == Place::Always && field.name != TAG.name;
        let (first, last) = if is_in_each { (0, parts) } else { (0, 1) };
        (first..last).map(move |part| Signal { field, part: is_in_each.then_some(part) })
    })
}

impl Signal {
    fn name(&self) -> SignalName {
        SignalName(self.field.name, self.part)
    }

    /// The raw value before anything is known: the code for none, or the value nearest to zero.
    fn start(&self) -> i64 {
        self.field.none.unwrap_or(0i64.max(self.field.min).min(self.field.max))
    }
}

/// The name of a signal, with its part where every part has one.
struct SignalName(&'static str, Option<u8>);

impl Display for SignalName {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        f.write_str(self.0)?;
        self.1.map_or(Ok(()), |part| write!(f, "{part}"))
    }
}

impl Display for Signal {
    /// Up to its unit.
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let Field { start, length, per_unit, unit, min, max, .. } = *self.field;
        write!(f, "{}", self.name())?;
        match (self.field.place, self.part) {
            (Place::Always, None) => {}
            (Place::Selector, _) => f.write_str(" M")?,
            (Place::Part(part), _) | (Place::Always, Some(part)) => write!(f, " m{part}")?,
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

    #[test]
    fn every_signal_says_what_it_means() {
        for (line, signal) in CATALOGUE.iter().flat_map(|line| signals(line).map(move |signal| (line, signal))) {
            let meaning = meaning::signal(line.content, signal.field.name);
            assert!(meaning.ends_with('.') && !meaning.contains('"'), "{} {}: {meaning}", line.name, signal.name());
        }
    }

    #[test]
    fn every_factor_of_the_catalogue_is_a_decimal() {
        for field in CATALOGUE.iter().flat_map(|line| line.fields) {
            assert_eq!(1_000_000_000 % field.per_unit, 0, "{}", field.name);
        }
    }
}
