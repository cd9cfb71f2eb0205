//! Non-uniform rational B-spline surfaces.

use crate::{NurbsError, Range, UvBox, Vector};
use glam::DVec3;

/// A tensor-product B-spline surface of any degree from 1 to 100, rational where it has weights.
///
/// Control point (i, j), i along u, is `points[i * count_v + j]`. The same invariants as [`crate::NurbsCurve`].
#[derive(Clone, Debug, PartialEq)]
pub struct NurbsSurface {
    degree_u: usize,
    degree_v: usize,
    knots_u: Vec<f64>,
    knots_v: Vec<f64>,
    count_u: usize,
    count_v: usize,
    points: Vec<DVec3>,
    weights: Option<Vec<f64>>,
}

impl NurbsSurface {
    /// Checks and builds; `points` and `weights` row by row, v running fastest. Weights that are all equal are dropped.
    ///
    /// # Errors
    /// Any [`NurbsError`] that names what does not fit.
    pub fn new(
        degree: [usize; 2],
        knots_u: Vec<f64>,
        knots_v: Vec<f64>,
        points: Vec<DVec3>,
        weights: Option<Vec<f64>>,
    ) -> Result<Self, NurbsError> {
        let [degree_u, degree_v] = degree;
        let count_u = knots_u.len().saturating_sub(degree_u + 1);
        let count_v = knots_v.len().saturating_sub(degree_v + 1);
        crate::basis::check_knots(degree_u, &knots_u, count_u)?;
        crate::basis::check_knots(degree_v, &knots_v, count_v)?;
        if points.len() != count_u.saturating_mul(count_v) {
            return Err(NurbsError::NetSize { found: points.len(), expected: count_u.saturating_mul(count_v) });
        }
        if let Some(i) = points.iter().position(|p| !p.all_finite()) {
            return Err(NurbsError::NotFinite(i));
        }
        let weights = crate::basis::check_weights(weights, points.len())?;
        Ok(Self { degree_u, degree_v, knots_u, knots_v, count_u, count_v, points, weights })
    }
    pub fn degree(&self) -> [usize; 2] {
        [self.degree_u, self.degree_v]
    }
    pub fn knots_u(&self) -> &[f64] {
        &self.knots_u
    }
    pub fn knots_v(&self) -> &[f64] {
        &self.knots_v
    }
    /// Number of control points along u and v.
    pub fn counts(&self) -> [usize; 2] {
        [self.count_u, self.count_v]
    }
    pub fn points(&self) -> &[DVec3] {
        &self.points
    }
    pub fn weights(&self) -> Option<&[f64]> {
        self.weights.as_deref()
    }
    pub fn domain(&self) -> UvBox {
        UvBox::from_ranges(
            Range::new(self.knots_u[self.degree_u], self.knots_u[self.count_u]),
            Range::new(self.knots_v[self.degree_v], self.knots_v[self.count_v]),
        )
    }
}
