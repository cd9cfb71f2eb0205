//! Non-uniform rational B-spline surfaces.

mod memo;
mod spans;

use crate::basis::{self, Basis};
use crate::{NurbsError, Range, SurfaceJet, UvBox, Vector, tensor};
use glam::{DAffine3, DVec2, DVec3};
use memo::Memo;

/// A tensor-product B-spline surface of any degree from 1 to 100, rational where it has weights.
///
/// Control point (i, j), i along u, is `points[i * count_v + j]`. The same invariants as
/// [`crate::NurbsCurve`].
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
    /// Its periods in u and v: asking for them evaluates both of its sides.
    pub(crate) periods: Memo<[Option<f64>; 2]>,
}

impl NurbsSurface {
    /// Checks and builds; `points` and `weights` row by row, v running fastest. Weights that are all equal
    /// are dropped.
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
        basis::check_knots(degree_u, &knots_u, count_u)?;
        basis::check_knots(degree_v, &knots_v, count_v)?;
        if points.len() != count_u.saturating_mul(count_v) {
            return Err(NurbsError::NetSize {
                found: points.len(),
                expected: count_u.saturating_mul(count_v),
            });
        }
        if let Some(i) = points.iter().position(|p| !p.all_finite()) {
            return Err(NurbsError::NotFinite(i));
        }
        let weights = basis::check_weights(weights, points.len())?;
        Ok(Self {
            degree_u,
            degree_v,
            knots_u,
            knots_v,
            count_u,
            count_v,
            points,
            weights,
            periods: Memo::default(),
        })
    }
    /// The degrees along u and along v, each 1 to 100.
    pub fn degree(&self) -> [usize; 2] {
        [self.degree_u, self.degree_v]
    }
    /// The knots along u, not decreasing.
    pub fn knots_u(&self) -> &[f64] {
        &self.knots_u
    }
    /// The knots along v, not decreasing.
    pub fn knots_v(&self) -> &[f64] {
        &self.knots_v
    }
    /// Number of control points along u and v.
    pub fn counts(&self) -> [usize; 2] {
        [self.count_u, self.count_v]
    }
    /// The control points, projected; point (i, j), i along u, is `points[i * count_v + j]`.
    pub fn points(&self) -> &[DVec3] {
        &self.points
    }
    /// The weights, one per control point in the same order; absent for a polynomial surface.
    pub fn weights(&self) -> Option<&[f64]> {
        self.weights.as_deref()
    }
    /// The ranges of both parameters.
    pub fn domain(&self) -> UvBox {
        UvBox::from_ranges(
            Range::new(self.knots_u[self.degree_u], self.knots_u[self.count_u]),
            Range::new(self.knots_v[self.degree_v], self.knots_v[self.count_v]),
        )
    }

    /// The point at `uv`, clamped to the domain.
    pub fn point(&self, uv: DVec2) -> DVec3 {
        let [[p]] = self.derivatives::<1>(uv);
        p
    }

    /// Point and the two first derivatives (by u, by v) at `uv`, clamped to the domain.
    pub fn jet1(&self, uv: DVec2) -> (DVec3, DVec3, DVec3) {
        let [[p, dv], [du, _]] = self.derivatives::<2>(uv);
        (p, du, dv)
    }

    /// Point and all derivatives to the second order at `uv`, clamped to the domain.
    pub fn jet(&self, uv: DVec2) -> SurfaceJet {
        let [[p, dv, dvv], [du, duv, _], [duu, ..]] = self.derivatives::<3>(uv);
        SurfaceJet { p, du, dv, duu, duv, dvv }
    }

    #[inline]
    fn derivatives<const R: usize>(&self, uv: DVec2) -> [[DVec3; R]; R] {
        let bu = Basis::<R>::new(self.degree_u, &self.knots_u, uv.x);
        let bv = Basis::<R>::new(self.degree_v, &self.knots_v, uv.y);
        tensor::derivatives(&bu, &bv, self.count_v, &self.points, self.weights.as_deref())
    }

    /// The surface moved by an affine map.
    pub fn transformed(&self, by: &DAffine3) -> Self {
        Self {
            points: self.points.iter().map(|&p| by.transform_point3(p)).collect(),
            periods: Memo::default(),
            ..self.clone()
        }
    }

    /// The same surface with u run backwards over the same domain.
    pub fn reversed_u(&self) -> Self {
        let index = |i: usize, j: usize| (self.count_u - 1 - i) * self.count_v + j;
        let knots_u = basis::mirrored(self.degree_u, &self.knots_u);
        Self { knots_u, ..self.gathered(self.count_u, self.count_v, index) }
    }

    /// The same surface with v run backwards over the same domain.
    pub fn reversed_v(&self) -> Self {
        let index = |i: usize, j: usize| i * self.count_v + self.count_v - 1 - j;
        let knots_v = basis::mirrored(self.degree_v, &self.knots_v);
        Self { knots_v, ..self.gathered(self.count_u, self.count_v, index) }
    }

    /// The same surface with u and v exchanged.
    pub fn swapped(&self) -> Self {
        let net = self.gathered(self.count_v, self.count_u, |i, j| j * self.count_v + i);
        Self {
            degree_u: self.degree_v,
            degree_v: self.degree_u,
            knots_u: self.knots_v.clone(),
            knots_v: self.knots_u.clone(),
            count_u: self.count_v,
            count_v: self.count_u,
            ..net
        }
    }

    /// This surface with control point (i, j) taken from `index(i, j)`.
    fn gathered(&self, rows: usize, columns: usize, index: impl Fn(usize, usize) -> usize) -> Self {
        let order: Vec<usize> = (0..rows * columns).map(|k| index(k / columns, k % columns)).collect();
        Self {
            points: order.iter().map(|&k| self.points[k]).collect(),
            weights: self.weights.as_ref().map(|w| order.iter().map(|&k| w[k]).collect()),
            knots_u: self.knots_u.clone(),
            knots_v: self.knots_v.clone(),
            periods: Memo::default(),
            ..*self
        }
    }

    /// Distinct knots in u inside the closed domain, both ends included.
    pub fn breaks_u(&self) -> Vec<f64> {
        basis::breaks(self.degree_u, &self.knots_u)
    }
    /// Distinct knots in v inside the closed domain, both ends included.
    pub fn breaks_v(&self) -> Vec<f64> {
        basis::breaks(self.degree_v, &self.knots_v)
    }
    /// Interior knots in u at which the parametrisation may be less than `continuity` times differentiable.
    pub fn breaks_u_below(&self, continuity: usize) -> Vec<f64> {
        basis::breaks_below(self.degree_u, &self.knots_u, continuity)
    }
    /// Interior knots in v at which the parametrisation may be less than `continuity` times differentiable.
    pub fn breaks_v_below(&self, continuity: usize) -> Vec<f64> {
        basis::breaks_below(self.degree_v, &self.knots_v, continuity)
    }

    /// True where the side u = start meets the side u = end, point by point, within 1e-9 of the net's size.
    pub fn is_closed_u(&self) -> bool {
        let u = self.domain().u();
        self.sides_meet(self.degree_v, &self.breaks_v(), |v| (DVec2::new(u.start, v), DVec2::new(u.end, v)))
    }

    /// True where the side v = start meets the side v = end, point by point, within 1e-9 of the net's size.
    pub fn is_closed_v(&self) -> bool {
        let v = self.domain().v();
        self.sides_meet(self.degree_u, &self.breaks_u(), |u| (DVec2::new(u, v.start), DVec2::new(u, v.end)))
    }

    /// Compares two sides at as many parameters of each span as determine their difference.
    fn sides_meet(&self, degree: usize, breaks: &[f64], ends: impl Fn(f64) -> (DVec2, DVec2)) -> bool {
        let steps = if self.weights.is_some() { 2 * degree } else { degree };
        let tolerance = 1e-9 * self.net_size();
        breaks.windows(2).all(|span| {
            (0..=steps).all(|k| {
                let (a, b) = ends(span[0] + (span[1] - span[0]) * k as f64 / steps as f64);
                (self.point(a) - self.point(b)).length() <= tolerance
            })
        })
    }

    /// The largest distance of a control point from the first.
    fn net_size(&self) -> f64 {
        self.points.iter().map(|p| p.distance(self.points[0])).fold(0.0, f64::max)
    }
}
