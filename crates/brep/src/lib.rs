//! The exact model: parts made of faces, faces trimmed by loops of coedges, edges shared by faces, parts
//! placed in an assembly tree.
//!
//! Geometry of a part stays in the units of its file; every placement carries the scale to its parent, and
//! the root nodes carry the scale to millimetres. So a walk down the tree ends in millimetres, whatever units
//! are mixed.

#![deny(missing_docs)]

mod assembly;
mod excerpt;
mod ids;
pub mod issue;
mod part;
mod source;
mod unsewn;
pub mod winding;

pub use assembly::{Model, Node, Placement};
pub use ids::{BodyId, EdgeId, FaceId, NodeId, PartId, ShellId, VertexId};
pub use issue::{
    AuditIssue, Issue, IssueKind, MeshIssue, MethodFault, Millimetres, Percent, ReadIssue, Real, ResultIssue,
    Severity, SplineFault, Word,
};
pub use part::{
    Body, BodyKind, Coedge, Color, Edge, Face, FaceGeometry, Loop, LooseItem, LooseKind, Part, Pcurve, Shell,
    TessellatedItem, Vertex,
};
pub use source::Source;
