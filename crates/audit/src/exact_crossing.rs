//! Whether two faces cut each other in the file, or only their facets do.
//!
//! From a place where facets cut each other, Newton's method looks for a point of both surfaces:
//!
//! ```text
//! S(u, v) − T(s, t) = 0     three equations, four unknowns; of all steps the shortest one
//! ```
//!
//! The faces cut each other if such a point lies inside both, farther from their edges than edges are off the
//! surfaces and chords off the edges. Where surfaces only touch, the method does not converge, and no
//! crossing is claimed.
//!
//! Where edges are further off the surfaces than the surfaces are off each other, no mesh that follows the
//! edges keeps its facets apart.

use crate::chart::exact;
use crate::precision::{ROUNDING, surface_magnitude};
use chordal_brep::{Face, FaceGeometry, Loop, Part};
use chordal_mesh::{Origin, PartMesh};
use chordal_nurbs::{CurveInverter, DVec2, DVec3, Surface};
use glam::DMat3;
use std::borrow::Cow;

/// Newton steps. From inside a facet the method converges in a few or not at all.
const STEPS: usize = 20;

/// Steps towards the foot of a point: facets are near their surfaces, and a few digits suffice.
const FOOT_STEPS: usize = 4;

/// Surfaces that meet at less than this angle, in radians, touch: rounding decides whether they cross.
const TOUCHING: f64 = 1e-4;

/// A point is inside a face if it is farther from its edges than this many times what edges and chords are
/// off.
const INSIDE: f64 = 2.0;

/// Parameters that differ by less than this share of the parameters of the face are one point of a face that
/// cuts itself.
const SAME_PARAMETERS: f64 = 1e-6;

/// A face seen from a place at which its facets are cut.
struct Side<'a> {
    part: &'a Part,
    mesh: &'a PartMesh,
    index: usize,
    facet: u32,
    surface: Cow<'a, Surface>,
    periods: [Option<f64>; 2],
    /// The parameters of the place in the facet.
    uv: DVec2,
}

/// Whether the exact faces of two facets that cut each other also cross.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum InFile {
    /// No crossing of the faces is found.
    Apart,
    /// Their edges are further off them than they are off each other.
    LooseEdges,
    /// They cut each other.
    Crossing,
}

/// Whether two exact faces cross near the point `at`, where two of their facets cut each other.
pub(crate) fn in_file(
    part: &Part,
    mesh: &PartMesh,
    faces: [usize; 2],
    facets: [u32; 2],
    at: DVec3,
) -> InFile {
    let side = |i: usize| Side::new(part, mesh, faces[i], facets[i], at);
    let (Some(a), Some(b)) = (side(0), side(1)) else { return InFile::Apart };
    if faces_cross(&a, &b, at) {
        InFile::Crossing
    } else if edges_are_loose(&a, &b, at) {
        InFile::LooseEdges
    } else {
        InFile::Apart
    }
}

/// True where the faces cut each other near the point.
fn faces_cross(a: &Side<'_>, b: &Side<'_>, at: DVec3) -> bool {
    let reach = a.size_of_facet().max(b.size_of_facet());
    let Some([of_a, of_b]) = common_point(a, b) else { return false };
    let p = a.surface.point(of_a);
    if p.distance(at) > reach || (a.index == b.index && a.is_same_place(of_a, of_b)) {
        return false;
    }
    let normals = a.surface.normal(of_a).zip(b.surface.normal(of_b));
    let is_transversal = normals.is_some_and(|(n, m)| n.cross(m).length() > TOUCHING);
    is_transversal && a.has_inside(of_a, p) && b.has_inside(of_b, p)
}

/// Parameters on both surfaces of one point near the place.
fn common_point(a: &Side<'_>, b: &Side<'_>) -> Option<[DVec2; 2]> {
    let (mut of_a, mut of_b) = (a.uv, b.uv);
    for _ in 0..STEPS {
        let (p, pu, pv) = a.surface.jet1(of_a);
        let (q, qu, qv) = b.surface.jet1(of_b);
        let miss = p - q;
        if miss.length() <= a.rounding() + b.rounding() {
            return Some([of_a, of_b]);
        }
        let square = |d: DVec3| DMat3::from_cols(d * d.x, d * d.y, d * d.z);
        let sum = square(pu) + square(pv) + square(qu) + square(qv);
        let step = sum.inverse() * miss;
        if !step.is_finite() {
            return None;
        }
        of_a -= DVec2::new(pu.dot(step), pv.dot(step));
        of_b += DVec2::new(qu.dot(step), qv.dot(step));
    }
    None
}

/// True where a vertex of one of the facets is further off its surface than the surfaces are off each other.
fn edges_are_loose(a: &Side<'_>, b: &Side<'_>, at: DVec3) -> bool {
    let gap = a.gap_of_facet().max(b.gap_of_facet());
    gap > a.rounding() + b.rounding() && gap >= a.foot(at).distance(b.foot(at))
}

impl<'a> Side<'a> {
    fn new(part: &'a Part, mesh: &'a PartMesh, index: usize, facet: u32, at: DVec3) -> Option<Self> {
        let FaceGeometry::Surface(surface) = &part.faces[index].geometry else { return None };
        let surface = exact(surface);
        let periods = surface.periods();
        let mut side = Self { part, mesh, index, facet, surface, periods, uv: DVec2::ZERO };
        side.uv = side.parameters_in_facet(at);
        Some(side)
    }

    fn face(&self) -> &'a Face {
        &self.part.faces[self.index]
    }

    fn corners(&self, triangle: u32) -> [(DVec2, DVec3); 3] {
        let of_face = &self.mesh.faces[self.index];
        of_face.triangles[triangle as usize].map(|c| {
            let corner = of_face.corners[c as usize];
            (corner.uv, self.mesh.positions[corner.position as usize])
        })
    }

    /// The linear parameters at a point of the facet.
    fn parameters_in_facet(&self, at: DVec3) -> DVec2 {
        let [a, b, c] = self.corners(self.facet);
        let (d, e, p) = (b.1 - a.1, c.1 - a.1, at - a.1);
        let (dd, de, ee) = (d.dot(d), d.dot(e), e.dot(e));
        let determinant = dd * ee - de * de;
        let x = (p.dot(d) * ee - p.dot(e) * de) / determinant;
        let y = (p.dot(e) * dd - p.dot(d) * de) / determinant;
        if x.is_finite() && y.is_finite() { a.0 + (b.0 - a.0) * x + (c.0 - a.0) * y } else { a.0 }
    }

    /// The point of the surface under a point of the facet, by Gauss and Newton: the nearest one of all may
    /// lie on the other side of a wall.
    fn foot(&self, at: DVec3) -> DVec3 {
        let mut uv = self.uv;
        for _ in 0..FOOT_STEPS {
            let (p, du, dv) = self.surface.jet1(uv);
            let (uu, uv_, vv) = (du.dot(du), du.dot(dv), dv.dot(dv));
            let (u, v, determinant) = (du.dot(at - p), dv.dot(at - p), uu * vv - uv_ * uv_);
            let step = DVec2::new(u * vv - v * uv_, v * uu - u * uv_) / determinant;
            if !step.is_finite() {
                break;
            }
            uv += step;
        }
        self.surface.point(uv)
    }

    fn size_of_facet(&self) -> f64 {
        let [a, b, c] = self.corners(self.facet).map(|c| c.1);
        a.distance(b).max(b.distance(c)).max(c.distance(a))
    }

    /// The largest distance of a corner of the facet from the surface.
    fn gap_of_facet(&self) -> f64 {
        let gap = |(uv, p): (DVec2, DVec3)| self.surface.point(uv).distance(p);
        self.corners(self.facet).map(gap).into_iter().fold(0.0, f64::max)
    }

    fn rounding(&self) -> f64 {
        let size = self.corners(self.facet).iter().fold(0.0f64, |m, c| m.max(c.1.abs().max_element()));
        ROUNDING * (size + surface_magnitude(&self.surface))
    }

    fn is_same_place(&self, uv: DVec2, other: DVec2) -> bool {
        (0..2).all(|axis| {
            let d = uv[axis] - other[axis];
            let d = d - self.periods[axis].map_or(0.0, |p| p * (d / p).round());
            d.abs() <= SAME_PARAMETERS * (1.0 + uv[axis].abs())
        })
    }

    /// True where a point of the surface lies inside the face, clear of its edges.
    fn has_inside(&self, uv: DVec2, p: DVec3) -> bool {
        self.is_covered(uv) && self.is_clear_of_edges(p)
    }

    /// True where a triangle of the face lies over the parameters, or over a full turn of them.
    fn is_covered(&self, uv: DVec2) -> bool {
        let of_face = &self.mesh.faces[self.index];
        let turns = |axis: usize| match self.periods[axis] {
            Some(period) => vec![0.0, period, -period],
            None => vec![0.0],
        };
        let is_over = |p: DVec2| {
            of_face.triangles.iter().any(|t| {
                let [a, b, c] = t.map(|c| of_face.corners[c as usize].uv);
                let turns = [(a, b), (b, c), (c, a)].map(|(a, b)| (b - a).perp_dot(p - a));
                turns.iter().all(|&t| t >= 0.0) || turns.iter().all(|&t| t <= 0.0)
            })
        };
        let (us, vs) = (turns(0), turns(1));
        us.iter().any(|&u| vs.iter().any(|&v| is_over(uv + DVec2::new(u, v))))
    }

    fn is_clear_of_edges(&self, p: DVec3) -> bool {
        let gap = self.gap();
        let edges = self.face().loops.iter().flat_map(|a_loop| match a_loop {
            Loop::Edges { coedges, .. } => coedges.as_slice(),
            _ => &[],
        });
        edges.into_iter().all(|coedge| {
            let edge = &self.part.edges[coedge.edge.index()];
            let Some(curve) = edge.curve.as_deref() else { return true };
            let nearest = CurveInverter::new(curve, edge.range).invert(p, None);
            let chords = self.distance_of_chords(coedge.edge.index(), curve.point(nearest.t));
            nearest.distance > INSIDE * (gap + chords)
        })
    }

    /// The largest distance of a vertex of an edge from the surface of the face.
    fn gap(&self) -> f64 {
        let of_face = &self.mesh.faces[self.index];
        let at_edge =
            |c: &&chordal_mesh::Corner| !matches!(self.mesh.origins[c.position as usize], Origin::Face(_));
        let gap = |c: &chordal_mesh::Corner| {
            self.surface.point(c.uv).distance(self.mesh.positions[c.position as usize])
        };
        of_face.corners.iter().filter(at_edge).map(gap).fold(0.0, f64::max)
    }

    /// The distance of a point of an edge from its chords.
    fn distance_of_chords(&self, edge: usize, p: DVec3) -> f64 {
        let at = |i: u32| self.mesh.positions[i as usize];
        let to_chord = |chord: &[u32]| {
            let (a, d) = (at(chord[0]), at(chord[1]) - at(chord[0]));
            let along = ((p - a).dot(d) / d.length_squared()).clamp(0.0, 1.0);
            p.distance(a + d * if along.is_nan() { 0.0 } else { along })
        };
        let chords = self.mesh.edges[edge].windows(2).map(to_chord);
        chords.fold(f64::INFINITY, f64::min)
    }
}
