//! Bounds of curves that are given in the parameter space of a surface.
//!
//! - *Chord.* On a spline surface the curve is composed with the patches that it runs over, exactly, and the
//!   control points of what comes out are measured ([`crate::NurbsSurface::lift`]).
//! - *Derivatives*, and everything on other surfaces: the chain rule, with bounds of the surface's
//!   derivatives over the box that the parameter curve keeps to.

use super::spline_chord::hull_to_chord;
use crate::math;
use crate::vector::largest;
use crate::{Curve, Curve2, LiftOptions, LiftedPiece, Range, Surface, SurfaceBounds, UvBox};
use glam::DVec2;

/// The highest degree at which a curve on a spline surface is composed exactly to bound its chord.
///
/// The work of the composition grows with the square of the degree. Above this degree the chain rule over
/// enclosures is cheaper; it is looser, so a lower value gives more chords.
const EXACT_DEGREE: usize = 40;

/// Upper bound of the two-sided distance between the curve over `range` and the chord between its ends;
/// `None` where the surface is no spline, or the curve has no exact form on it.
pub(super) fn exact_chord_error(surface: &Surface, curve: &Curve2, range: Range) -> Option<f64> {
    let Surface::Nurbs(spline) = surface else { return None };
    let plane = curve.to_nurbs(range).ok()?;
    let [p, q] = spline.degree();
    if plane.degree() * (p + q) > EXACT_DEGREE {
        return None;
    }
    let mut pieces: Vec<LiftedPiece> = Vec::new();
    for (_, piece) in plane.bezier_pieces() {
        // Beyond the domain closed surfaces begin anew, and the outermost patches do not.
        let domain = spline.domain();
        let slack = domain.size() * OUTSIDE;
        let inside = |p: &DVec2| domain.inflated(slack).contains(*p);
        if !piece.points.iter().all(inside) {
            return None;
        }
        pieces.extend(spline.lift(&piece, LiftOptions::default()).ok()?);
    }
    let chord = (surface.point(curve.point(range.start)), surface.point(curve.point(range.end)));
    Some(largest(pieces.iter().map(|piece| hull_to_chord(&piece.xyz, chord) + piece.error)))
}

/// How far parameters may leave the domain, as a share of it, and still count as inside.
///
/// Readers compute curves that end on the border of the domain to some units in the last place. Without this
/// slack such a curve would lose its exact bound.
const OUTSIDE: f64 = 1e-13;

/// Norms of Su, Sv, Suu, Suv, Svv over a box.
struct Norms {
    first: [f64; 2],
    second: [f64; 3],
}

pub(super) fn derivative_bound(surface: &Surface, curve: &Curve2, order: usize, range: Range) -> f64 {
    let lifted = curve.lifted();
    let [c1, c2] = [1, 2].map(|k| lifted.derivative_bound(k, range));
    // Nowhere further from the middle than half the length run.
    let reach = c1 * 0.5 * range.length();
    if !reach.is_finite() {
        return f64::INFINITY;
    }
    let middle = curve.point(0.5 * (range.start + range.end));
    let uv = UvBox::new(middle, middle).inflated(DVec2::splat(reach));
    let Some(s) = norms(surface, uv) else { return f64::INFINITY };
    let first = math::hypot(s.first[0], s.first[1]);
    match order {
        1 => first * c1,
        2 => (s.second[0] + 2.0 * s.second[1] + s.second[2]) * c1 * c1 + first * c2,
        _ => f64::INFINITY,
    }
}

/// `None` where nothing is proven.
fn norms(surface: &Surface, uv: UvBox) -> Option<Norms> {
    let farthest = |r: f64, slope: f64| (r + slope * uv.min.y).abs().max((r + slope * uv.max.y).abs());
    Some(match surface {
        Surface::Plane { .. } => Norms { first: [1.0, 1.0], second: [0.0; 3] },
        Surface::Cylinder { radius, .. } => {
            Norms { first: [radius.abs(), 1.0], second: [radius.abs(), 0.0, 0.0] }
        }
        Surface::Cone { radius, half_angle, .. } => {
            let slope = math::tan(*half_angle);
            let r = farthest(*radius, slope);
            Norms { first: [r, 1.0 / math::cos(*half_angle).abs()], second: [r, slope.abs(), 0.0] }
        }
        Surface::Sphere { radius, .. } => {
            let r = radius.abs();
            Norms { first: [r, r], second: [r, r, r] }
        }
        Surface::Torus { major, minor, .. } => {
            let (big, r) = (major.abs() + minor.abs(), minor.abs());
            Norms { first: [big, r], second: [big, r, r] }
        }
        Surface::Extrusion { profile, direction } => {
            let [d1, d2] = [1, 2].map(|k| profile.derivative_bound(k, uv.u()));
            Norms { first: [d1, direction.length()], second: [d2, 0.0, 0.0] }
        }
        Surface::Revolution { profile, axis_origin, .. } => {
            let [d1, d2] = [1, 2].map(|k| profile.derivative_bound(k, uv.v()));
            let r = profile.point(uv.center().y).distance(*axis_origin) + d1 * 0.5 * uv.size().y;
            Norms { first: [r, d1], second: [r, d1, d2] }
        }
        Surface::Nurbs(_) | Surface::Offset { .. } => return general_norms(surface, uv),
    })
}

/// From enclosures of the second derivatives, and the first ones at the middle. The box is cut to the domain,
/// outside of which only closed directions go on.
fn general_norms(surface: &Surface, uv: UvBox) -> Option<Norms> {
    let domain = surface.domain();
    let mut inside = UvBox::new(domain.clamp(uv.min), domain.clamp(uv.max));
    for (axis, period) in surface.periods().into_iter().enumerate() {
        if period.is_some() {
            inside.min[axis] = uv.min[axis];
            inside.max[axis] = uv.max[axis];
        }
    }
    let uv = inside;
    let mut pieces = Vec::new();
    let jump = SurfaceBounds::new(surface, uv, f64::INFINITY).pieces(uv, &mut pieces);
    let mut second = [0.0f64; 3];
    for piece in &pieces {
        for (bound, norm) in second.iter_mut().zip(piece.norms) {
            *bound = bound.max(norm);
        }
    }
    let (_, du, dv) = surface.jet1(uv.center());
    let half = uv.size() * 0.5;
    let first = [
        du.length() + second[0] * half.x + second[1] * half.y + jump.x * pieces.len() as f64,
        dv.length() + second[1] * half.x + second[2] * half.y + jump.y * pieces.len() as f64,
    ];
    (!pieces.is_empty()).then_some(Norms { first, second })
}

impl Curve2 {
    /// The same curve in the plane z = 0 of space, with the same parameters.
    pub(crate) fn lifted(&self) -> Curve {
        use crate::{CompositeSegment, Frame, Frame2};
        let frame = |f: &Frame2| {
            let (x, y) = (f.x.extend(0.0), f.y.extend(0.0));
            Frame { origin: f.origin.extend(0.0), x, y, z: x.cross(y) }
        };
        match self {
            Curve2::Line { origin, direction } => {
                Curve::Line { origin: origin.extend(0.0), direction: direction.extend(0.0) }
            }
            Curve2::Circle { frame: f, radius } => Curve::Circle { frame: frame(f), radius: *radius },
            Curve2::Ellipse { frame: f, a, b } => Curve::Ellipse { frame: frame(f), a: *a, b: *b },
            Curve2::Parabola { frame: f, focal } => Curve::Parabola { frame: frame(f), focal: *focal },
            Curve2::Hyperbola { frame: f, a, b } => Curve::Hyperbola { frame: frame(f), a: *a, b: *b },
            Curve2::Polyline(points) => Curve::Polyline(points.iter().map(|p| p.extend(0.0)).collect()),
            Curve2::Nurbs(curve) => Curve::Nurbs(curve.mapped(|p| p.extend(0.0))),
            Curve2::Composite(pieces) => Curve::Composite(
                pieces
                    .iter()
                    .map(|(c, start, end)| CompositeSegment { curve: c.lifted(), start: *start, end: *end })
                    .collect(),
            ),
            // Crossed with the plane's normal a direction turns to the right.
            Curve2::Offset { basis, distance } => Curve::Offset {
                basis: Box::new(basis.lifted()),
                distance: *distance,
                reference: glam::DVec3::Z,
            },
        }
    }
}
