//! Non-uniform rational B-spline curves.

use crate::{NurbsError, Range, Vector};
use glam::{DVec2, DVec3};

/// A B-spline curve of any degree from 1 to 100, rational where it has weights.
///
/// Fields are private so that a value is always valid: `knots.len() == points.len() + degree + 1`, knots do not
/// decrease, the domain `knots[degree]..knots[points.len()]` is not empty, weights (if any) are finite and non-zero.
#[derive(Clone, Debug, PartialEq)]
pub struct NurbsCurve<V> {
    degree: usize,
    knots: Vec<f64>,
    points: Vec<V>,
    weights: Option<Vec<f64>>,
}

pub type NurbsCurve2 = NurbsCurve<DVec2>;
pub type NurbsCurve3 = NurbsCurve<DVec3>;

impl<V: Vector> NurbsCurve<V> {
    /// Checks and builds. Weights that are all equal are dropped.
    ///
    /// # Errors
    /// Any [`NurbsError`] that names what does not fit.
    pub fn new(degree: usize, knots: Vec<f64>, points: Vec<V>, weights: Option<Vec<f64>>) -> Result<Self, NurbsError> {
        crate::basis::check_knots(degree, &knots, points.len())?;
        if let Some(i) = points.iter().position(|p| !p.all_finite()) {
            return Err(NurbsError::NotFinite(i));
        }
        let weights = crate::basis::check_weights(weights, points.len())?;
        Ok(Self { degree, knots, points, weights })
    }
    pub fn degree(&self) -> usize {
        self.degree
    }
    pub fn knots(&self) -> &[f64] {
        &self.knots
    }
    pub fn points(&self) -> &[V] {
        &self.points
    }
    pub fn weights(&self) -> Option<&[f64]> {
        self.weights.as_deref()
    }
    pub fn domain(&self) -> Range {
        Range::new(self.knots[self.degree], self.knots[self.points.len()])
    }
}
