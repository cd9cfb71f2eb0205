//! What readers of boundary representations share: a part under construction, issues, loops that must close.

mod bad;
mod chain;
mod merge;
mod notes;
mod placement;
mod splines;

pub(crate) use bad::{Bad, Res};
pub(crate) use chain::{Chained, chained};
pub(crate) use merge::merge_vertices;
pub(crate) use notes::Notes;
pub(crate) use placement::placement;
pub(crate) use splines::{expanded_knots, replace_zero_weights, unrolled};

use chordal_brep::{Coedge, Edge, EdgeId, Part, Source, Vertex, VertexId};
use chordal_nurbs::{Curve, DVec3, Range};
use rustc_hash::FxHashMap;
use std::sync::Arc;

/// A part under construction.
#[derive(Debug, Default)]
pub(crate) struct PartBuilder {
    pub part: Part,
    /// Vertices found to be one.
    same: Vec<(VertexId, VertexId)>,
    /// Straight edges put into gaps of loops, by their vertices.
    joints: FxHashMap<(VertexId, VertexId), EdgeId>,
}

/// Ends of a loop's edges that are nearer than this part of the loop's size are one vertex, where the file
/// says no more: coordinates are commonly rounded to seven digits.
const SAME_VERTEX: f64 = 1e-6;

impl PartBuilder {
    /// Continues a part that has a name and a source only.
    pub(crate) fn new(part: Part) -> Self {
        Self { part, ..Self::default() }
    }

    pub(crate) fn new_vertex(&mut self, point: DVec3, source: Source) -> VertexId {
        let id = VertexId::from(self.part.vertices.len());
        self.part.vertices.push(Vertex { point, source });
        id
    }

    pub(crate) fn point_of(&self, vertex: VertexId) -> DVec3 {
        self.part.vertices[vertex.index()].point
    }

    pub(crate) fn push_edge(&mut self, edge: Edge) -> EdgeId {
        let id = EdgeId::from(self.part.edges.len());
        self.part.edges.push(edge);
        id
    }

    /// A straight edge between two vertices; a single point where they are in one place.
    pub(crate) fn straight_edge(&mut self, start: VertexId, end: VertexId, source: Source) -> EdgeId {
        let (p, q) = (self.point_of(start), self.point_of(end));
        let range = Range::new(0.0, 1.0);
        if p == q {
            self.merge(start, end);
            return self.push_edge(Edge { curve: None, range, start, end: start, source });
        }
        let curve = Some(Arc::new(Curve::Line { origin: p, direction: q - p }));
        self.push_edge(Edge { curve, range, start, end, source })
    }

    /// Start and end of a coedge in the direction of its loop.
    pub(crate) fn ends(&self, coedge: &Coedge) -> (VertexId, VertexId) {
        let edge = &self.part.edges[coedge.edge.index()];
        if coedge.forward { (edge.start, edge.end) } else { (edge.end, edge.start) }
    }

    /// Notes that two vertices are one.
    pub(crate) fn merge(&mut self, a: VertexId, b: VertexId) {
        if a != b {
            self.same.push((a.min(b), a.max(b)));
        }
    }

    /// The finished part.
    pub(crate) fn finish(mut self) -> Part {
        merge_vertices(&mut self.part, &self.same);
        self.part
    }

    /// How many coedges of a loop do not end in the vertex where the next one starts.
    pub(crate) fn breaks(&self, coedges: &[Coedge]) -> usize {
        let next = coedges.iter().cycle().skip(1);
        coedges.iter().zip(next).filter(|(a, b)| self.ends(a).1 != self.ends(b).0).count()
    }

    /// How many coedges of a loop end further than `stated` (or rounding) from where the next one starts.
    pub(crate) fn gaps(&self, coedges: &[Coedge], stated: f64) -> usize {
        let tolerance = self.joint_tolerance(coedges, stated);
        let next = coedges.iter().cycle().skip(1);
        let apart =
            |a: VertexId, b: VertexId| a != b && self.point_of(a).distance(self.point_of(b)) > tolerance;
        coedges.iter().zip(next).filter(|(a, b)| apart(self.ends(a).1, self.ends(b).0)).count()
    }

    /// Merges the vertices where consecutive coedges of a loop meet in one place but not in one vertex.
    pub(crate) fn merge_meeting(&mut self, coedges: &[Coedge], stated: f64) {
        let tolerance = self.joint_tolerance(coedges, stated);
        for i in 0..coedges.len() {
            let (a, b) = (self.ends(&coedges[i]).1, self.ends(&coedges[(i + 1) % coedges.len()]).0);
            if self.point_of(a).distance(self.point_of(b)) <= tolerance {
                self.merge(a, b);
            }
        }
    }

    /// Closes a loop whose coedges are in order: ends within `stated` (or rounding) of each other become one
    /// vertex, wider gaps are closed with straight edges. Returns the widest of these gaps, 0 where there is
    /// none.
    pub(crate) fn close(&mut self, coedges: &mut Vec<Coedge>, stated: f64, source: Source) -> f64 {
        self.merge_meeting(coedges, stated);
        let tolerance = self.joint_tolerance(coedges, stated);
        let mut joined = Vec::with_capacity(coedges.len() + 2);
        let mut widest = 0.0f64;
        for i in 0..coedges.len() {
            joined.push(coedges[i].clone());
            let (a, b) = (self.ends(&coedges[i]).1, self.ends(&coedges[(i + 1) % coedges.len()]).0);
            let gap = self.point_of(a).distance(self.point_of(b));
            if a != b && gap > tolerance {
                widest = widest.max(gap);
                joined.push(self.joint(a, b, source));
            }
        }
        *coedges = joined;
        widest
    }

    fn joint_tolerance(&self, coedges: &[Coedge], stated: f64) -> f64 {
        let first = coedges.first().map_or(DVec3::ZERO, |c| self.point_of(self.ends(c).0));
        let far = |v: VertexId| self.point_of(v).distance(first);
        let size = coedges.iter().map(|c| far(self.ends(c).0).max(far(self.ends(c).1))).fold(0.0, f64::max);
        stated.min(1e-3 * size).max(SAME_VERTEX * size)
    }

    /// A straight edge from one vertex to another, shared by all loops that need it.
    fn joint(&mut self, from: VertexId, to: VertexId, source: Source) -> Coedge {
        let (start, end) = (from.min(to), from.max(to));
        let known = self.joints.get(&(start, end)).copied();
        let edge = known.unwrap_or_else(|| {
            let edge = self.straight_edge(start, end, source);
            self.joints.insert((start, end), edge);
            edge
        });
        Coedge { edge, forward: from == start, pcurves: Vec::new() }
    }
}
