//! A reader of DBC files: text enters; messages with data ids and signals leave. It reads as much of the format as
//! `holdover.dbc` uses.

use std::collections::HashMap;

/// A signal of Intel byte order: its first bit in the frame's 64 bits, and its number of bits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Signal {
    start: u32,
    bits: u32,
    is_signed: bool,
    factor: f64,
    least: i64,
    most: i64,
}

impl Signal {
    /// Writes the nearest value within the signal's limits into the frame. A value that is not a number becomes all
    /// ones.
    pub fn put(&self, word: &mut u64, value: f64) {
        if value.is_nan() {
            return self.put_raw(word, -1);
        }
        self.put_raw(word, ((value / self.factor).round() as i64).clamp(self.least, self.most));
    }

    /// Writes a raw number, modulo the range of the bits.
    pub fn put_raw(&self, word: &mut u64, raw: i64) {
        let mask = self.mask();
        *word = *word & !(mask << self.start) | ((raw as u64 & mask) << self.start);
    }

    /// The raw number.
    pub fn raw(&self, word: u64) -> i64 {
        let raw = (word >> self.start) & self.mask();
        let unused = 64 - self.bits;
        if self.is_signed { ((raw << unused) as i64) >> unused } else { raw as i64 }
    }

    /// The value.
    pub fn get(&self, word: u64) -> f64 {
        self.raw(word) as f64 * self.factor
    }

    /// The smallest value of the signal's grid that is at least this, within its limits.
    pub fn up(&self, value: f64) -> f64 {
        ((value / self.factor - 1e-9).ceil() as i64).clamp(self.least, self.most) as f64 * self.factor
    }

    fn mask(&self) -> u64 {
        u64::MAX >> (64 - self.bits)
    }
}

/// A message.
#[derive(Clone, Debug, Default)]
pub struct Message {
    /// Its identifier on the bus.
    pub id: u16,
    /// What its checksum covers besides the bytes.
    pub data_id: u16,
    signals: HashMap<String, Signal>,
}

impl Message {
    /// The signal with this name. It panics if there is none: this crate works only with a catalogue that has it.
    pub fn signal(&self, name: &str) -> Signal {
        *self.signals.get(name).unwrap_or_else(|| panic!("holdover.dbc has no signal {name} in {:#x}", self.id))
    }
}

/// All messages, by name.
#[derive(Clone, Debug, Default)]
pub struct Dbc(HashMap<String, Message>);

impl Dbc {
    /// Reads the text.
    pub fn parse(text: &str) -> Self {
        let mut messages: HashMap<String, Message> = HashMap::new();
        let mut data_ids: HashMap<u16, u16> = HashMap::new();
        let mut current = None;
        for line in text.lines() {
            let words: Vec<&str> = line.split_whitespace().collect();
            match words.as_slice() {
                ["BO_", id, name, ..] => {
                    let name = name.trim_end_matches(':').to_string();
                    let id = id.parse().expect("an identifier");
                    messages.insert(name.clone(), Message { id, ..Message::default() });
                    current = Some(name);
                }
                ["SG_", name, rest @ ..] => {
                    // A multiplexer's mark may be between the name and the colon.
                    let place = rest.iter().position(|word| *word == ":").expect("a colon") + 1;
                    let message = current.as_ref().and_then(|name| messages.get_mut(name)).expect("a message");
                    message.signals.insert((*name).to_string(), signal(rest[place], rest[place + 1], rest[place + 2]));
                }
                ["BA_", "\"E2EDataId\"", "BO_", id, value] => {
                    let value = value.trim_end_matches(';').parse().expect("a data id");
                    data_ids.insert(id.parse().expect("an identifier"), value);
                }
                _ => {}
            }
        }
        for message in messages.values_mut() {
            message.data_id = *data_ids.get(&message.id).expect("every message has a data id");
        }
        Self(messages)
    }

    /// All messages, in no particular order.
    pub fn messages(&self) -> impl Iterator<Item = &Message> {
        self.0.values()
    }

    /// The message with this name.
    pub fn message(&self, name: &str) -> &Message {
        self.0.get(name).unwrap_or_else(|| panic!("holdover.dbc has no message {name}"))
    }
}

/// `12|14@1-`, `(0.002,0)` and `[-16.382|16.382]`.
fn signal(place: &str, scale: &str, limits: &str) -> Signal {
    let (start, rest) = place.split_once('|').expect("a place");
    let (bits, order) = rest.split_once('@').expect("a byte order");
    assert!(order.starts_with('1'), "Intel byte order only");
    let (factor, offset) = scale.trim_matches(['(', ')']).split_once(',').expect("a scale");
    assert_eq!(offset, "0", "no offsets");
    let factor: f64 = factor.parse().expect("a factor");
    let (least, most) = limits.trim_matches(['[', ']']).split_once('|').expect("limits");
    let raw = |text: &str| (text.parse::<f64>().expect("a limit") / factor).round() as i64;
    Signal {
        start: start.parse().expect("a bit"),
        bits: bits.parse().expect("a number of bits"),
        is_signed: order.ends_with('-'),
        factor,
        least: raw(least),
        most: raw(most),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_signal_is_read_as_it_was_written() {
        let text = "BO_ 1154 Command: 8 Unit\n SG_ A : 12|14@1- (0.002,0) [-16.382|16.382] \"m/s2\" Modem\n \
                    SG_ F m0 : 37|16@1+ (1,0) [0|65534] \"N\" Modem\nBA_ \"E2EDataId\" BO_ 1154 18434;\n";
        let dbc = Dbc::parse(text);
        let (message, mut word) = (dbc.message("Command"), u64::MAX);
        assert_eq!((message.id, message.data_id), (1154, 18434));
        message.signal("A").put(&mut word, -3.1);
        message.signal("F").put(&mut word, 1e9);
        assert!((message.signal("A").get(word) + 3.1).abs() < 1e-9);
        assert_eq!(message.signal("F").raw(word), 65_534);
        assert_eq!(word & 0xFFF, 0xFFF);
    }
}
