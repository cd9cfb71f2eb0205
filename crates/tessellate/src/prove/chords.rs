//! Whether a facet is over the tolerance because of a chord of its boundary, or because of what lies inside.
//!
//! A facet over a long chord of the boundary is too far off until the chord is halved, whatever is done
//! inside. A facet beside a fine chord needs points inside. Bounds of the chord alone distinguish the two.
//! Where such a bound is far beyond the tolerance, the chord is examined in parts.

use super::Prover;
use crate::face_mesh::FaceMesh;
use chordal_nurbs::{Facet, chord_bound};

/// A chord whose own bound is below this share of the tolerance is not to blame for its facet.
const FINE_CHORD: f64 = 0.5;

/// A chord whose bound is more tolerances than this would be halved many times before it is proven, if the
/// surface is wild beside the chord and not over it. Such a chord is examined in [`WILD_PARTS`] parts; if all
/// of them are within [`WILD_FINE`] tolerances, the chord is not to blame.
const WILD_CHORD: f64 = 64.0;
const WILD_PARTS: usize = 8;
const WILD_FINE: f64 = 0.1;

/// How often points inside are tried before such a chord is made finer, in one attempt at a face. Where the
/// surface is wild over the chord as well, no facet beside it can be proven until the chord is halved;
/// without this limit, points would be inserted without end.
pub(super) const POINTS_FIRST: u32 = 32;

/// A chord that bends by less than this share of the height of a facet counts as straight.
pub(super) const CHORD_BENDS: f64 = 0.25;

impl Prover<'_> {
    /// True where a chord is so far from the surface by itself that a point inside the facet would not help.
    /// False where the fault lies inside, or is unknown.
    pub(super) fn is_coarse_chord(&mut self, facet: &Facet, i: usize, tolerance: f64) -> bool {
        if self.sampled {
            return true;
        }
        let ends = [(i + 1) % 3, (i + 2) % 3];
        let (uv, xyz) = (ends.map(|k| facet.uv[k]), ends.map(|k| facet.xyz[k]));
        let error = chord_bound(self.bounds, uv, xyz, 1, &mut self.scratch);
        let is_coarse = error > FINE_CHORD * tolerance;
        if is_coarse && error > WILD_CHORD * tolerance && self.points_first > 0 {
            let closer = chord_bound(self.bounds, uv, xyz, WILD_PARTS, &mut self.scratch);
            let is_fine = closer <= WILD_FINE * tolerance;
            self.points_first -= u32::from(is_fine);
            return !is_fine;
        }
        is_coarse
    }
}

/// A bent boundary edge whose image on the surface passes the opposite corner nearer than `distance`: the
/// chord is to blame, and no point inside helps.
pub(super) fn close_to_boundary(
    face: &FaceMesh<'_, '_>,
    facet: &Facet,
    boundary: [bool; 3],
    distance: f64,
) -> Option<usize> {
    (0..3).filter(|&i| boundary[i]).find(|&i| {
        let [p, a, b] = [0, 1, 2].map(|k| facet.uv[(i + k) % 3]);
        let along = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
        let height = face.surface().point(a.lerp(b, along)).distance(facet.xyz[i]);
        height <= distance && bend(face, facet, i) > CHORD_BENDS * height
    })
}

/// The distance between the surface and the middle of the edge opposite corner `i`.
pub(super) fn bend(face: &FaceMesh<'_, '_>, facet: &Facet, i: usize) -> f64 {
    let [a, b] = [1, 2].map(|k| (i + k) % 3);
    let middle = face.surface().point(facet.uv[a].midpoint(facet.uv[b]));
    middle.distance(facet.xyz[a].midpoint(facet.xyz[b]))
}
