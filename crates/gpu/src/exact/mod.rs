//! Exact faces for drawing: surfaces, trimming curves in their parameters, and how many samples a view needs.

mod cone;
mod edges;
mod faces;
mod lod;
mod outside;
mod pieces;
pub(crate) mod trim;

pub(crate) use cone::{Cone, normal_cone};
pub(crate) use edges::{EdgeParameters, edge_lines};
pub use faces::{ExactFace, ExactModel, ExactPart, exact_model};
pub(crate) use lod::{errors_served, grid, steps};
pub(crate) use outside::outside_faces;
pub(crate) use pieces::Cubic;
