//! Mending a triangle that is over the limits, inside the face: a flip of an edge, or a new point.

use super::Prover;
use crate::face_mesh::FaceMesh;
use crate::metric::Metric;
use crate::triangulate::{Location, NONE};
use chordal_chart::Segment;
use chordal_nurbs::DVec2;

/// A flip is tried for facets whose error is at most this many tolerances; facets further off need points.
const FLIP_HELPS: f64 = 3.0;

/// A crease that cuts off less than this share of a facet's width passes its corner: a point on the crease
/// would all but fall on that corner.
const CREASE_BESIDE: f64 = 0.01;

/// Lengths that differ by less than this share are equal, so that rounding decides nothing.
const SAME_LENGTH: f64 = 1e-9;

impl Prover<'_> {
    /// Flips an edge or inserts a point; false where neither is possible.
    pub(super) fn mend(
        &mut self,
        face: &mut FaceMesh<'_, '_>,
        t: u32,
        error: f64,
        edge: Option<usize>,
    ) -> bool {
        if edge.is_none() && error < FLIP_HELPS * self.limits.tolerance && self.flip_helps(face, t) {
            return true;
        }
        let corners = face.mesh().corners(t);
        let m = Metric::mean(face.mesh().triangles[t as usize].map(|v| face.metric(v)));
        let longest = edge.or_else(|| {
            let length = |i: usize| m.length(corners[(i + 2) % 3] - corners[(i + 1) % 3]);
            clearly_longest(0..3, length)
        });
        let center = (corners[0] + corners[1] + corners[2]) / 3.0;
        let on_crease = self.crease_point(corners);
        let at_middle = longest.filter(|&i| face.mesh().neighbors[t as usize][i] != NONE);
        let middle = at_middle.map(|i| corners[(i + 1) % 3].midpoint(corners[(i + 2) % 3]));
        let snapped = |p: DVec2| face.chart().grid.snap(p);
        let middle = middle.map(snapped).zip(at_middle);
        let places =
            [on_crease.map(|p| (p, None)), middle.map(|(p, i)| (p, Some(i))), Some((snapped(center), None))];
        for (p, edge) in places.into_iter().flatten() {
            let at = match edge {
                Some(i) => face.mesh().locate_on(t, i, p),
                None => face.mesh().locate(p, t),
            };
            if !matches!(at, Location::Inside(_) | Location::OnEdge(..)) {
                continue;
            }
            if face.insert(p, at).is_some() {
                return true;
            }
        }
        false
    }

    /// A place inside the triangle on a line at which the surface has a crease.
    fn crease_point(&self, corners: [DVec2; 3]) -> Option<DVec2> {
        let (us, vs) = self.bounds.creases();
        for (axis, values) in [(0, us), (1, vs)] {
            for value in values {
                let side = corners.map(|c| c[axis] - value);
                let size = side.iter().fold(0.0f64, |m, s| m.max(s.abs()));
                let beside = CREASE_BESIDE * size;
                if side.iter().any(|&s| s > beside) && side.iter().any(|&s| s < -beside) {
                    let cuts: Vec<DVec2> = (0..3)
                        .filter(|&i| side[i] * side[(i + 1) % 3] < 0.0)
                        .map(|i| {
                            corners[i].lerp(corners[(i + 1) % 3], side[i] / (side[i] - side[(i + 1) % 3]))
                        })
                        .collect();
                    let mut p = cuts.iter().copied().sum::<DVec2>() / cuts.len().max(1) as f64;
                    p[axis] = value;
                    return (!cuts.is_empty()).then_some(p);
                }
            }
        }
        None
    }

    /// A chord of a triangle that cannot be mended otherwise.
    pub(super) fn coarse_boundary(&self, face: &FaceMesh<'_, '_>, t: u32) -> Option<(u32, u32)> {
        (0..3).find_map(|i| match self.boundary_segment(face, t, i) {
            Some(Segment::Edge { edge, chord }) if face.mesh().neighbors[t as usize][i] == NONE => {
                Some((edge, chord))
            }
            _ => None,
        })
    }
}

/// The longest; of those that differ by rounding only, the first, so that a part gets the same mesh at
/// any place.
pub(super) fn clearly_longest(
    of: impl Iterator<Item = usize>,
    length: impl Fn(usize) -> f64,
) -> Option<usize> {
    of.reduce(|best, i| if length(i) > length(best) * (1.0 + SAME_LENGTH) { i } else { best })
}
