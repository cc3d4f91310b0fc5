//! The attributes of the file. What is known of a message enters; its attributes leave by name. All are written for every message, also
//! where a value is the default, because not every tool reads the defaults.

use core::fmt::{Display, Formatter, Result};

use super::Described;
use super::texts;
use crate::wire::catalogue::data_id;
use crate::wire::status::INTERFACE;

/// The value of an attribute.
#[derive(Clone, Copy)]
pub(super) enum Value {
    /// A number, or the place of a name in its enumeration.
    Number(u16),
    Text(&'static str),
}

impl Display for Value {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        match self {
            Self::Number(number) => write!(f, "{number}"),
            Self::Text(text) => write!(f, "\"{text}\""),
        }
    }
}

/// When a message is sent, by the place of its name in the enumeration of `GenMsgSendType`.
#[repr(u16)]
enum SendType {
    /// `Cyclic`.
    Always = 0,
    /// `CyclicIfActive`.
    IfActive = 1,
    /// `NoMsgSendType`.
    Never = 2,
}

/// The format of a frame of CAN FD, by its place in the enumeration of `VFrameFormat`.
#[repr(u16)]
enum FrameFormat {
    StandardCanFd = 14,
    ExtendedCanFd = 15,
}

/// Defines the attributes, and gives those of the bus.
pub(super) fn define(f: &mut Formatter<'_>, is_over_fd: bool) -> Result {
    f.write_str(texts::attributes(is_over_fd))?;
    let (bus, rates): (_, &[(&str, u32)]) = if is_over_fd {
        ("CAN FD", &[("Baudrate", 500_000), ("BaudrateCANFD", 2_000_000)])
    } else {
        ("CAN", &[("Baudrate", 500_000)])
    };
    // As a default first, and then as the value.
    for keyword in ["BA_DEF_DEF_", "BA_"] {
        writeln!(f, "{keyword} \"BusType\" \"{bus}\";")?;
        for (name, rate) in rates {
            writeln!(f, "{keyword} \"{name}\" {rate};")?;
        }
        writeln!(f, "{keyword} \"InterfaceVersion\" {INTERFACE};")?;
    }
    Ok(())
}

impl Described {
    pub(super) fn attributes(&self) -> impl Iterator<Item = (&'static str, Value)> {
        let (line, limits, is_over_fd) = (self.line, self.line.limits(), self.is_over_fd);
        let both = |name, value| Some((name, Value::Number(value)));
        let classic = |name, value: u8| (!is_over_fd).then_some((name, Value::Number(value.into())));
        let fd = |name, value| is_over_fd.then_some((name, Value::Number(value)));
        let most_lost = limits.max_delta_counter_init;
        let send_type = match line.is_sent() {
            false => SendType::Never,
            true if line.only.is_empty() => SendType::Always,
            true => SendType::IfActive,
        };
        let format = if self.id.is_extended() { FrameFormat::ExtendedCanFd } else { FrameFormat::StandardCanFd };
        let profile = if is_over_fd { "PROFILE_05" } else { "PROFILE_01A" };
        [
            fd("VFrameFormat", format as u16),
            fd("CANFD_BRS", 1),
            both("GenMsgSendType", send_type as u16),
            both("GenMsgCycleTime", line.cycle_ms),
            both("GenMsgTimeout", line.timeout_ms),
            classic("FramesPerCycle", line.frames),
            Some(("E2EProfile", Value::Text(profile))),
            both("E2EDataId", data_id(line.offset_for(self.slot))),
            classic("E2EMaxDeltaCounterInit", most_lost),
            classic("E2EMaxNoNewOrRepeatedData", limits.max_no_new_or_repeated),
            classic("E2ESyncCounterInit", limits.sync_counter_init),
            fd("E2EMaxDeltaCounter", u16::from(most_lost).saturating_add(1)),
        ]
        .into_iter()
        .flatten()
    }
}
