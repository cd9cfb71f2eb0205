//! How far the file's parameter curves (pcurves) of a face lie off the edges that they belong to.
//!
//! Chordal bounds faces by the curves of edges in space, which both faces share. A reader that trims a face
//! by its pcurves gets another boundary, further off by the difference. The file causes this difference, so
//! it is part of the file's gap.

use chordal_brep::{Coedge, Edge, Face, Loop, Part, Pcurve};
use chordal_chart::{EdgeSamples, FaceSurface};
use chordal_nurbs::{Curve, CurveInverter, DVec2, DVec3, Surface};

/// Newton steps along a curve, from a parameter that is nearly the nearest one. They converge quadratically.
const STEPS: usize = 4;

/// A pcurve whose ends lie further from the ends of its edge than this share of the edge's length belongs to
/// another piece of the curve. Nothing determines which one, so no reader can use it.
const OTHER_PIECE: f64 = 0.1;

/// Parameters beyond the end of the domain by this share of it are at its end.
const SAME_PARAMETER: f64 = 1e-6;

/// The largest distance between the pcurves of a face, lifted to its surface, and the curves of their edges,
/// at the ends and in the middle of every chord; 0 on planes, which need no pcurves.
pub(crate) fn pcurve_gap(part: &Part, face: &Face, surface: &FaceSurface<'_>, edges: &[EdgeSamples]) -> f64 {
    if matches!(surface.surface, Surface::Plane { .. }) {
        return 0.0;
    }
    let coedges = face.loops.iter().flat_map(|l| match l {
        Loop::Edges { coedges, .. } => coedges.as_slice(),
        _ => &[],
    });
    let gap = |coedge: &Coedge| {
        let edge = &part.edges[coedge.edge.index()];
        let Some(curve) = edge.curve.as_deref() else { return 0.0 };
        let samples = &edges[coedge.edge.index()];
        coedge.pcurves.iter().map(|pcurve| off(edge, curve, pcurve, surface, samples)).fold(0.0, f64::max)
    };
    coedges.map(gap).fold(0.0, f64::max)
}

/// The gap of one pcurve; `None` for a pcurve that no reader can use.
fn off(
    edge: &Edge,
    curve: &Curve,
    pcurve: &Pcurve,
    surface: &FaceSurface<'_>,
    EdgeSamples { t, points, .. }: &EdgeSamples,
) -> f64 {
    let uv = |t: f64| {
        let share = (t - edge.range.start) / edge.range.length();
        pcurve.curve.point(pcurve.range.start + share * pcurve.range.length())
    };
    let lifted = |t: f64| surface.point(uv(t));
    let (Some(&first), Some(&last)) = (t.first(), t.last()) else { return 0.0 };
    let length: f64 = points.windows(2).map(|p| p[0].distance(p[1])).sum();
    let at_ends = lifted(first).distance(points[0]).max(lifted(last).distance(points[points.len() - 1]));
    if at_ends > OTHER_PIECE * length || [first, last].iter().any(|&t| is_beyond(surface, uv(t))) {
        return 0.0;
    }
    let at = |t: f64| beside(curve, edge, t, lifted(t), surface.resolution);
    let gaps = t.iter().map(|&t| at(t)).chain(t.windows(2).map(|t| at(0.5 * (t[0] + t[1]))));
    let gap = gaps.fold(0.0f64, |m, d| if d.is_finite() { m.max(d) } else { f64::INFINITY });
    if gap.is_finite() { gap } else { 0.0 }
}

/// True for parameters outside of the surface.
fn is_beyond(surface: &FaceSurface<'_>, p_uv: DVec2) -> bool {
    let domain = surface.domain();
    (0..2).any(|i| {
        let slack = SAME_PARAMETER * (domain.max[i] - domain.min[i]);
        surface.periods[i].is_none() && (p_uv[i] < domain.min[i] - slack || p_uv[i] > domain.max[i] + slack)
    })
}

/// The distance of a point from the curve of the edge, found from parameter `t`; the curve may be followed
/// beyond the ends of the edge.
fn beside(curve: &Curve, edge: &Edge, t: f64, p: DVec3, resolution: f64) -> f64 {
    let direct = curve.point(t).distance(p);
    if direct.partial_cmp(&resolution).is_none_or(|o| o.is_le()) {
        return direct;
    }
    let mut at = t;
    for _ in 0..STEPS {
        let jet = curve.jet(at);
        let next = at + (p - jet.p).dot(jet.d1) / jet.d1.length_squared();
        if !next.is_finite() {
            break;
        }
        at = if curve.period().is_some() { next } else { edge.range.clamp(next) };
    }
    if curve.point(at).distance(p) > resolution {
        at = CurveInverter::new(curve, edge.range).invert(p, None).t;
    }
    let jet = curve.jet(at);
    let off = p - jet.p;
    let is_end = at == edge.range.start || at == edge.range.end;
    // Beyond an end, only the distance beside the tangent counts.
    if is_end { off.reject_from(jet.d1).length() } else { off.length() }.min(direct)
}
