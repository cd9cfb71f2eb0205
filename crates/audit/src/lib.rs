//! The audit of a finished mesh against the exact model.
//!
//! It uses the model and the mesh, and nothing of the mesher. With the mesher it shares the crate `nurbs`:
//! evaluation, inversion, and the bounds of facets and chords; a share of the facets therefore gets a second
//! bound that shares no code with the first.
//!
//! - Edges are sampled on their curves and in order (`edges`).
//! - Each face is bounded by exactly the chords of its edges (`boundary`).
//! - It covers the right part of its surface (`region`), once (`overlap`), with the area that its exact loops
//!   bound (`area`).
//! - The error bounds hold (`prove`), and for a share of the facets a second, simple one (`second_bound`).
//! - Each shell is closed and oriented by the identity of its vertices (`shell`); faces that go on smoothly
//!   at an edge are not folded there (`folds_at_edges`), and no facets of a closed shell cut each
//!   other (`self_intersections`).
//!
//! [`largest_distance`] computes the distance of any two meshes by branch and bound.

mod along_sides;
mod area;
mod bend;
mod boundary;
mod boundary_tree;
mod chart;
mod context;
mod cuts;
mod distance;
mod edges;
mod exact_crossing;
mod face;
mod face_at;
mod fan;
mod findings;
mod folds_at_edges;
mod graph;
mod halves;
mod overlap;
mod part;
mod precision;
mod prove;
mod region;
mod report;
mod second_bound;
mod self_intersections;
mod separation;
mod shell;
mod simple_bound;
mod triangle_pair;
mod triangle_tree;
mod unrolled;

pub use distance::{Distance, largest_distance};
pub use part::audit_part;
pub use report::{
    AuditOptions, Claim, FaceAudit, FaceCrossing, FacetCrossing, PartAudit, Problem, ShellAudit, Subject,
};
pub use self_intersections::facet_crossings;
pub use triangle_tree::{Nearest, TriangleTree};
