//! T-junctions: an edge is cut where a vertex of another edge lies on it, so that overlapping edges become
//! pieces between the same vertices.

use crate::border::{Border, Borders};
use crate::cluster::Clusters;
use crate::foot::{foot, segment_distance};
use chordal_nurbs::{Box3, Range};
use rayon::prelude::*;

/// Cuts are at least this share of the tolerance away from each other and from the ends.
const SHORTEST: f64 = 0.05;
/// A vertex may cut one edge twice only where the edge is this many tolerances long between the two places.
const SAME_VERTEX: f64 = 3.0;

/// A part of a border between two merged vertices.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Piece {
    pub border: u32,
    pub range: Range,
    /// Clusters at the start and the end of the range.
    pub ends: [u32; 2],
}

/// All pieces, in the order of the borders.
#[derive(Clone, Debug, Default)]
pub(crate) struct Pieces {
    pub all: Vec<Piece>,
    /// For each border, the range of its pieces.
    pub of: Vec<(u32, u32)>,
    /// The largest distance of a cut from its vertex.
    pub largest_move: f64,
}

/// A place on a border where it is to be cut.
#[derive(Clone, Copy, Debug)]
struct Cut {
    border: u32,
    t: f64,
    cluster: u32,
    distance: f64,
}

/// Cuts every border at the vertices that lie on it; `ends` are the clusters of the borders' own ends.
pub(crate) fn cut(borders: &Borders, ends: &[[u32; 2]], clusters: &Clusters, tolerance: f64) -> Pieces {
    let mut cuts: Vec<Cut> = (0..clusters.all.len() as u32)
        .into_par_iter()
        .with_min_len(64)
        .flat_map_iter(|c| cuts_at(borders, ends, clusters, c, tolerance))
        .collect();
    cuts.sort_unstable_by(|a, b| {
        a.border.cmp(&b.border).then(a.t.total_cmp(&b.t)).then(a.cluster.cmp(&b.cluster))
    });
    let mut pieces = Pieces::default();
    let mut at = 0;
    for (b, border) in borders.all.iter().enumerate() {
        let first = at;
        while at < cuts.len() && cuts[at].border == b as u32 {
            at += 1;
        }
        let kept = kept(border, ends[b], &cuts[first..at], tolerance);
        pieces.largest_move = kept.iter().fold(pieces.largest_move, |m, c| m.max(c.distance));
        pieces.add(border, b as u32, ends[b], &kept);
    }
    pieces
}

impl Pieces {
    fn add(&mut self, border: &Border, index: u32, ends: [u32; 2], cuts: &[Cut]) {
        let first = self.all.len() as u32;
        let (mut t, mut cluster) = (border.range.start, ends[0]);
        for cut in cuts {
            let range = Range::new(t, cut.t);
            self.all.push(Piece { border: index, range, ends: [cluster, cut.cluster] });
            (t, cluster) = (cut.t, cut.cluster);
        }
        let range = Range::new(t, border.range.end);
        self.all.push(Piece { border: index, range, ends: [cluster, ends[1]] });
        self.of.push((first, self.all.len() as u32));
    }
}

/// The places where one vertex lies on borders that do not end in it.
fn cuts_at(
    borders: &Borders,
    ends: &[[u32; 2]],
    clusters: &Clusters,
    cluster: u32,
    tolerance: f64,
) -> Vec<Cut> {
    let p = clusters.all[cluster as usize].target;
    let mut near: Vec<(u32, u32, f64)> = Vec::new();
    borders.tree.meeting(Box3 { min: p, max: p }.inflated(tolerance), |chord| {
        let (b, k) = borders.chords[chord as usize];
        let border = &borders.all[b as usize];
        if ends[b as usize].contains(&cluster) {
            return;
        }
        let (d, s) = segment_distance(p, border.points[k as usize], border.points[k as usize + 1]);
        if d <= tolerance + border.stray[k as usize] {
            let t = &border.t[k as usize..];
            near.push((b, k, t[0] + (t[1] - t[0]) * s));
        }
    });
    near.sort_unstable_by_key(|n| (n.0, n.1));
    let mut found: Vec<Cut> = Vec::new();
    // Consecutive chords are one approach.
    for run in near.chunk_by(|a, b| a.0 == b.0 && a.1 + 1 == b.1) {
        let border = &borders.all[run[0].0 as usize];
        let feet = run.iter().map(|&(_, _, t)| foot(&border.curve, border.range, p, t));
        let best = feet.min_by(|a, b| a.1.total_cmp(&b.1).then(a.0.total_cmp(&b.0)));
        if let Some((t, distance)) = best.filter(|f| f.1 <= tolerance) {
            found.push(Cut { border: run[0].0, t, cluster, distance });
        }
    }
    found
}

/// The cuts of a border, in the order of their parameters, without slivers; of two cuts that are too
/// near to each other, the one closer to its vertex.
fn kept(border: &Border, ends: [u32; 2], cuts: &[Cut], tolerance: f64) -> Vec<Cut> {
    let shortest = SHORTEST * tolerance;
    let apart = |t0: f64, t1: f64| border.curve.point(t0).distance(border.curve.point(t1));
    let mut kept: Vec<Cut> = Vec::new();
    for &cut in cuts {
        if apart(cut.t, border.range.start).min(apart(cut.t, border.range.end)) <= shortest {
            continue;
        }
        while let Some(last) = kept.last() {
            let too_near = apart(last.t, cut.t) <= shortest
                || last.cluster == cut.cluster
                    && run_length(border, last.t, cut.t) <= SAME_VERTEX * tolerance;
            if !too_near || last.distance <= cut.distance {
                break;
            }
            kept.pop();
        }
        let free = kept.last().is_none_or(|last| {
            apart(last.t, cut.t) > shortest
                && (last.cluster != cut.cluster
                    || run_length(border, last.t, cut.t) > SAME_VERTEX * tolerance)
        });
        if free && !ends.contains(&cut.cluster) {
            kept.push(cut);
        }
    }
    kept
}

/// The approximate length of the border between two parameters.
fn run_length(border: &Border, t0: f64, t1: f64) -> f64 {
    let mut last = border.curve.point(t0);
    let mut length = 0.0;
    for &t in border.t.iter().filter(|&&t| t > t0 && t < t1).chain([&t1]) {
        let p = border.curve.point(t);
        length += p.distance(last);
        last = p;
    }
    length
}
