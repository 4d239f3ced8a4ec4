//! Words to the user: whatever has become of the terminal, no panic.
//!
//! The macros of the standard library panic where a stream cannot be written: in a pipe whose reader has gone (`| head`), on a
//! full disk behind a redirection.

use std::fmt::Display;
use std::io::{Error, ErrorKind, Result, Write, stderr, stdout};

/// Writes words to standard output. A reader that has gone wants no more of them: that is no error.
///
/// # Errors
/// If standard output cannot be written.
pub fn print(words: impl Display) -> Result<()> {
    write(&mut stdout().lock(), words)
}

/// Writes a line to standard output, as [`print()`] does.
///
/// # Errors
/// As [`print()`].
pub fn print_line(line: impl Display) -> Result<()> {
    print(format_args!("{line}\n"))
}

/// Writes a line to standard error, if that can be written: there is nobody left to tell if not.
pub fn note(line: impl Display) {
    let _ = writeln!(stderr().lock(), "{line}");
}

fn write(out: &mut impl Write, words: impl Display) -> Result<()> {
    match write!(out, "{words}").and_then(|()| out.flush()) {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        Err(error) => Err(Error::new(error.kind(), format!("standard output cannot be written: {error}"))),
        Ok(()) => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A stream that fails.
    struct Failing(ErrorKind);

    impl Write for Failing {
        fn write(&mut self, _: &[u8]) -> Result<usize> {
            Err(self.0.into())
        }
        fn flush(&mut self) -> Result<()> {
            Ok(())
        }
    }

    #[test]
    fn a_reader_that_has_gone_is_no_error_and_a_full_disk_is() {
        write(&mut Failing(ErrorKind::BrokenPipe), "words").unwrap();
        let error = write(&mut Failing(ErrorKind::StorageFull), "words").unwrap_err();
        assert_eq!(error.kind(), ErrorKind::StorageFull);
        assert!(error.to_string().starts_with("standard output cannot be written: "), "{error}");
        let mut out = Vec::new();
        write(&mut out, format_args!("{} words\n", 2)).unwrap();
        assert_eq!(out, b"2 words\n");
    }
}
