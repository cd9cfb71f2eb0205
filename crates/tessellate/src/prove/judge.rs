//! What is wrong with one triangle, if anything.
//!
//! A triangle is examined in this order; the first that is wrong counts:
//!
//! 1. A triangle whose corners are not three vertices is not written: nothing is wrong with it.
//! 2. An edge inside the face that another face has too.
//! 3. Its distance from the surface: a chord of its boundary is to blame, or what lies inside.
//! 4. It faces away from the surface, doubled back over itself.
//! 5. An edge turns too far, or is too long; edges on the boundary first, since the face runs again with
//!    finer ones.

use super::Prover;
use super::chords::{CHORD_BENDS, bend, close_to_boundary};
use super::mend::clearly_longest;
use super::sampled::sampled_bound;
use crate::closer::{box_around, tolerance_within};
use crate::effort::Remedy;
use crate::face_mesh::FaceMesh;
use crate::limits::{TURN_LENGTH, turns_too_far};
use crate::shared_edge::sorted;
use crate::triangulate::NONE;
use chordal_chart::{Key, Segment};
use chordal_nurbs::orient;
use chordal_nurbs::{DVec3, Facet, FacetBound, facet_bound};

/// Facets lower than this share of the tolerance may face any way: they can do no harm.
const FOLD_HEIGHT: f64 = 0.05;

/// If the cosine between two normals is below this, they differ too much for a statement about the side of a
/// facet.
const NORMALS_AGREE: f64 = 0.3;

/// What is wrong with a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Fault {
    /// The edge opposite this corner is too long for this face, whatever is done inside.
    Edge(usize),
    /// As `Edge`, for a facet that the chord folds: other chords as coarse as this one fold other facets.
    FoldingEdge(usize),
    /// Too far from the surface, or turning too much across the edge opposite the corner.
    Inside(Option<usize>),
    /// Turned over where it meets the boundary; its longest inner edge lies opposite the corner.
    Fold(Option<usize>),
}

impl Prover<'_> {
    pub(super) fn facet(face: &FaceMesh<'_, '_>, t: u32) -> Facet {
        let corners = face.mesh().triangles[t as usize];
        Facet {
            uv: corners.map(|v| face.mesh().points[v as usize]),
            xyz: corners.map(|v| face.xyz(v)),
            sag: std::array::from_fn(|i| Self::sag(face, t, i)),
        }
    }

    /// The sagitta of the edge opposite corner `i`, where it is a chord of a model edge.
    pub(super) fn sag(face: &FaceMesh<'_, '_>, t: u32, i: usize) -> Option<f64> {
        if face.mesh().neighbors[t as usize][i] != NONE {
            return None;
        }
        let corners = face.mesh().triangles[t as usize];
        match face.segment(corners[(i + 1) % 3], corners[(i + 2) % 3]) {
            Some(Segment::Edge { edge, chord }) => Some(face.edge_samples(edge).sag[chord as usize]),
            _ => None,
        }
    }

    pub(super) fn bound(&mut self, face: &FaceMesh<'_, '_>, facet: &Facet, allowed: f64) -> FacetBound {
        if self.sampled {
            sampled_bound(face, facet)
        } else {
            let finer = self.finer.filter(|_| allowed < self.limits.tolerance);
            facet_bound(finer.unwrap_or(self.bounds), facet, allowed, &mut self.scratch)
        }
    }

    /// What is claimed of a facet within its limits. A facet that must lie closer is proven by bounds that
    /// are tight there; what is claimed is what anybody finds again who knows the tolerance only.
    fn claimed(&mut self, facet: &Facet, error: f64, allowed: f64) -> f64 {
        if self.sampled || allowed >= self.limits.tolerance {
            return error;
        }
        error.max(facet_bound(self.bounds, facet, self.limits.tolerance, &mut self.scratch).error)
    }

    /// The allowed distance of a facet: the tolerance of edges for facets that touch one, if that is larger.
    ///
    /// This holds for all facets at an edge, not only for those over its chords: a facet from one end of a
    /// long chord to its middle is long itself. It is less where facets cut those of another face.
    pub(super) fn allowed(&self, face: &FaceMesh<'_, '_>, corners: [u32; 3]) -> f64 {
        let on_edge = |v: u32| !matches!(face.key(v), Key::Private(_));
        let boundary = self.limits.boundary;
        let is_at_edge = boundary > self.limits.tolerance && corners.into_iter().any(on_edge);
        let allowed = if is_at_edge { boundary } else { self.limits.tolerance };
        let places = face.context().closer;
        if places.is_empty() {
            return allowed;
        }
        tolerance_within(places, &box_around(&corners.map(|v| face.xyz(v))), allowed)
    }

    /// A triangle whose corners are not three vertices is not written.
    pub(super) fn collapsed(face: &FaceMesh<'_, '_>, t: u32) -> bool {
        let [a, b, c] = face.mesh().triangles[t as usize].map(|v| face.key(v));
        a == b || b == c || c == a
    }

    /// The corner opposite an inner edge that another face has too.
    fn doubled_side(face: &FaceMesh<'_, '_>, t: u32) -> Option<usize> {
        if face.context().doubled.is_empty() {
            return None;
        }
        let keys = face.mesh().triangles[t as usize].map(|v| face.key(v));
        let inner = |&i: &usize| {
            let across = face.mesh().neighbors[t as usize][i];
            across != NONE && !Self::collapsed(face, across)
        };
        (0..3)
            .filter(inner)
            .find(|&i| face.context().doubled.contains(&sorted([keys[(i + 1) % 3], keys[(i + 2) % 3]])))
    }

    /// The bound of a triangle and what is wrong with it.
    pub fn judge(&mut self, face: &FaceMesh<'_, '_>, t: u32) -> (f64, Option<Fault>) {
        // 1. Triangles that are not written.
        if Self::collapsed(face, t) {
            return (0.0, None);
        }
        let corners = face.mesh().triangles[t as usize];
        let facet = Self::facet(face, t);
        let [a, b, c] = facet.uv;
        if self.accepts() && orient(a, b, c) < 0.0 {
            return (f64::INFINITY, None);
        }
        // 2. Edges that another face has too.
        if let Some(i) = Self::doubled_side(face, t) {
            return (f64::INFINITY, Some(Fault::Inside(Some(i))));
        }
        // 3. The distance.
        let tolerance = self.allowed(face, corners);
        let bound = self.bound(face, &facet, tolerance);
        let boundary = face.mesh().neighbors[t as usize].map(|n| n == NONE);
        if bound.error > tolerance {
            let coarse = (0..3).filter(|&i| boundary[i] && bound.edges[i] > tolerance);
            let worst = coarse.max_by(|&a, &b| bound.edges[a].total_cmp(&bound.edges[b]));
            let worst = worst.filter(|&i| self.is_coarse_chord(&facet, i, tolerance));
            let worst = worst.or_else(|| close_to_boundary(face, &facet, boundary, FOLD_HEIGHT * tolerance));
            return (bound.error, Some(worst.map_or(Fault::Inside(None), Fault::Edge)));
        }
        // 4. Folds.
        if let Some(fault) = self.fold(face, &facet, t, boundary, tolerance) {
            return (f64::INFINITY, Some(fault));
        }
        // 5. Angles and lengths.
        let claimed = self.claimed(&facet, bound.error, tolerance);
        let fault = self.long_or_turning(face, corners, boundary, tolerance);
        (
            claimed,
            fault.or_else(|| (claimed > tolerance.max(self.limits.tolerance)).then_some(Fault::Inside(None))),
        )
    }

    /// A facet that faces away from the surface where it meets the boundary: it may reach beyond the face.
    /// Folds inside the face only cover it more than once; they are mended where facets must part.
    fn fold(
        &self,
        face: &FaceMesh<'_, '_>,
        facet: &Facet,
        t: u32,
        boundary: [bool; 3],
        tolerance: f64,
    ) -> Option<Fault> {
        let corners = face.mesh().triangles[t as usize];
        let is_at_end = |&v: &u32| match face.key(v) {
            Key::Private(_) => !self.effort.has(Remedy::Folds) && (v as usize) < face.chart().points.len(),
            _ => true,
        };
        let must_part = tolerance < self.limits.tolerance;
        if !must_part && !corners.iter().any(is_at_end) {
            return None;
        }
        let height = self.folded_height(facet.xyz, corners.map(|v| face.normal(v)), tolerance)?;
        // A chord that leaves the face by about as much as the facet is high must be finer. Otherwise an
        // inner edge leaves the face.
        let leaves = |i: usize| facet.sag[i].or_else(|| boundary[i].then(|| bend(face, facet, i)));
        let coarse = (0..3).find(|&i| leaves(i).is_some_and(|bend| bend > CHORD_BENDS * height));
        Some(coarse.map_or_else(|| Fault::Fold(longest_inner(face, t, facet)), Fault::FoldingEdge))
    }

    /// An edge that turns further, or is longer, than allowed.
    fn long_or_turning(
        &self,
        face: &FaceMesh<'_, '_>,
        corners: [u32; 3],
        boundary: [bool; 3],
        tolerance: f64,
    ) -> Option<Fault> {
        let normals = face.turning_normals(corners);
        let is_wrong = |&i: &usize| {
            let [j, k] = [(i + 1) % 3, (i + 2) % 3];
            let length = face.xyz(corners[j]).distance(face.xyz(corners[k]));
            let turns =
                length > TURN_LENGTH * tolerance && turns_too_far(normals[j], normals[k], self.limits.angle);
            turns || length > self.limits.length * (1.0 + 1e-9)
        };
        let boundary_first = (0..3).filter(|&i| boundary[i]).chain((0..3).filter(|&i| !boundary[i]));
        let wrong = boundary_first.into_iter().find(is_wrong)?;
        Some(if boundary[wrong] { Fault::Edge(wrong) } else { Fault::Inside(Some(wrong)) })
    }

    /// The height of a facet that faces away from the surface at its corners: it lies outside the face,
    /// doubled back.
    pub(super) fn folded_height(&self, xyz: [DVec3; 3], normals: [DVec3; 3], tolerance: f64) -> Option<f64> {
        let [a, b, c] = xyz;
        let cross = (b - a).cross(c - a);
        let longest =
            (b - a).length_squared().max((c - b).length_squared()).max((a - c).length_squared()).sqrt();
        let height = cross.length() / longest.max(f64::MIN_POSITIVE);
        let [n, m, k] = normals;
        let agree = n.dot(m).min(m.dot(k)).min(k.dot(n)) > NORMALS_AGREE;
        let least = FOLD_HEIGHT * tolerance.min(self.limits.tolerance);
        (agree && height > least && (n + m + k).dot(cross) < 0.0).then_some(height)
    }

    /// True where an edge of this triangle turns too far.
    pub(super) fn turns(&self, face: &FaceMesh<'_, '_>, corners: [u32; 3]) -> bool {
        let [n, m, k] = face.turning_normals(corners);
        [(n, m), (m, k), (k, n)].iter().any(|&(n, m)| turns_too_far(n, m, self.limits.angle))
    }
}

/// The longest edge in space that is no boundary, by the corner opposite to it.
fn longest_inner(face: &FaceMesh<'_, '_>, t: u32, facet: &Facet) -> Option<usize> {
    let inner = (0..3).filter(|&i| face.mesh().neighbors[t as usize][i] != NONE);
    let length = |i: usize| facet.xyz[(i + 1) % 3].distance_squared(facet.xyz[(i + 2) % 3]);
    clearly_longest(inner, length)
}
