//! Chords of trimming curves judged in the plane of parameters, leaf by leaf.
//!
//! Source: Kahlesz, Balázs, Klein 2001, section 6: over each leaf a curve may lie as far from its chord as
//! the leaf's stretch of lengths allows ([`super::quadtree`]). The paper cuts curves at the borders of
//! leaves and approximates every piece by itself. Here the curve over a chord is followed over the leaves in
//! the same way ([`super::tracking`]), but borders set no vertices on edges: the chord must be near enough to
//! the curve in every leaf that it passes. How near is bounded by the control points of the piece over the
//! leaf.

use super::cells::{Cells, Rule};
use super::leaf_mesh::LeafMesh;
use super::tracking::track;
use chordal_brep::{Face, Loop, Pcurve};
use chordal_nurbs::{BezierCurve, DVec2, Range};
use chordal_tessellate::method::{FaceMesh, Segment};

/// The chords that are too coarse, and how the curves were followed.
#[derive(Clone, Debug, Default)]
pub struct JudgedChords {
    /// Chords (edge, index) that lie farther from their curves than the rule allows.
    pub coarse: Vec<(u32, u32)>,
    /// How often each transition of the state machine was taken.
    pub transitions: [usize; 4],
    /// Curves that could not be followed to their end; they were judged by samples.
    pub lost: usize,
    /// Edges of leaves along which a curve ran.
    pub directed: usize,
}

/// Judges the chords of all loops; the result is empty where the rule does not judge chords.
pub fn judge_chords(face: &FaceMesh<'_, '_>, cells: &Cells, rule: &dyn Rule) -> JudgedChords {
    let tolerance = face.limits().boundary;
    let mut found = JudgedChords::default();
    let asked = cells.leaves.first().and_then(|leaf| rule.chord_share(&leaf.piece, tolerance));
    if asked.is_none() {
        return found;
    }
    let chords = chords(face);
    let mut mesh = LeafMesh::new(cells.leaves.iter().map(|leaf| leaf.bounds).collect());
    let shares: Vec<f64> = cells
        .leaves
        .iter()
        .map(|leaf| rule.chord_share(&leaf.piece, tolerance).unwrap_or(f64::INFINITY))
        .collect();
    let middles: Vec<DVec2> = chords.iter().map(|c| c.uv[0].midpoint(c.uv[1])).collect();
    for (chord, middle) in chords.iter().zip(cells.leaf_of_each(&middles)) {
        let curve = planar(face, chord);
        let tracked = track(&mut mesh, &curve);
        let sum = |i: usize| found.transitions[i] + tracked.transitions[i];
        found.transitions = std::array::from_fn(sum);
        let is_coarse = if tracked.lost {
            found.lost += 1;
            middle.is_some_and(|leaf| {
                let size = cells.leaves[leaf].bounds.size();
                curve.iter().any(|c| farthest(c, chord.uv, size) > shares[leaf])
            })
        } else {
            tracked.pieces.iter().any(|piece| {
                let Some(leaf) = piece.leaf.map(|leaf| leaf as usize) else { return false };
                let over_leaf = curve[piece.curve].restricted(piece.range[0], piece.range[1]);
                farthest(&over_leaf, chord.uv, cells.leaves[leaf].bounds.size()) > shares[leaf]
            })
        };
        if is_coarse {
            found.coarse.push((chord.edge, chord.index));
        }
    }
    found.directed = mesh.edges.values().filter(|e| e.forward.is_some()).count();
    found.coarse.sort_unstable();
    found.coarse.dedup();
    found
}

struct Chord {
    edge: u32,
    index: u32,
    uv: [DVec2; 2],
    /// The first end comes first along the edge.
    forward: bool,
}

fn chords(face: &FaceMesh<'_, '_>) -> Vec<Chord> {
    let points = &face.chart().points;
    let ring = |&(start, end): &(u32, u32)| {
        (start..end).map(move |i| [i as usize, if i + 1 == end { start } else { i + 1 } as usize])
    };
    let chord = |[i, j]: [usize; 2]| {
        let Segment::Edge { edge, chord } = points[i].segment else { return None };
        let samples = face.edge_samples(edge);
        let (a, b) = (face.position(points[i].key), samples.points[chord as usize]);
        let forward = a.distance_squared(b) <= a.distance_squared(samples.points[chord as usize + 1]);
        Some(Chord { edge, index: chord, uv: [points[i].uv, points[j].uv], forward })
    };
    face.chart().loops.iter().flat_map(ring).filter_map(chord).collect()
}

/// The largest distance of the control points, and so of the curve, from the line through a chord; lengths
/// counted in `size` per direction.
fn farthest(curve: &BezierCurve<DVec2>, [a, b]: [DVec2; 2], size: DVec2) -> f64 {
    let d = (b - a) / size;
    let off = |p: &DVec2| ((*p - a) / size).perp_dot(d).abs() / d.length().max(f64::MIN_POSITIVE);
    curve.points.iter().map(off).fold(0.0, f64::max)
}

/// The curve over a chord in the plane of the chart: the file's own where it has one that ends where the
/// chord does, else a cubic through four points of the edge, brought back onto the surface.
fn planar(face: &FaceMesh<'_, '_>, chord: &Chord) -> Vec<BezierCurve<DVec2>> {
    from_file(face, chord).unwrap_or_else(|| vec![through_samples(face, chord)])
}

/// The file's curves of an edge on a face; two of a seam.
fn pcurves(face: &Face, edge: u32) -> impl Iterator<Item = &Pcurve> {
    let coedges = face.loops.iter().flat_map(|a_loop| match a_loop {
        Loop::Edges { coedges, .. } => &coedges[..],
        _ => &[],
    });
    coedges.filter(move |c| c.edge.index() == edge as usize).flat_map(|c| &c.pcurves)
}

/// Ends of the file's curve may differ by this share of the chord's length.
const AGREES: f64 = 1e-3;

fn from_file(face: &FaceMesh<'_, '_>, chord: &Chord) -> Option<Vec<BezierCurve<DVec2>>> {
    let edge = &face.part().edges[chord.edge as usize];
    let t = &face.edge_samples(chord.edge).t;
    let [a, b] = chord.uv;
    let share = |t: f64| (t - edge.range.start) / edge.range.length();
    pcurves(face.face(), chord.edge).find_map(|pcurve| {
        let own = |t: f64| pcurve.range.start + share(t) * pcurve.range.length();
        let range = Range::new(own(t[chord.index as usize]), own(t[chord.index as usize + 1]));
        let mut pieces: Vec<BezierCurve<DVec2>> =
            pcurve.curve.to_nurbs(range).ok()?.bezier_pieces().into_iter().map(|(_, piece)| piece).collect();
        if !chord.forward {
            pieces.reverse();
            pieces.iter_mut().for_each(|piece| *piece = piece.reversed());
        }
        // The chart may lie whole periods beside the file's curve.
        let shift = a - *pieces.first()?.points.first()?;
        pieces.iter_mut().for_each(|piece| *piece = piece.mapped(|p| p + shift));
        let end = *pieces.last()?.points.last()?;
        let agrees = (end - b).length() <= AGREES * (b - a).length();
        let turns = |axis: usize| match face.surface().periods[axis] {
            Some(period) => (shift[axis] / period - (shift[axis] / period).round()).abs() * period,
            None => shift[axis].abs(),
        };
        (agrees && DVec2::new(turns(0), turns(1)).length() <= AGREES * (b - a).length()).then_some(pieces)
    })
}

fn through_samples(face: &FaceMesh<'_, '_>, chord: &Chord) -> BezierCurve<DVec2> {
    let [a, b] = chord.uv;
    let straight = BezierCurve { points: vec![a, b], weights: None };
    let samples = face.edge_samples(chord.edge);
    let Some(curve) = face.part().edges[chord.edge as usize].curve.as_deref() else { return straight };
    let (from, to) = (samples.t[chord.index as usize], samples.t[chord.index as usize + 1]);
    let at = |s: f64| {
        let along = if chord.forward { s } else { 1.0 - s };
        let start = a.lerp(b, s);
        let uv = face.surface().descend(curve.point(from + along * (to - from)), start);
        // The search left the surroundings of the chord: it found another part of the surface.
        ((uv - start).length() <= (b - a).length()).then_some(uv)
    };
    let (Some(p), Some(q)) = (at(1.0 / 3.0), at(2.0 / 3.0)) else { return straight };
    let (low, high) =
        ((p * 18.0 - q * 9.0 - a * 5.0 + b * 2.0) / 6.0, (q * 18.0 - p * 9.0 - b * 5.0 + a * 2.0) / 6.0);
    BezierCurve { points: vec![a, low, high, b], weights: None }
}
