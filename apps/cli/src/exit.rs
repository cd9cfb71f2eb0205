//! Exit codes, and the two channels: standard output is data, standard error is talk.

use std::io::Write;
use std::process::ExitCode;

/// How the program ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Exit {
    /// All was done.
    Clean,
    /// Something was written, something was left undone.
    Undone,
    /// Nothing was written.
    Nothing,
}

impl Exit {
    pub fn code(self) -> ExitCode {
        ExitCode::from(match self {
            Exit::Clean => 0,
            Exit::Undone => 1,
            Exit::Nothing => 2,
        })
    }
}

/// One sentence on standard error.
pub fn say(sentence: &str) {
    // Nobody listens where this fails; that is no reason to stop.
    let _ = writeln!(std::io::stderr(), "chordal: {sentence}");
}

/// Data on standard output; a reader that has gone away is no error.
pub fn print(data: &str) {
    let mut out = std::io::stdout().lock();
    let _ = out.write_all(data.as_bytes()).and_then(|()| out.flush());
}
