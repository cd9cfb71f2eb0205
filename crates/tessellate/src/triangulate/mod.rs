//! Triangulation in the plane of parameters: a sweep for the boundary, then insertion and flips in the
//! metric.

mod ears;
mod mesh;
mod sweep;

pub(crate) use ears::clip_ears;
pub use mesh::{Location, NONE, Triangulation};
pub use sweep::{SweepError, sweep};

use chordal_nurbs::DVec2;

/// Exact sign of the turn a → b → c: positive where it is to the left.
pub fn orient(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    let coord = |p: DVec2| robust::Coord { x: p.x, y: p.y };
    robust::orient2d(coord(a), coord(b), coord(c))
}
