//! What can be found by the audit of a finished mesh.

use std::fmt;

/// Found by the audit of a finished mesh.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum AuditIssue {
    /// A sentence without a variant of its own yet. The variant goes when every stage is typed.
    Other(String),
}

impl AuditIssue {
    /// A stable name for programs to match.
    pub fn code(&self) -> &'static str {
        match self {
            AuditIssue::Other(_) => "other",
        }
    }
}

impl fmt::Display for AuditIssue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            AuditIssue::Other(sentence) => f.write_str(sentence),
        }
    }
}
