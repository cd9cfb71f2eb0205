//! Exact faces for drawing: surfaces, trimming curves in their parameters, and how many samples a view needs.

mod cone;
mod edges;
pub(crate) mod inside;
mod model;
mod outside;
mod pieces;
mod sampling;

pub(crate) use edges::edge_lines;
pub use model::{TrimmedFace, TrimmedModel, TrimmedPart, trimmed_model};
pub(crate) use pieces::Cubic;
pub(crate) use sampling::{errors_served, grid, steps};
