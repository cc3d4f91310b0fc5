//! The two streams of the terminal: results leave by stdout, progress and logs by stderr.
//!
//! `println!` panics when the reader has closed the pipe (`holdover-sim --json | head -c 1`); these two do not.

use crate::error::Error;
use std::io::{self, Write};

/// Prints results on stdout. A reader that has gone has what it wanted: a broken pipe is no error.
///
/// # Errors
/// Anything else that keeps the results from arriving whole, such as a full disk.
pub fn print(results: &str) -> Result<(), Error> {
    print_to(&mut io::stdout().lock(), results)
}

/// Prints a line of progress or of the log on stderr; nothing is owed to a stderr that is closed.
pub fn say(line: &str) {
    let _ = writeln!(io::stderr().lock(), "{line}");
}

fn print_to(out: &mut impl Write, results: &str) -> Result<(), Error> {
    match out.write_all(results.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(Error::unwritable("standard output".as_ref(), &error))
        }
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Refuses(io::ErrorKind);

    impl Write for Refuses {
        fn write(&mut self, _: &[u8]) -> io::Result<usize> {
            Err(self.0.into())
        }
        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn a_reader_that_has_gone_is_no_error_and_a_full_disk_is() {
        assert_eq!(print_to(&mut Refuses(io::ErrorKind::BrokenPipe), "x"), Ok(()));
        let error = print_to(&mut Refuses(io::ErrorKind::StorageFull), "x").unwrap_err();
        assert!(error.to_string().starts_with("standard output: cannot be written"), "{error}");
    }
}
