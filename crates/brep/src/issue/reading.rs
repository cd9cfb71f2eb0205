//! What can be found while a file is read.

use serde::Serialize;
use std::fmt;

/// Found while a file is read.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub enum ReadIssue {
    /// A sentence without a variant of its own yet. The variant goes when every stage is typed.
    Other(String),
}

impl ReadIssue {
    /// A stable name for programs to match.
    pub fn code(&self) -> &'static str {
        match self {
            ReadIssue::Other(_) => "other",
        }
    }
}

impl fmt::Display for ReadIssue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ReadIssue::Other(sentence) => f.write_str(sentence),
        }
    }
}
