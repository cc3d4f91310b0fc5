//! CAN controllers as their manuals have them, as far as a driver can tell: what the driver writes into their registers enters, and
//! what is on the bus leaves. The test that takes them in has the board's sources as `crate::board`.
#![allow(dead_code)] // every test uses its own part of it

pub mod stm32;
pub mod stm32g474;
pub mod zynqmp;

use crate::board::frame::CanFrame;
use embedded_can::{ExtendedId, Frame, Id, StandardId};

/// What the tests ask of any of them.
pub trait Chip {
    /// The bus is free for this many frames; those that the controller sends.
    fn send(&self, most: usize) -> Vec<CanFrame>;
    /// A transmission begins and fails, because nobody acknowledges; nothing may have been there to send.
    fn fail(&self);
    /// A frame comes over the bus.
    fn hear(&self, frame: &CanFrame);
    /// Too many errors.
    fn go_off(&self);
    /// Another period has passed on an idle bus.
    fn wait(&self);
    /// Whether it takes part in the bus, or will when that has been idle for a moment.
    fn is_on(&self) -> bool;
}

/// What they ask of one with mailboxes, which sends the lowest identifier first.
pub trait Mailboxes: Chip {
    /// The first frame is on the bus, and neither its end nor an error has come.
    fn begin(&self);
    /// Whether an interrupt is there.
    fn interrupts(&self) -> bool;
    /// Mailboxes that wait.
    fn pending(&self) -> usize;
}

pub fn standard(id: u16, data: &[u8]) -> CanFrame {
    CanFrame::new(StandardId::new(id).unwrap(), data).unwrap()
}

pub fn same(a: &CanFrame, b: &CanFrame) -> bool {
    a.id() == b.id() && a.is_remote_frame() == b.is_remote_frame() && a.dlc() == b.dlc() && a.data() == b.data()
}

/// Every form that a frame can have.
pub fn forms() -> Vec<CanFrame> {
    let ids: [Id; 6] = [
        StandardId::ZERO.into(),
        StandardId::new(0x482).unwrap().into(),
        StandardId::MAX.into(),
        ExtendedId::ZERO.into(),
        ExtendedId::new(0x1234_5678).unwrap().into(),
        ExtendedId::MAX.into(),
    ];
    let data = [1, 2, 3, 4, 5, 6, 7, 0x80];
    let frames =
        |id| (0..=8).flat_map(move |length| [CanFrame::new(id, &data[..length]), CanFrame::new_remote(id, length)]);
    ids.into_iter().flat_map(frames).map(Option::unwrap).collect()
}
