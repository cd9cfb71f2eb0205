//! Which part of the surface the mesh of a face covers.
//!
//! A bound of the distance does not distinguish one part of a surface from another. That the boundary of the
//! mesh is the face's loops ([`crate::boundary`]), that all triangles run one way round and that none lies on
//! another ([`crate::overlap`]) leaves two regions where the surface is closed: each loop has the face on one
//! side and the rest of the surface on the other. Here the file's directions decide.
//!
//! 1. A face with loops has a boundary; otherwise the whole surface is covered.
//! 2. On a closed surface the face is on the left of its loops, seen against the normal that the file gives
//!    it. Where the edges of a closed shell agree all round, the neighbours decide instead: files exist whose
//!    loops contradict the sense of their face and whose shell is right.
//! 3. A face of a torus that meets its own axis (lemon or apple) is on one of its two sheets.
//! 4. Vertices inside the face lie, in the chart, between its boundaries.
//!
//! Where the surface is not closed, the side does not matter: only one of the two regions is bounded. Files
//! give loops and senses the wrong way round there, and the region is the same.

use crate::boundary::Boundary;
use crate::chart::Chart;
use crate::context::Context;
use crate::findings::Log;
use crate::halves::Half;
use chordal_brep::{AuditIssue, Coedge, Face, Loop};
use chordal_mesh::Origin;
use chordal_nurbs::{Surface, UvBox, math};

/// How far inside vertices may lie beyond the boundary in the chart, relative to its extent: rounding.
const BEYOND: f64 = 1e-9;

pub(crate) fn check_region(
    context: &Context<'_>,
    chart: &Chart<'_>,
    bounds: &Boundary,
    single: &[Half],
    log: &mut Log<'_>,
) {
    if covers_whole_surface(log.face, bounds) {
        log.add(AuditIssue::WholeSurface);
    }
    if is_on_both_sheets(chart) {
        log.add(AuditIssue::BothSheets);
    }
    let beyond = beyond_boundary(context, chart, bounds, single);
    if beyond > 0 {
        log.add(AuditIssue::OutOfReach { vertices: beyond });
    }
}

/// True where the face has a loop with an inside and no triangle ends at any loop. A seam that is the only
/// loop of a whole sphere or torus is none: each of its edges runs there and back.
fn covers_whole_surface(face: &Face, bounds: &Boundary) -> bool {
    let is_seam = |a_loop: &Loop| match a_loop {
        Loop::Vertex(_) => true,
        Loop::Polygon { .. } => false,
        Loop::Edges { coedges, .. } => coedges.iter().all(|c| coedges.iter().any(|other| is_back(c, other))),
    };
    bounds.chords.is_empty() && !face.loops.iter().all(is_seam)
}

/// True for two uses of one edge in opposite directions.
fn is_back(one: &Coedge, other: &Coedge) -> bool {
    other.edge == one.edge && other.forward != one.forward
}

/// Whether the mesh is on the side of its loops that the file means.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum LoopSide {
    /// It is, or only one side is bounded.
    Right,
    /// Its triangles face as in the file, and its loops have the opposite direction. A shell that is closed
    /// and consistent refutes the direction of the loops: the neighbours run along the same edges.
    AgainstLoops,
    /// Its triangles run along the loops as in the file, and face the other way. The neighbours do not
    /// show it: a cap of a sphere and the rest of it close the same hole, and only the sense of the face
    /// differs.
    AgainstSense,
}

/// Finds the side of the loops where both sides are bounded. A loop that runs along a seam and back tells by
/// the seam which side is meant.
pub(crate) fn loop_side(chart: &Chart<'_>, bounds: &Boundary, face: &Face) -> LoopSide {
    let cut_open = |a_loop: &Loop| match a_loop {
        Loop::Edges { coedges, .. } => coedges.iter().any(|c| coedges.iter().any(|other| is_back(c, other))),
        _ => false,
    };
    if !is_closed(chart) || face.loops.iter().any(cut_open) {
        return LoopSide::Right;
    }
    let along_normal = chart.turned == face.normal_reversed();
    match (bounds.forward > 0, bounds.backward > 0) {
        (false, true) if along_normal => LoopSide::AgainstLoops,
        (true, false) if !along_normal => LoopSide::AgainstSense,
        _ => LoopSide::Right,
    }
}

/// True where the surface has no border: in each direction it is periodic or ends in poles.
fn is_closed(chart: &Chart<'_>) -> bool {
    let ends_in_poles = |axis: usize| {
        let range = if axis == 0 { chart.surface.domain().u() } else { chart.surface.domain().v() };
        let near = 1e-9 * range.length();
        let at = |value: f64| chart.poles.iter().any(|p| p.axis == axis && (p.value - value).abs() <= near);
        range.is_finite() && at(range.start) && at(range.end)
    };
    let closed = [0, 1].map(|axis| chart.period(axis).is_some());
    match closed {
        [true, true] => true,
        [true, false] => ends_in_poles(1),
        [false, true] => ends_in_poles(0),
        [false, false] => false,
    }
}

/// True where corners lie on both sheets of a torus whose tube is wider than its circle.
fn is_on_both_sheets(chart: &Chart<'_>) -> bool {
    let Surface::Torus { major, minor, .. } = chart.surface else { return false };
    if major.abs() >= minor.abs() {
        return false;
    }
    let near = 1e-6 * minor.abs();
    let radii = || chart.mesh.corners.iter().map(|c| major + minor * math::cos(c.uv.y));
    radii().any(|r| r > near) && radii().any(|r| r < -near)
}

/// How many vertices inside the face lie, in the chart, beyond the box of its loops. Where the mesher cut the
/// chart open, the sides of the cut bound it as well.
fn beyond_boundary(context: &Context<'_>, chart: &Chart<'_>, bounds: &Boundary, single: &[Half]) -> usize {
    let uv = |h: &Half| [h.a, h.b].map(|corner| chart.mesh.corners[corner as usize].uv);
    let reach = if bounds.cuts.is_empty() && bounds.stray.is_empty() {
        UvBox::from_points(bounds.chords.iter().flat_map(|c| uv(&c.half)))
    } else {
        UvBox::from_points(single.iter().flat_map(uv))
    };
    let reach = reach.inflated(reach.size() * BEYOND);
    let inner = chart.mesh.corners.iter().filter(|c| {
        matches!(context.mesh.origins[c.position as usize], Origin::Face(_)) && !reach.contains(c.uv)
    });
    inner.count()
}
