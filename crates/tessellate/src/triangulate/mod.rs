//! Triangulation in the plane of parameters: a sweep for the boundary, then insertion and flips in the
//! metric.

mod ears;
mod mesh;
mod sweep;

pub(crate) use ears::clip_ears;
pub use mesh::{Location, NONE, Triangulation};
pub use sweep::{SweepError, sweep};
