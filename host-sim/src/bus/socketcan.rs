//! A CAN interface of Linux: frames enter and are sent by its driver. Frames of other nodes, the echoes of the own
//! frames, and error frames leave with the kernel's time stamps, in microseconds since 1970.
//!
//! *Own frames* come back when they really were on the bus. The kernel marks them, but socket libraries do not pass the
//! mark on. So a frame that equals an own frame without an echo yet is taken for that echo. If a foreign frame with the
//! same bits comes at the same time, the two are taken for one another, which makes no difference.

use super::port::{BusError, Event, Port};
use super::{Bus, Frame};
use crate::error::{Error, quoted};
use embedded_can::{ExtendedId, Id, StandardId};
use holdover::time::Instant;
use holdover::wire::Identifier;
use nix::poll::{PollFd, PollFlags, PollTimeout, poll};
use socketcan::{
    CanAnyFrame, CanErrorFrame, CanFdFrame, CanFdSocket, CanFilter, CanFrame, EmbeddedFrame, Frame as _, Socket,
    SocketOptions, id::FdFlags,
};
use std::collections::VecDeque;
use std::io::{self, ErrorKind};
use std::os::fd::AsFd;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

/// Bytes that may wait in the kernel for this program: a second of a full bus.
const WAITING_BYTES: i32 = 1 << 22;
/// Level of the socket option for that, in Linux.
const SOL_SOCKET: i32 = 1;
const SO_RCVBUFFORCE: i32 = 33;
/// How long to wait while the driver's transmit queue is full.
const QUEUE_PATIENCE: Duration = Duration::from_millis(20);

/// A node on a CAN interface.
#[derive(Debug)]
pub struct SocketCan {
    socket: CanFdSocket,
    /// Frames that were sent and have not been seen on the bus yet.
    awaited: VecDeque<Frame>,
    /// An event that was received, and is later than a [`Bus::receive`] asked for.
    early: Option<(Instant, Event)>,
}

impl SocketCan {
    /// Opens an interface by its name.
    ///
    /// # Errors
    /// There is no CAN, no such interface, or the interface is down; with the remedy.
    pub fn open(name: &str) -> Result<Self, Error> {
        let socket = CanFdSocket::open_iface(0).and_then(|_| CanFdSocket::open(name));
        let socket = socket.map_err(|error| unopened(name, &error))?;
        if is_down(name) {
            return Err(Error::new(format!("{} is down", quoted(name)), format!("as root: {}", up(name))));
        }
        let set_up = || {
            socket.set_nonblocking(true)?;
            socket.set_recv_timestamp(true)?;
            socket.set_recv_own_msgs(true)?;
            socket.set_error_filter_accept_all()?;
            // Above the system's own limit this needs root rights. Within that limit about 500 frames fit.
            let forced = socket.set_socket_option_int(SOL_SOCKET, SO_RCVBUFFORCE, WAITING_BYTES);
            forced.or_else(|_| socket.as_raw_socket().set_recv_buffer_size(WAITING_BYTES as usize))
        };
        set_up().map_err(|error| unopened(name, &error))?;
        Ok(Self { socket, awaited: VecDeque::new(), early: None })
    }

    /// Lets the kernel pass only error frames, and frames with these identifiers, of any kind and length.
    ///
    /// # Errors
    /// Errors of the system.
    pub fn hear_only(&self, ids: impl IntoIterator<Item = Identifier>) -> io::Result<()> {
        const EXACTLY: u32 = 0x9FFF_FFFF; // all bits of the identifier, and how many it has
        let filters: Vec<_> = ids.into_iter().map(|id| CanFilter::new(id.in_dbc(), EXACTLY)).collect();
        self.socket.set_filters(&filters)
    }

    /// Frames that were sent and have not been seen on the bus.
    #[must_use]
    pub fn awaited(&self) -> usize {
        self.awaited.len()
    }

    /// The next event that has occurred by now.
    fn next(&mut self) -> io::Result<Option<(Instant, Event)>> {
        if let Some(early) = self.early.take() {
            return Ok(Some(early));
        }
        let (frame, stamps) = match self.socket.read_frame_with_timestamps() {
            Ok(read) => read,
            Err(error) => {
                return match error.kind() {
                    ErrorKind::WouldBlock | ErrorKind::Interrupted => Ok(None),
                    ErrorKind::NetworkDown => {
                        self.awaited.clear();
                        Ok(Some((self.now(), Event::Down)))
                    }
                    _ => Err(error),
                };
            }
        };
        let at = stamps.socket.map_or_else(|| self.now(), instant);
        let event = match read(&frame) {
            Some(frame) => match self.awaited.iter().position(|sent| is_same(sent, &frame)) {
                Some(place) => {
                    self.awaited.remove(place);
                    Event::Sent(frame)
                }
                None => Event::Received(frame),
            },
            None => Event::Error(error(&frame)),
        };
        Ok(Some((at, event)))
    }

    fn write(&self, frame: &CanAnyFrame) -> io::Result<()> {
        let given_up = SystemTime::now() + QUEUE_PATIENCE;
        loop {
            match self.socket.write_frame(frame) {
                // The driver's queue is full: the bus is slower than this program.
                Err(error) if is_queue_full(&error) && SystemTime::now() < given_up => {
                    std::thread::sleep(Duration::from_micros(200));
                }
                other => return other,
            }
        }
    }
}

impl Port for SocketCan {
    fn now(&self) -> Instant {
        instant(SystemTime::now())
    }

    fn send(&mut self, frame: Frame) -> io::Result<()> {
        self.write(&linux(&frame)?)?;
        self.awaited.push_back(frame);
        Ok(())
    }

    fn send_error(&mut self, error: BusError) -> io::Result<()> {
        let frame = CanErrorFrame::new_error(error.classes, &error.data).map_err(io::Error::other)?;
        self.write(&CanAnyFrame::Error(frame))
    }

    fn wait(&mut self, until: Instant) -> io::Result<Option<(Instant, Event)>> {
        loop {
            if let Some(event) = self.next()? {
                return Ok(Some(event));
            }
            let left = until.since(self.now()).as_micros();
            if left <= 0 {
                return Ok(None);
            }
            // The kernel waits for events in whole milliseconds. An event in the remaining time has its stamp
            // nevertheless.
            match u16::try_from(left / 1000).unwrap_or(u16::MAX) {
                0 => std::thread::sleep(Duration::from_micros(left.unsigned_abs())),
                millis => {
                    let waited =
                        poll(&mut [PollFd::new(self.socket.as_fd(), PollFlags::POLLIN)], PollTimeout::from(millis));
                    match waited {
                        Ok(_) | Err(nix::Error::EINTR) => {}
                        Err(error) => return Err(error.into()),
                    }
                }
            }
        }
    }
}

/// A bus by its own time: a frame is sent now, whatever its time, and the echoes are not passed on.
impl Bus for SocketCan {
    fn send(&mut self, _at: Instant, frame: Frame) -> io::Result<()> {
        Port::send(self, frame)
    }

    fn receive(&mut self, upto: Instant) -> io::Result<Option<(Instant, Frame)>> {
        while let Some((at, event)) = self.next()? {
            match event {
                Event::Received(_) if at > upto => {
                    self.early = Some((at, event));
                    return Ok(None);
                }
                Event::Received(frame) => return Ok(Some((at, frame))),
                Event::Sent(_) | Event::Error(_) | Event::Down => {}
            }
        }
        Ok(None)
    }
}

fn instant(time: SystemTime) -> Instant {
    let since = time.duration_since(UNIX_EPOCH).unwrap_or_default();
    Instant::from_micros(u64::try_from(since.as_micros()).unwrap_or(u64::MAX))
}

/// Whether they are the same but for flags, of which a kernel may add some.
fn is_same(a: &Frame, b: &Frame) -> bool {
    let bits = |frame: &Frame| (frame.id(), frame.is_fd(), frame.is_remote_frame(), frame.dlc());
    bits(a) == bits(b) && a.data() == b.data()
}

/// The frame; `None` if it reports an error.
fn read(frame: &CanAnyFrame) -> Option<Frame> {
    let id = identifier(frame)?;
    match frame {
        CanAnyFrame::Normal(data) => Frame::new(id, EmbeddedFrame::data(data)),
        CanAnyFrame::Remote(remote) => Frame::new_remote(id, EmbeddedFrame::dlc(remote)),
        CanAnyFrame::Fd(fd) => Frame::fd(id, fd.flags().bits(), EmbeddedFrame::data(fd)),
        CanAnyFrame::Error(_) => None,
    }
}

fn identifier(frame: &CanAnyFrame) -> Option<Id> {
    match frame.raw_id() & 0x1FFF_FFFF {
        raw if frame.is_extended() => ExtendedId::new(raw).map(Id::Extended),
        raw => u16::try_from(raw).ok().and_then(StandardId::new).map(Id::Standard),
    }
}

/// The error that a frame reports.
fn error(frame: &CanAnyFrame) -> BusError {
    let mut data = [0; 8];
    data.iter_mut().zip(frame.data()).for_each(|(to, from)| *to = *from);
    BusError { classes: frame.raw_id() & 0x1FFF_FFFF, data }
}

fn linux(frame: &Frame) -> io::Result<CanAnyFrame> {
    let made = match (frame.is_fd(), frame.is_remote_frame()) {
        (true, _) => {
            let flags = FdFlags::from_bits_truncate(frame.flags());
            CanFdFrame::with_flags(frame.id(), frame.data(), flags).map(CanAnyFrame::Fd)
        }
        (false, true) => <CanFrame as EmbeddedFrame>::new_remote(frame.id(), frame.dlc()).map(CanAnyFrame::from),
        (false, false) => <CanFrame as EmbeddedFrame>::new(frame.id(), frame.data()).map(CanAnyFrame::from),
    };
    made.ok_or_else(|| io::Error::new(ErrorKind::InvalidInput, "no frame of CAN"))
}

fn is_queue_full(error: &io::Error) -> bool {
    const ENOBUFS: i32 = 105;
    error.raw_os_error() == Some(ENOBUFS) || error.kind() == ErrorKind::WouldBlock
}

fn is_down(name: &str) -> bool {
    const UP: u32 = 1;
    let flags = std::fs::read_to_string(format!("/sys/class/net/{name}/flags")).ok();
    let flags = flags.and_then(|flags| u32::from_str_radix(flags.trim().trim_start_matches("0x"), 16).ok());
    flags.is_some_and(|flags| flags & UP == 0)
}

/// The command that sets the interface up.
fn up(name: &str) -> String {
    let bitrate = if name.starts_with("can") { " type can bitrate 500000" } else { "" };
    format!("ip link set {name} up{bitrate}")
}

fn unopened(name: &str, error: &io::Error) -> Error {
    const EAFNOSUPPORT: i32 = 97;
    const ENODEV: i32 = 19;
    let shown = quoted(name);
    let is_there = std::path::Path::new("/sys/class/net").join(name).exists();
    match error.raw_os_error() {
        Some(EAFNOSUPPORT) => Error::new(
            "this kernel has no CAN",
            "as root: modprobe can-raw; or run the command under a kernel that has it: scripts/vcan.sh COMMAND...",
        ),
        Some(ENODEV) if is_there => Error::new(format!("{shown} is no CAN interface"), "name one, such as vcan0"),
        Some(ENODEV) => Error::new(
            format!("there is no network interface {shown}"),
            format!("as root: modprobe vcan && ip link add dev {name} type vcan && ip link set {name} up"),
        ),
        _ => Error::new(format!("{shown} cannot be used ({error})"), "check the interface with `ip -details link`"),
    }
}
