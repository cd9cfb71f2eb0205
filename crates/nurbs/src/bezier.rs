//! Bézier curves and patches.

use glam::DVec3;

/// A Bézier curve over 0..=1; rational where it has weights. `points` are projected (not multiplied by weights).
#[derive(Clone, Debug, PartialEq)]
pub struct BezierCurve<V> {
    pub points: Vec<V>,
    pub weights: Option<Vec<f64>>,
}

/// A Bézier patch over the unit square; point (i, j), i along u, is `points[i * (degree[1] + 1) + j]`.
#[derive(Clone, Debug, PartialEq)]
pub struct BezierPatch {
    pub degree: [usize; 2],
    pub points: Vec<DVec3>,
    pub weights: Option<Vec<f64>>,
}
