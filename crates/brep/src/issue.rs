//! One diagnostic type for the whole pipeline, from reader to report.
//!
//! Every stage that repairs, guesses, drops or rejects something records an [`Issue`]: a kind that code can
//! match, a severity, and the entity of the file that it concerns. The sentence that people read is made here
//! and nowhere else, so that wording, plurals and units are the same in every stage.
//!
//! Each stage has an enum of its own ([`ReadIssue`], [`MeshIssue`], [`AuditIssue`], [`ResultIssue`]) in a
//! file of its own. The fields of a variant are values, never prepared text; they are serialised into the
//! report as they are.

mod auditing;
mod meshing;
mod reading;
mod result;
mod values;
pub mod words;

pub use auditing::{AuditIssue, MeshDefect, PolylineDefect};
pub use meshing::{MeshIssue, MethodFault};
pub use reading::{ReadIssue, Word};
pub use result::ResultIssue;
pub use values::{Millimetres, Percent, Real, SplineFault};

use crate::Source;
use serde::ser::SerializeStruct;
use serde::{Deserialize, Serialize, Serializer};
use std::fmt;

/// The consequence of an issue for the result.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// Something was repaired or noticed; the result is complete.
    #[default]
    Note,
    /// Something was ignored or changed that may matter to the user; no geometry is missing.
    Warning,
    /// Geometry is missing, or a guarantee does not hold: the run ends with exit code 1.
    Error,
}

impl Severity {
    /// The name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Severity::Note => "note",
            Severity::Warning => "warning",
            Severity::Error => "error",
        }
    }
}

/// What happened, by stage.
///
/// Lengths are millimetres unless a field states another unit; the stage that makes the issue converts them.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum IssueKind {
    /// Found while the file was read.
    Read(ReadIssue),
    /// Found while a face or edge was meshed.
    Mesh(MeshIssue),
    /// Found by the audit of the finished mesh.
    Audit(AuditIssue),
    /// Found when the results of all stages are added up, or while the mesh is written.
    Result(ResultIssue),
}

impl IssueKind {
    /// The stage that found it: `read`, `mesh`, `audit` or `result`.
    pub fn stage(&self) -> &'static str {
        match self {
            IssueKind::Read(_) => "read",
            IssueKind::Mesh(_) => "mesh",
            IssueKind::Audit(_) => "audit",
            IssueKind::Result(_) => "result",
        }
    }

    /// A stable name for programs to match, such as `unknown-surface`.
    pub fn code(&self) -> &'static str {
        match self {
            IssueKind::Read(kind) => kind.code(),
            IssueKind::Mesh(kind) => kind.code(),
            IssueKind::Audit(kind) => kind.code(),
            IssueKind::Result(kind) => kind.code(),
        }
    }
}

impl fmt::Display for IssueKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            IssueKind::Read(kind) => kind.fmt(f),
            IssueKind::Mesh(kind) => kind.fmt(f),
            IssueKind::Audit(kind) => kind.fmt(f),
            IssueKind::Result(kind) => kind.fmt(f),
        }
    }
}

impl From<ReadIssue> for IssueKind {
    fn from(kind: ReadIssue) -> Self {
        IssueKind::Read(kind)
    }
}

impl From<MeshIssue> for IssueKind {
    fn from(kind: MeshIssue) -> Self {
        IssueKind::Mesh(kind)
    }
}

impl From<AuditIssue> for IssueKind {
    fn from(kind: AuditIssue) -> Self {
        IssueKind::Audit(kind)
    }
}

impl From<ResultIssue> for IssueKind {
    fn from(kind: ResultIssue) -> Self {
        IssueKind::Result(kind)
    }
}

/// Something that was repaired, guessed, dropped or rejected, with the entity of the file that it concerns.
#[derive(Clone, Debug, PartialEq)]
pub struct Issue {
    /// The consequence for the result.
    pub severity: Severity,
    /// The entity and line in the file.
    pub source: Source,
    /// What happened.
    pub kind: IssueKind,
}

impl Issue {
    /// An issue about the entity at `source`.
    pub fn new(severity: Severity, source: Source, kind: impl Into<IssueKind>) -> Self {
        Self { severity, source, kind: kind.into() }
    }

    /// Something was repaired or guessed; no geometry is missing.
    pub fn warning(source: Source, kind: impl Into<IssueKind>) -> Self {
        Self::new(Severity::Warning, source, kind)
    }

    /// Geometry is missing.
    pub fn error(source: Source, kind: impl Into<IssueKind>) -> Self {
        Self::new(Severity::Error, source, kind)
    }

    /// The sentence for a place that names `owner` already: the entity is named only where it is another one.
    pub fn about(&self, owner: Source) -> String {
        if self.source == owner { self.kind.to_string() } else { self.to_string() }
    }

    /// The issue as one of `owner`: where it is about another entity, the sentence names that.
    pub fn for_owner(&self, owner: Source) -> Issue {
        if self.source == owner || self.source == Source::default() {
            return Issue { source: owner, ..self.clone() };
        }
        Issue::new(self.severity, owner, ReadIssue::Of { issue: Box::new(self.clone()) })
    }

    /// True if geometry is missing or a guarantee does not hold.
    pub fn is_error(&self) -> bool {
        self.severity == Severity::Error
    }
}

/// Severity, entity, line, code and sentence.
impl Serialize for Issue {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut fields = serializer.serialize_struct("Issue", 5)?;
        fields.serialize_field("severity", &self.severity)?;
        fields.serialize_field("entity", &self.source.entity)?;
        fields.serialize_field("line", &self.source.line)?;
        fields.serialize_field("code", self.kind.code())?;
        fields.serialize_field("message", &self.kind.to_string())?;
        fields.end()
    }
}

/// `#42 (line 48): gap of 5 mm between consecutive edges closed with a straight edge`.
impl fmt::Display for Issue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.source == Source::default() {
            return self.kind.fmt(f);
        }
        write!(f, "{}: {}", self.source, self.kind)
    }
}
