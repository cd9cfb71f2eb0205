//! The audit: trusts nothing upstream.
//!
//! Everything is recomputed from the exact model and the mesh: that every face is there and bounded by exactly the
//! chords of its edges (`boundary`), that edges are sampled on their curves and in order (`edges`), that each shell is
//! closed and oriented by the identity of its vertices (`shell`), and that the error bounds hold (`prove`).
//! Of two meshes of which nothing else is known, [`largest_distance`] gives the distance by branch and bound.

mod area;
mod boundary;
mod box_tree;
mod chart;
mod context;
mod cuts;
mod distance;
mod edges;
mod face;
mod fan;
mod findings;
mod halves;
mod overlap;
mod part;
mod precision;
mod prove;
mod region;
mod report;
mod sampled;
mod self_intersections;
mod shell;
mod triangle_pair;
mod triangle_tree;

pub use distance::{Distance, largest_distance};
pub use part::audit_part;
pub use report::{AuditOptions, Claim, FaceAudit, FaceCrossing, PartAudit, Problem, ShellAudit, Subject};
pub use triangle_tree::{Nearest, TriangleTree};
