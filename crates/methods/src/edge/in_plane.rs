//! Trimming curves approximated in the plane of parameters.
//!
//! Source: Kahlesz, Balázs, Klein 2001, section 6, which Balázs, Guthe, Klein 2004 compare with (Table 2, *2d
//! Bézier*). The surface is quartered until its error is within ε = κ/3; the curve is cut at the borders of
//! the leaves, and over each leaf it may lie δ = (κ − 2ε)/‖bl‖ from its chord, lengths counted in the leaf's
//! own parameters. Only leaves under the curve are made.
//!
//! The paper adds up the surface at two points of the plane. The sum holds for the chord in space, too:
//! with E the distance of leaf and bilinear surface at equal parameters and T the twist,
//!
//! ```text
//! curve – bilinear surface over it      E
//! there – over the chord in the plane   ‖bl‖ δ = κ/3
//! there – the chord in space            ¼‖T‖, its ends off the surface by E
//!                                       2E + ¼‖T‖ + κ/3 ≤ κ      as E + ¼‖T‖ ≤ ε
//! ```
//!
//! The paper's Lemma 2 bounds E for polynomial leaves only. Over rational ones points slide along the
//! bilinear surface by as much as weights differ, so E is bounded with them ([`off_bilinear`]).

use super::curve::TrimmingCurve;
use crate::fill::node::{Bilinear, off_bilinear};
use crate::fill::quadtree::{SURFACE_SHARE, norm};
use chordal_nurbs::{
    BezierCurve, BezierPatch, ChordCriterion, ChordCut, DVec2, DVec3, LiftOptions, NurbsSurface, Range, UvBox,
};

/// Vertices of the polyline, with guesses of the edge's parameters.
#[derive(Default)]
pub struct Stops {
    pub points: Vec<DVec3>,
    pub guesses: Vec<f64>,
}

/// Leaves are quartered at most this often.
const DEEPEST: u32 = 24;

/// The vertices of the curve within κ = `tolerance`; `None` where a curve cannot be approximated.
pub fn stops(curve: &TrimmingCurve, tolerance: f64) -> Option<Stops> {
    let mut stops = Stops::default();
    for (range, plane) in &curve.pieces {
        for piece in curve.surface.lift_onto_patches(plane, LiftOptions::default()) {
            let at = |s: f64| {
                let own = piece.range.start + s * piece.range.length();
                range.start + own * range.length()
            };
            let mut leaf = Descent { tolerance, found: Vec::new() };
            leaf.descend(&piece.patch, &piece.local, Range::new(0.0, 1.0), 0)?;
            let is_first = stops.points.is_empty();
            for s in leaf.found.into_iter().skip(usize::from(!is_first)) {
                stops.points.push(piece.patch.eval(piece.local.eval(s)));
                stops.guesses.push(at(s));
            }
        }
    }
    Some(stops)
}

struct Descent {
    tolerance: f64,
    /// Parameters of the curve over the patch, increasing.
    found: Vec<f64>,
}

impl Descent {
    /// `curve` is the part over `range`, in the unit square of `patch`.
    fn descend(
        &mut self,
        patch: &BezierPatch,
        curve: &BezierCurve<DVec2>,
        range: Range,
        depth: u32,
    ) -> Option<()> {
        let whole = over_unit_square(patch)?;
        let error = off_bilinear(&whole) + 0.25 * Bilinear::new(&whole).twist().length();
        let is_flat = error <= SURFACE_SHARE * self.tolerance;
        if is_flat || depth >= DEEPEST {
            let share = (1.0 - 2.0 * SURFACE_SHARE) * self.tolerance / norm(&whole);
            let t = curve.flattened(share, ChordCriterion::Line, ChordCut::Midpoint)?;
            let skip = usize::from(!self.found.is_empty());
            self.found.extend(t[skip..].iter().map(|t| range.start + t * range.length()));
            return Some(());
        }
        for pair in cuts(curve).windows(2) {
            let part = curve.restricted(pair[0], pair[1]);
            let quadrant = quadrant_of(part.eval(0.5));
            let local = part.in_unit_square(&quadrant);
            let at = |t: f64| range.start + t * range.length();
            self.descend(
                &patch.restricted(quadrant),
                &local,
                Range::new(at(pair[0]), at(pair[1])),
                depth + 1,
            )?;
        }
        Some(())
    }
}

/// Where the curve crosses the middle lines of the unit square, with its ends.
fn cuts(curve: &BezierCurve<DVec2>) -> Vec<f64> {
    let mut cuts = vec![0.0, 1.0];
    cuts.extend((0..2).flat_map(|axis| curve.crossings(axis, 0.5, ON_LINE)));
    cuts.sort_unstable_by(f64::total_cmp);
    cuts.dedup();
    cuts
}

/// Of a leaf: nearer to its border a curve runs along it.
const ON_LINE: f64 = 1e-12;

fn quadrant_of(p: DVec2) -> UvBox {
    let low = |t: f64| if t < 0.5 { 0.0 } else { 0.5 };
    let min = DVec2::new(low(p.x), low(p.y));
    UvBox::new(min, min + 0.5)
}

fn over_unit_square(patch: &BezierPatch) -> Option<NurbsSurface> {
    let knots = |degree: usize| (0..2 * degree + 2).map(|i| f64::from(u8::from(i > degree))).collect();
    let [p, q] = patch.degree;
    NurbsSurface::new([p, q], knots(p), knots(q), patch.points.clone(), patch.weights.clone()).ok()
}
