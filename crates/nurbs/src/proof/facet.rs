//! The proven distance between a surface piece and a flat triangle whose corners lie on the surface.
//!
//! Cylinders, cones, spheres and tori have forms of their own ([`elementary`]): the distance of a facet's
//! points to the surface, whose closest-point projection maps facets onto the surface, consistently along
//! shared edges. All other surfaces go through enclosures of their second derivatives ([`general`]).
//!
//! Sound as long as the mesh lies nearer to the surface than its smallest radius of curvature; facets that
//! lean too far against the surface are rejected.

mod chord;
mod elementary;
mod extruded;
mod form;
mod general;
mod lattice;
mod refine_bound;
mod setting;
mod slope;

use crate::math;
use crate::{Piece, Surface, SurfaceBounds, work};
use glam::{DVec2, DVec3};

/// The work of a bound beside that of its pieces and evaluations.
const FACET: u64 = 200;

/// One facet to be bounded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facet {
    /// Corners in parameter space.
    pub uv: [DVec2; 3],
    /// The surface at these corners.
    pub xyz: [DVec3; 3],
    /// Of each edge (opposite corner i) that bounds the face, how far its chord lies from the boundary curve.
    pub sag: [Option<f64>; 3],
}

/// Upper bound of the two-sided distance between the surface over the triangle and the facet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FacetBound {
    /// The bound for the whole facet; infinite if nothing can be proven.
    pub error: f64,
    /// The share of the edge opposite corner i alone, which no point inside the facet can lower. Where
    /// `error` is far beyond what is enough, only a lower bound.
    pub edges: [f64; 3],
}

impl FacetBound {
    const NONE: FacetBound = FacetBound { error: f64::INFINITY, edges: [f64::INFINITY; 3] };
    const EXACT: FacetBound = FacetBound { error: 0.0, edges: [0.0; 3] };

    /// The better of two bounds as a whole.
    fn or_less(self, other: Self) -> Self {
        if other.error < self.error { other } else { self }
    }
}

/// Bounds one facet. A bound below `enough` is as good as any: the effort spent on tightness depends on it.
/// `scratch` is reused from call to call.
pub fn facet_bound(
    bounds: &SurfaceBounds<'_>,
    facet: &Facet,
    enough: f64,
    scratch: &mut Vec<Piece>,
) -> FacetBound {
    work::count(FACET);
    let mut bound = match bounds.surface() {
        Surface::Plane { .. } => FacetBound::EXACT,
        Surface::Cylinder { radius, .. } => elementary::cone(facet, [*radius; 3], 1.0),
        Surface::Cone { radius, half_angle, .. } => {
            let radii = facet.uv.map(|p| radius + p.y * math::tan(*half_angle));
            elementary::cone(facet, radii, math::cos(*half_angle))
        }
        Surface::Sphere { frame, radius } => elementary::sphere(facet, frame.origin, *radius),
        // Where the tube is wider than its circle, only the part that faces away from the axis has the simple
        // form.
        Surface::Torus { frame, major, minor }
            if facet.uv.iter().all(|p| major + minor * math::cos(p.y) > 0.0) =>
        {
            let own = elementary::torus(facet, frame, *major, *minor, enough);
            // Facets long against the tube's radius are beyond it: derivatives must do.
            if own.error.is_finite() { own } else { general::bound(bounds, facet, enough, scratch) }
        }
        Surface::Extrusion { profile, direction } => {
            let own = general::bound(bounds, facet, enough, scratch);
            if own.error <= enough { own } else { own.or_less(extruded::bound(facet, profile, *direction)) }
        }
        _ => general::bound(bounds, facet, enough, scratch),
    };
    for i in 0..3 {
        if let Some(sag) = facet.sag[i] {
            bound.error = bound.error.max(sag);
        }
    }
    // Evaluation and these formulas are good to a few units in the last place of the largest coordinate.
    let rounding = 32.0 * f64::EPSILON * facet.xyz.iter().fold(0.0f64, |m, p| m.max(p.abs().max_element()));
    bound.error += rounding;
    bound
}

/// Upper bound of the distance between the image of a segment of parameter space and the chord between its
/// ends' points; from second derivatives about the segment only, in so many equal `parts`, however wild the
/// surface is beside it. Infinite if nothing can be proven.
pub fn chord_bound(
    bounds: &SurfaceBounds<'_>,
    uv: [DVec2; 2],
    xyz: [DVec3; 2],
    parts: usize,
    scratch: &mut Vec<Piece>,
) -> f64 {
    match bounds.surface() {
        Surface::Plane { .. } => 0.0,
        Surface::Cylinder { .. } | Surface::Cone { .. } | Surface::Sphere { .. } => f64::INFINITY,
        _ => chord::bound(bounds, uv, xyz, parts, scratch),
    }
}

/// Barycentric coordinates of point (i, j) of the lattice that divides every edge of a triangle in `parts`.
fn lattice_point(i: usize, j: usize, parts: usize) -> [f64; 3] {
    [i, j, parts - i - j].map(|k| k as f64 / parts as f64)
}

/// Barycentric coordinates of the points that divide every edge of a triangle in `parts`.
fn lattice(parts: usize) -> impl Iterator<Item = [f64; 3]> {
    let step = 1.0 / parts as f64;
    (0..=parts).flat_map(move |i| {
        (0..=parts - i).map(move |j| [i as f64 * step, j as f64 * step, (parts - i - j) as f64 * step])
    })
}
