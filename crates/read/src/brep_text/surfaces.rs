//! Surfaces, brought to the parameters that the model uses.
//!
//! The file's cone has its v along the slant, ours along the axis. The file's placements may be left-handed,
//! ours are not: there the axis, and with it v, is turned round.

use super::curves::{MAX_DEPTH, Parsed, bezier_knots, curve, finite, knot_vector, knots, point, poles};
use super::tokens::{Stop, Tokens};
use chordal_brep::{ReadIssue, Real};
use chordal_nurbs::{DVec2, DVec3, Frame, NurbsSurface, Range, Surface, UvBox, math};

/// A surface and how the file's parameters become ours.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Patch {
    pub surface: Surface,
    /// What the file's (u, v) are multiplied by.
    pub factors: DVec2,
    /// Our Su × Sv points against the file's.
    pub reversed: bool,
    /// The trims of a rectangular trimmed surface, in our parameters.
    pub trims: Option<UvBox>,
}

impl Patch {
    fn plain(surface: Surface) -> Self {
        Self { surface, factors: DVec2::ONE, reversed: false, trims: None }
    }
}

/// A placement made right-handed by turning its axis round.
struct Placed {
    frame: Frame,
    left_handed: bool,
}

impl Placed {
    fn patch(self, v_factor: f64, build: impl FnOnce(Frame, f64) -> Surface) -> Patch {
        let side = if self.left_handed { -1.0 } else { 1.0 };
        let factors = DVec2::new(1.0, v_factor * side);
        Patch { surface: build(self.frame, side), factors, reversed: self.left_handed, trims: None }
    }
}

fn placed(tokens: &mut Tokens<'_>) -> Result<Result<Placed, ReadIssue>, Stop> {
    let [origin, z, x, y] = [point(tokens)?, point(tokens)?, point(tokens)?, point(tokens)?];
    Ok(finite([origin, z, x, y]).map(|()| {
        let left_handed = x.cross(y).dot(z) < 0.0;
        Placed { frame: Frame::new(origin, if left_handed { -z } else { z }, x), left_handed }
    }))
}

/// One surface.
pub(crate) fn surface(tokens: &mut Tokens<'_>, depth: u32) -> Parsed<Patch> {
    let kind = tokens.integer()?;
    match kind {
        1 => Ok(placed(tokens)?.map(|p| Patch::plain(Surface::Plane { frame: p.frame }))),
        2 => {
            let (place, radius) = (placed(tokens)?, tokens.real()?);
            let radius = radius_of(radius);
            Ok(place.and_then(|p| {
                let radius = radius?;
                Ok(p.patch(1.0, |frame, _| Surface::Cylinder { frame, radius }))
            }))
        }
        3 => {
            let (place, radius, angle) = (placed(tokens)?, tokens.real()?, tokens.real()?);
            Ok(place.and_then(|p| cone(p, radius, angle)))
        }
        4 => {
            let (place, radius) = (placed(tokens)?, tokens.real()?);
            Ok(place.and_then(|p| {
                let radius = radius_of(radius)?;
                Ok(p.patch(1.0, |frame, _| Surface::Sphere { frame, radius }))
            }))
        }
        5 => {
            let (place, major, minor) = (placed(tokens)?, tokens.real()?, tokens.real()?);
            Ok(place.and_then(|p| {
                let minor = radius_of(minor)?;
                Ok(p.patch(1.0, |frame, _| Surface::Torus { frame, major, minor }))
            }))
        }
        6 => {
            let direction = point(tokens)?;
            let profile = curve(tokens, 0)?;
            Ok(finite([direction])
                .and(profile)
                .map(|profile| Patch::plain(Surface::Extrusion { profile: profile.curve, direction })))
        }
        7 => {
            let (axis_origin, axis) = (point(tokens)?, point(tokens)?);
            let profile = curve(tokens, 0)?;
            Ok(profile.and_then(|profile| revolution(profile.curve, axis_origin, axis)))
        }
        8 => bezier(tokens),
        9 => bspline(tokens),
        10 if depth < MAX_DEPTH => {
            let [u1, u2, v1, v2] = [tokens.real()?, tokens.real()?, tokens.real()?, tokens.real()?];
            let basis = surface(tokens, depth + 1)?;
            Ok(basis.map(|basis| trimmed(basis, Range::new(u1, u2), Range::new(v1, v2))))
        }
        11 if depth < MAX_DEPTH => {
            let distance = tokens.real()?;
            let basis = surface(tokens, depth + 1)?;
            Ok(basis.map(|basis| {
                let distance = if basis.reversed { -distance } else { distance };
                Patch { surface: Surface::Offset { basis: Box::new(basis.surface), distance }, ..basis }
            }))
        }
        _ => Err(tokens.stop("the kind of a surface")),
    }
}

/// A radius of a surface. Negative ones keep their sign, see [`crate::settle_surfaces`].
fn radius_of(value: f64) -> Result<f64, ReadIssue> {
    let sound = value.is_finite() && value != 0.0;
    if sound { Ok(value) } else { Err(ReadIssue::BadValue { what: "radius", value: Real(value) }) }
}

fn cone(place: Placed, radius: f64, angle: f64) -> Result<Patch, ReadIssue> {
    let (sine, cosine) = math::sin_cos(angle);
    if !angle.is_finite() || !radius.is_finite() {
        return Err(ReadIssue::NotFinite { what: "radius or half angle" });
    }
    if sine == 0.0 {
        let radius = radius_of(radius)?;
        return Ok(place.patch(1.0, |frame, _| Surface::Cylinder { frame, radius }));
    }
    Ok(place.patch(cosine, |frame, side| Surface::Cone { frame, radius, half_angle: angle * side }))
}

fn revolution(profile: chordal_nurbs::Curve, axis_origin: DVec3, axis: DVec3) -> Result<Patch, ReadIssue> {
    let axis = axis.try_normalize().filter(|_| axis_origin.is_finite());
    let axis = axis.ok_or(ReadIssue::ZeroVector { what: "axis of revolution" })?;
    Ok(Patch::plain(Surface::Revolution { profile, axis_origin, axis }))
}

fn trimmed(basis: Patch, u: Range, v: Range) -> Patch {
    let along = |r: Range, factor: f64| {
        let (a, b) = (r.start * factor, r.end * factor);
        Range::new(a.min(b), a.max(b))
    };
    let uv = UvBox::from_ranges(along(u, basis.factors.x), along(v, basis.factors.y));
    let sound = uv.is_finite() && uv.min.cmplt(uv.max).all();
    Patch { trims: if sound { Some(uv) } else { basis.trims }, ..basis }
}

fn bezier(tokens: &mut Tokens<'_>) -> Parsed<Patch> {
    let rational = tokens.flag()? | tokens.flag()?;
    let degree = [tokens.count()?, tokens.count()?];
    let count = degree[0].saturating_add(1).saturating_mul(degree[1].saturating_add(1));
    let (points, weights) = poles(tokens, count, rational, point)?;
    let [u, v] = degree.map(bezier_knots);
    Ok(spline_patch(degree, u, v, points, weights))
}

fn bspline(tokens: &mut Tokens<'_>) -> Parsed<Patch> {
    let rational = tokens.flag()? | tokens.flag()?;
    let periodic = [tokens.flag()?, tokens.flag()?];
    let degree = [tokens.count()?, tokens.count()?];
    let [nu, nv] = [tokens.count()?, tokens.count()?];
    let knot_counts = [tokens.count()?, tokens.count()?];
    let (points, weights) = poles(tokens, nu.saturating_mul(nv), rational, point)?;
    let (u, mu) = knots(tokens, knot_counts[0])?;
    let (v, mv) = knots(tokens, knot_counts[1])?;
    let vectors = knot_vector(&u, &mu, degree[0], nu, periodic[0])
        .and_then(|u| Ok((u, knot_vector(&v, &mv, degree[1], nv, periodic[1])?)));
    Ok(vectors.and_then(|((u, rows), (v, columns))| {
        let at = |i: usize| (i / columns % nu) * nv + i % columns % nv;
        let repeated = rows * columns;
        let points = (0..repeated).map(|i| points[at(i)]).collect();
        let weights = weights.map(|w| (0..repeated).map(|i| w[at(i)]).collect());
        spline_patch(degree, u, v, points, weights)
    }))
}

fn spline_patch(
    degree: [usize; 2],
    u: Vec<f64>,
    v: Vec<f64>,
    points: Vec<DVec3>,
    weights: Option<Vec<f64>>,
) -> Result<Patch, ReadIssue> {
    let nurbs = NurbsSurface::new(degree, u, v, points, weights).map_err(ReadIssue::from)?;
    Ok(Patch::plain(Surface::Nurbs(nurbs)))
}
