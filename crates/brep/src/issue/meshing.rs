//! What can be found while a face or an edge is meshed.

use serde::Serialize;
use std::fmt;

/// Found while a face or an edge is meshed.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub enum MeshIssue {
    /// A sentence without a variant of its own yet. The variant goes when every stage is typed.
    Other(String),
}

impl MeshIssue {
    /// A stable name for programs to match.
    pub fn code(&self) -> &'static str {
        match self {
            MeshIssue::Other(_) => "other",
        }
    }
}

impl fmt::Display for MeshIssue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            MeshIssue::Other(sentence) => f.write_str(sentence),
        }
    }
}
