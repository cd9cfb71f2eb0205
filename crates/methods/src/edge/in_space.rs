//! Trimming curves lifted into space, and polylines of them.
//!
//! Source: Balázs, Guthe, Klein 2004, sections 4 and 5.1. Simplification runs over all pieces at once: where
//! they end at knot lines of the surface, vertices are mostly needless. Curves then get the share γ of the
//! tolerance, simplification the rest; both are Hausdorff distances, so the sum is one.

use super::curve::TrimmingCurve;
use super::simplify::simplified;
use super::{CURVE_SHARE, Criterion};
use crate::fill::Cut;
use chordal_nurbs::{BezierCurve, DVec3, LiftOptions, Range};
use chordal_tessellate::method::EdgePiece;

/// A Bézier curve in space, and the edge's parameters that its ends belong to.
pub type Lifted = (Range, BezierCurve<DVec3>);

/// A polyline with guesses of the edge's parameters.
pub struct Polyline {
    pub points: Vec<DVec3>,
    pub guesses: Vec<f64>,
    /// Vertices that simplification left out.
    pub left_out: usize,
}

/// The curve on its surface.
pub fn lifted(curve: &TrimmingCurve) -> Option<Vec<Lifted>> {
    let mut all = Vec::with_capacity(curve.pieces.len());
    for (range, plane) in &curve.pieces {
        let at = |s: f64| range.start + s * range.length();
        let pieces = curve.surface.lift(plane, LiftOptions::default()).ok()?;
        all.extend(pieces.into_iter().map(|p| (Range::new(at(p.range.start), at(p.range.end)), p.xyz)));
    }
    Some(all)
}

/// The edge's own curve, where no face has a curve to be lifted.
pub fn own(edge: &EdgePiece<'_>) -> Option<Vec<Lifted>> {
    Some(edge.curve.to_nurbs(edge.range).ok()?.bezier_pieces())
}

/// The pieces as one polyline within `tolerance`.
pub fn polyline(
    pieces: &[Lifted],
    tolerance: f64,
    (criterion, cut, is_simplified): (Criterion, Cut, bool),
) -> Option<Polyline> {
    let of_curves = if is_simplified { CURVE_SHARE * tolerance } else { tolerance };
    let (mut points, mut guesses) = (Vec::new(), Vec::new());
    for (i, (range, curve)) in pieces.iter().enumerate() {
        let stops = curve.flattened(of_curves, criterion.of_curves(), cut.of_curves())?;
        for &s in &stops[usize::from(i > 0)..] {
            points.push(curve.eval(s));
            guesses.push(range.start + s * range.length());
        }
    }
    if !is_simplified {
        return Some(Polyline { points, guesses, left_out: 0 });
    }
    let kept = simplified(&points, (1.0 - CURVE_SHARE) * tolerance);
    Some(Polyline {
        left_out: points.len() - kept.len(),
        points: kept.iter().map(|&i| points[i]).collect(),
        guesses: kept.iter().map(|&i| guesses[i]).collect(),
    })
}
