//! What a program says: lines enter, and leave on the emulator's output. A panic is said, and ends the program.

use core::fmt::{self, Write};

use crate::file::File;
use crate::semihosting::end;

/// The emulator's output, which is a file of its own name.
struct Output(File);

impl Write for Output {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        text.bytes().for_each(|byte| self.0.write(&[byte]));
        Ok(())
    }
}

/// Says a line.
pub fn say(line: fmt::Arguments) {
    if let Some(mut output) = File::create(":tt\0").map(Output) {
        let _ = writeln!(output, "{line}"); // the output takes everything
        output.0.flush();
    }
}

#[panic_handler]
fn panicked(info: &core::panic::PanicInfo) -> ! {
    say(format_args!("{info}"));
    end(false)
}
