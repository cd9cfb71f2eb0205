//! What the scene graph formats (Open Inventor, VRML, X3D) have in common: nodes with fields, and the model
//! that walking them fills.
//!
//! A reader makes a [`Graph`](graph) from text ([`text`]), XML or binary data; a walk through it
//! ([`mod@walk`]) hands shapes to a [`Stage`](stage), which makes parts, bodies and the tree.

pub(crate) mod context;
pub(crate) mod graph;
mod knots;
mod lexer;
pub(crate) mod matrix;
pub(crate) mod nurbs;
pub(crate) mod primitives;
pub(crate) mod prototypes;
pub(crate) mod stage;
pub(crate) mod text;
pub(crate) mod walk;
