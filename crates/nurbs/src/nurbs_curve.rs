//! Non-uniform rational B-spline curves.

use crate::basis::{self, Basis};
use crate::homogeneous::{Homogeneous, project_jet};
use crate::{NurbsError, Range, Vector};
use glam::{DAffine3, DVec2, DVec3};

/// A B-spline curve of any degree from 1 to 100, rational where it has weights.
///
/// Fields are private so that a value is always valid: `knots.len() == points.len() + degree + 1`, knots do
/// not decrease, the domain `knots[degree]..knots[points.len()]` is not empty, weights (if any) are finite
/// and non-zero.
#[derive(Clone, Debug, PartialEq)]
pub struct NurbsCurve<V> {
    degree: usize,
    knots: Vec<f64>,
    points: Vec<V>,
    weights: Option<Vec<f64>>,
}

/// A B-spline in the plane.
pub type NurbsCurve2 = NurbsCurve<DVec2>;
/// A B-spline in space.
pub type NurbsCurve3 = NurbsCurve<DVec3>;

impl<V: Vector> NurbsCurve<V> {
    /// Checks and builds. Weights that are all equal are dropped.
    ///
    /// ```
    /// use chordal_nurbs::{DVec2, NurbsCurve2};
    /// // A quarter of the unit circle.
    /// let points = vec![DVec2::X, DVec2::ONE, DVec2::Y];
    /// let weights = vec![1.0, 0.5_f64.sqrt(), 1.0];
    /// let arc = NurbsCurve2::new(2, vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0], points, Some(weights))?;
    /// assert!((arc.point(0.3).length() - 1.0).abs() < 1e-15);
    /// # Ok::<(), chordal_nurbs::NurbsError>(())
    /// ```
    ///
    /// # Errors
    /// Any [`NurbsError`] that names what does not fit.
    pub fn new(
        degree: usize,
        knots: Vec<f64>,
        points: Vec<V>,
        weights: Option<Vec<f64>>,
    ) -> Result<Self, NurbsError> {
        basis::check_knots(degree, &knots, points.len())?;
        if let Some(i) = points.iter().position(|p| !p.all_finite()) {
            return Err(NurbsError::NotFinite(i));
        }
        let weights = basis::check_weights(weights, points.len())?;
        Ok(Self { degree, knots, points, weights })
    }
    /// The degree, 1 to 100.
    pub fn degree(&self) -> usize {
        self.degree
    }
    /// The knots, not decreasing: `points + degree + 1` of them.
    pub fn knots(&self) -> &[f64] {
        &self.knots
    }
    /// The control points, projected (not multiplied by weights).
    pub fn points(&self) -> &[V] {
        &self.points
    }
    /// The weights, one per control point; absent for a polynomial curve.
    pub fn weights(&self) -> Option<&[f64]> {
        self.weights.as_deref()
    }
    /// The range of the parameter: `knots[degree]..knots[points]`.
    pub fn domain(&self) -> Range {
        Range::new(self.knots[self.degree], self.knots[self.points.len()])
    }

    /// The point at `t`, clamped to the domain.
    pub fn point(&self, t: f64) -> V {
        self.derivatives::<1>(t)[0]
    }

    /// Point, first and second derivative at `t`, clamped to the domain.
    pub fn jet(&self, t: f64) -> [V; 3] {
        self.derivatives(t)
    }

    /// Point and the first three derivatives at `t`, clamped to the domain.
    pub fn jet3(&self, t: f64) -> [V; 4] {
        self.derivatives(t)
    }

    /// Sums are taken relative to the first control point concerned: derivatives then keep their digits far
    /// from the origin.
    #[inline]
    fn derivatives<const R: usize>(&self, t: f64) -> [V; R] {
        let basis = Basis::<R>::new(self.degree, &self.knots, t);
        let window = basis.first..=basis.first + self.degree;
        let points = &self.points[window.clone()];
        let origin = points[0];
        let mut jet: [V; R] = match &self.weights {
            None => std::array::from_fn(|k| {
                let mut sum = V::default();
                for (n, p) in basis.row(k).iter().zip(points) {
                    sum += (*p - origin) * *n;
                }
                sum
            }),
            Some(weights) => {
                let weights = &weights[window];
                project_jet(std::array::from_fn(|k| {
                    let mut sum = Homogeneous::default();
                    for ((n, p), w) in basis.row(k).iter().zip(points).zip(weights) {
                        sum += Homogeneous { v: (*p - origin) * (n * w), w: n * w };
                    }
                    sum
                }))
            }
        };
        jet[0] += origin;
        jet
    }

    /// The curve with every control point mapped; equal to the mapped curve where `map` is affine.
    pub fn mapped<W: Vector>(&self, map: impl Fn(V) -> W) -> NurbsCurve<W> {
        NurbsCurve {
            degree: self.degree,
            knots: self.knots.clone(),
            points: self.points.iter().map(|&p| map(p)).collect(),
            weights: self.weights.clone(),
        }
    }

    /// The same curve run backwards over the same domain: `reversed(t)` is `self(start + end - t)`.
    pub fn reversed(&self) -> Self {
        Self {
            degree: self.degree,
            knots: basis::mirrored(self.degree, &self.knots),
            points: self.points.iter().rev().copied().collect(),
            weights: self.weights.as_ref().map(|w| w.iter().rev().copied().collect()),
        }
    }

    /// Distinct knots inside the closed domain, both ends included.
    pub fn breaks(&self) -> Vec<f64> {
        basis::breaks(self.degree, &self.knots)
    }

    /// Interior knots at which the parametrisation may be less than `continuity` times continuously
    /// differentiable.
    pub fn breaks_below(&self, continuity: usize) -> Vec<f64> {
        basis::breaks_below(self.degree, &self.knots, continuity)
    }

    /// True where the ends meet within 1e-9 of the control polygon's size.
    pub fn is_closed(&self) -> bool {
        let domain = self.domain();
        let gap = (self.point(domain.start) - self.point(domain.end)).norm();
        gap <= 1e-9 * self.net_size()
    }

    /// The largest distance of a control point from the first.
    fn net_size(&self) -> f64 {
        self.points.iter().map(|&p| (p - self.points[0]).norm()).fold(0.0, f64::max)
    }
}

impl NurbsCurve3 {
    /// The curve moved by an affine map.
    pub fn transformed(&self, by: &DAffine3) -> Self {
        self.mapped(|p| by.transform_point3(p))
    }
}
