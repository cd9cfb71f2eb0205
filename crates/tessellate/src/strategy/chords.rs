//! Chords of trimming curves judged in the plane of parameters, leaf by leaf.
//!
//! Source: Kahlesz, Balázs, Klein 2001, section 6: over each leaf a curve may lie as far from its chord as the leaf's stretch of
//! lengths allows ([`super::quadtree`]). The document cuts curves at the borders of leaves; here a chord belongs to
//! the leaf that holds its middle, as borders set no vertices on edges. Distances are samples of the edge's curve,
//! brought back onto the surface: a choice of where to cut, not a proof.

use super::cells::{Cells, Rule};
use crate::chart::Segment;
use crate::face::FaceWork;
use chordal_nurbs::DVec2;

/// The chords (edge, index) that lie farther from their curves than the rule allows; none where it has no opinion.
pub(crate) fn coarse_chords(work: &FaceWork<'_, '_>, cells: &Cells, rule: &dyn Rule) -> Vec<(u32, u32)> {
    let tolerance = work.limits.tolerance;
    let asked = cells.leaves.first().and_then(|leaf| rule.chord_share(&leaf.piece, tolerance));
    if asked.is_none() {
        return Vec::new();
    }
    let chords = chords(work);
    let middles: Vec<DVec2> = chords.iter().map(|c| c.uv[0].midpoint(c.uv[1])).collect();
    let leaves = cells.leaf_of_each(&middles);
    let mut coarse: Vec<(u32, u32)> = chords
        .iter()
        .zip(leaves)
        .filter_map(|(chord, leaf)| {
            let leaf = &cells.leaves[leaf?];
            let share = rule.chord_share(&leaf.piece, tolerance)?;
            (deviation(work, chord, leaf.bounds.size()) > share).then_some((chord.edge, chord.index))
        })
        .collect();
    coarse.sort_unstable();
    coarse.dedup();
    coarse
}

struct Chord {
    edge: u32,
    index: u32,
    uv: [DVec2; 2],
    /// The first end comes first along the edge.
    forward: bool,
}

fn chords(work: &FaceWork<'_, '_>) -> Vec<Chord> {
    let points = &work.chart.points;
    let ring = |&(start, end): &(u32, u32)| {
        (start..end).map(move |i| [i as usize, if i + 1 == end { start } else { i + 1 } as usize])
    };
    let chord = |[i, j]: [usize; 2]| {
        let Segment::Edge { edge, chord } = points[i].segment else { return None };
        let samples = &work.context.edges[edge as usize];
        let (a, b) = (work.position(points[i].key), samples.points[chord as usize]);
        let forward = a.distance_squared(b) <= a.distance_squared(samples.points[chord as usize + 1]);
        Some(Chord { edge, index: chord, uv: [points[i].uv, points[j].uv], forward })
    };
    work.chart.loops.iter().flat_map(ring).filter_map(chord).collect()
}

/// The largest distance of the curve's parameters from the chord, lengths counted in `size` per direction.
fn deviation(work: &FaceWork<'_, '_>, chord: &Chord, size: DVec2) -> f64 {
    let samples = &work.context.edges[chord.edge as usize];
    let Some(curve) = work.context.part.edges[chord.edge as usize].curve.as_deref() else { return 0.0 };
    let (from, to) = (samples.t[chord.index as usize], samples.t[chord.index as usize + 1]);
    let [a, b] = chord.uv;
    let d = (b - a) / size;
    [0.25, 0.5, 0.75].iter().fold(0.0f64, |largest, &s| {
        let along = if chord.forward { s } else { 1.0 - s };
        let start = a.lerp(b, along);
        let uv = work.context.surface.descend(curve.point(from + s * (to - from)), start);
        let off = (uv - a) / size;
        let distance = off.perp_dot(d).abs() / d.length().max(f64::MIN_POSITIVE);
        // Where the search left the chord's surroundings, it found another part of the surface.
        if (uv - start).length() > (b - a).length() { largest } else { largest.max(distance) }
    })
}
