//! Surfaces.

use super::args::{Args, Kind};
use super::bspline::Knots;
use super::document::{Ix, Res};
use super::geometry::Geometry;
use super::keyword::Kw;
use crate::assemble::replace_zero_weights;
use chordal_brep::{ReadIssue, Real};
use chordal_nurbs::{DVec3, NurbsSurface, Surface};

/// The parts of a spline surface as an entity states them.
struct SplineSurface {
    degree: [usize; 2],
    /// Rows along u, points of a row along v.
    rows: Vec<Vec<DVec3>>,
    knots: [Knots; 2],
    weights: Option<Vec<Vec<f64>>>,
}

const FORMS: [(Kw, fn() -> Knots); 5] = [
    (Kw::UniformSurface, || Knots::Uniform),
    (Kw::QuasiUniformSurface, || Knots::QuasiUniform),
    (Kw::BezierSurface, || Knots::Bezier),
    (Kw::PiecewiseBezierSurface, || Knots::Bezier),
    (Kw::BSplineSurface, || Knots::QuasiUniform),
];

impl Geometry<'_> {
    pub(crate) fn build_surface(&mut self, ix: Ix) -> Res<Surface> {
        let doc = self.doc;
        let kw = doc.kw(ix);
        if kw == Kw::Complex || kw == Kw::BSplineSurfaceWithKnots || FORMS.iter().any(|(form, _)| *form == kw)
        {
            return self.spline_surface(ix);
        }
        let mut args = doc.open(ix)?;
        args.skip(1);
        match kw {
            Kw::Plane => Ok(Surface::Plane { frame: self.frame(args.reference()?)? }),
            Kw::CylindricalSurface => {
                let frame = self.frame(args.reference()?)?;
                Ok(Surface::Cylinder { frame, radius: self.radius(ix, "radius", args.real()?) })
            }
            Kw::ConicalSurface => self.cone(ix, args),
            Kw::SphericalSurface => {
                let frame = self.frame(args.reference()?)?;
                Ok(Surface::Sphere { frame, radius: self.radius(ix, "radius", args.real()?) })
            }
            Kw::ToroidalSurface | Kw::DegenerateToroidalSurface => {
                let frame = self.frame(args.reference()?)?;
                let major = args.real()?;
                Ok(Surface::Torus { frame, major, minor: self.radius(ix, "minor radius", args.real()?) })
            }
            Kw::SurfaceOfLinearExtrusion => {
                let profile = self.curve(args.reference()?)?;
                Ok(Surface::Extrusion { profile, direction: self.vector(args.reference()?)? })
            }
            Kw::SurfaceOfRevolution => {
                let profile = self.curve(args.reference()?)?;
                let (axis_origin, axis) = self.axis(args.reference()?)?;
                Ok(Surface::Revolution { profile, axis_origin, axis })
            }
            Kw::OffsetSurface => {
                let basis = args.reference()?;
                let basis = Box::new(self.nested(ix, |geometry| geometry.build_surface(basis))?);
                Ok(Surface::Offset { basis, distance: args.real()? })
            }
            Kw::OrientedSurface | Kw::RectangularTrimmedSurface | Kw::CurveBoundedSurface => {
                let basis = args.reference()?;
                self.nested(ix, |geometry| geometry.build_surface(basis))
            }
            _ => Err(doc.unknown(ix, "a surface")),
        }
    }

    /// A radius of a surface. It keeps its sign, see [`crate::settle_surfaces`]; where it is zero the surface
    /// has no area.
    fn radius(&self, ix: Ix, what: &'static str, value: f64) -> f64 {
        if value == 0.0 {
            self.doc.warn(ix, ReadIssue::BadValue { what, value: Real(0.0) });
        }
        value
    }

    /// CONICAL_SURFACE(name, position, radius, semi_angle). A negative angle opens the other way.
    fn cone(&mut self, ix: Ix, mut args: Args<'_>) -> Res<Surface> {
        let frame = self.frame(args.reference()?)?;
        let radius = args.real()?;
        let half_angle = args.real()? * self.units.angle_rad;
        if half_angle == 0.0 {
            self.doc.warn(ix, ReadIssue::ConeIsCylinder);
            return Ok(Surface::Cylinder { frame, radius: self.radius(ix, "radius", radius) });
        }
        Ok(Surface::Cone { frame, radius, half_angle })
    }

    fn spline_surface(&mut self, ix: Ix) -> Res<Surface> {
        let SplineSurface { degree, mut rows, knots, weights } = self.spline_surface_data(ix)?;
        let bad = |issue: ReadIssue| self.doc.bad(ix, issue);
        let count_v = rows.first().map_or(0, Vec::len);
        if rows.iter().any(|row| row.len() != count_v) {
            return Err(bad(ReadIssue::RowsDiffer));
        }
        let vectors = [
            knots[0].vector(degree[0], rows.len()).map_err(bad)?,
            knots[1].vector(degree[1], count_v).map_err(bad)?,
        ];
        let trim = |rows: Vec<Vec<f64>>| flatten(&vectors, rows);
        let mut weights = match weights {
            Some(w) if w.len() != rows.len() || w.iter().any(|row| row.len() != count_v) => {
                return Err(bad(ReadIssue::Count {
                    what: "weights",
                    found: w.iter().map(Vec::len).sum(),
                    expected: rows.len() * count_v,
                }));
            }
            weights => weights.map(trim),
        };
        if vectors.iter().any(|vector| vector.repaired()) {
            self.doc.warn(ix, ReadIssue::SurplusKnots);
        }
        if weights.as_deref_mut().is_some_and(replace_zero_weights) {
            self.doc.warn(ix, ReadIssue::ZeroWeight);
        }
        let points = flatten(&vectors, std::mem::take(&mut rows));
        let [u, v] = vectors;
        let surface = NurbsSurface::new(degree, u.knots, v.knots, points, weights);
        surface.map(Surface::Nurbs).map_err(|error| self.doc.bad(ix, error))
    }

    fn spline_surface_data(&mut self, ix: Ix) -> Res<SplineSurface> {
        let doc = self.doc;
        let mut args = doc.open(ix)?;
        if doc.kw(ix) != Kw::Complex {
            args.skip(1);
            let (degree, rows) = self.surface_head(&mut args)?;
            args.skip(4);
            let knots = match FORMS.iter().find(|(form, _)| *form == doc.kw(ix)) {
                Some((_, knots)) => [knots(), knots()],
                None => listed_knots(&mut args)?,
            };
            return Ok(SplineSurface { degree, rows, knots, weights: None });
        }
        let leaves = args.leaves();
        let leaf = |kw| leaves.iter().find(|(name, _)| *name == kw).map(|(_, args)| args.clone());
        let Some(mut head) = leaf(Kw::BSplineSurface) else {
            return Err(doc.unknown(ix, "a surface"));
        };
        let (degree, rows) = self.surface_head(&mut head)?;
        let knots = match leaf(Kw::BSplineSurfaceWithKnots) {
            Some(mut args) => listed_knots(&mut args)?,
            None => {
                let form = FORMS
                    .iter()
                    .find(|(form, _)| leaf(*form).is_some())
                    .map_or(FORMS[1].1, |(_, knots)| *knots);
                [form(), form()]
            }
        };
        let weights = leaf(Kw::RationalBSplineSurface).map(|mut args| weight_rows(&mut args)).transpose()?;
        Ok(SplineSurface { degree, rows, knots, weights })
    }

    fn surface_head(&mut self, args: &mut Args<'_>) -> Res<([usize; 2], Vec<Vec<DVec3>>)> {
        let degree = [args.integer()?, args.integer()?];
        let [Ok(u), Ok(v)] = degree.map(usize::try_from) else {
            return Err(args.wrong(ReadIssue::BadValue {
                what: "degree",
                value: Real(degree[0].min(degree[1]) as f64),
            }));
        };
        let mut list = args.list()?;
        let mut rows = Vec::new();
        while list.kind() != Kind::End {
            let row = list.references_strict()?;
            rows.push(self.points(row)?);
        }
        Ok(([u, v], rows))
    }
}

fn listed_knots(args: &mut Args<'_>) -> Res<[Knots; 2]> {
    let multiplicities = [args.integers()?, args.integers()?];
    let values = [args.reals()?, args.reals()?];
    let [mu, mv] = multiplicities;
    let [ku, kv] = values;
    Ok([Knots::Listed { multiplicities: mu, values: ku }, Knots::Listed { multiplicities: mv, values: kv }])
}

fn weight_rows(args: &mut Args<'_>) -> Res<Vec<Vec<f64>>> {
    let mut list = args.list()?;
    let mut rows = Vec::new();
    while list.kind() != Kind::End {
        rows.push(list.reals()?);
    }
    Ok(rows)
}

/// Rows to one vector, v running fastest, without what the knot vectors leave without effect.
fn flatten<T: Clone>(vectors: &[super::bspline::KnotVector; 2], rows: Vec<Vec<T>>) -> Vec<T> {
    vectors[0].trim(rows).into_iter().flat_map(|row| vectors[1].trim(row)).collect()
}
