//! Makes sources and issues from a document.

use crate::schema::{Source, Warning};
use chordal_brep as brep;

pub(crate) fn source((entity, line): Source) -> brep::Source {
    brep::Source { entity, line }
}

/// An issue that was read from a document: it has the code and the sentence, and no typed values.
pub(crate) fn issue(warning: Warning) -> brep::Issue {
    let severity = if warning.lost { brep::Severity::Error } else { brep::Severity::Warning };
    let known = brep::ReadIssue::CODES.iter().find(|code| **code == warning.code);
    let code = known.copied().unwrap_or("recorded");
    let kind = brep::ReadIssue::Recorded { code, sentence: warning.message };
    brep::Issue::new(severity, source(warning.source), kind)
}
