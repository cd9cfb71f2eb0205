//! Corners of an edge, where its tangent changes direction at one point. A sharp corner is a vertex. Soft
//! corners occur in polylines through points of a smooth curve: they are vertices only where no chord may
//! pass over them.

use super::{Probes, Sampling};
use chordal_nurbs::{Curve, Range, Surface, math};

/// A change of direction of more than this, in radians, is a corner. Smaller ones are rounding of the file.
const CORNER: f64 = 1e-3;

/// A corner of up to this angle, in radians, is soft: the file approximates a bend.
const SOFT: f64 = 0.2;

/// Chords over soft corners use this share of the tolerance along curved faces, whose facets need the rest.
const BESIDE_CURVED: f64 = 0.5;

/// A piece of an edge between two corners.
#[derive(Clone, Copy)]
pub(super) struct Piece {
    pub range: Range,
    /// The piece begins at a soft corner.
    soft: bool,
}

/// Cuts a range at the corners of the curve and at `stops`.
pub(super) fn smooth_pieces(curve: &Curve, range: Range, stops: &[f64]) -> Vec<Piece> {
    let step = 1e-7 * range.length();
    let kink = |t: f64| math::angle_between(curve.jet(t - step).d1, curve.jet(t + step).d1);
    let corners = curve.breaks(range).into_iter().map(|t| (t, kink(t)));
    let mut cuts: Vec<(f64, bool)> =
        corners.filter(|&(_, kink)| kink > CORNER).map(|(t, kink)| (t, kink <= SOFT)).collect();
    for &stop in stops {
        // Most corners lie on a crease as well. Its position is known better there.
        match cuts.iter_mut().find(|(t, _)| (t - stop).abs() <= step) {
            Some((_, soft)) => *soft = false,
            None => cuts.push((stop, false)),
        }
    }
    cuts.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut pieces = Vec::with_capacity(1);
    let (mut start, mut soft) = (range.start, false);
    for (t, next_soft) in cuts {
        if t > start + step && t < range.end - step {
            pieces.push(Piece { range: Range::new(start, t), soft });
            (start, soft) = (t, next_soft);
        }
    }
    pieces.push(Piece { range: Range::new(start, range.end), soft });
    pieces
}

/// Joins pieces where one chord may pass over the soft corners between them: within the tolerance, and no
/// longer than the faces at the edge need.
pub(super) fn passed_over(pieces: Vec<Piece>, sampling: &Sampling<'_, '_, '_>) -> Vec<Piece> {
    if !pieces.iter().any(|piece| piece.soft) {
        return pieces;
    }
    let flat = sampling.uses.iter().all(|u| matches!(u.surface.surface, Surface::Plane { .. }));
    let allowed = sampling.limits.tolerance * if flat { 1.0 } else { BESIDE_CURVED };
    let mut joined: Vec<Piece> = Vec::with_capacity(pieces.len());
    let mut chords = 0.0;
    for piece in pieces {
        let own = Probes::new(sampling, piece.range).total();
        chords += own;
        if let Some(last) = joined.last_mut().filter(|_| piece.soft && chords <= 1.0) {
            let longer = Range::new(last.range.start, piece.range.end);
            if sampling.curve.chord_error(longer.start, longer.end) <= allowed {
                last.range = longer;
                continue;
            }
        }
        joined.push(piece);
        chords = own;
    }
    joined
}
