//! Exit codes, and the two channels: results on standard output, messages on standard error.

use std::io::{self, ErrorKind, IsTerminal, Write};
use std::sync::atomic::{AtomicBool, Ordering};

/// Standard output could not be written.
static RESULTS_ARE_LOST: AtomicBool = AtomicBool::new(false);

/// How the program ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Exit {
    /// Done without problems.
    Clean,
    /// Done, with problems.
    Problems,
    /// Nothing was written.
    Nothing,
}

impl Exit {
    /// The code for the system; results that did not reach standard output are a problem.
    pub fn code(self) -> u8 {
        let are_lost = RESULTS_ARE_LOST.load(Ordering::Relaxed);
        match if are_lost { self.max(Exit::Problems) } else { self } {
            Exit::Clean => 0,
            Exit::Problems => 1,
            Exit::Nothing => 2,
        }
    }
}

/// One sentence on standard error.
pub fn say(sentence: &str) {
    // If standard error cannot be written, there is no other place for the message.
    let _ = writeln!(io::stderr(), "chordal: {sentence}");
}

/// Prints text to standard output. A closed pipe is no error.
pub fn print(data: &str) {
    print_bytes(data.as_bytes());
}

/// Writes bytes to standard output. A closed pipe is no error. Any other failure is reported, and the
/// program ends with 1 at least.
pub fn print_bytes(data: &[u8]) {
    if let Err(error) = try_print(data) {
        RESULTS_ARE_LOST.store(true, Ordering::Relaxed);
        say(&format!("cannot write to standard output: {error}"));
    }
}

/// Writes bytes to standard output. A closed pipe is no error.
///
/// # Errors
/// Any other failure.
pub fn try_print(data: &[u8]) -> io::Result<()> {
    let mut out = io::stdout().lock();
    match out.write_all(data).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(error),
        _ => Ok(()),
    }
}

/// Whether a person looks at standard output.
pub fn stdout_is_terminal() -> bool {
    io::stdout().is_terminal()
}
