//! The inaccuracy of edges of crossing loops. Edges within this distance of each other may be the same edge
//! in the file.
//!
//! The *looseness* of an edge is the largest distance of its ends from its vertices, and of its samples from
//! the surfaces of the faces whose loops cross.

use super::Crossed;
use crate::keys::{Key, Segment};
use chordal_brep::{Edge, Part, VertexId};
use chordal_nurbs::DVec3;
use std::collections::BTreeMap;

/// A distance larger than this fraction of the part's size is not looseness but a fault of another kind.
const LOOSEST: f64 = 1e-3;

/// Loops that hook back at a vertex by up to this many times the looseness of their edges meet in the vertex.
const HOOK: f64 = 4.0;

pub(super) struct Looseness {
    /// Points nearer together than this are one.
    pub resolution: f64,
    of_edge: BTreeMap<u32, f64>,
}

impl Looseness {
    pub(super) fn of(part: &Part, crossed: &[Crossed<'_, '_>], resolution: f64) -> Self {
        let mut of_edge: BTreeMap<u32, f64> = BTreeMap::new();
        for Crossed { context, chart, .. } in crossed {
            for point in &chart.points {
                let Segment::Edge { edge, .. } = point.segment else { continue };
                let on_edge = match point.key {
                    Key::Vertex(v) => part.vertices[v as usize].point,
                    Key::Edge(e, i) => context.edges[e as usize].points[i as usize],
                    Key::Private(_) => continue,
                };
                let own = of_edge.entry(edge).or_insert_with(|| end_gap(part, edge));
                *own = own.max(context.surface.point(point.uv).distance(on_edge));
            }
        }
        let loosest = LOOSEST * size(part);
        of_edge.values_mut().for_each(|gap| *gap = if gap.is_finite() { gap.min(loosest) } else { 0.0 });
        Self { resolution, of_edge }
    }

    pub(super) fn of_edge(&self, edge: u32) -> f64 {
        self.of_edge.get(&edge).copied().unwrap_or(0.0)
    }

    /// How far apart two edges may lie to be one.
    pub(super) fn between(&self, a: u32, b: u32) -> f64 {
        self.resolution + self.of_edge(a) + self.of_edge(b)
    }

    /// How far from a vertex an edge may lie and still begin or end there.
    pub(super) fn of_hook(&self, edge: u32) -> f64 {
        self.resolution + HOOK * self.of_edge(edge)
    }

    /// The common vertex of two edges that meet beside it, where both are so near to it that they may end
    /// there.
    pub(super) fn hook(&self, part: &Part, edges: [u32; 2], points: [DVec3; 2]) -> Option<VertexId> {
        let [a, b] = edges.map(|e| &part.edges[e as usize]);
        let of_b = [b.start, b.end];
        let at = |v: VertexId| part.vertices[v.index()].point;
        let is_near = |v: &VertexId| {
            (0..2).all(|k| points[k].distance(at(*v)) <= self.of_hook(edges[0]).max(self.of_hook(edges[1])))
        };
        [a.start, a.end].into_iter().filter(|v| of_b.contains(v)).find(is_near)
    }
}

/// The larger distance of an end of an edge from its vertex.
fn end_gap(part: &Part, edge: u32) -> f64 {
    let edge: &Edge = &part.edges[edge as usize];
    let Some(curve) = &edge.curve else { return 0.0 };
    let ends = [(edge.range.start, edge.start), (edge.range.end, edge.end)];
    ends.iter().fold(0.0, |m, (t, v)| m.max(curve.point(*t).distance(part.vertices[v.index()].point)))
}

/// The diagonal of the box of the vertices.
fn size(part: &Part) -> f64 {
    let points = part.vertices.iter().map(|v| v.point).filter(|p| p.is_finite());
    let (low, high) = points.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(a, b), p| (a.min(p), b.max(p)));
    let size = (high - low).length();
    if size.is_finite() { size } else { 0.0 }
}
