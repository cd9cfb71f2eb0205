//! Surfaces: made from numpy, evaluated, inverted, cut into Bézier patches.

use crate::errors::argument;
use crate::numbers::{array, copied, doubles, rows2, rows3, with_last};
use chordal::math::{DVec2, DVec3};
use chordal::nurbs::{self, NurbsError, NurbsSurface, Range, SurfaceInverter, SurfaceKind, UvBox};
use numpy::{PyArray1, PyArrayDyn};
use pyo3::prelude::*;
use std::sync::Arc;

type Doubles<'py> = Bound<'py, PyArrayDyn<f64>>;

/// Half the width of the window in which points of an unbounded surface are looked for where nobody says where.
const UNBOUNDED: f64 = 1e6;

/// A surface, with parameters as in STEP (ISO 10303-42): angles are radians.
#[pyclass(frozen, module = "chordal")]
#[derive(Clone, Debug)]
pub struct Surface(Arc<nurbs::Surface>);

/// An error of a curve or surface that the caller made.
pub fn failed(error: NurbsError) -> PyErr {
    crate::errors::request(&error.to_string())
}

impl Surface {
    /// A surface of a model.
    pub fn whole(surface: Arc<nurbs::Surface>) -> Self {
        Self(surface)
    }

    /// The name of its kind, as in the report.
    pub fn kind_name(&self) -> &'static str {
        match self.0.kind() {
            SurfaceKind::Plane => "plane",
            SurfaceKind::Cylinder => "cylinder",
            SurfaceKind::Cone => "cone",
            SurfaceKind::Sphere => "sphere",
            SurfaceKind::Torus => "torus",
            SurfaceKind::Extrusion => "extrusion",
            SurfaceKind::Revolution => "revolution",
            SurfaceKind::Nurbs => "nurbs",
            SurfaceKind::Offset => "offset",
        }
    }

    fn spline(&self) -> PyResult<&NurbsSurface> {
        match &*self.0 {
            nurbs::Surface::Nurbs(spline) => Ok(spline),
            _ => Err(crate::errors::request(&format!(
                "a {} has no knots; `to_nurbs` makes its exact NURBS form",
                self.kind_name()
            ))),
        }
    }

    fn of(spline: Result<NurbsSurface, NurbsError>) -> PyResult<Self> {
        spline.map(|spline| Self(Arc::new(nurbs::Surface::Nurbs(spline)))).map_err(failed)
    }

    /// One row of `N` numbers per point of parameters.
    fn rows<'py, const N: usize>(
        &self,
        uv: &Bound<'py, PyAny>,
        tail: &[usize],
        of: impl Fn(&nurbs::Surface, DVec2) -> [f64; N] + Sync,
    ) -> PyResult<Doubles<'py>> {
        let py = uv.py();
        let (uv, shape) = rows2(&doubles(uv, "uv", Some(2))?);
        let rows: Vec<[f64; N]> = py.detach(|| uv.iter().map(|&uv| of(&self.0, uv)).collect());
        array(py, rows.into_flattened(), &[&shape[..], tail].concat())
    }
}

#[pymethods]
impl Surface {
    /// A NURBS surface: `points` (nu, nv, 3), `weights` (nu, nv), knots with `n + degree + 1` values.
    #[staticmethod]
    #[pyo3(signature = (degree, knots_u, knots_v, points, weights = None))]
    fn nurbs(
        degree: (usize, usize),
        knots_u: &Bound<'_, PyAny>,
        knots_v: &Bound<'_, PyAny>,
        points: &Bound<'_, PyAny>,
        weights: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let points = doubles(points, "points", Some(3))?;
        let (rows, shape) = rows3(&points);
        if shape.len() != 2 {
            return Err(argument("points", format!("the shape {:?} is not (nu, nv, 3)", points.shape())));
        }
        let weights = weights.map(|weights| doubles(weights, "weights", None)).transpose()?;
        let weights = weights.map(|weights| weights.iter().copied().collect());
        let list = |knots, name| doubles(knots, name, None).map(|knots| knots.iter().copied().collect());
        let (knots_u, knots_v): (Vec<f64>, Vec<f64>) = (list(knots_u, "knots_u")?, list(knots_v, "knots_v")?);
        if knots_u.len() != shape[0] + degree.0 + 1 {
            let (knots, points, degree) = (knots_u.len(), shape[0], degree.0);
            return Err(failed(NurbsError::KnotCount { knots, points, degree }));
        }
        Self::of(NurbsSurface::new([degree.0, degree.1], knots_u, knots_v, rows, weights))
    }

    /// Its kind: plane, cylinder, cone, sphere, torus, extrusion, revolution, nurbs or offset.
    #[getter]
    fn kind(&self) -> &'static str {
        self.kind_name()
    }

    /// The range of u and the range of v; infinite where it has no end.
    #[getter]
    fn domain(&self) -> ((f64, f64), (f64, f64)) {
        let domain = self.0.domain();
        ((domain.min.x, domain.max.x), (domain.min.y, domain.max.y))
    }

    /// The periods along u and v.
    #[getter]
    fn periods(&self) -> (Option<f64>, Option<f64>) {
        self.0.periods().into()
    }

    /// The points at `uv` (…, 2): (…, 3).
    fn evaluate<'py>(&self, uv: &Bound<'py, PyAny>) -> PyResult<Doubles<'py>> {
        self.rows(uv, &[3], |surface, uv| surface.point(uv).to_array())
    }

    /// The unit normals at `uv` (…, 2): (…, 3); NaN at a point that has none.
    fn normals<'py>(&self, uv: &Bound<'py, PyAny>) -> PyResult<Doubles<'py>> {
        self.rows(uv, &[3], |surface, uv| surface.normal(uv).unwrap_or(DVec3::NAN).to_array())
    }

    /// The point and its derivatives at `uv` (…, 2): (…, 6, 3), in the order S, Su, Sv, Suu, Suv, Svv.
    fn derivatives<'py>(&self, uv: &Bound<'py, PyAny>) -> PyResult<Doubles<'py>> {
        self.rows::<18>(uv, &[6, 3], |surface, uv| {
            let jet = surface.jet(uv);
            let all = [jet.p, jet.du, jet.dv, jet.duu, jet.duv, jet.dvv].map(|d| d.to_array());
            std::array::from_fn(|i| all[i / 3][i % 3])
        })
    }

    /// The nearest parameters to `points` (…, 3): (…, 2), and their distances (…).
    #[pyo3(signature = (points, uv_range = None))]
    fn invert<'py>(
        &self,
        points: &Bound<'py, PyAny>,
        uv_range: Option<((f64, f64), (f64, f64))>,
    ) -> PyResult<(Doubles<'py>, Doubles<'py>)> {
        let py = points.py();
        let (points, shape) = rows3(&doubles(points, "points", Some(3))?);
        let within = uv_range.map_or_else(|| bounded(self.0.domain()), given_box);
        let found: Vec<_> = py.detach(|| {
            let inverter = SurfaceInverter::new(&self.0, within);
            points.iter().map(|&point| inverter.invert(point, None)).collect()
        });
        let uv = found.iter().flat_map(|inversion| inversion.uv.to_array()).collect();
        let distances = found.iter().map(|inversion| inversion.distance).collect();
        Ok((array(py, uv, &with_last(&shape, 2))?, array(py, distances, &shape)?))
    }

    /// The exact NURBS form over a range of parameters, the whole domain where none is given.
    #[pyo3(signature = (uv_range = None))]
    fn to_nurbs(&self, uv_range: Option<((f64, f64), (f64, f64))>) -> PyResult<Self> {
        let within = uv_range.map_or_else(|| self.0.domain(), given_box);
        Self::of(self.0.to_nurbs(within))
    }

    /// The degrees along u and v.
    #[getter]
    fn degree(&self) -> PyResult<(usize, usize)> {
        self.spline().map(|spline| spline.degree().into())
    }

    /// The knots along u.
    #[getter]
    fn knots_u<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        self.spline().map(|spline| copied(py, spline.knots_u()))
    }

    /// The knots along v.
    #[getter]
    fn knots_v<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        self.spline().map(|spline| copied(py, spline.knots_v()))
    }

    /// The control points (nu, nv, 3), not multiplied by weights.
    #[getter]
    fn points<'py>(&self, py: Python<'py>) -> PyResult<Doubles<'py>> {
        let spline = self.spline()?;
        let [nu, nv] = spline.counts();
        array(py, spline.points().iter().flat_map(|p| p.to_array()).collect(), &[nu, nv, 3])
    }

    /// The weights (nu, nv); `None` where all are equal.
    #[getter]
    fn weights<'py>(&self, py: Python<'py>) -> PyResult<Option<Doubles<'py>>> {
        let spline = self.spline()?;
        let [nu, nv] = spline.counts();
        spline.weights().map(|weights| array(py, weights.to_vec(), &[nu, nv])).transpose()
    }

    /// The same surface with control points moved to `points` (nu, nv, 3).
    fn with_points(&self, points: &Bound<'_, PyAny>) -> PyResult<Self> {
        let spline = self.spline()?;
        let (rows, shape) = rows3(&doubles(points, "points", Some(3))?);
        if shape != spline.counts() {
            let [nu, nv] = spline.counts();
            return Err(argument("points", format!("the surface has {nu} by {nv} control points")));
        }
        let weights = spline.weights().map(<[f64]>::to_vec);
        let (u, v) = (spline.knots_u().to_vec(), spline.knots_v().to_vec());
        Self::of(NurbsSurface::new(spline.degree(), u, v, rows, weights))
    }

    /// The same surface with a knot inserted along u.
    #[pyo3(signature = (u, times = 1))]
    fn insert_knot_u(&self, u: f64, times: usize) -> PyResult<Self> {
        Self::of(self.spline()?.insert_knot_u(u, times))
    }

    /// The same surface with a knot inserted along v.
    #[pyo3(signature = (v, times = 1))]
    fn insert_knot_v(&self, v: f64, times: usize) -> PyResult<Self> {
        Self::of(self.spline()?.insert_knot_v(v, times))
    }

    /// The part of a NURBS surface over a range of parameters.
    fn piece(&self, uv_range: ((f64, f64), (f64, f64))) -> PyResult<Self> {
        Self::of(self.spline()?.piece(given_box(uv_range)))
    }

    /// The polynomial pieces of a NURBS surface, u outer and v inner.
    fn bezier_patches(&self, py: Python<'_>) -> PyResult<Vec<BezierPatch>> {
        let spline = self.spline()?;
        spline.bezier_patches(spline.domain()).iter().map(|patch| BezierPatch::new(py, patch)).collect()
    }

    fn __repr__(&self) -> String {
        format!("<chordal.Surface: {}>", self.kind_name())
    }
}

fn given_box(((u0, u1), (v0, v1)): ((f64, f64), (f64, f64))) -> UvBox {
    UvBox::from_ranges(Range::new(u0, u1), Range::new(v0, v1))
}

/// A finite window of an unbounded direction.
fn bounded(domain: UvBox) -> UvBox {
    let finite = |r: Range| Range::new(r.start.max(-UNBOUNDED), r.end.min(UNBOUNDED));
    UvBox::from_ranges(finite(domain.u()), finite(domain.v()))
}

/// A polynomial piece of a surface over the unit square.
#[pyclass(frozen, get_all, module = "chordal")]
#[derive(Debug)]
pub struct BezierPatch {
    /// The control points (p + 1, q + 1, 3), not multiplied by weights.
    points: Py<PyArrayDyn<f64>>,
    /// The weights (p + 1, q + 1); `None` for a polynomial patch.
    weights: Option<Py<PyArrayDyn<f64>>>,
    /// The ranges of u and v of the surface that it covers.
    uv_range: ((f64, f64), (f64, f64)),
}

impl BezierPatch {
    fn new(py: Python<'_>, (cell, patch): &(UvBox, nurbs::BezierPatch)) -> PyResult<Self> {
        let [p, q] = patch.degree;
        let points = patch.points.iter().flat_map(|point| point.to_array()).collect();
        let weights = patch.weights.clone().map(|weights| array(py, weights, &[p + 1, q + 1])).transpose()?;
        Ok(Self {
            points: array(py, points, &[p + 1, q + 1, 3])?.unbind(),
            weights: weights.map(Bound::unbind),
            uv_range: ((cell.min.x, cell.max.x), (cell.min.y, cell.max.y)),
        })
    }
}
