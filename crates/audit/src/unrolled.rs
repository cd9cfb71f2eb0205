//! Whether the boundary of a face's mesh in the chart is its exact loops, unrolled.
//!
//! The corners of the mesh lie on the surface at their parameters, and the boundary is the chords of the
//! loops ([`crate::boundary`]); but where a surface is closed, or meets itself, a point has several places in
//! the chart, and a chord may lead to the wrong one. Of each chord a b it is looked at whether the step in
//! the chart leads there,
//!
//! ```text
//!              by the derivatives at a
//!       a ●┄┄┄┄┄┄┄┄┄┄┄┄✕      to within half the chord's length of b,
//!          ╲___________● b    and the exact curve stays within half of it of the chord;
//! ```
//!
//! or else whether the middle of the step lies on the surface within half a chord of the middle of the exact
//! curve. A place that is whole periods off is as far away as the surface is around, in both. If all chords
//! lead to their right places and the two sides of cuts are whole periods apart, the area of the triangles
//! is, by Green's theorem, that within the exact loops.

use crate::boundary::{Boundary, BoundaryChord};
use crate::chart::Chart;
use crate::context::Context;
use crate::halves::Half;
use chordal_nurbs::{DVec2, DVec3, Surface};

/// The tolerance of a position, in chords.
const SHARE: f64 = 0.5;

/// Parameters may be off by this by rounding, relative to the chart.
const ROUNDING: f64 = 1e-9;

/// True if the boundary in the chart is known to be the exact loops; false proves nothing.
pub(crate) fn is_unrolled(context: &Context<'_>, chart: &Chart<'_>, bounds: &Boundary) -> bool {
    // The parameters of a plane are coordinates.
    matches!(chart.surface, Surface::Plane { .. })
        || bounds.cuts.iter().all(|cut| is_seam(chart, cut))
            && bounds.chords.iter().all(|chord| leads_there(context, chart, chord))
}

/// True where a chord leads to the right place in the chart.
fn leads_there(context: &Context<'_>, chart: &Chart<'_>, chord: &BoundaryChord) -> bool {
    let (a, b) = (chord.half.a as usize, chord.half.b as usize);
    let corners = [a, b].map(|c| &chart.mesh.corners[c]);
    let [p, q] = corners.map(|c| context.mesh.positions[c.position as usize]);
    let near = SHARE * p.distance(q);
    let [from, to] = beside_poles(chart, &chord.half);
    let [du, dv] = chart.derivatives[a];
    let step = to - from;
    let missed = chart.xyz[b].distance(chart.xyz[a] + du * step.x + dv * step.y);
    if missed <= near && chord.sag <= near {
        return true;
    }
    let middle = chord.of.and_then(|of| middle_of(context, of));
    middle.is_some_and(|m| chart.point(0.5 * (from + to)).distance(m) <= near)
}

/// The middle of the exact curve over a chord of an edge.
fn middle_of(context: &Context<'_>, (edge, chord): (u32, u32)) -> Option<DVec3> {
    let curve = context.part.edges[edge as usize].curve.as_deref()?;
    let at = &context.edges[edge as usize].parameters;
    let (from, to) = (at.get(chord as usize)?, at.get(chord as usize + 1)?);
    Some(curve.point(0.5 * (from + to)))
}

/// The ends of a half-edge in the chart; one at a pole is moved along the pole to the parameter line of the
/// other.
pub(crate) fn beside_poles(chart: &Chart<'_>, half: &Half) -> [DVec2; 2] {
    let ends = [half.a, half.b];
    let mut uv = ends.map(|c| chart.mesh.corners[c as usize].uv);
    let poles = ends.map(|c| chart.at_pole(c));
    for i in 0..2 {
        let Some(pole) = poles[i] else { continue };
        uv[i][pole.axis] = pole.value;
        if poles[1 - i].is_none() {
            uv[i][1 - pole.axis] = uv[1 - i][1 - pole.axis];
        }
    }
    uv
}

/// True for the two sides of a cut that are the same moved by whole periods, but for an end at a pole, which
/// has many places in the chart.
fn is_seam(chart: &Chart<'_>, [there, back]: &[Half; 2]) -> bool {
    let uv = |c: u32| chart.mesh.corners[c as usize].uv;
    let moved = |one: u32, other: u32| {
        let at_pole = chart.pole_axis(one).or(chart.pole_axis(other)).is_some();
        (!at_pole).then(|| uv(other) - uv(one))
    };
    let near = ROUNDING * (1.0 + chart.uv_box.size().max_element());
    let whole = |d: DVec2| (d - chart.whole_turns(d)).abs().max_element() <= near;
    match (moved(there.a, back.b), moved(there.b, back.a)) {
        (Some(d), Some(e)) => whole(d) && (d - e).abs().max_element() <= near,
        (Some(d), None) | (None, Some(d)) => whole(d),
        (None, None) => true,
    }
}
