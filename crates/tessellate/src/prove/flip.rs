//! Flips of inner edges after which both triangles are within the limits.

use super::Prover;
use crate::face_mesh::FaceMesh;
use crate::triangulate::NONE;
use chordal_nurbs::{DVec3, Facet};

/// Triangles lower than this share of their coordinates have no area: their height is rounding.
const NO_HEIGHT: f64 = 1e-12;

impl Prover<'_> {
    /// Flips an inner edge of `t` where both new triangles are within the limits.
    pub(super) fn flip_helps(&mut self, face: &mut FaceMesh<'_, '_>, t: u32) -> bool {
        (0..3).any(|i| self.flip(face, t, i))
    }

    /// Flips the longest edge of every triangle whose corners lie on one line in space, although the triangle
    /// has an area in the chart. The new triangles are judged afterwards.
    pub(super) fn flip_slivers(&self, face: &mut FaceMesh<'_, '_>) {
        for t in 0..face.mesh().triangles.len() as u32 {
            let corners = face.mesh().triangles[t as usize];
            if Self::collapsed(face, t) || has_area(face, corners) {
                continue;
            }
            let xyz = corners.map(|v| face.xyz(v));
            let side = |i: &usize| xyz[(i + 1) % 3].distance_squared(xyz[(i + 2) % 3]);
            let longest = (0..3).max_by(|a, b| side(a).total_cmp(&side(b)));
            if let Some((flip, i)) = longest.and_then(|i| Flip::new(face, t, i).zip(Some(i)))
                && flip.triangles.iter().all(|(corners, _)| has_area(face, *corners))
            {
                face.mesh_mut().flip_edge(t, i);
            }
        }
    }

    /// Flips the edge opposite corner `i` where both new triangles are within the limits.
    fn flip(&mut self, face: &mut FaceMesh<'_, '_>, t: u32, i: usize) -> bool {
        let Some(flip) = Flip::new(face, t, i) else { return false };
        let [a, b] = flip.edge.map(|v| face.xyz(v));
        let helps = a.distance(b) <= self.limits.length
            && !flip
                .triangles
                .iter()
                .any(|&(corners, _)| self.turns(face, corners) || !has_area(face, corners))
            && flip.triangles.into_iter().all(|triangle| self.keeps(face, triangle));
        if helps {
            face.mesh_mut().flip_edge(t, i);
        }
        helps
    }

    /// True where a triangle, given by its corners and the sagittas of its sides, would be within the limits.
    fn keeps(&mut self, face: &FaceMesh<'_, '_>, (corners, sag): ([u32; 3], [Option<f64>; 3])) -> bool {
        let facet = Facet {
            uv: corners.map(|v| face.mesh().points[v as usize]),
            xyz: corners.map(|v| face.xyz(v)),
            sag,
        };
        let allowed = self.allowed(face, corners);
        self.folded_height(facet.xyz, corners.map(|v| face.normal(v)), allowed).is_none()
            && self.bound(face, &facet, allowed).error <= allowed
    }
}

/// The two triangles that a flip would make.
struct Flip {
    edge: [u32; 2],
    /// Corners, and the sagittas of the sides opposite to them.
    triangles: [([u32; 3], [Option<f64>; 3]); 2],
}

impl Flip {
    /// The flip of the edge opposite corner `i` of triangle `t`; `None` on the boundary, or where the two
    /// triangles are no convex quadrilateral.
    fn new(face: &FaceMesh<'_, '_>, t: u32, i: usize) -> Option<Self> {
        let other = face.mesh().neighbors[t as usize][i];
        if other == NONE {
            return None;
        }
        let c = face.mesh().triangles[t as usize];
        let (apex, a, b) = (c[i], c[(i + 1) % 3], c[(i + 2) % 3]);
        let j = (0..3).find(|&j| face.mesh().neighbors[other as usize][j] == t)?;
        let apex2 = face.mesh().triangles[other as usize][j];
        if !face.mesh().can_flip(apex, a, b, apex2) {
            return None;
        }
        let sags = [t, other].map(|t| std::array::from_fn::<_, 3, _>(|i| Prover::sag(face, t, i)));
        // (apex, a, apex2): opposite apex lies a–apex2 (the other's side), opposite apex2 lies apex–a (t's
        // side).
        let first = ([apex, a, apex2], [sags[1][(j + 1) % 3], None, sags[0][(i + 2) % 3]]);
        let second = ([apex, apex2, b], [sags[1][(j + 2) % 3], sags[0][(i + 1) % 3], None]);
        Some(Self { edge: [apex, apex2], triangles: [first, second] })
    }
}

/// False for three corners on one line, up to rounding.
fn has_area(face: &FaceMesh<'_, '_>, corners: [u32; 3]) -> bool {
    let [a, b, c] = corners.map(|v| face.position(face.key(v)));
    let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
    let size = [a, b, c].iter().fold(longest, |m: f64, p: &DVec3| m.max(p.abs().max_element()));
    (b - a).cross(c - a).length() > longest * NO_HEIGHT * size
}
