//! Loops whose coedges do not meet end to start: turned, reordered, their vertices merged, and at last joined by
//! straight edges, so that a loop is closed whatever the file says.

use super::builder::Builder;
use super::document::Ix;
use chordal_brep::{Coedge, Edge, EdgeId, VertexId};
use chordal_nurbs::{Curve, Range};
use std::sync::Arc;

impl Builder<'_> {
    fn ends(&self, coedge: &Coedge) -> (VertexId, VertexId) {
        let edge = &self.part.edges[coedge.edge.index()];
        if coedge.forward { (edge.start, edge.end) } else { (edge.end, edge.start) }
    }

    /// How many coedges do not end in the vertex where the next one starts.
    fn breaks(&self, coedges: &[Coedge]) -> usize {
        let next = coedges.iter().cycle().skip(1);
        coedges.iter().zip(next).filter(|(a, b)| self.ends(a).1 != self.ends(b).0).count()
    }

    /// Closes a loop. Each step is tried only where the ones before left breaks.
    pub(crate) fn mend_chain(&mut self, ix: Ix, coedges: &mut Vec<Coedge>) {
        if self.breaks(coedges) > 0 {
            self.mend_broken_chain(ix, coedges);
        }
        self.settled.resize(self.part.edges.len(), false);
        for coedge in coedges {
            self.settled[coedge.edge.index()] = true;
        }
    }

    fn mend_broken_chain(&mut self, ix: Ix, coedges: &mut Vec<Coedge>) {
        self.merge_met(coedges);
        if self.breaks_apart(coedges) == 0 {
            return;
        }
        self.turn_misfits(ix, coedges);
        if self.breaks_apart(coedges) > 0
            && let Some(sorted) = self.sorted(coedges)
        {
            *coedges = sorted;
            self.doc.warn(ix, "the edges of the loop are not listed in order; they are sorted");
        }
        self.merge_met(coedges);
        self.join(ix, coedges);
    }

    /// The distance within which two ends of a loop's edges are one vertex.
    fn joint_tolerance(&self, coedges: &[Coedge]) -> f64 {
        let points = coedges.iter().map(|c| self.point_of(self.ends(c).0));
        let first = self.point_of(self.ends(&coedges[0]).0);
        let size = points.map(|p| p.distance(first)).fold(0.0, f64::max);
        let size = if size > 0.0 { size } else { first.distance(self.point_of(self.ends(&coedges[0]).1)) };
        let stated = self.part.uncertainty.unwrap_or(0.0).min(1e-3 * size);
        stated.max(1e-6 * size)
    }

    fn breaks_apart(&self, coedges: &[Coedge]) -> usize {
        let tolerance = self.joint_tolerance(coedges);
        let next = coedges.iter().cycle().skip(1);
        let apart =
            |a: VertexId, b: VertexId| a != b && self.point_of(a).distance(self.point_of(b)) > tolerance;
        coedges.iter().zip(next).filter(|(a, b)| apart(self.ends(a).1, self.ends(b).0)).count()
    }

    /// Merges the vertices where consecutive coedges meet in one place but not in one vertex.
    fn merge_met(&mut self, coedges: &[Coedge]) {
        let tolerance = self.joint_tolerance(coedges);
        for i in 0..coedges.len() {
            let (a, b) = (self.ends(&coedges[i]).1, self.ends(&coedges[(i + 1) % coedges.len()]).0);
            if self.point_of(a).distance(self.point_of(b)) <= tolerance {
                self.merge(a, b);
            }
        }
    }

    /// Mends coedges that fit only the other way round.
    ///
    /// On an open curve the vertices tell which way the edge runs, so the flag of the use is wrong. On a closed one
    /// they do not: there it is the edge, rather than each of its uses, that has its two vertices exchanged, and the
    /// other part of the curve is meant; unless an earlier loop was content with it.
    fn turn_misfits(&mut self, ix: Ix, coedges: &mut [Coedge]) {
        let count = coedges.len();
        for i in 0..count {
            let [previous, next] = [(i + count - 1) % count, (i + 1) % count].map(|k| self.ends(&coedges[k]));
            let (start, end) = self.ends(&coedges[i]);
            let breaks = |start, end| usize::from(previous.1 != start) + usize::from(end != next.0);
            if count < 2 || breaks(end, start) >= breaks(start, end) {
                continue;
            }
            if self.exchange_vertices(coedges[i].edge) {
                coedges[i].pcurves.clear();
            } else {
                coedges[i].forward = !coedges[i].forward;
                self.doc.warn(ix, "an edge of the loop runs against the others; it is turned round");
            }
        }
    }

    /// Makes an edge on a closed curve the other part between its vertices; false where it has no other part or where
    /// a loop uses it already.
    fn exchange_vertices(&mut self, id: EdgeId) -> bool {
        let edge = &mut self.part.edges[id.index()];
        let Some(period) = edge.curve.as_ref().and_then(|curve| curve.period()) else { return false };
        if edge.start == edge.end || self.settled.get(id.index()) == Some(&true) {
            return false;
        }
        let Range { start, end } = edge.range;
        if start + period <= end {
            return false;
        }
        edge.range = Range::new(end, start + period);
        std::mem::swap(&mut edge.start, &mut edge.end);
        let entity = self.doc.find(edge.source.entity);
        if let Some(ix) = entity {
            self.doc.warn(ix, "its vertices are exchanged: the loops run the other part of its closed curve");
            if let Some(Ok(known)) = self.edges.get_mut(&ix) {
                known.pcurves = Arc::new([]);
            }
        }
        true
    }

    /// The same coedges in an order in which each starts where the one before ends, if there is one without a choice.
    fn sorted(&self, coedges: &[Coedge]) -> Option<Vec<Coedge>> {
        const MOST: usize = 1000;
        if coedges.len() > MOST {
            return None;
        }
        let mut left: Vec<Coedge> = coedges.to_vec();
        let mut chain = vec![left.remove(0)];
        while !left.is_empty() {
            let end = self.ends(chain.last().expect("the chain starts with one")).1;
            let next = left.iter().position(|c| self.ends(c).0 == end)?;
            chain.push(left.remove(next));
        }
        (self.breaks(&chain) == 0).then_some(chain)
    }

    /// Puts a straight edge into every gap that is left.
    fn join(&mut self, ix: Ix, coedges: &mut Vec<Coedge>) {
        let tolerance = self.joint_tolerance(coedges);
        let mut joined = Vec::with_capacity(coedges.len() + 2);
        let mut widest = 0.0f64;
        for i in 0..coedges.len() {
            joined.push(coedges[i].clone());
            let (a, b) = (self.ends(&coedges[i]).1, self.ends(&coedges[(i + 1) % coedges.len()]).0);
            let gap = self.point_of(a).distance(self.point_of(b));
            if a != b && gap > tolerance {
                widest = widest.max(gap);
                joined.push(self.joining(ix, a, b));
            }
        }
        if widest > 0.0 {
            self.doc.warn(
                ix,
                format!("consecutive edges of the loop are {widest:.3e} apart; joined by straight edges"),
            );
            *coedges = joined;
        }
    }

    /// A straight edge from one vertex to another, shared by all loops that need it.
    fn joining(&mut self, ix: Ix, from: VertexId, to: VertexId) -> Coedge {
        let (start, end) = (from.min(to), from.max(to));
        let known = self.joints.get(&(start, end)).copied();
        let edge = known.unwrap_or_else(|| {
            let (p, q) = (self.point_of(start), self.point_of(end));
            let id = EdgeId::from(self.part.edges.len());
            let curve = Some(Arc::new(Curve::Line { origin: p, direction: q - p }));
            let source = self.doc.source(ix);
            self.part.edges.push(Edge { curve, range: Range::new(0.0, 1.0), start, end, source });
            self.joints.insert((start, end), id);
            id
        });
        Coedge { edge, forward: from == start, pcurves: Vec::new() }
    }
}
