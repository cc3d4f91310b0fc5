//! The parts of the file that are the same whatever the catalogue says.

/// Up to the messages.
pub(super) const HEAD: &str = concat!(
    "VERSION \"",
    env!("CARGO_PKG_VERSION"),
    "\"

NS_ :

BS_:

BU_: Unit Modem Vehicle

"
);

/// What the times of every message mean.
macro_rules! timeouts {
    () => {
        "GenMsgSendType CyclicIfActive: sent every GenMsgCycleTime, but only while it is as the message's comment says. GenMsgTimeout: \
of what the unit receives, the time after which it reacts; 0: what was said last holds. Of what it sends: for receivers, while the message \
is active."
    };
}

/// What holds for every message.
const NOTES: &str = concat!(
    "CM_ \"Every message: AUTOSAR E2E Profile 1, variant 1A: Crc is CRC-8 with polynomial 0x1D, initial \
value and final xor 0, over E2EDataId (low byte, high byte) and bytes 1 to 7; Counter counts 0 to 14 on each identifier. \
A raw value outside a signal's limits is reserved, and so is one between the last value and a named one: a frame with one is refused whole. Where a message \
needs several frames, they carry the same Tag, which differs from that of the message before; a message is used only when \
whole. ",
    timeouts!(),
    "\";
"
);

/// The nodes.
pub(super) const NODES: &str = "CM_ BU_ Unit \"The holdover unit.\";
CM_ BU_ Modem \"The V2X modem; it assigns the slots and keeps the bus's GNSS time.\";
CM_ BU_ Vehicle \"The vehicle's own sensors, driver's desk and planner.\";
";

/// The attributes.
const ATTRIBUTES: &str = "BA_DEF_ \"BusType\" STRING ;
BA_DEF_ \"Baudrate\" INT 0 1000000;
BA_DEF_ \"InterfaceVersion\" INT 0 7;
BA_DEF_ BO_ \"GenMsgSendType\" ENUM \"Cyclic\",\"CyclicIfActive\",\"NoMsgSendType\";
BA_DEF_ BO_ \"E2EProfile\" STRING ;
BA_DEF_ SG_ \"GenSigStartValue\" INT -2147483648 2147483647;
BA_DEF_ BO_ \"GenMsgCycleTime\" INT 0 65535;
BA_DEF_ BO_ \"GenMsgTimeout\" INT 0 65535;
BA_DEF_ BO_ \"FramesPerCycle\" INT 1 255;
BA_DEF_ BO_ \"E2EDataId\" INT 0 65535;
BA_DEF_ BO_ \"E2EMaxDeltaCounterInit\" INT 0 14;
BA_DEF_ BO_ \"E2EMaxNoNewOrRepeatedData\" INT 0 14;
BA_DEF_ BO_ \"E2ESyncCounterInit\" INT 0 14;
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

/// What holds for every message over CAN FD.
#[cfg(feature = "fd")]
const NOTES_FD: &str = concat!(
    "CM_ \"Every message is one frame of CAN FD with a bit rate switch: AUTOSAR E2E Profile 5: Crc is CRC-16 with \
polynomial 0x1021, initial value 0xFFFF and final xor 0, over the bytes after it and then E2EDataId (low byte, high byte); Counter counts 0 to 255 on each \
identifier. A raw value outside a signal's limits is reserved, and so is one between the last value and a named one: a frame with one is refused whole; \
but what a signal named Valid says is not there is ignored. Bits that no signal has are 0. Part n of a comment are the signals whose names end in n. ",
    timeouts!(),
    "\";
"
);

/// The attributes over CAN FD.
#[cfg(feature = "fd")]
const ATTRIBUTES_FD: &str = "BA_DEF_ \"BusType\" STRING ;
BA_DEF_ \"Baudrate\" INT 0 1000000;
BA_DEF_ \"BaudrateCANFD\" INT 0 16000000;
BA_DEF_ \"InterfaceVersion\" INT 0 7;
BA_DEF_ BO_ \"VFrameFormat\" ENUM \"StandardCAN\",\"ExtendedCAN\",\"reserved\",\"reserved\",\"reserved\",\"reserved\",\"reserved\",\"reserved\",\"reserved\",\"reserved\",\"reserved\",\"reserved\",\"reserved\",\"reserved\",\"StandardCAN_FD\",\"ExtendedCAN_FD\";
BA_DEF_ BO_ \"CANFD_BRS\" ENUM \"0\",\"1\";
BA_DEF_ BO_ \"GenMsgSendType\" ENUM \"Cyclic\",\"CyclicIfActive\",\"NoMsgSendType\";
BA_DEF_ BO_ \"E2EProfile\" STRING ;
BA_DEF_ SG_ \"GenSigStartValue\" INT -2147483648 2147483647;
BA_DEF_ BO_ \"GenMsgCycleTime\" INT 0 65535;
BA_DEF_ BO_ \"GenMsgTimeout\" INT 0 65535;
BA_DEF_ BO_ \"E2EDataId\" INT 0 65535;
BA_DEF_ BO_ \"E2EMaxDeltaCounter\" INT 0 255;
BA_DEF_DEF_ \"VFrameFormat\" \"StandardCAN_FD\";
BA_DEF_DEF_ \"CANFD_BRS\" \"1\";
BA_DEF_DEF_ \"GenMsgSendType\" \"Cyclic\";
BA_DEF_DEF_ \"E2EProfile\" \"PROFILE_05\";
BA_DEF_DEF_ \"GenSigStartValue\" 0;
BA_DEF_DEF_ \"GenMsgCycleTime\" 0;
BA_DEF_DEF_ \"GenMsgTimeout\" 0;
BA_DEF_DEF_ \"E2EDataId\" 0;
BA_DEF_DEF_ \"E2EMaxDeltaCounter\" 0;
";

/// What holds for every message of this kind of bus.
pub(super) const fn notes(is_over_fd: bool) -> &'static str {
    #[cfg(feature = "fd")]
    if is_over_fd {
        return NOTES_FD;
    }
    let _ = is_over_fd;
    NOTES
}

/// The attributes of this kind of bus.
pub(super) const fn attributes(is_over_fd: bool) -> &'static str {
    #[cfg(feature = "fd")]
    if is_over_fd {
        return ATTRIBUTES_FD;
    }
    let _ = is_over_fd;
    ATTRIBUTES
}
