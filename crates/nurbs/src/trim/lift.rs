//! Trimming curves lifted onto their surface, exactly.
//!
//! Source: Balázs, Guthe, Klein 2004, section 4. The paper finds the lifted curve of degree `d (du + dv)`
//! by interpolation and a singular value decomposition, which limits it to degrees about 20; here it is
//! composed in Bernstein form ([`crate::BezierPatch::compose`]), in homogeneous coordinates, so rational
//! curves and patches are exact, too.
//!
//! 1. Degrees that the plane curve does not need are dropped, from both ends towards the middle.
//! 2. It is cut where it changes sides of a knot line; a stretch along one belongs to either patch.
//! 3. Each stretch is composed with the patch under its middle.
//! 4. Degrees that the curve in space does not need are dropped. *Lossless* is a share of the curve's size,
//!    and what it did cost is proven and reported.

use super::roots::sign_changes;
use crate::{BezierCurve, BezierPatch, NurbsError, NurbsSurface, Range, UvBox, Vector};
use glam::{DVec2, DVec3};
use std::collections::BTreeMap;

/// How much the reductions of degree may cost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LiftOptions {
    /// What counts as nothing, as a share of the curve's size, in the plane and in space.
    pub lossless: f64,
    /// Lifted curves of a higher degree than this are brought down to it where that costs no more than
    /// `allowance`.
    pub degree_cap: usize,
    /// In the surface's units; 0: the degree is what it is.
    pub allowance: f64,
}

impl Default for LiftOptions {
    fn default() -> Self {
        Self { lossless: 1e-12, degree_cap: 20, allowance: 0.0 }
    }
}

/// A piece of a trimming curve over one polynomial piece of the surface, in the plane and in space.
#[derive(Clone, Debug, PartialEq)]
pub struct LiftedPiece {
    /// The part of the whole trimming curve, whose parameters run from 0 to 1.
    pub range: Range,
    /// In the surface's parameters.
    pub uv: BezierCurve<DVec2>,
    /// On the surface, at the same parameters as `uv`.
    pub xyz: BezierCurve<DVec3>,
    /// Proven distance, at equal parameters, that the reduction of degree put between `xyz` and the surface
    /// over `uv`.
    pub error: f64,
}

/// A piece of a trimming curve over one polynomial piece of the surface, and that.
#[derive(Clone, Debug, PartialEq)]
pub struct PatchPiece {
    /// The part of the whole trimming curve, whose parameters run from 0 to 1.
    pub range: Range,
    /// In the surface's parameters.
    pub uv: BezierCurve<DVec2>,
    /// In the patch's own, which map the cell to the unit square.
    pub local: BezierCurve<DVec2>,
    /// The cell of the surface's parameters that the patch covers.
    pub cell: UvBox,
    /// The polynomial piece of the surface.
    pub patch: BezierPatch,
}

/// Pieces of the plane curve shorter than this share of it are rounding at a knot line.
const SHORTEST: f64 = 1e-12;

/// Parameters this share of the domain's extent from a knot line are on it.
const ON_LINE: f64 = 1e-14;

impl NurbsSurface {
    /// The Bézier curves that the surface makes of a Bézier curve in its plane of parameters, one for each
    /// stretch over one polynomial piece.
    ///
    /// Beyond the domain the outermost pieces go on.
    ///
    /// # Errors
    /// [`NurbsError::NoExactForm`] where the degree passes 1000.
    pub fn lift(
        &self,
        curve: &BezierCurve<DVec2>,
        options: LiftOptions,
    ) -> Result<Vec<LiftedPiece>, NurbsError> {
        self.lift_onto_patches(curve, options)
            .into_iter()
            .map(|piece| {
                let (xyz, error) = reduced(piece.patch.compose(&piece.local)?, &options);
                Ok(LiftedPiece { range: piece.range, uv: piece.uv, xyz, error })
            })
            .collect()
    }

    /// The stretches of a Bézier curve in the plane of parameters over one polynomial piece of the surface
    /// each, without the degrees that it does not need.
    pub fn lift_onto_patches(&self, curve: &BezierCurve<DVec2>, options: LiftOptions) -> Vec<PatchPiece> {
        let plane = without_spare_degrees(curve, options.lossless).0;
        let mut patches = BTreeMap::new();
        let cuts = self.cuts(&plane);
        let piece = |pair: &[f64]| {
            let uv = plane.restricted(pair[0], pair[1]);
            let middle = self.domain().clamp(uv.eval(0.5));
            let (cell, patch) = self.patch_under(middle, &mut patches).clone();
            let local = uv.in_unit_square(&cell);
            PatchPiece { range: Range::new(pair[0], pair[1]), uv, local, cell, patch }
        };
        cuts.windows(2).map(piece).collect()
    }

    /// Parameters from 0 to 1 between which the curve stays on one side of every knot line.
    fn cuts(&self, curve: &BezierCurve<DVec2>) -> Vec<f64> {
        let size = self.domain().size();
        let mut cuts = Vec::new();
        for (axis, breaks) in [self.breaks_u(), self.breaks_v()].into_iter().enumerate() {
            for &value in &breaks[1..breaks.len() - 1] {
                cuts.extend(curve.crossings(axis, value, ON_LINE * size[axis]));
            }
        }
        cuts.push(1.0);
        cuts.sort_unstable_by(f64::total_cmp);
        let mut kept = vec![0.0];
        for t in cuts {
            if t - kept[kept.len() - 1] > SHORTEST && (1.0 - t > SHORTEST || t == 1.0) {
                kept.push(t);
            }
        }
        kept
    }

    /// The polynomial piece under a point of the domain, made once for every cell.
    fn patch_under<'p>(
        &self,
        p_uv: DVec2,
        patches: &'p mut BTreeMap<[usize; 2], (UvBox, BezierPatch)>,
    ) -> &'p (UvBox, BezierPatch) {
        let [p, q] = self.degree();
        let s = crate::basis::find_span(p, self.knots_u(), p_uv.x);
        let t = crate::basis::find_span(q, self.knots_v(), p_uv.y);
        patches.entry([s, t]).or_insert_with(|| {
            let (us, vs) = (&self.knots_u()[s..=s + 1], &self.knots_v()[t..=t + 1]);
            let inside = DVec2::new(0.5 * (us[0] + us[1]), 0.5 * (vs[0] + vs[1]));
            let found = self.bezier_patches(
                UvBox::new(inside, inside).inflated(DVec2::new(us[1] - us[0], vs[1] - vs[0]) * 0.25),
            );
            found.into_iter().next().expect("every point of the domain lies in a span")
        })
    }
}

impl BezierCurve<DVec2> {
    /// Parameters strictly between 0 and 1 at which the curve changes sides of the line where coordinate
    /// `axis` is `value`, increasing. Control points within `on_line` of it are on it.
    pub fn crossings(&self, axis: usize, value: f64, on_line: f64) -> Vec<f64> {
        let net = self.homogeneous();
        let beyond: Vec<f64> = net.iter().map(|h| h.v[axis] - value * h.w).collect();
        let heaviest = net.iter().fold(0.0f64, |m, h| m.max(h.w.abs()));
        sign_changes(&beyond, on_line * heaviest)
    }
}

/// Without the degrees that cost nothing, then down to the cap where the allowance is enough.
fn reduced(curve: BezierCurve<DVec3>, options: &LiftOptions) -> (BezierCurve<DVec3>, f64) {
    let (lean, mut error) = without_spare_degrees(&curve, options.lossless);
    if lean.degree() <= options.degree_cap || options.allowance <= 0.0 {
        return (lean, error);
    }
    let mut best = lean.clone();
    // The bound is monotone enough: the degree is lowered one by one until the bound is too large.
    while best.degree() > options.degree_cap {
        let (lower, cost) = crate::degree::reduced_to(&lean, best.degree() - 1);
        if !(cost <= options.allowance) {
            break;
        }
        best = lower;
        error = cost;
    }
    (best, error)
}

/// Rounding of the control points, in units of the last place, that steps of reduction make larger.
const ROUNDING: f64 = 64.0;

/// As many degrees lower as cost no more than `lossless` of the curve's size and the rounding of its points
/// all together, and what they cost.
///
/// Every step takes the left half of the control points from the left, the right half from the right, the
/// mean where they meet, and is judged by elevating the result again.
fn without_spare_degrees<V: Vector>(curve: &BezierCurve<V>, lossless: f64) -> (BezierCurve<V>, f64) {
    let origin = curve.points[0];
    let size = curve.points.iter().fold(0.0f64, |m, p| m.max((*p - origin).norm()));
    // Far from the origin a short curve's points are rounded by more than a share of its size.
    let rounding = ROUNDING * f64::EPSILON * curve.points.iter().fold(0.0f64, |m, p| m.max(p.norm()));
    let mut lean = curve.clone();
    let mut cost = 0.0;
    while lean.degree() > 1 {
        match lean.reduced() {
            Some((lower, step)) if cost + step <= lossless * size + rounding => {
                lean = lower;
                cost += step;
            }
            _ => break,
        }
    }
    (lean, cost)
}
