//! Cuts: where a face's triangles are glued to each other along a line that is no edge of the model.
//!
//! A seam's two sides lie whole periods apart in the chart: nothing is between them. Where triangles whose
//! corners are not three vertices were omitted, a sliver of surface between the two sides has a single mesh
//! edge over it. At a pole the sectors of [`crate::fan`] cover it; elsewhere it needs a bound of its own:
//! that of the vector error e = S − L against the affine map L of the sliver onto the edge (see
//! `chordal_nurbs::facet_bound` for the formula along one direction), or, where the sides are a hair apart on
//! either side of a crease, its width, beyond what bounds the triangles at its sides.

use crate::chart::Chart;
use crate::halves::Half;
use chordal_nurbs::{DVec2, DVec3, Piece, Surface, SurfaceBounds, UvBox};

/// The relation of the two sides of a cut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Cut {
    /// Nothing: one side is the other moved by whole periods.
    Seam,
    /// A sliver, whose distance from its edge is at most `alone`, zero where something else covers it; it is
    /// also at most `width` wide.
    Sliver { alone: f64, width: f64 },
}

/// How far apart in the chart (relative to its extent) two sides of a seam may be by rounding.
const SAME_UV: f64 = 1e-9;

pub(crate) fn judge(
    chart: &Chart<'_>,
    bounds: &SurfaceBounds<'_>,
    sides: &[Half; 2],
    scratch: &mut Vec<Piece>,
) -> Cut {
    let [first, second] = sides;
    let uv = |corner: u32| chart.mesh.corners[corner as usize].uv;
    let (a, b) = (uv(first.a), uv(first.b));
    let (b2, a2) = (uv(second.a), uv(second.b));
    let size = chart.uv_box.size();
    let close = |d: DVec2| d.abs().cmple(SAME_UV * (size + a.abs().max(b.abs()))).all();
    // An end that is not on a pole determines by how many periods the sides are apart.
    let at_a = chart.whole_turns(a2 - a);
    let at_b = chart.whole_turns(b2 - b);
    let (off_a, off_b) = (a2 - a - at_a, b2 - b - at_b);
    if at_a == at_b && close(off_a) && close(off_b) {
        return Cut::Seam;
    }
    // The central projection of a sphere or a cone needs no parameters at a pole.
    let projected = matches!(chart.surface, Surface::Sphere { .. } | Surface::Cone { .. });
    if projected && sides.iter().any(|h| chart.touches_pole(h))
        || sides.iter().all(|h| chart.is_fan(h.triangle))
    {
        return Cut::Sliver { alone: 0.0, width: 0.0 };
    }
    let turns = if close(off_b) { at_b } else { at_a };
    let (a2, b2) = (a2 - turns, b2 - turns);
    let (p, q) = (chart.point(a), chart.point(b));
    let halves = [([a, b, b2], [p, q, q]), ([a, b2, a2], [p, q, p])];
    let error = halves
        .iter()
        .filter(|(uv, _)| uv[0] != uv[1] && uv[1] != uv[2] && uv[2] != uv[0])
        .map(|(uv, ends)| vector_bound(bounds, *uv, *ends, chart, scratch))
        .fold(0.0, f64::max);
    let width = width(bounds, [a, b, b2, a2], chart, scratch);
    Cut::Sliver { alone: error, width }
}

/// How far apart the two sides a–b and a2–b2 of a sliver are at most: ‖S(x + d) − S(x)‖ ≤ max ‖DS[d]‖ over
/// the sliver's box, by the derivatives at one corner, the second ones over the box, and the jumps within.
fn width(bounds: &SurfaceBounds<'_>, uv: [DVec2; 4], chart: &Chart<'_>, pieces: &mut Vec<Piece>) -> f64 {
    let [a, b, b2, a2] = uv;
    let uv_box = UvBox::from_points(uv);
    pieces.clear();
    let kink = bounds.pieces(uv_box, pieces);
    if pieces.is_empty() {
        return f64::INFINITY;
    }
    let norms = pieces.iter().fold([0.0f64; 3], |m, p| std::array::from_fn(|i| m[i].max(p.norms[i])));
    let (_, du, dv) = chart.surface.jet1(chart.wrap.apply(a));
    let size = uv_box.size();
    let along_u = du.length() + norms[0] * size.x + norms[1] * size.y + kink.x;
    let along_v = dv.length() + norms[1] * size.x + norms[2] * size.y + kink.y;
    let d = (a2 - a).abs().max((b2 - b).abs());
    along_u * d.x + along_v * d.y
}

/// An upper bound of ‖S − L‖ over a triangle of the chart, L affine with the given images of the corners.
fn vector_bound(
    bounds: &SurfaceBounds<'_>,
    uv: [DVec2; 3],
    images: [DVec3; 3],
    chart: &Chart<'_>,
    pieces: &mut Vec<Piece>,
) -> f64 {
    let uv_box = UvBox::from_points(uv);
    pieces.clear();
    let kink = bounds.pieces(uv_box, pieces);
    if pieces.is_empty() {
        return f64::INFINITY;
    }
    let size = uv_box.size();
    let norms = pieces.iter().fold([0.0f64; 3], |m, p| std::array::from_fn(|i| m[i].max(p.norms[i])));
    let bend = |d: DVec2| norms[0] * d.x * d.x + 2.0 * norms[1] * (d.x * d.y).abs() + norms[2] * d.y * d.y;
    let worst = bend(uv[2] - uv[1]).max(bend(uv[0] - uv[2])).max(bend(uv[1] - uv[0]));
    let kinks = 0.25 * (kink.x * size.x + kink.y * size.y);
    // Σ λ_i λ_j |D²S[d_ij, d_ij]| / 2 is at most the largest of them over 6.
    let corners = (0..3).map(|i| chart.point(uv[i]).distance(images[i])).fold(0.0, f64::max);
    worst / 6.0 + kinks + corners
}
