//! Curves in space: made from numpy, evaluated, inverted.

use crate::numbers::{array, copied, doubles, rows3, with_last};
use crate::surface::failed;
use chordal::nurbs::{self, CurveInverter, NurbsCurve3, NurbsError, Range};
use numpy::{PyArray1, PyArrayDyn};
use pyo3::prelude::*;
use std::sync::Arc;

type Doubles<'py> = Bound<'py, PyArrayDyn<f64>>;

/// A curve in space over a range of its parameter, with parameters as in STEP (ISO 10303-42).
#[pyclass(frozen, module = "chordal")]
#[derive(Clone, Debug)]
pub struct Curve {
    pub curve: Arc<nurbs::Curve>,
    pub range: Range,
}

impl Curve {
    fn of(spline: Result<NurbsCurve3, NurbsError>) -> PyResult<Self> {
        let spline = spline.map_err(failed)?;
        Ok(Self { range: spline.domain(), curve: Arc::new(nurbs::Curve::Nurbs(spline)) })
    }

    fn spline(&self) -> PyResult<&NurbsCurve3> {
        match &*self.curve {
            nurbs::Curve::Nurbs(spline) => Ok(spline),
            _ => {
                Err(crate::errors::request("this curve has no knots; `to_nurbs` makes its exact NURBS form"))
            }
        }
    }
}

#[pymethods]
impl Curve {
    /// A NURBS curve: `points` (n, 3), `weights` (n,), `n + degree + 1` knots.
    #[staticmethod]
    #[pyo3(signature = (degree, knots, points, weights = None))]
    fn nurbs(
        degree: usize,
        knots: &Bound<'_, PyAny>,
        points: &Bound<'_, PyAny>,
        weights: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let (points, _) = rows3(&doubles(points, "points", Some(3))?);
        let weights = weights.map(|weights| doubles(weights, "weights", None)).transpose()?;
        let weights = weights.map(|weights| weights.iter().copied().collect());
        let knots = doubles(knots, "knots", None)?.iter().copied().collect();
        Self::of(NurbsCurve3::new(degree, knots, points, weights))
    }

    /// The range of the parameter.
    #[getter]
    fn range(&self) -> (f64, f64) {
        (self.range.start, self.range.end)
    }

    /// The points at the parameters `t` (…): (…, 3).
    fn evaluate<'py>(&self, t: &Bound<'py, PyAny>) -> PyResult<Doubles<'py>> {
        let py = t.py();
        let t = doubles(t, "t", None)?;
        let points = t.iter().flat_map(|&t| self.curve.point(t).to_array()).collect();
        array(py, points, &with_last(t.shape(), 3))
    }

    /// The point and its first two derivatives at the parameters `t` (…): (…, 3, 3).
    fn derivatives<'py>(&self, t: &Bound<'py, PyAny>) -> PyResult<Doubles<'py>> {
        let py = t.py();
        let t = doubles(t, "t", None)?;
        let jets = t.iter().map(|&t| self.curve.jet(t));
        let rows = jets.flat_map(|jet| [jet.p, jet.d1, jet.d2].into_iter().flat_map(|d| d.to_array()));
        array(py, rows.collect(), &with_last(&with_last(t.shape(), 3), 3))
    }

    /// The nearest parameters to `points` (…, 3): (…), and their distances (…).
    fn invert<'py>(&self, points: &Bound<'py, PyAny>) -> PyResult<(Doubles<'py>, Doubles<'py>)> {
        let py = points.py();
        let (points, shape) = rows3(&doubles(points, "points", Some(3))?);
        let inverter = CurveInverter::new(&self.curve, self.range);
        let found: Vec<_> = points.iter().map(|&point| inverter.invert(point, None)).collect();
        let t = found.iter().map(|inversion| inversion.t).collect();
        let distances = found.iter().map(|inversion| inversion.distance).collect();
        Ok((array(py, t, &shape)?, array(py, distances, &shape)?))
    }

    /// A grid of `count` points over the range: float64 (count, 6): the point and the unit tangent.
    #[pyo3(signature = (count = 10))]
    fn grid<'py>(&self, py: Python<'py>, count: usize) -> PyResult<Doubles<'py>> {
        if !(2..=1_000_000).contains(&count) {
            return Err(crate::errors::argument("count", format!("{count} is not between 2 and a million")));
        }
        let step = self.range.length() / (count - 1) as f64;
        let rows = (0..count).flat_map(|i| {
            let jet = self.curve.jet(self.range.start + step * i as f64);
            jet.p.to_array().into_iter().chain(jet.d1.normalize_or_zero().to_array())
        });
        array(py, rows.collect(), &[count, 6])
    }

    /// The exact NURBS form over the range.
    fn to_nurbs(&self) -> PyResult<Self> {
        Self::of(self.curve.to_nurbs(self.range))
    }

    /// The degree of a NURBS curve.
    #[getter]
    fn degree(&self) -> PyResult<usize> {
        self.spline().map(|spline| spline.degree())
    }

    /// The knots of a NURBS curve.
    #[getter]
    fn knots<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        self.spline().map(|spline| copied(py, spline.knots()))
    }

    /// The control points (n, 3) of a NURBS curve, not multiplied by weights.
    #[getter]
    fn points<'py>(&self, py: Python<'py>) -> PyResult<Doubles<'py>> {
        crate::numbers::points(py, self.spline()?.points().iter().map(|p| p.to_array()).collect())
    }

    /// The weights of a NURBS curve; `None` where all are equal.
    #[getter]
    fn weights<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray1<f64>>>> {
        self.spline().map(|spline| spline.weights().map(|weights| copied(py, weights)))
    }

    /// The same curve with a knot inserted.
    #[pyo3(signature = (t, times = 1))]
    fn insert_knot(&self, t: f64, times: usize) -> PyResult<Self> {
        Self::of(self.spline()?.insert_knot(t, times))
    }

    /// The control points of the polynomial pieces of a NURBS curve, each (degree + 1, 3), with their ranges.
    #[allow(clippy::type_complexity, reason = "a tuple in Python")]
    fn bezier_pieces<'py>(&self, py: Python<'py>) -> PyResult<Vec<(Doubles<'py>, (f64, f64))>> {
        let pieces = self.spline()?.bezier_pieces();
        let piece = |(range, curve): &(Range, nurbs::BezierCurve<chordal::math::DVec3>)| {
            let points = curve.points.iter().map(|p| p.to_array()).collect();
            Ok((crate::numbers::points(py, points)?, (range.start, range.end)))
        };
        pieces.iter().map(piece).collect()
    }

    fn __repr__(&self) -> String {
        format!("<chordal.Curve over {:?}..{:?}>", self.range.start, self.range.end)
    }
}
