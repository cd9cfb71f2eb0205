//! Bézier curves.

use crate::basis::Basis;
use crate::homogeneous::{self, Homogeneous, project_jet};
use crate::{NurbsError, Range, UvBox, Vector, blossom};
use glam::DVec2;

/// A Bézier curve over 0..=1; rational where it has weights. `points` are projected (not multiplied by
/// weights).
#[derive(Clone, Debug, PartialEq)]
pub struct BezierCurve<V> {
    /// The control points, projected (not multiplied by weights); one more than the degree.
    pub points: Vec<V>,
    /// The weights, one per control point; absent for a polynomial curve.
    pub weights: Option<Vec<f64>>,
}

impl<V: Vector> BezierCurve<V> {
    /// The degree.
    pub fn degree(&self) -> usize {
        self.points.len() - 1
    }

    /// The point at `t`; the polynomial goes on outside 0..=1.
    pub fn eval(&self, t: f64) -> V {
        self.derivatives::<1>(t)[0]
    }

    /// Point, first and second derivative at `t`.
    pub fn jet(&self, t: f64) -> [V; 3] {
        self.derivatives(t)
    }

    fn derivatives<const R: usize>(&self, t: f64) -> [V; R] {
        if self.degree() == 0 {
            let mut jet = [V::default(); R];
            jet[0] = self.points[0];
            return jet;
        }
        let basis = Basis::<R>::bernstein(self.degree(), t);
        let origin = self.points[0];
        let local = |i: usize| self.points[i] - origin;
        let mut jet: [V; R] = match &self.weights {
            None => std::array::from_fn(|k| {
                basis.row(k).iter().enumerate().fold(V::default(), |sum, (i, n)| sum + local(i) * *n)
            }),
            Some(w) => project_jet(std::array::from_fn(|k| {
                let terms = basis.row(k).iter().enumerate();
                terms.fold(Homogeneous::default(), |sum, (i, n)| sum + Homogeneous::new(local(i), w[i]) * *n)
            })),
        };
        jet[0] += origin;
        jet
    }

    /// Control points multiplied by their weights, and the weights.
    pub(crate) fn homogeneous(&self) -> Vec<Homogeneous<V>> {
        homogeneous::homogeneous(&self.points, self.weights.as_deref())
    }

    /// The inverse of [`Self::homogeneous`]; the weights are dropped where the curve is not `rational`.
    pub(crate) fn from_homogeneous(net: Vec<Homogeneous<V>>, rational: bool) -> Self {
        let (points, weights) = homogeneous::projected(net, rational);
        Self { points, weights }
    }

    /// Applies an algorithm on homogeneous control points.
    fn through(&self, algorithm: impl FnOnce(&mut Vec<Homogeneous<V>>)) -> Self {
        let mut net = self.homogeneous();
        algorithm(&mut net);
        Self::from_homogeneous(net, self.weights.is_some())
    }

    /// The parts below and above `t`, each over 0..=1.
    pub fn split(&self, t: f64) -> (Self, Self) {
        let mut above = self.homogeneous();
        let below = blossom::split(&mut above, t);
        let rational = self.weights.is_some();
        (Self::from_homogeneous(below, rational), Self::from_homogeneous(above, rational))
    }

    /// The part over `a..b`, over 0..=1; run backwards where `a > b`.
    pub fn restricted(&self, a: f64, b: f64) -> Self {
        self.through(|net| blossom::restrict(net, a, b))
    }

    /// The same curve run backwards.
    pub fn reversed(&self) -> Self {
        self.through(|net| net.reverse())
    }

    /// The derivative by the curve's own parameter; `None` where the curve is rational.
    pub fn hodograph(&self) -> Option<Self> {
        self.weights.is_none().then(|| Self { points: blossom::hodograph(&self.points), weights: None })
    }

    /// The same curve, one degree higher.
    pub fn elevated(&self) -> Self {
        self.through(|net| *net = blossom::elevate(net))
    }

    /// True where every weight has the same sign (or there is none).
    pub fn has_positive_weights(&self) -> bool {
        same_sign(self.weights.as_deref())
    }

    /// The curve with every control point mapped; equal to the mapped curve where `map` is affine.
    pub fn mapped<W: Vector>(&self, map: impl Fn(V) -> W) -> BezierCurve<W> {
        BezierCurve { points: self.points.iter().map(|&p| map(p)).collect(), weights: self.weights.clone() }
    }

    /// The same curve as a B-spline over `range`.
    ///
    /// # Errors
    /// Any [`NurbsError`] that names what does not fit: an empty range, a degree out of bounds, a zero
    /// weight.
    pub fn to_nurbs(&self, range: Range) -> Result<crate::NurbsCurve<V>, NurbsError> {
        let n = self.points.len();
        let knots = (0..2 * n).map(|i| if i < n { range.start } else { range.end }).collect();
        crate::NurbsCurve::new(self.degree(), knots, self.points.clone(), self.weights.clone())
    }
}

impl BezierCurve<DVec2> {
    /// The curve in the coordinates that map `cell` to the unit square.
    pub fn in_unit_square(&self, cell: &UvBox) -> Self {
        self.mapped(|p| (p - cell.min) / cell.size())
    }
}

/// True where every weight has the same sign (or there is none).
pub(crate) fn same_sign(weights: Option<&[f64]>) -> bool {
    weights.is_none_or(|w| w.iter().all(|w| *w > 0.0) || w.iter().all(|w| *w < 0.0))
}
