//! The distance between the image of a segment of parameter space and its chord.

use super::form::Form;
use crate::math;
use crate::{Piece, SurfaceBounds, UvBox};
use glam::{DVec2, DVec3};

/// A chord whose middle bends by less than this share of its length is taken for straight.
///
/// The direction of a smaller bend is mostly rounding; the surface's normal then gives the direction across
/// the chord. The value only changes how tight the bound is, not whether it holds.
const STRAIGHT: f64 = 1e-7;

/// See [`super::chord_bound`]: the distance from the chord at the ends of equal parts of the segment, and
/// between them the error of linear interpolation across the chord, in two directions.
pub(super) fn bound(
    bounds: &SurfaceBounds<'_>,
    uv: [DVec2; 2],
    xyz: [DVec3; 2],
    parts: usize,
    pieces: &mut Vec<Piece>,
) -> f64 {
    let Some(chord) = (xyz[1] - xyz[0]).try_normalize() else { return f64::INFINITY };
    let middle = uv[0].midpoint(uv[1]);
    // Where it bends to, and not to any side: the bound must not depend on how the part lies in space.
    let bend = (bounds.point(middle) - xyz[0].midpoint(xyz[1])).reject_from_normalized(chord);
    let straight = bend.length() <= STRAIGHT * xyz[0].distance(xyz[1]);
    let side =
        if straight { bounds.normal(middle).map(|n| n.reject_from_normalized(chord)) } else { Some(bend) };
    let across = side.and_then(DVec3::try_normalize).unwrap_or_else(|| chord.any_orthonormal_vector());
    let axes = [across, chord.cross(across)];
    let d = (uv[1] - uv[0]) / parts as f64;
    let at = |i: usize| uv[0].lerp(uv[1], i as f64 / parts as f64);
    let off = |i: usize| (bounds.point(at(i)) - xyz[0]).reject_from_normalized(chord).length();
    let mut part = |i: usize| {
        pieces.clear();
        let kink = bounds.pieces(UvBox::from_points([at(i), at(i + 1)]), pieces);
        if pieces.is_empty() {
            return f64::INFINITY;
        }
        let least_weight = pieces.iter().fold(f64::INFINITY, |m, p| m.min(p.least_weight));
        let [a, b] = axes.map(|w| {
            Form::new(pieces, at(i).midpoint(at(i + 1)), w, xyz[0]).largest_along(d) / (8.0 * least_weight)
        });
        let between = math::hypot(a, b) + 0.25 * kink.dot(d.abs());
        if parts == 1 {
            return between;
        }
        // Between its ends the weight may be smaller than there by this share.
        let rate = pieces.iter().fold(DVec2::ZERO, |m, p| m.max(p.weight_rate)) / least_weight;
        off(i).max(off(i + 1)) * (1.0 + rate.dot(d.abs())) + between
    };
    (0..parts).fold(0.0, |worst: f64, i| worst.max(part(i)))
}
