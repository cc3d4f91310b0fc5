//! Files of the host, by semihosting: names and bytes enter, bytes leave.

use crate::semihosting::{Call, call};

/// A file of the host, with a small buffer, because each call stops the emulator.
pub struct File {
    handle: usize,
    buffer: [u8; 640],
    /// Bytes of the buffer that are in use: written, or read and not taken yet.
    from: usize,
    to: usize,
}

/// `rb` and `wb` in the numbers of the interface.
const READ: usize = 1;
const WRITE: usize = 5;

impl File {
    /// Opens one to be read; the name ends in a zero.
    pub fn open(name: &str) -> Option<Self> {
        Self::with_mode(name, READ)
    }

    /// Creates one to be written; the name ends in a zero.
    pub fn create(name: &str) -> Option<Self> {
        Self::with_mode(name, WRITE)
    }

    fn with_mode(name: &str, mode: usize) -> Option<Self> {
        let length = name.strip_suffix('\0')?.len();
        // SAFETY: the three words are what the call takes: a name of that length with a zero behind it, and a mode.
        let handle = unsafe { on(Call::Open, [name.as_ptr() as usize, mode, length]) };
        (handle != usize::MAX).then_some(Self { handle, buffer: [0; 640], from: 0, to: 0 })
    }

    /// The next `N` bytes; `None` at the end.
    pub fn read<const N: usize>(&mut self) -> Option<[u8; N]> {
        let mut bytes = [0; N];
        for byte in &mut bytes {
            *byte = self.byte()?;
        }
        Some(bytes)
    }

    fn byte(&mut self) -> Option<u8> {
        if self.from == self.to {
            let (place, size) = (self.buffer.as_mut_ptr() as usize, self.buffer.len());
            // SAFETY: the call writes at most `size` bytes to a buffer that has as many, and returns how many it did not.
            let missing = unsafe { on(Call::Read, [self.handle, place, size]) };
            (self.from, self.to) = (0, size.saturating_sub(missing));
        }
        let byte = self.buffer[..self.to].get(self.from)?;
        self.from += 1;
        Some(*byte)
    }

    /// Writes bytes, sooner or later.
    pub fn write<const N: usize>(&mut self, bytes: &[u8; N]) {
        if let Some(place) = self.buffer.get_mut(self.to..).and_then(<[u8]>::first_chunk_mut) {
            *place = *bytes;
            self.to += N;
        }
        if self.buffer.len() - self.to < N {
            self.flush();
        }
    }

    /// Writes what is not written yet.
    pub fn flush(&mut self) {
        // SAFETY: the call reads so many bytes of a buffer that has as many.
        unsafe { on(Call::Write, [self.handle, self.buffer.as_ptr() as usize, self.to]) };
        self.to = 0;
    }
}

/// A call with three words.
///
/// # Safety
/// As for [`call`], of the addresses in the words.
unsafe fn on(which: Call, words: [usize; 3]) -> usize {
    // SAFETY: the call takes the address of three words; for what these are the caller answers.
    unsafe { call(which, words.as_ptr() as usize) }
}
