//! Facets of an extruded profile, by the profile's distance from its chords.
//!
//! Seen along the direction of extrusion, a facet with corners at u_a ≤ u_b ≤ u_c lies in the triangle of
//! these three points of the profile, and the surface over it on the arc from u_a to u_c. Points of the
//! triangle are no farther from its longest side than its middle corner is, nor farther along than the middle
//! corner is from either end; that side is the chord of the arc. How fast the parameter runs along the arc
//! plays no part, other than for bounds by second derivatives: those cannot be had below the tolerance where
//! a profile bends sharply or its speed varies much within one chord.

use super::{Facet, FacetBound};
use crate::Curve;
use glam::DVec3;

pub(super) fn bound(facet: &Facet, profile: &Curve, direction: DVec3) -> FacetBound {
    let Some(along) = direction.try_normalize() else { return FacetBound::NONE };
    let u = facet.uv.map(|p| p.x);
    let mut order = [0, 1, 2];
    order.sort_by(|&i, &j| u[i].total_cmp(&u[j]));
    let [a, b, c] = order;
    let seen = |i: usize, j: usize| (facet.xyz[i] - facet.xyz[j]).reject_from_normalized(along).length();
    let chord = profile.chord_error(u[a], u[c]);
    let to_middle = seen(a, b).min(seen(b, c)).min(chord);
    let edge = |i: usize| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        if seen(j, k) == 0.0 { 0.0 } else { profile.chord_error(u[j].min(u[k]), u[j].max(u[k])) }
    };
    FacetBound { error: chord + to_middle, edges: [edge(0), edge(1), edge(2)] }
}
