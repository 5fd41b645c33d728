//! Standard output that survives a closed pipe.

use std::io::{self, ErrorKind, Write};

use crate::errors::CliError;

/// Writes `text` to standard output, ending it with a line feed if it has none.
///
/// A reader that has gone away (`linkdyn scenes | head -1`) is not an error.
///
/// # Errors
/// If standard output cannot be written for any other reason, such as a full disk.
pub fn print(text: &str) -> Result<(), CliError> {
    print_to(&mut io::stdout().lock(), text)
}

fn print_to(to: &mut dyn Write, text: &str) -> Result<(), CliError> {
    let end = if text.ends_with('\n') { "" } else { "\n" };
    let written = to
        .write_all(text.as_bytes())
        .and_then(|()| to.write_all(end.as_bytes()))
        .and_then(|()| to.flush());
    match written {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(CliError::failed("standard output could not be written").with_source(error))
        }
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Broken(ErrorKind);

    impl Write for Broken {
        fn write(&mut self, _: &[u8]) -> io::Result<usize> {
            Err(self.0.into())
        }
        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn a_closed_pipe_is_no_error_and_a_full_disk_is() {
        assert!(print_to(&mut Broken(ErrorKind::BrokenPipe), "x").is_ok());
        assert!(print_to(&mut Broken(ErrorKind::StorageFull), "x").is_err());
    }

    #[test]
    fn text_ends_with_one_line_feed() {
        let mut out = Vec::new();
        print_to(&mut out, "a").unwrap();
        print_to(&mut out, "b\n").unwrap();
        assert_eq!(out, b"a\nb\n");
    }
}
