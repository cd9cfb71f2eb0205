//! How finely cuts through a face are sampled.

use chordal_nurbs::{DVec2, SurfaceJet};
use std::fmt::Debug;

/// Lengths on a surface in a unit that grows where the surface is less curved, so that chords of equal length
/// stay equally near to it.
pub trait SeamMetric: Debug {
    /// The length of a small step of parameters at a place of the surface; 0 where the surface is singular.
    fn length(&self, jet: &SurfaceJet, step_uv: DVec2) -> f64;
}

/// The limits that the chords of cuts through a face must keep.
#[derive(Clone, Copy, Debug)]
pub struct Seams<'a> {
    /// Measures chords.
    pub metric: &'a dyn SeamMetric,
    /// The longest chord in that measure; 1 is as long as an edge of the mesh may be.
    pub chord: f64,
    /// The distance that a chord of length 1 may have from the surface.
    pub tolerance: f64,
}
