//! The audit: trusts nothing upstream.
//!
//! Everything is recomputed from the exact model and the mesh: that every face is there and bounded by exactly the
//! chords of its edges ([`boundary`]), that edges are sampled on their curves and in order ([`edges`]), that each shell is
//! closed and oriented by the identity of its vertices ([`shell`]), and that the error bounds hold ([`face`]).
mod boundary;
mod cuts;
mod edges;
mod face;
mod fan;
mod halves;
mod part;
mod prove;
mod report;
mod shell;

pub use part::audit_part;
pub use report::{AuditOptions, Claim, FaceAudit, PartAudit, Problem, ProblemKind, ShellAudit, Subject};
