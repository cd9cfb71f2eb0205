//! Exact faces for drawing: surfaces, trimming curves in their parameters, and how many samples a view needs.

mod edges;
mod faces;
mod lod;
mod pieces;
pub(crate) mod trim;

pub(crate) use edges::{EdgeParameters, edge_lines};
pub use faces::{ExactFace, ExactModel, ExactPart, exact_model};
pub(crate) use lod::grid;
pub(crate) use pieces::Cubic;
