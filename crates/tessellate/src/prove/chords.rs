//! Whether it is a chord that is wrong with a facet, or what lies inside it.
//!
//! A facet over a long chord of the boundary is too far off until the chord is halved, whatever is done inside; one beside a fine
//! chord needs points inside. Bounds tell the two apart, and where they are far beyond the tolerance they are looked at more closely.

use super::Prover;
use crate::face_mesh::FaceMesh;
use chordal_nurbs::{Facet, chord_bound};

/// A chord this many tolerances off, bounded by itself, is clearly not what is wrong with its facet.
const FINE_CHORD: f64 = 0.5;

/// A chord with a bound of more tolerances than this would be halved many times before it is proven, on surfaces that are wild beside it,
/// not over it: it is looked at in so many parts. Within this share of the tolerance then, it is not what is wrong.
const WILD_CHORD: f64 = 64.0;
const WILD_PARTS: usize = 8;
const WILD_FINE: f64 = 0.1;

/// So often points inside are tried first in one attempt at a face. Where the surface is wild over the chord as well, no facet beside it
/// can be proven, however small, until it is halved.
pub(super) const POINTS_FIRST: u32 = 32;

/// A chord that bends by less than this share of a facet's height is straight to it.
pub(super) const CHORD_BENDS: f64 = 0.25;

impl Prover<'_> {
    /// True where an edge is so far from the surface by itself that a point inside the facet would not help: else what is wrong, or
    /// not known, lies inside.
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

/// A bent boundary edge whose image on the surface passes the corner opposite to it nearer than this: what is wrong with the facet
/// is the chord's, and no point inside helps.
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

/// How far the surface leaves the middle of the edge opposite corner `i`.
pub(super) fn bend(face: &FaceMesh<'_, '_>, facet: &Facet, i: usize) -> f64 {
    let [a, b] = [1, 2].map(|k| (i + k) % 3);
    let middle = face.surface().point(facet.uv[a].midpoint(facet.uv[b]));
    middle.distance(facet.xyz[a].midpoint(facet.xyz[b]))
}
