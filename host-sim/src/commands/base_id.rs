//! The first identifier of the catalogue as an option, which several commands have: what is typed enters, a checked base leaves.

use std::num::ParseIntError;

use holdover::wire::BaseId;

use crate::error::Error;

/// A number, decimal or hexadecimal as 0x480.
///
/// # Errors
/// What is no number of 16 bits.
pub fn number(text: &str) -> Result<u16, ParseIntError> {
    match text.strip_prefix("0x").or_else(|| text.strip_prefix("0X")) {
        Some(digits) => u16::from_str_radix(digits, 16),
        None => text.parse(),
    }
}

/// The base with this identifier; the default one where none is given.
///
/// # Errors
/// An identifier from which not all messages fit into 11 bits.
pub fn checked(id: Option<u16>) -> Result<BaseId, Error> {
    let Some(id) = id else { return Ok(BaseId::DEFAULT) };
    BaseId::new(id).ok_or_else(|| {
        let remedy = format!("give one up to {:#x}, so that the messages fit into 11 bits", BaseId::MAX);
        Error::new(format!("the first identifier is {id:#x}"), remedy).in_option("--base-id")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_base_is_decimal_or_hexadecimal_and_leaves_room_for_all_messages() {
        for (text, id) in [("0", 0), ("1152", 0x480), ("0x480", 0x480), ("0X740", 0x740), ("1856", 0x740)] {
            assert_eq!(checked(Some(number(text).unwrap())).unwrap().get(), id);
        }
        assert_eq!(checked(None).unwrap(), BaseId::DEFAULT);
        for text in ["0x741", "1857", "65535"] {
            assert!(checked(Some(number(text).unwrap())).is_err(), "{text}");
        }
        for text in ["", "x", "-1", "65536", "0x", "480h"] {
            assert!(number(text).is_err(), "{text}");
        }
    }
}
