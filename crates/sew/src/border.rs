//! Borders: the edges that exactly one coedge uses, each as a polyline with parameters.

use crate::foot::segment_distance;
use chordal_brep::{EdgeId, Loop, Part};
use chordal_nurbs::{Box3, BoxTree, Curve, Range};
use glam::DVec3;
use rayon::prelude::*;
use std::sync::Arc;

/// A chord is halved while its curve is further from it than this share of its length, so that boxes stay
/// slim.
const STRAY: f64 = 0.05;
/// The most halvings of one smooth piece.
const DEPTH: usize = 8;
/// The fewest chords of a closed edge: fewer would not show its direction.
const CLOSED_CHORDS: usize = 6;

/// Where an edge is used.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Use {
    pub face: u32,
    pub in_loop: u32,
    pub coedge: u32,
    pub forward: bool,
}

/// An edge with one use.
#[derive(Clone, Debug)]
pub(crate) struct Border {
    pub edge: EdgeId,
    pub of: Use,
    pub curve: Arc<Curve>,
    pub range: Range,
    /// Vertices of the part.
    pub ends: [u32; 2],
    /// Parameters of the polyline, ends included.
    pub t: Vec<f64>,
    pub points: Vec<DVec3>,
    /// For each chord, the approximate distance of the curve from it.
    pub stray: Vec<f64>,
    pub length: f64,
}

/// All borders of a part, with a tree over their chords.
#[derive(Clone, Debug, Default)]
pub(crate) struct Borders {
    pub all: Vec<Border>,
    /// For each chord of the tree, its border and its index there.
    pub chords: Vec<(u32, u32)>,
    pub tree: BoxTree,
}

/// The uses of every edge, in the order of faces and loops.
pub(crate) fn edge_uses(part: &Part) -> Vec<Vec<Use>> {
    let mut uses = vec![Vec::new(); part.edges.len()];
    for (face, of_face) in part.faces.iter().enumerate() {
        for (in_loop, a_loop) in of_face.loops.iter().enumerate() {
            let Loop::Edges { coedges, .. } = a_loop else { continue };
            for (coedge, used) in coedges.iter().enumerate() {
                uses[used.edge.index()].push(Use {
                    face: face as u32,
                    in_loop: in_loop as u32,
                    coedge: coedge as u32,
                    forward: used.forward,
                });
            }
        }
    }
    uses
}

impl Borders {
    /// Collects the borders of a part in the order of its edges.
    pub fn new(part: &Part, uses: &[Vec<Use>]) -> Self {
        let single: Vec<usize> = (0..part.edges.len())
            .filter(|&e| uses[e].len() == 1 && part.edges[e].range.is_finite())
            .collect();
        let all: Vec<Border> = single
            .par_iter()
            .with_min_len(64)
            .filter_map(|&e| Border::new(part, EdgeId::from(e), uses[e][0]))
            .collect();
        let mut chords = Vec::new();
        let mut boxes = Vec::new();
        for (b, border) in all.iter().enumerate() {
            for (k, ends) in border.points.windows(2).enumerate() {
                chords.push((b as u32, k as u32));
                boxes.push(Box3::from_points([ends[0], ends[1]]).inflated(border.stray[k]));
            }
        }
        Self { all, chords, tree: BoxTree::new(boxes) }
    }

    /// The distance of `p` from a chord of the tree, minus the distance of the curve from that chord.
    pub fn distance(&self, chord: u32, p: DVec3) -> f64 {
        let (b, k) = self.chords[chord as usize];
        let border = &self.all[b as usize];
        let (k, ends) = (k as usize, &border.points);
        (segment_distance(p, ends[k], ends[k + 1]).0 - border.stray[k]).max(0.0)
    }
}

impl Border {
    fn new(part: &Part, id: EdgeId, of: Use) -> Option<Self> {
        let edge = &part.edges[id.index()];
        let curve = edge.curve.clone()?;
        let least = if edge.start == edge.end { CLOSED_CHORDS } else { 1 };
        let t = nodes(&curve, edge.range, least);
        let points: Vec<DVec3> = t.iter().map(|&t| curve.point(t)).collect();
        if points.iter().any(|p| !p.is_finite()) {
            return None;
        }
        let stray: Vec<f64> = t.windows(2).map(|t| 1.5 * strays(&curve, t[0], t[1])).collect();
        let length = points.windows(2).map(|p| p[0].distance(p[1])).sum();
        let ends = [edge.start.0, edge.end.0];
        Some(Self { edge: id, of, curve, range: edge.range, ends, t, points, stray, length })
    }

    /// Parameters of a polyline of any edge, ends included, with a least number of steps.
    pub fn parameters(curve: &Curve, range: Range, least: usize) -> Vec<f64> {
        if matches!(curve, Curve::Line { .. }) {
            return (0..=least).map(|i| range.start + range.length() * i as f64 / least as f64).collect();
        }
        nodes(curve, range, least)
    }

    pub fn is_straight(&self) -> bool {
        matches!(*self.curve, Curve::Line { .. })
    }

    /// The nodes of the polyline strictly between two parameters, and the middles between neighbours.
    pub fn between(&self, range: Range) -> Vec<f64> {
        let mut inner: Vec<f64> = vec![range.start];
        inner.extend(self.t.iter().copied().filter(|&t| t > range.start && t < range.end));
        inner.push(range.end);
        let least = if self.is_straight() { 2 } else { 8 };
        while inner.len() < least + 1 {
            inner = halved(&inner);
        }
        let mut found: Vec<f64> = inner.windows(2).map(|w| 0.5 * (w[0] + w[1])).collect();
        found.extend(&inner[1..inner.len() - 1]);
        found.sort_by(f64::total_cmp);
        found
    }
}

fn halved(t: &[f64]) -> Vec<f64> {
    let mut fine = vec![t[0]];
    t.windows(2).for_each(|w| fine.extend([0.5 * (w[0] + w[1]), w[1]]));
    fine
}

/// The approximate distance of the curve from a chord, measured at three places.
fn strays(curve: &Curve, t0: f64, t1: f64) -> f64 {
    if matches!(curve, Curve::Line { .. }) {
        return 0.0;
    }
    let (a, b) = (curve.point(t0), curve.point(t1));
    [0.25, 0.5, 0.75]
        .iter()
        .map(|s| segment_distance(curve.point(t0 + (t1 - t0) * s), a, b).0)
        .fold(0.0, f64::max)
}

fn nodes(curve: &Curve, range: Range, least: usize) -> Vec<f64> {
    let mut stops = vec![range.start];
    stops.extend(curve.breaks(range));
    stops.push(range.end);
    while stops.len() < least + 1 {
        stops = halved(&stops);
    }
    let mut t = vec![range.start];
    stops.windows(2).for_each(|w| refine(curve, w[0], w[1], DEPTH, &mut t));
    t
}

fn refine(curve: &Curve, t0: f64, t1: f64, depth: usize, t: &mut Vec<f64>) {
    let length = curve.point(t0).distance(curve.point(t1));
    if depth > 0 && strays(curve, t0, t1) > STRAY * length {
        let middle = 0.5 * (t0 + t1);
        refine(curve, t0, middle, depth - 1, t);
        refine(curve, middle, t1, depth - 1, t);
    } else {
        t.push(t1);
    }
}
