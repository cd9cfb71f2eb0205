//! The audit: trusts nothing upstream.
//!
//! Everything is recomputed from the exact model and the mesh: that every face is there and bounded by exactly the
//! chords of its edges ([`boundary`]), that edges are sampled on their curves and in order ([`edges`]), that each shell is
//! closed and oriented by the identity of its vertices ([`shell`]), and that the error bounds hold ([`prove`]).
//! Of two meshes of which nothing else is known, [`largest_distance`] gives the distance by branch and bound.

mod boundary;
mod chart;
mod context;
mod cuts;
mod distance;
mod edges;
mod face;
mod fan;
mod findings;
mod halves;
mod part;
mod precision;
mod prove;
mod report;
mod shell;
mod triangle_tree;

pub use distance::{Distance, largest_distance};
pub use part::audit_part;
pub use report::{AuditOptions, Claim, FaceAudit, PartAudit, Problem, ShellAudit, Subject};
pub use triangle_tree::TriangleTree;
