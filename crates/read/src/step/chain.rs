//! Loops whose coedges do not meet end to start: turned, reordered, their vertices merged, and finally joined
//! by straight edges, so that every loop is closed.

use super::builder::Builder;
use super::document::Ix;
use crate::assemble::chained;
use chordal_brep::{Coedge, EdgeId, ReadIssue};
use chordal_nurbs::Range;
use std::sync::Arc;

impl Builder<'_> {
    /// Closes a loop. Each step is tried only if gaps remain after the steps before it.
    pub(crate) fn mend_chain(&mut self, ix: Ix, coedges: &mut Vec<Coedge>) {
        if self.build.breaks(coedges) > 0 {
            self.mend_broken_chain(ix, coedges);
        }
        self.settled.resize(self.build.part.edges.len(), false);
        for coedge in coedges {
            self.settled[coedge.edge.index()] = true;
        }
    }

    fn mend_broken_chain(&mut self, ix: Ix, coedges: &mut Vec<Coedge>) {
        let stated = self.build.part.uncertainty.unwrap_or(0.0);
        self.build.merge_meeting(coedges, stated);
        if self.build.gaps(coedges, stated) == 0 {
            return;
        }
        self.turn_misfits(ix, coedges);
        if self.build.gaps(coedges, stated) > 0
            && let Some(sorted) = self.sorted(coedges)
        {
            *coedges = sorted;
            self.doc.warn(ix, ReadIssue::EdgesSorted);
        }
        let gap = self.build.close(coedges, stated, self.doc.source(ix));
        if gap > 0.0 {
            self.doc.warn(ix, ReadIssue::GapClosed { gap: self.geometry.units.millimetres(gap) });
        }
    }

    /// Mends coedges that fit only the other way round.
    ///
    /// On an open curve the vertices determine the direction of the edge, so the flag of the use is wrong. On
    /// a closed one they do not: there it is the edge, rather than each of its uses, that has its two
    /// vertices exchanged, and the other part of the curve is meant; unless an earlier loop was content with
    /// it.
    fn turn_misfits(&mut self, ix: Ix, coedges: &mut [Coedge]) {
        let count = coedges.len();
        for i in 0..count {
            let [previous, next] =
                [(i + count - 1) % count, (i + 1) % count].map(|k| self.build.ends(&coedges[k]));
            let (start, end) = self.build.ends(&coedges[i]);
            let breaks = |start, end| usize::from(previous.1 != start) + usize::from(end != next.0);
            if count < 2 || breaks(end, start) >= breaks(start, end) {
                continue;
            }
            if self.exchange_vertices(coedges[i].edge) {
                coedges[i].pcurves.clear();
            } else {
                coedges[i].forward = !coedges[i].forward;
                self.doc.warn(ix, ReadIssue::EdgeTurned);
            }
        }
    }

    /// Makes an edge on a closed curve the other part between its vertices; false where it has no other part
    /// or where a loop uses it already.
    fn exchange_vertices(&mut self, id: EdgeId) -> bool {
        let edge = &mut self.build.part.edges[id.index()];
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
            self.doc.warn(ix, ReadIssue::VerticesExchanged);
            if let Some(Ok(known)) = self.edges.get_mut(&ix) {
                known.pcurves = Arc::new([]);
            }
        }
        true
    }

    /// The same coedges in an order in which each starts where the one before ends, if they make one closed
    /// loop.
    fn sorted(&self, coedges: &[Coedge]) -> Option<Vec<Coedge>> {
        let mut found = chained(coedges.to_vec(), |coedge| self.build.ends(coedge), |_, _| f64::INFINITY);
        if found.open.is_empty() && found.closed.len() == 1 { found.closed.pop() } else { None }
    }
}
