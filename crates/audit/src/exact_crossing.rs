//! Whether two faces cut or touch each other in the file, or only their facets do.
//!
//! From places where facets cut each other, Newton's method looks for a point of both surfaces:
//!
//! ```text
//! S(u, v) − T(s, t) = 0     three equations, four unknowns; of all steps the shortest one
//! ```
//!
//! Such a point is common to both faces if each of them has it inside, farther from its edges than edges are
//! off the surface, or on its border, up to rounding; and if it is not where the two faces meet by right, at
//! an edge or vertex in common.
//!
//! - The faces *cut* each other if both have it inside and their normals differ.
//! - They *touch* each other otherwise: they lie on each other, or the border of one lies on the other.
//!
//! ```text
//!      cut            touch: lie on each other     touch: border on the inside
//!       │                 ═══════                          │
//!     ──┼──            ───────   ───                     ──┴──
//!       │
//! ```
//!
//! Faces that are apart by more than rounding have no common point, however near they are: Newton's method
//! then does not converge.
//!
//! Where edges are further off the surfaces than the surfaces are off each other, no mesh that follows the
//! edges keeps its facets apart.

use crate::face_at::{FaceAt, Place};
use crate::triangle_pair::{Facet3, common_inside, cut_points};
use chordal_brep::{Part, VertexId};
use chordal_mesh::PartMesh;
use chordal_nurbs::{DVec2, DVec3};
use glam::DMat3;

/// Newton steps. From inside a facet the method converges in a few or not at all.
const STEPS: usize = 20;

/// Surfaces that meet at less than this angle, in radians, touch: rounding decides whether they cross.
const TOUCHING: f64 = 1e-4;

/// How many times the error of a common point it must be away from edges. Smooth neighbours are as near
/// together as rounding within the square root of rounding from their edge, in multiples of their facets; of
/// radii of curvature up to a thousand times the facet, this is enough.
const CLEAR: f64 = 100.0;

/// Whether the exact faces of two facets that cut each other also cross or touch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum InFile {
    /// No common point of the faces is found.
    Apart,
    /// Their edges are further off them than they are off each other.
    LooseEdges,
    /// They lie on each other, or the border of one lies on the other.
    Touching,
    /// They cut each other.
    Crossing,
}

/// Where two facets cut each other.
pub(crate) struct Cut {
    /// A point inside both.
    at: DVec3,
    length: f64,
}

impl Cut {
    pub fn of(s: &Facet3, t: &Facet3) -> Self {
        Self { at: common_inside(s, t), length: cut_points(s, t).diagonal() }
    }
}

/// What the file says about two faces near a cut of two of their facets.
pub(crate) fn in_file(part: &Part, mesh: &PartMesh, faces: [usize; 2], facets: [u32; 2], cut: Cut) -> InFile {
    let face = |i: usize| FaceAt::new(part, mesh, faces[i], facets[i]);
    let (Some(a), Some(b)) = (face(0), face(1)) else { return InFile::Apart };
    let pair = Pair::new(a, b, cut);
    let mut found = InFile::Apart;
    for start in pair.starts() {
        found = found.max(pair.meets(start));
        if found == InFile::Crossing {
            return found;
        }
    }
    if found == InFile::Apart && pair.has_loose_edges() { InFile::LooseEdges } else { found }
}

/// Two faces at a place where their facets cut each other.
struct Pair<'a> {
    faces: [FaceAt<'a>; 2],
    cut: Cut,
    /// The size of the larger facet.
    reach: f64,
    /// The edges and vertices at which the faces meet by right.
    common_edges: Vec<usize>,
    common_vertices: Vec<VertexId>,
}

impl<'a> Pair<'a> {
    fn new(a: FaceAt<'a>, b: FaceAt<'a>, cut: Cut) -> Self {
        let of_b: Vec<usize> = b.edges().collect();
        let common_edges = a.edges().filter(|edge| of_b.contains(edge)).collect();
        let of_b = b.vertices();
        let common_vertices = a.vertices().into_iter().filter(|vertex| of_b.contains(vertex)).collect();
        let reach = a.size_of_facet().max(b.size_of_facet());
        Self { faces: [a, b], cut, reach, common_edges, common_vertices }
    }

    /// Places at the cut, and beyond it along its line: where the faces cut each other, they do so along a
    /// curve, and its nearest point may lie beside one of them.
    fn starts(&self) -> impl Iterator<Item = DVec3> + '_ {
        let [n, m] = self.faces.each_ref().map(|face| face.normal_of_facet().normalize_or_zero());
        let line = n.cross(m).try_normalize();
        let Cut { at, length } = self.cut;
        let along = [0.45 * length, -0.45 * length, 0.5 * self.reach, -0.5 * self.reach];
        let beside = line.into_iter().flat_map(move |d| along.into_iter().map(move |s| at + d * s));
        std::iter::once(at).chain(beside)
    }

    fn rounding(&self) -> f64 {
        self.faces[0].rounding + self.faces[1].rounding
    }

    /// What the faces do at a common point near a place.
    fn meets(&self, start: DVec3) -> InFile {
        let [a, b] = &self.faces;
        let Some([of_a, of_b]) = self.coincident(start).or_else(|| self.common_point(start)) else {
            return InFile::Apart;
        };
        let p = a.surface.point(of_a);
        if p.distance(self.cut.at) > self.reach || (a.index == b.index && a.is_same_place(of_a, of_b)) {
            return InFile::Apart;
        }
        let Some((n, m)) = a.surface.normal(of_a).zip(b.surface.normal(of_b)) else { return InFile::Apart };
        let sine = n.cross(m).length();
        let error = self.error(sine);
        if a.distance_of(&self.common_edges, &self.common_vertices, p) <= a.margin(error).max(b.margin(error))
        {
            return InFile::Apart;
        }
        match (a.place(of_a, p, error), b.place(of_b, p, error)) {
            (Place::Inside, Place::Inside) if sine > TOUCHING => InFile::Crossing,
            (Place::Inside | Place::Border, Place::Inside | Place::Border) => InFile::Touching,
            _ if self.has_border_on(a, b, p, error) || self.has_border_on(b, a, p, error) => InFile::Touching,
            _ => InFile::Apart,
        }
    }

    /// True where the border of `a` near a point lies on `b`: where the surfaces are tangent, the point
    /// itself is not known well enough to be called a point of the border.
    fn has_border_on(&self, a: &FaceAt<'_>, b: &FaceAt<'_>, p: DVec3, error: f64) -> bool {
        let Some(on_border) = a.border_near(p, error) else { return false };
        let uv = b.foot(on_border);
        let q = b.surface.point(uv);
        q.distance(on_border) <= self.rounding() && b.place(uv, q, error) != Place::Elsewhere
    }

    /// What a common point may be off along the surfaces. Where they are tangent, the root of rounding.
    fn error(&self, sine: f64) -> f64 {
        let rounding = self.rounding();
        let least = (rounding / self.reach.max(rounding)).sqrt();
        CLEAR * rounding / sine.max(least)
    }

    /// Parameters on both surfaces of the point under a place, where it is the same point of both.
    fn coincident(&self, start: DVec3) -> Option<[DVec2; 2]> {
        let [a, b] = &self.faces;
        let of_a = a.foot(start);
        let p = a.surface.point(of_a);
        let of_b = b.foot(p);
        (b.surface.point(of_b).distance(p) <= self.rounding()).then_some([of_a, of_b])
    }

    /// Parameters on both surfaces of one point near a place.
    fn common_point(&self, start: DVec3) -> Option<[DVec2; 2]> {
        let [a, b] = &self.faces;
        let (mut of_a, mut of_b) = (a.parameters_in_facet(start), b.parameters_in_facet(start));
        for _ in 0..STEPS {
            let (p, pu, pv) = a.surface.jet1(of_a);
            let (q, qu, qv) = b.surface.jet1(of_b);
            let miss = p - q;
            if miss.length() <= self.rounding() {
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

    /// True where a vertex of one of the facets is further off its surface than the surfaces are off each
    /// other.
    fn has_loose_edges(&self) -> bool {
        let [a, b] = &self.faces;
        let [p, q] = self.faces.each_ref().map(|face| face.surface.point(face.foot(self.cut.at)));
        let gap = a.gap_of_facet().max(b.gap_of_facet());
        gap > self.rounding() && gap >= p.distance(q)
    }
}
