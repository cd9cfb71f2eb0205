//! Exit codes, and the two channels: results on standard output, messages on standard error.

use std::io::{IsTerminal, Write};
use std::process::ExitCode;

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
    /// The code for the system.
    pub fn code(self) -> ExitCode {
        ExitCode::from(match self {
            Exit::Clean => 0,
            Exit::Problems => 1,
            Exit::Nothing => 2,
        })
    }
}

/// One sentence on standard error.
pub fn say(sentence: &str) {
    // Where this fails there is nobody to tell.
    let _ = writeln!(std::io::stderr(), "chordal: {sentence}");
}

/// Text on standard output; a reader that has gone away is no error.
pub fn print(data: &str) {
    print_bytes(data.as_bytes());
}

/// Bytes on standard output; a reader that has gone away is no error.
pub fn print_bytes(data: &[u8]) {
    let mut out = std::io::stdout().lock();
    let _ = out.write_all(data).and_then(|()| out.flush());
}

/// Whether a person looks at standard output.
pub fn stdout_is_terminal() -> bool {
    std::io::stdout().is_terminal()
}
