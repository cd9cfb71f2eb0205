//! Published methods of tessellating trimmed surfaces, as plug-ins of `chordal-tessellate`.
//!
//! A [`Strategy`] fills the inside of faces; an [`EdgeMethod`] cuts edges into chords. Both share the proof
//! and the stitching of the default mesher. [`strategies`] and [`edge_methods`] list them by name.

pub mod compare;
mod edge;
mod edge_method;
mod fill;
mod loops;
pub mod papers;
mod strategy;

pub use edge::Criterion;
pub use edge_method::{EdgeMethod, EdgeMethodEntry, edge_method_named, edge_methods};
pub use fill::Cut;
pub use fill::delaunay::Fill;
pub use fill::quadtree::Stretch;
pub use loops::{LoopRow, loop_rows};
pub use strategy::{Strategy, StrategyEntry, strategies, strategy_named};
